"""Panels of a sensitivity analysis: bars of the effects of the factors on each quantity, the largest on top."""

import numpy as np
from option_words import option_in_words
from picture_axes import COLOURS, GREY, Panel
from picture_rows import draw_beside, height_of, wrapped_rows
from picture_runs import engineering, engineering_of_si, in_words
from picture_table import keep
from sensitivity_measures import Analysis
from traverse_report.language import capital
from traverse_report.quantities import QUANTITIES, words_of

MOST_QUANTITIES, MOST_FACTORS = 4, 12
MAIN = {"sobol": "with all interactions (total index)", "morris": "size of the effect over the range of the option",
        "local": "change for one standard deviation of the option"}
SECOND = {"sobol": "alone (first index)", "morris": "standard deviation of the effects"}


def method_in_words(results):
    analysis = Analysis(results)
    runs = f"{len(results.file['study/finished']):,} runs"
    of = f"{100.0 * analysis.confidence:g} % confidence"
    return {"sobol": f"parts of the variance of each quantity, Sobol' indices of {analysis.samples:,} samples, {runs}; "
                     f"whiskers: {of}",
            "morris": f"elementary effects by Morris, {analysis.samples:,} trajectories, {runs}; whiskers: {of}",
            "local": f"central differences at the means of the options, {runs}; "
                     "whiskers: difference from a longer step"}[analysis.method]


def shown_quantities(analysis, asked):
    """At most MOST_QUANTITIES: those of limits, those on request, then those of the file."""
    limited = analysis.file["criterion"].asstr()[:] if "criterion" in analysis.file else []
    names = dict.fromkeys([*limited, *(f"peak_{name}" for name in asked), *analysis.units])
    return [name for name in names if name in analysis.units][:MOST_QUANTITIES]


def unit_of(analysis, quantity):
    """(unit for print, factor) of the measures of a quantity."""
    if analysis.has_ratios:
        return "", 1.0
    if quantity in QUANTITIES:
        return engineering(QUANTITIES[quantity].kind)
    return engineering_of_si(analysis.units[quantity])


def factor_in_words(analysis, quantity, i):
    """Lines beside the bars of factor i: its name, and its measures with their intervals."""
    unit, factor = unit_of(analysis, quantity)
    main, second = analysis.main(quantity), analysis.second(quantity)

    def number(value):
        said = f"{value:.3f}" if analysis.has_ratios else in_words(float(f"{factor * value:.3g}"), "")
        return said.replace("-", "−")

    value, low, high = (one[i] for one in main)
    said = number(value)
    if analysis.method == "local":
        said += f" ± {number(high - value)}"
    elif low < high:
        said += f" [{number(low)}, {number(high)}]"
    said = f"{said} {unit}".rstrip()
    if second is not None:
        said += f"; {'alone' if analysis.method == 'sobol' else 'deviation'} {number(second.value[i])}"
    return [(option_in_words(analysis.factors[i]), "black"), (said, GREY)]


def panels_of(results, asked=()):
    analysis = Analysis(results)
    return [panel_of(analysis, quantity) for quantity in shown_quantities(analysis, asked)]


def panel_of(analysis, quantity):
    order = analysis.order(quantity)[:MOST_FACTORS]
    rows = wrapped_rows([factor_in_words(analysis, quantity, i) for i in order])
    return Panel(lambda ax, worst: draw(ax, analysis, quantity, order, rows), height_of(rows))


def draw(ax, analysis, quantity, order, rows):
    """Draws the bars of the main measure with their intervals, and those of the second one below them."""
    unit, factor = unit_of(analysis, quantity)
    main, second = analysis.main(quantity), analysis.second(quantity)
    middles = np.array([middle for middle, _ in draw_beside(ax, rows)])
    draw_bars(ax, main, order, middles - (0.0 if second is None else 0.3), factor, COLOURS[0],
              MAIN[analysis.method], analysis)
    if second is not None:
        draw_bars(ax, second, order, middles + 0.55, factor, COLOURS[1], SECOND[analysis.method], analysis, 0.5)
        ax.legend(loc="lower right", frameon=False, fontsize=8.5)
    ax.axvline(0.0, color=GREY, lw=0.8)
    left_out = len(analysis.factors) - len(order)
    ax.set(title=capital(words_of(quantity)) +
           (f" ({left_out} options with smaller effects are not drawn)" if left_out else ""))
    ax.set_xlabel("part of the variance" if analysis.has_ratios else f"{MAIN[analysis.method]} ({unit or 'ratio'})")
    ax.grid(False, axis="y")
    ax.margins(x=0.03)


def draw_bars(ax, measure, order, places, factor, colour, words, analysis, height=1.1):
    value, low, high = (factor * one[order] for one in measure)
    for name, values in ((words, value), (f"{words}, low", low), (f"{words}, high", high)):
        keep(ax, name, [analysis.factors[i] for i in order], values)
    ax.barh(places, value, height, color=colour, alpha=0.8, label=words)
    whiskers = np.maximum(np.array([value - low, high - value]), 0.0)
    if whiskers.any():
        ax.errorbar(value, places, xerr=whiskers, fmt="none", ecolor="black", elinewidth=0.9, capsize=2.0)
