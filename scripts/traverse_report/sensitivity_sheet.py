"""The page of a sensitivity analysis: bars of the effects of the uncertain options, and a table of all measures."""

import numpy as np
from picture_sensitivity import shown_quantities
from sensitivity_measures import Analysis

from . import curves
from .language import capital, num, percent, t
from .page import GREY, LEFT, table
from .quantities import QUANTITIES, unit_of, unit_of_si, words_of

MAIN = {"sobol": "with all interactions", "morris": "size of the effect", "local": "change for one standard deviation"}
SECOND = {"sobol": "alone", "morris": "standard deviation of the effects"}
METHODS = {"sobol": "Sobol' indices of {count} samples: the part of each option in the variance of the quantity.",
           "morris": "Elementary effects by Morris, {count} trajectories: the change over the range of the option.",
           "local": "Derivatives at the means of the options; brackets: the difference from a longer step."}
MOST_DRAWN = 12  # options


class Words:
    """The measures of a sensitivity analysis in the language of the report."""

    def __init__(self, source):
        self.analysis, self.runs = Analysis(source.results), source.runs
        self.method = self.analysis.method

    def unit(self, quantity):
        """(unit for print, factor) of the measures of a quantity."""
        if self.analysis.has_ratios:
            return "", 1.0
        return unit_of(quantity) if quantity in QUANTITIES else unit_of_si(self.analysis.units[quantity])

    def explanation(self):
        said = [t(METHODS[self.method], count=num(self.analysis.samples, ",.0f"))]
        if self.method != "local":
            said.append(t("Brackets: interval with the confidence {level}.", level=percent(self.analysis.confidence)))
        return " ".join([*said, t("Each quantity is the greatest over all other varied options.")])

    def head(self):
        second = [t(SECOND[self.method])] if self.method in SECOND else []
        return [t("quantity"), t("option"), t(MAIN[self.method]), *second]

    def rows(self):
        """Texts of each quantity and each option, those with the largest effect first."""
        found = []
        for quantity in self.analysis.units:
            (unit, factor), main = self.unit(quantity), self.analysis.main(quantity)
            second = self.analysis.second(quantity)
            for number, i in enumerate(self.analysis.order(quantity)):
                cells = [self.measure(one, i, factor, unit) for one in (main, second) if one is not None]
                found.append([words_of(quantity) if number == 0 else "", self.runs.words(self.analysis.factors[i])[0],
                              *cells])
        return found

    def measure(self, measure, i, factor, unit):
        value, low, high = (num(factor * one[i], ".3f" if self.analysis.has_ratios else ".3g") for one in measure)
        return f"{value} [{low}; {high}] {unit}".rstrip() if low != high else f"{value} {unit}".rstrip()


def workbook_rows(source):
    """Head and rows: each quantity with each option, the measures and the ends of their intervals."""
    words, rows = Words(source), []
    names = [t(names[words.method]) for names in (MAIN, SECOND) if words.method in names]
    for quantity in words.analysis.units:
        (unit, factor), measures = words.unit(quantity), [words.analysis.main(quantity)]
        measures += [words.analysis.second(quantity)] if len(names) > 1 else []
        for i in words.analysis.order(quantity):
            numbers = [float(factor * one[i]) for measure in measures for one in measure]
            rows.append([words_of(quantity), words.runs.words(words.analysis.factors[i])[0], unit or "1", *numbers])
    heads = [f"{name}{end}" for name in names for end in ("", f", {t('least')}", f", {t('greatest')}")]
    return [t("quantity"), t("option"), t("unit"), *heads], rows


def sheet(report, source):
    if not source.is_sensitivity:
        return
    words, page = Words(source), report.page(t("Sensitivity analysis"))
    report.anchor("sensitivity")
    page.text(LEFT, words.explanation(), size=8, colour=GREY)
    for quantity in shown_quantities(words.analysis, ()):
        order = words.analysis.order(quantity)[:MOST_DRAWN]
        height = 0.3 + 0.2 * len(order)
        page = page if page.room() > height + 0.9 else report.page(page.heading)
        draw(page.axes(height, left=1.9), words, quantity, order)
    page = page if page.room() > 1.5 else report.page(page.heading)
    head = words.head()
    columns = [(head[0], 2.1, "left"), (head[1], 1.7, "left"), *((name, 1.5, "left") for name in head[2:])]
    table(report, page, columns, words.rows(), size=7)


def draw(ax, words, quantity, order):
    """Draws the bars of one quantity, the largest effect on top."""
    unit, factor = words.unit(quantity)
    places = np.arange(len(order))
    measures = [(words.analysis.main(quantity), MAIN, 0.45, -0.12),
                (words.analysis.second(quantity), SECOND, 0.2, 0.25)]
    for i, (measure, names, height, shift) in enumerate(measures):
        if measure is None:
            continue
        value, low, high = (factor * one[order] for one in measure)
        ax.barh(places + shift, value, height, color=curves.COLOURS[i], alpha=0.8, label=t(names[words.method]))
        whiskers = np.maximum([value - low, high - value], 0.0)
        if whiskers.any():
            ax.errorbar(value, places + shift, xerr=whiskers, fmt="none", ecolor="black", elinewidth=0.7, capsize=1.5)
    ax.set_yticks(places, [words.runs.words(words.analysis.factors[i])[0] for i in order], fontsize=7.5)
    ax.set(title=capital(words_of(quantity)), xlabel=unit, ylim=(len(order) - 0.5, -0.5))
    ax.grid(False, axis="y")
    ax.margins(x=0.03)
    ax.axvline(0.0, color=GREY, lw=0.8)
    ax.legend(loc="lower right", frameon=False, fontsize=7)
