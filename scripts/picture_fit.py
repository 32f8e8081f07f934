"""The measurements of a fit with their computed counterparts, and the estimates in words."""

import numpy as np
from picture_axes import COLOURS, GREY, End, Panel, label_at_ends, legible, note_beside
from picture_data import thin
from picture_table import draw_curve

UNITS = {"deflection": ("mm", 1e3), "moment": ("kN m", 1e-3), "shear": ("kN", 1e-3), "acceleration": ("m/s²", 1.0),
         "velocity": ("m/s", 1.0)}


def panels_of(results):
    """A panel for each measured series, and one for the frequencies."""
    found = [Panel(lambda ax, worst, name=name: draw_series(ax, results, name), 2.2)
             for name in results.file.get("fit/series", [])]
    if "fit/frequencies" in results.file:
        found.append(Panel(lambda ax, worst: draw_frequencies(ax, results)))
    return found


def draw_series(ax, results, name):
    """The measured values, the computed ones, and below them the residuals."""
    group = results.file[f"fit/series/{name}"]
    quantity = str(group.attrs["dataset"]).rsplit("/", 1)[-1]
    own = (str(group["measured"].attrs["unit"]), 1.0)
    unit, factor = UNITS[quantity] if "x" in group.attrs else own
    time, measured, computed = (group[key][()] for key in ("time", "measured", "computed"))
    smaller, more = legible(unit, [factor * measured])
    measured, computed = factor * more * measured, factor * more * computed
    at = f"{quantity} at {group.attrs['x']:.6g} m" if "x" in group.attrs else str(group.attrs["dataset"]).strip("/")
    ax.set(title=f"{name}: {at}", ylabel=smaller, xlabel="time of the measurement (s)", xlim=(time[0], time[-1]))
    draw_curve(ax, *thin(time, measured), "measured", color=GREY, lw=2.6, alpha=0.6)
    ends = [End(measured[-1], "measured", GREY)]
    if np.all(np.isfinite(computed)):
        draw_curve(ax, *thin(time, computed), "computed", color=COLOURS[0], lw=1.2)
        draw_curve(ax, *thin(time, computed - measured), "residual", color=COLOURS[1], lw=0.8)
        ends += [End(computed[-1], "computed", COLOURS[0]), End(computed[-1] - measured[-1], "residual", COLOURS[1])]
    label_at_ends(ax, ends)


def draw_frequencies(ax, results):
    """The residuals of the measured frequencies over their standard deviations."""
    group = results.file["fit/frequencies"]
    measured, computed, sd = (group[key][()] for key in ("measured", "computed", "sd"))
    numbers = np.arange(1, len(measured) + 1)
    ax.set(title="Frequencies: computed less measured", ylabel="standard deviations", xlabel="frequency of the list",
           xlim=(0.5, len(measured) + 0.5), xticks=numbers)
    ax.axhspan(-1.0, 1.0, color=GREY, alpha=0.15, lw=0)
    draw_curve(ax, numbers, (computed - measured) / sd, "frequencies", marker="o", ls="none", color=COLOURS[0])
    note_beside(ax, "grey: one standard deviation")


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
