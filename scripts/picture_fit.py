"""The measurements of a fit with their computed counterparts, and the estimates in words."""

from typing import NamedTuple

import numpy as np
from engineering_units import printed
from picture_axes import COLOURS, GREY, End, Panel, label_at_ends, legible, note_beside
from picture_data import thin
from picture_table import draw_curve

UNITS = {"deflection": ("mm", 1e3), "moment": ("kN m", 1e-3), "shear": ("kN", 1e-3), "acceleration": ("m/s²", 1.0),
         "velocity": ("m/s", 1.0)}


class Words(NamedTuple):
    """The texts of the panels."""
    measured: str = "measured"
    computed: str = "computed"
    residual: str = "residual"
    time: str = "time of the measurement (s)"
    frequencies: str = "Frequencies: computed less measured"
    deviations: str = "standard deviations"
    number: str = "frequency of the list"
    note: str = "grey: one standard deviation"


def panels_of(results):
    """A panel for each measured series, and one for the frequencies."""
    found = [Panel(lambda ax, worst, name=name, group=group: draw_series(ax, group, title_of(name, group)), 2.2)
             for name, group in results.file.get("fit/series", {}).items()]
    if "fit/frequencies" in results.file:
        found.append(Panel(lambda ax, worst: draw_frequencies(ax, results.file["fit/frequencies"])))
    return found


def quantity_of(group):
    return str(group.attrs["dataset"]).rsplit("/", 1)[-1]


def unit_of(group):
    """(unit for print, factor from SI) of a series."""
    own = (printed(str(group["measured"].attrs["unit"])), 1.0)
    return UNITS.get(quantity_of(group), own) if "x" in group.attrs else own


def title_of(name, group):
    at = f"{quantity_of(group)} at {group.attrs['x']:.6g} m" if "x" in group.attrs else \
        str(group.attrs["dataset"]).strip("/")
    return f"{name}: {at}"


def draw_series(ax, group, title, words=Words()):
    """The measured values of a series, the computed ones, and below them the residuals."""
    unit, factor = unit_of(group)
    time, measured, computed = (group[key][()] for key in ("time", "measured", "computed"))
    smaller, more = legible(unit, [factor * measured])
    measured, computed = factor * more * measured, factor * more * computed
    ax.set(title=title, ylabel=smaller, xlabel=words.time, xlim=(time[0], time[-1]))
    draw_curve(ax, *thin(time, measured), words.measured, color=GREY, lw=2.6, alpha=0.6)
    ends = [End(measured[-1], words.measured, GREY)]
    if np.all(np.isfinite(computed)):
        residual = computed - measured
        draw_curve(ax, *thin(time, computed), words.computed, color=COLOURS[0], lw=1.2)
        draw_curve(ax, *thin(time, residual), words.residual, color=COLOURS[1], lw=0.8)
        ends += [End(computed[-1], words.computed, COLOURS[0]), End(residual[-1], words.residual, COLOURS[1])]
    label_at_ends(ax, ends)


def draw_frequencies(ax, group, words=Words()):
    """The residuals of the measured frequencies over their standard deviations."""
    measured, computed, sd = (group[key][()] for key in ("measured", "computed", "sd"))
    numbers = np.arange(1, len(measured) + 1)
    ax.set(title=words.frequencies, ylabel=words.deviations, xlabel=words.number, xlim=(0.5, len(measured) + 0.5),
           xticks=numbers)
    ax.axhspan(-1.0, 1.0, color=GREY, alpha=0.15, lw=0)
    draw_curve(ax, numbers, (computed - measured) / sd, "frequencies", marker="o", ls="none", color=COLOURS[0])
    note_beside(ax, words.note)


def fit_in_words(results):
    """The estimates with their standard errors: 'beam_EI 8.331e+09 ± 2.1e+07 N m2'."""
    group = results.file["fit"]
    names = results.file["unknown"].asstr()[()]
    units = str(group["estimate"].attrs["unit"]).split(", ")
    said = []
    for name, value, error, unit in zip(names, group["estimate"][()], group["standard_error"][()], units):
        if np.isfinite(value):
            plus = f" ± {error:.2g}" if np.isfinite(error) else ""
            said.append(f"{name} {value:.5g}{plus}" + (f" {unit}" if unit != "1" else ""))
    return said
