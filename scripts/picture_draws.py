"""Random draws of a study in a picture: median, band of quantiles and greatest value, or the distribution."""

import numpy as np
from picture_axes import COLOURS, GREY, RED, End, label_at_ends, note_beside
from picture_runs import in_words
from picture_speeds import above_in_words, draw_limits, draw_list, finish, label_values
from picture_table import draw_curve, keep

BAND = (0.05, 0.95)  # quantiles of the drawn band


def statistics(values):
    """Median, both quantiles of the band, and the greatest value over the last axis, without unknown values."""
    known = np.where(np.isnan(values).all(axis=-1, keepdims=True), 0.0, values)
    found = [np.nanquantile(known, q, axis=-1) for q in (0.5, *BAND, 1.0)]
    return [np.where(np.isnan(values).all(axis=-1), np.nan, one) for one in found]


def band_in_words():
    return f"{100 * BAND[0]:g} to {100 * BAND[1]:g} % of the draws"


def draw_statistics(ax, axis, values, unit, limits, names=True):
    """Draws median, band of quantiles and greatest value of random draws [x, draws] over the axis."""
    x, (middle, low, high, worst) = axis.values, statistics(values)
    for edge, level in ((low, BAND[0]), (high, BAND[1])):
        keep(ax, f"{100 * level:g} % quantile", x, edge)
    ax.fill_between(x, low, high, color=COLOURS[0], alpha=0.18, lw=0)
    few = {"marker": "o", "ms": 3.5} if len(x) < 15 else {}
    draw_curve(ax, x, middle, "median", color=COLOURS[0], lw=2.0, **few)
    draw_curve(ax, x, worst, "greatest", color=COLOURS[1], lw=1.2, **few)
    ax.set_xlabel(axis.label())
    label_values(ax, unit)
    finish(ax, x, worst)
    draw_limits(ax, x, worst, limits)
    if names:
        ends = [(worst, f"greatest of {values.shape[-1]} draws", COLOURS[1]), (middle, "median", COLOURS[0]),
                (0.5 * (low + high), f"band: {band_in_words()}", GREY)]
        label_at_ends(ax, [End(curve[-1], words, colour) for curve, words, colour in ends if not np.isnan(curve[-1])])
        said = [above_in_words(limit, x, [("the greatest", worst)], axis.unit) for limit in limits]
        if any(said):
            note_beside(ax, "; ".join(filter(None, said)), colour=RED)


def draw_distribution(ax, values, words, unit, limits):
    """Draws the share of draws below each value, with median, band of quantiles and greatest value."""
    known = np.sort(values[~np.isnan(values)])
    if not len(known):
        return
    share = np.arange(1, len(known) + 1) / len(known)
    keep(ax, "share of the draws up to this value", known, 100.0 * share, "%")
    ax.plot(known, 100.0 * share, color=COLOURS[0], drawstyle="steps-post")
    middle, low, high, worst = statistics(known)
    ax.axvspan(low, high, color=COLOURS[0], alpha=0.12, lw=0)
    ax.axvline(middle, color=COLOURS[0], lw=1.0, ls=(0, (4, 3)))
    ax.set(xlabel=f"{words[0].lower()}{words[1:]} ({unit})" if unit else words, ylabel="share of the draws below (%)",
           ylim=(0.0, 103.0))
    top = ax.get_xlim()[1]
    for limit in limits:
        if limit.value < top + np.ptp(known):
            ax.axvline(limit.value, color=RED, lw=1.2, ls=(0, (6, 2)))
    broken = [(f"{limit.words}: above in {np.count_nonzero(known > limit.value)} of {len(known)}", RED)
              for limit in limits]
    draw_list(ax, [(f"greatest:  {in_words(worst, unit)}", COLOURS[1]),
                   (f"{100 * BAND[1]:g} % quantile:  {in_words(high, unit)}", GREY),
                   (f"median:  {in_words(middle, unit)}", COLOURS[0]),
                   (f"{100 * BAND[0]:g} % quantile:  {in_words(low, unit)}", GREY),
                   (f"least:  {in_words(known[0], unit)}", GREY), ("shaded: between the quantiles", GREY), *broken])
