"""Axes of pictures and reports: colours, curves over time, and names at the ends of curves."""

from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from picture_data import spread, thin
from picture_layout import NAME, NOTE
from picture_table import draw_curve, keep

# Okabe and Ito's colours, which colour-blind readers can distinguish; the darker ones first, for text.
COLOURS = ["#0072B2", "#D55E00", "#007A59", "#A8578A", "#8A6A00", "#3A3A3A"]
STYLES = ["-", (0, (5, 1.5)), (0, (1.2, 1.2))]  # if there are more curves than colours
GREY, PALE = "#666666", "#B8B8B8"
RED = "#B00020"  # limits, and lost contact
LABEL_SIZE, SMALLEST_LABEL = 10, 5

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 11, "axes.titlesize": 13, "axes.titleweight": "bold",
    "axes.titlelocation": "left", "axes.titlepad": 8, "axes.grid": True, "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6, "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#888888",
    "text.parse_math": False,  # the name of a scene may contain $
    "axes.axisbelow": True, "lines.linewidth": 1.5, "lines.solid_joinstyle": "round", "axes.xmargin": 0.0,
})


class Panel(NamedTuple):
    """A part of a picture: a function of its axes and of the instant of the greatest deflection, which may return
    another instant. A wide panel uses the room of the names beside it too."""
    draw: object
    height: float = 1.75  # inches
    wide: bool = False


class End(NamedTuple):
    """The end of a curve, with its name, colour and style. x: as a fraction of the width of the axes."""
    value: float
    name: str
    colour: str
    style: object = "-"
    x: float = 1.0


def label_at_ends(ax, ends):
    """Draws names right of the axes, connected with the ends of their curves; many names are smaller."""
    low, high = ax.get_ylim()
    height = ax.get_position().height * ax.figure.get_figheight() * 72  # points
    size = min(max(0.94 * height / (1.35 * max(len(ends) - 1, 1)), SMALLEST_LABEL), LABEL_SIZE)
    gap = min(1.5 * size / height, 0.94 / max(len(ends) - 1, 1))
    places = spread([(end.value - low) / (high - low) for end in ends], gap, 0.03, 0.97)
    for end, place in zip(ends, places):
        early = end.x < 1.0  # the line to the name must not look like the curve
        line = {"arrowstyle": "-", "color": PALE if early else end.colour, "lw": 0.9,
                "ls": ":" if early else end.style, "shrinkA": 1, "shrinkB": 0,
                "relpos": (0.0, 0.5)}
        ax.annotate(end.name, xy=(end.x, (end.value - low) / (high - low)), xytext=(1.035, place),
                    xycoords="axes fraction", textcoords="axes fraction", va="center", color=end.colour,
                    fontsize=size, annotation_clip=False, arrowprops=line, gid=NAME)


def note_beside(ax, words, size=9, colour=GREY):
    """Draws a note beside the title, above the names of the curves."""
    ax.text(1.035, 1.03, words, transform=ax.transAxes, va="bottom", fontsize=size, color=colour, gid=NOTE)


SMALL = {"mm": ("µm", 0.01), "m/s²": ("mm/s²", 0.01), "kN": ("N", 1.0), "kN m": ("N m", 1.0)}  # below: the smaller unit


def legible(unit, values):
    """The unit for these values and the factor to it: a thousandth of the given unit if all values are small."""
    smaller, limit = SMALL.get(unit, (unit, 0.0))
    greatest = max((np.nanmax(np.abs(each), initial=0.0) for each in values), default=0.0)
    return (smaller, 1e3) if 0.0 < greatest < limit else (unit, 1.0)


def time_panel(ax, results, title, unit, curves, band=None, worst=None):
    """Draws curves over time. curves: (name, values); band: (name, least, greatest)."""
    unit, factor = legible(unit, [values for _, values in curves] + list(band[1:] if band else ()))
    curves = [(name, factor * values) for name, values in curves]
    band = band and (band[0], factor * band[1], factor * band[2])
    ax.set_title(title)
    ax.set_ylabel(unit)
    ax.set_xlabel("time (s)")
    time, ends = results.time, []
    if band is not None:
        name, least, greatest = band
        t, lower = thin(time, least)
        u, upper = thin(time, greatest)
        grid = np.union1d(t, u)
        ax.fill_between(grid, np.interp(grid, t, lower), np.interp(grid, u, upper), color=PALE, alpha=0.55, lw=0)
        keep(ax, f"{name}: least", t, lower)
        keep(ax, f"{name}: greatest", u, upper)
        ends.append(End(0.5 * (least[-1] + greatest[-1]), name, GREY))
    for (name, values), colour in zip(curves, COLOURS):
        draw_curve(ax, *thin(time, values), name, color=colour)
        ends.append(End(values[-1], name, colour))
    if worst is not None and time[0] <= worst <= time[-1]:
        ax.axvline(worst, color=GREY, lw=0.9, ls=(0, (4, 3)))
        note_beside(ax, "dashed: largest deflection")
    if len(time) > 1:
        ax.set_xlim(time[0], time[-1])
    low, high = ax.get_ylim()
    if low > 0.0 and low < 0.6 * high:
        ax.set_ylim(0.0, high)
    elif high - low < 1e-3 * max(abs(low), abs(high)):  # constant but for the last digits
        ax.set_ylim(low - 0.01 * abs(low), high + 0.01 * abs(high))
    label_at_ends(ax, ends)
