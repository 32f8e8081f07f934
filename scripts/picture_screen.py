"""The panel of a screen: the response of every bridge under every formation, relative to its limit."""

import numpy as np
from picture_axes import RED
from picture_table import keep

MOST_NAMES = 40


def draw(ax, results):
    """Draws a heat map of the ratios: blue where the limits are kept, red where a limit is exceeded."""
    ratio = results.values("screen/ratio")
    bridges, formations = names_of(results, "bridge"), names_of(results, "formation")
    worst_bridges = np.argsort(-np.nanmax(np.nan_to_num(ratio), axis=1), kind="stable")
    worst_formations = np.argsort(-np.nanmax(np.nan_to_num(ratio), axis=0), kind="stable")
    values = ratio[np.ix_(worst_bridges, worst_formations)]
    mesh = ax.pcolormesh(np.ma.masked_invalid(values), cmap="RdBu_r", vmin=0.0, vmax=2.0, rasterized=True)
    name_ticks(ax.set_yticks, [bridges[i] for i in worst_bridges], {})
    name_ticks(ax.set_xticks, [formations[i] for i in worst_formations], {"rotation": 90})
    for i, row in zip(worst_bridges, values):
        keep(ax, bridges[i], np.array([formations[j] for j in worst_formations]), row, "ratio")
    ax.invert_yaxis()
    ax.grid(False)
    exceeded = int((ratio > 1.0).sum())
    ax.set(title="Largest response over its limit, the worst bridges above and the worst formations on the left",
           xlabel=f"{len(formations)} formations", ylabel=f"{len(bridges)} bridges")
    ax.text(0.0, -0.02, f"{exceeded} of {int(np.isfinite(ratio).sum())} pairs exceed a limit", color=RED, fontsize=8.5,
            va="top", transform=ax.transAxes)
    bar = ax.figure.colorbar(mesh, cax=ax.inset_axes([1.035, 0.0, 0.02, 1.0]), extend="max")
    bar.set_label("response / limit")


def names_of(results, dimension):
    return list(results.file[dimension].asstr()[()])


def name_ticks(set_ticks, names, looks):
    """Names places along an axis, if there are few enough."""
    if len(names) <= MOST_NAMES:
        set_ticks(np.arange(len(names)) + 0.5, names, fontsize=7.5, **looks)
    else:
        set_ticks([])
