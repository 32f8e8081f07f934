"""The panel of a screen: the response of every bridge under every formation, relative to its limit."""

import numpy as np
from picture_table import keep

MOST_NAMES = 40
LONGEST_NAME = 14  # characters


TITLE, LABEL = "Largest response over its limit, bridges by formations", "response / limit"


def order_of(ratio):
    """The bridges and the formations of [b, f] ratios, those with the largest one first."""
    known = np.nan_to_num(ratio)
    return [np.argsort(-known.max(axis=axis), kind="stable") for axis in (1, 0)]


def draw(ax, results, title=TITLE, label=LABEL):
    """Draws a heat map of the ratios: blue where the limits are kept, red where a limit is exceeded."""
    ratio = results.values("screen/ratio")
    bridges, formations = names_of(results, "bridge"), names_of(results, "formation")
    worst_bridges, worst_formations = order_of(ratio)
    values = ratio[np.ix_(worst_bridges, worst_formations)]
    mesh = ax.pcolormesh(np.ma.masked_invalid(values), cmap="RdBu_r", vmin=0.0, vmax=2.0, rasterized=True)
    name_ticks(ax.set_yticks, [bridges[i] for i in worst_bridges], {})
    name_ticks(ax.set_xticks, [formations[i] for i in worst_formations], {"rotation": 90})
    for i, row in zip(worst_bridges, values):
        keep(ax, bridges[i], np.array([formations[j] for j in worst_formations]), row, "ratio")
    ax.invert_yaxis()
    ax.grid(False)
    ax.set(title=title)
    bar = ax.figure.colorbar(mesh, cax=ax.inset_axes([1.035, 0.0, 0.02, 1.0]), extend="max")
    bar.set_label(label)


def in_words(results):
    """How many pairs there are, and how many exceed a limit."""
    ratio = results.values("screen/ratio")
    return (f"{ratio.shape[0]:,} bridges, {ratio.shape[1]:,} formations; {int((ratio > 1.0).sum()):,} of "
            f"{int(np.isfinite(ratio).sum()):,} pairs exceed a limit at some speed; the worst ones above and on the left")


def names_of(results, dimension):
    return list(results.file[dimension].asstr()[()])


def name_ticks(set_ticks, names, looks):
    """Names places along an axis, if there are few enough."""
    if len(names) <= MOST_NAMES:
        set_ticks(np.arange(len(names)) + 0.5, [name[:LONGEST_NAME] for name in names], fontsize=7.5, **looks)
    else:
        set_ticks([])
