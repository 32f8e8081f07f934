#!/usr/bin/python3
"""Draws a results file on one page: picture.py RESULTS.h5 OUT.png

The page contains the parts that are in the file: the shape of the bridge at the largest deflection, deflections, wheel
forces, accelerations and sensors over time; or mode shapes; or the peaks of a sweep over the speed. Each curve has a
name.
"""

import argparse
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.transforms import blended_transform_factory  # noqa: E402
import picture_hanging  # noqa: E402
import picture_rail  # noqa: E402
from picture_axes import (  # noqa: E402
    COLOURS, GREY, LABEL_SIZE, PALE, STYLES, End, label_at_ends, legible, time_panel)
from picture_data import (  # noqa: E402
    MOST_CURVES, MOST_TRAINS, Results, choose, choose_probes, ordinal, place_in_words)
from picture_layout import fit, stack, wrapped  # noqa: E402
from picture_model import Model, draw_forces, draw_foundation, draw_supports, symbols_in_words  # noqa: E402
from picture_vehicles import (  # noqa: E402
    SIGNALS, cars_of, chains_of, draw_accelerations, draw_chains, draw_drives, draw_positions, draw_sensors,
    draw_static_wheels, draw_wheels, drives_of, sensors_of, wheels_of)
from picture_words import (  # noqa: E402
    method_in_words, modes_in_words, summary_in_words, sweep_in_words, worst_in_words)

WIDTH, LEFT = 11.5, 0.98  # inches: width of the picture, left margin of its axes


def draw_deflection(ax, results, worst):
    values = 1e3 * results.over_time(results.file["probes/deflection"])
    chosen = choose_probes(results, np.abs(values).max(axis=0))
    note = "" if len(chosen) == values.shape[1] else f" ({len(chosen)} of {values.shape[1]} places)"
    curves = [(place_in_words(results.probes[i], results.supports), values[:, i]) for i in chosen]
    time_panel(ax, results, f"Deflection of the bridge, upward positive{note}", "mm", curves, worst=worst)


# Panels on request: the dataset, its title, unit and the factor to this unit.
ASKED = {"acceleration": ("Vertical acceleration of the bridge, unfiltered", "m/s²", 1.0),
         "moment": ("Bending moment of the bridge, positive in sagging", "kN m", 1e-3),
         "shear": ("Shear force of the bridge", "kN", 1e-3)}
MAY_BE_ASKED = [*ASKED, "bearings", "sensors"]


STATIC = {"deflection": ("Static deflection over all positions of the load, upward positive", "mm", 1e3),
          "moment": ("Bending moment, positive in sagging", "kN m", 1e-3), "shear": ("Shear force", "kN", 1e-3)}


def draw_asked(ax, results, name):
    title, unit, factor = ASKED[name]
    values = factor * results.over_time(results.file[f"probes/{name}"])
    chosen = choose_probes(results, np.abs(values).max(axis=0))
    note = "" if len(chosen) == values.shape[1] else f" ({len(chosen)} of {values.shape[1]} places)"
    time_panel(ax, results, title + note, unit,
               [(place_in_words(results.probes[i], results.supports), values[:, i]) for i in chosen])


def draw_bearings(ax, results):
    """Forces of supports and foundation springs; the greatest ones if there are many."""
    found = []
    if "supports/reaction" in results.file:
        forces = 1e-3 * results.over_time(results.file["supports/reaction"])[:, :, 1]
        found += [(f"support at {x:.6g} m", forces[:, i]) for i, x in enumerate(results.supports) if forces[:, i].any()]
    if "foundation/vertical/force" in results.file:
        forces = 1e-3 * results.over_time(results.file["foundation/vertical/force"])
        found += [(f"spring at {x:.6g} m", forces[:, i])
                  for i, x in enumerate(results.values("foundation/vertical/x"))]
    chosen = choose(len(found), MOST_CURVES, np.array([np.abs(values).max() for _, values in found]))
    note = "" if len(chosen) == len(found) else f" ({len(chosen)} of {len(found)})"
    time_panel(ax, results, f"Bearing forces on the bridge, upward positive{note}", "kN", [found[i] for i in chosen])


def draw_symbols(ax, results, low, high):
    """Draws supports, springs and hinges under the undeflected line; returns their names as text."""
    model = Model(results)
    return symbols_in_words(draw_foundation(ax, model, low, high) | draw_supports(ax, model, low, high))


def draw_train(ax, results, time):
    """Draws the positions of vehicles and forces at this time, as boxes and arrows above the bridge."""
    above = blended_transform_factory(ax.transData, ax.transAxes)
    low, high = ax.get_xlim()
    middle = []
    row = int(np.argmin(np.abs(results.time - time))) if results.rows else 0
    for vehicle in results.vehicles if results.rows else []:
        xs = [vehicle[name]["position"][row, 0] for name in vehicle if "position" in vehicle[name]]
        if not xs or max(xs) < low or min(xs) > high:
            continue
        left, width = max(min(xs), low), max(min(max(xs), high) - max(min(xs), low), 0.004 * (high - low))
        ax.add_patch(plt.Rectangle((left, 0.80), width, 0.07, transform=above, color="#9DB7C9", lw=0))
        middle.append(left + width / 2)
    forces = Model(results).forces_at(time, results.options)
    places = forces[:, 0]
    there = (places >= low) & (places <= high)
    draw_forces(ax, places[there], forces[there, 1], 0.14, 0.76, above)
    middle += list(places[there])
    if middle:
        name = what_moves(results, len(forces))
        ax.text(np.clip(np.mean(middle), low, high), 0.915, name, transform=above, ha="center", va="bottom",
                fontsize=9, color=GREY)


def what_moves(results, forces):
    """The name of the moving loads, such as 'the train'."""
    trains = len(np.unique(Model(results).trains[:, 0]))
    vehicles = ("the trains" if trains > 1 else "the train" if len(results.vehicles) > 1 else
                "the vehicle" if results.vehicles else "")
    return " and ".join(filter(None, (vehicles, "moving forces" if forces > 1 else "a moving force" if forces else "")))


def draw_shape(ax, results):
    x, shape = results.values("shape/x"), 1e3 * results.values("shape/deflection")
    unit, smaller = legible("mm", [shape])
    shape, metres = smaller * shape, 1e-3 / smaller
    time = float(results.file["shape/deflection"].attrs["time"])
    low, high = x[0], x[-1]
    moved = x[np.abs(shape) > 0.03 * np.abs(shape).max()] if np.any(shape) else x
    note = ""
    if results.supports is not None and moved[-1] - moved[0] < 0.25 * (high - low):
        margin = 0.3 * (moved[-1] - moved[0]) + 2.0 * np.diff(results.supports).max()
        low, high = max(low, moved[0] - margin), min(high, moved[-1] + margin)
        note = f"\nThe bridge is {x[-1] - x[0]:,.0f} m long,\nonly the deflected part is shown."
    inside = (x >= low) & (x <= high)
    ax.axhline(0.0, color=PALE, lw=1.0)
    ax.plot(x[inside], shape[inside], color=COLOURS[0], lw=3.2, solid_capstyle="round")
    deepest, highest = min(shape.min(), 0.0), max(shape.max(), 0.0)
    height = max(deepest * -1.0, highest, 1e-9)
    moves = results.vehicles or Model(results).forces
    ax.set_ylim(deepest - 0.35 * height, highest + (0.75 if moves else 0.3) * height)
    ax.set_xlim(low - 0.02 * (high - low), high + 0.02 * (high - low))
    symbols = draw_symbols(ax, results, low, high)
    draw_train(ax, results, time)
    worst = int(np.argmax(np.abs(shape)))
    if np.any(shape):
        down = shape[worst] < 0.0
        ax.annotate(worst_in_words(results, x[worst], metres * shape[worst]), xy=(x[worst], shape[worst]),
                    xytext=(0, -6 if down else 6), textcoords="offset points", ha="center",
                    va="top" if down else "bottom", color=COLOURS[0], fontsize=LABEL_SIZE)
    box = ax.get_position()
    width = box.width * ax.figure.get_figwidth()
    scale = (np.ptp(ax.get_xlim()) / width) / (metres * np.ptp(ax.get_ylim()) / (box.height * ax.figure.get_figheight()))
    ax.set_title(f"The bridge at its largest deflection, {time:.4g} s" if results.rows > 1 else "The bridge under its load")
    times = f"{float(f'{scale:.2g}'):,.0f}"
    listed = "".join(f"\n{symbol}" for symbol in symbols.split("    ") if symbol)
    said = f"Deflection is drawn\n{times} times too large.{listed}{note}"
    ax.text(1.035, 0.5, said, transform=ax.transAxes, va="center", fontsize=LABEL_SIZE, color=GREY, linespacing=1.4)
    ax.set_ylabel(unit)
    ax.set_xlabel("place along the track (m)")
    return time


def draw_sweep(ax, results):
    """Greatest deflection of all probes over the speed, one curve per train; unfinished runs leave gaps."""
    speed = 3.6 * results.values("sweep/speed")
    peaks = 1e3 * np.abs(results.values("sweep/peak_deflection"))
    peaks = peaks.reshape(-1, len(speed), peaks.shape[-1])
    known = ~np.isnan(peaks).any(axis=-1)
    peaks = np.where(known, peaks.max(axis=-1), np.nan)
    chosen = choose(len(peaks), MOST_TRAINS, np.where(known, peaks, 0.0).max(axis=1))
    notes = [f"{len(chosen)} of {len(peaks)} trains"] if len(chosen) < len(peaks) else []
    notes += [f"{int((~known).sum())} of {known.size} runs are missing"] if not known.all() else []
    ax.set_title("Greatest deflection of the bridge over the train's speed" +
                 (f" ({', '.join(notes)})" if notes else ""))
    ax.set_ylabel("mm")
    ax.set_xlabel("speed (km/h)")
    numbers, ends = results.values("sweep/hslm_a"), []
    there = speed[known.any(axis=0)] if known.any() else speed
    low, high = there[0], there[-1]
    for place, i in enumerate(chosen):
        colour, style = COLOURS[place % len(COLOURS)], STYLES[place // len(COLOURS) % len(STYLES)]
        ax.plot(speed, peaks[i], color=colour, ls=style, marker="o" if known[i].sum() == 1 else None)
        name = f"train A{numbers[i]:.0f}" if numbers is not None else ordinal(i, len(peaks), "train")
        if known[i].any():
            last = np.flatnonzero(known[i])[-1]
            part = (speed[last] - low) / (high - low) if high > low else 0.5
            ends.append(End(peaks[i][last], name, colour, style, part))
    if high > low:
        ax.set_xlim(low, high)
    if known.any():
        ax.set_ylim(0.0, 1.08 * np.nanmax(peaks[chosen]) or None)
    label_at_ends(ax, ends)


def draw_study(ax, results):
    """Greatest deflection over the option with most values, one curve for each combination of the others."""
    from traverse_report import curves, source  # imported here because they use this module's functions
    study = source.Source(results.file.filename)
    values = 1e3 * study.runs.of_run("peak_deflection")
    drawn = curves.over_x(ax, study, "peak_deflection", values, "mm", []) if study.runs.x_name else 0
    if not drawn:
        ax.plot(np.sort(values), np.linspace(0.0, 1.0, len(values)), color=COLOURS[0])
        ax.set(xlabel="greatest deflection (mm)", ylabel="share of the runs below")
    over = f"; thick: the greatest of all {' and '.join(study.runs.over)}, dotted: the median"
    over = over if study.runs.over and drawn else ""
    lines = f", a curve for each {study.runs.lines_in_words()}" if study.runs.line_names and drawn else ""
    ax.set_title(f"Greatest deflection of the bridge{lines}{over}", fontsize=11)


def draw_static(ax, results, name):
    """Least and greatest value of every load along the bridge, over all positions of the load."""
    _, unit, factor = STATIC[name]
    x, values = results.values("static/x"), factor * results.values(f"static/{name}")
    for i, (load, _) in enumerate(results.file["static/load"].asstr()[:]):
        for side in (0, 1):
            ax.plot(x, values[i, :, side], color=COLOURS[i % len(COLOURS)], label=None if side else load)
    ax.axhline(0.0, color=PALE, lw=1.0)
    ax.set(title=STATIC[name][0], ylabel=unit, xlabel="place along the bridge (m)", xlim=(x[0], x[-1]))
    ax.legend(loc="center left", bbox_to_anchor=(1.03, 0.5), frameon=False, fontsize=LABEL_SIZE)


def draw_modes(figure, results):
    """The first mode shapes, two per row; or the frequencies only."""
    frequency, shapes = results.values("modes/frequency"), results.values("modes/shape")
    figure.text(0.06, 0.16 / figure.get_figheight(), modes_in_words(frequency, shapes), fontsize=8.5, color=GREY)
    if shapes is None:
        ax = figure.add_axes([0.1, 0.12, 0.85, 0.7])
        ax.plot(np.arange(1, len(frequency) + 1), frequency, "o", color=COLOURS[0])
        ax.set(title="Natural frequencies", ylabel="Hz", xlabel="in ascending order")
        return
    axial = results.values("modes/axial")
    x = results.values("modes/x")
    x = np.arange(shapes.shape[1], dtype=float) if x is None else x
    count = min(len(shapes), MOST_CURVES)
    rows = (count + 1) // 2
    for i in range(count):
        ax = figure.add_axes([0.06 + 0.485 * (i % 2), 0.1 + 0.76 * (rows - 1 - i // 2) / rows, 0.43, 0.76 / rows - 0.1])
        ax.axhline(0.0, color=PALE, lw=1.0)
        ax.plot(x, shapes[i], color=COLOURS[0], lw=2.6)
        ax.set_ylim(-1.25, 1.25)
        ax.set_yticks([])
        ax.set_xlim(x[0] - 0.02 * np.ptp(x), x[-1] + 0.02 * np.ptp(x))
        draw_symbols(ax, results, x[0], x[-1])
        along = ", along the track" if axial is not None and axial[i] else ""
        ax.set_title(f"{frequency[i]:.4g} Hz{along}" if frequency[i] > 0.0 else f"free motion{along}")
        if i >= count - 2:
            ax.set_xlabel("place along the track (m)" if "modes/x" in results.file else "node")


def heading_height(results):
    """Height above the first panel, inches."""
    title, said = heading_in_words(results, False)
    return 1.45 + 0.36 * (len(title) - 1) + 0.22 * max(len(said) - 1, 0)


def heading_in_words(results, modes_only):
    """Lines of the title and of the text below it."""
    speed, summary = results.speed(), results.summary
    title = results.scene()
    if modes_only:
        title += ": natural shapes of the bridge"
    elif results.options.get("scene_analysis") == "static":
        title += ", at rest"
    elif results.options.get("scene_analysis") == "envelope":
        title += ", largest static effects"
    elif results.options.get("scene_analysis") == "rail":
        title += ", rail and bridge together (UIC 774-3)"
    elif "sweep/speed" in results.file:
        title += f", {sweep_in_words(results)}"
    elif "study/finished" in results.file:
        title += f", a study of {len(results.file['study/finished']):,} runs"
    elif speed:
        title += f", {3.6 * speed:.4g} km/h"
    said = summary_in_words(results)
    if not summary and results.rows:
        said.append(f"the run did not reach its end; drawn up to {results.time[-1]:.4g} s")
    if modes_only and "modes/shape" in results.file:
        said = ["each scaled to the same height; circles, triangles and squares are supports, zigzags springs"]
    return wrapped(title, 0.9 * WIDTH, 18, "bold"), wrapped("; ".join(said), 0.9 * WIDTH, 11.5)


def heading(figure, results, modes_only):
    title, said = heading_in_words(results, modes_only)
    height = figure.get_figheight()
    figure.text(0.06, 1.0 - 0.30 / height, "\n".join(title), fontsize=18, weight="bold", va="top")
    figure.text(0.06, 1.0 - (0.32 + 0.36 * len(title)) / height, "\n".join(said), fontsize=11.5, color=GREY, va="top")
    attrs = results.file.attrs
    foot = f"{attrs.get('program', 'traverse')} {attrs.get('version', '')}"
    for what in ("steps", "runs"):
        if attrs.get(what):
            foot += f", {attrs[what]} {what} in {attrs['wall_seconds']:.3g} s"
    if "sweep" in results.file:
        foot = f"{method_in_words(results)}   {foot}"
    figure.text(0.94, 0.16 / figure.get_figheight(), foot, fontsize=8.5, color=GREY, ha="right")


def asked_panels(results, asked):
    """The requested panels with data in the file."""
    found = []
    sensors = sensors_of(results)
    for name in asked:
        if name == "bearings":
            if "supports/reaction" in results.file or "foundation/vertical/force" in results.file:
                found.append(lambda ax, worst: draw_bearings(ax, results))
        elif name == "sensors":
            found += [lambda ax, worst, signal=signal: draw_sensors(ax, results, sensors, signal)
                      for signal in list(SIGNALS)[1:] if sensors]
        elif f"probes/{name}" in results.file:
            found.append(lambda ax, worst, name=name: draw_asked(ax, results, name))
    return found if results.rows > 1 else []


def panels(results, asked=()):
    """All panels from top to bottom, as functions of the axes and the instant of the largest deflection."""
    file, found = results.file, []
    if "shape/deflection" in file and len(file["shape/x"]) > 1:
        found.append(lambda ax, worst: draw_shape(ax, results))
    wheels, cars, sensors = wheels_of(results), cars_of(results), sensors_of(results)
    hanging = picture_hanging.hanging_of(results) if results.rows > 1 else []
    travelling = [one for one in hanging if one.travels]
    if travelling and results.probes is not None:
        found.append(lambda ax, worst: picture_hanging.draw_places(ax, results, travelling))
    if results.rows > 1 and "probes/deflection" in file and len(results.probes):
        found.append(lambda ax, worst: draw_deflection(ax, results, worst))
    found += asked_panels(results, asked)
    if results.rows > 0 and wheels:
        drawing = draw_wheels if results.rows > 1 else draw_static_wheels
        found.append(lambda ax, worst: drawing(ax, results, wheels))
    if hanging:
        found += [lambda ax, worst, what=what: picture_hanging.draw(ax, results, hanging, what) for what in ("swing", "force")]
    chains, drives = chains_of(results), drives_of(results, [name for one in hanging for name in one.joint.split(" and ")])
    if results.rows > 1 and chains:
        found.append(lambda ax, worst: draw_chains(ax, results, chains))
    if results.rows > 1 and drives:
        found.append(lambda ax, worst: draw_drives(ax, results, drives))
    if results.rows > 1 and cars and not wheels and results.probes is None:
        found += [lambda ax, worst, direction=direction: draw_positions(ax, results, direction) for direction in (0, 1)]
    elif results.rows > 1 and cars:
        found.append(lambda ax, worst: draw_accelerations(ax, results, cars))
    if results.rows > 1 and sensors:
        found.append(lambda ax, worst: draw_sensors(ax, results, sensors, next(iter(SIGNALS))))
    if "sweep/peak_deflection" in file:
        found.append(lambda ax, worst: draw_sweep(ax, results))
    if "study/finished" in file:
        found.append(lambda ax, worst: draw_study(ax, results))
    if not found and "static/x" in file:
        found += [lambda ax, worst, name=name: draw_static(ax, results, name) for name in STATIC]
    if not found and "rail_forces/x" in file:
        found += [lambda ax, worst, panel=panel: panel(ax, results) for panel in picture_rail.PANELS]
    return found


def draw(results, out, asked=()):
    found = panels(results, asked)
    modes_only = not found and "modes/frequency" in results.file
    if not found and not modes_only:
        raise ValueError("contains nothing that can be drawn")
    sweep_only = len(found) == 1 and ("sweep/peak_deflection" in results.file or "study/finished" in results.file)
    figure = plt.figure(figsize=(WIDTH, 7.5))
    if modes_only:
        draw_modes(figure, results)
        heading(figure, results, modes_only)
    else:
        draw_panels(figure, results, found, 3.5 if sweep_only else 1.75)  # ten names beside the curves
    figure.savefig(out, dpi=130)
    plt.close(figure)


def draw_panels(figure, results, found, height):
    """Draws panels below each other, each with the height that its names need."""
    worst, axes, gaps = None, [], [heading_height(results)]
    for i, panel in enumerate(found):
        ax = figure.add_axes([LEFT / WIDTH, 0.1, 0.625, height / figure.get_figheight()], label=str(i))
        shape_on_top = i == 0 and "shape/deflection" in results.file
        worst = panel(ax, worst) if shape_on_top else (panel(ax, worst), worst)[1]
        if results.rows > 1 and panel is found[-1] and not ax.get_xlabel():
            ax.set_xlabel("time (s)")
        axes.append(ax)
        above, below = fit(ax, 1.0, 0.62)
        gaps[-1] += above
        gaps.append(1.0 + below)
    stack(figure, axes, height, gaps)
    heading(figure, results, False)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", help="a results file (HDF5)")
    parser.add_argument("out", help="the picture: .png, .pdf or .svg")
    parser.add_argument("--panels", default="", metavar="LIST", help="what a crossing shows besides, with commas between: "
                        f"{', '.join(MAY_BE_ASKED)}")
    arguments = parser.parse_args()
    asked = [name for name in arguments.panels.split(",") if name]
    for name in asked:
        if name not in MAY_BE_ASKED:
            print(f"picture.py: --panels {name}: allowed: {', '.join(MAY_BE_ASKED)}", file=sys.stderr)
            return 1
    try:
        with h5py.File(arguments.results, "r", locking=False) as file:
            draw(Results(file), arguments.out, asked)
    except (OSError, ValueError) as error:
        print(f"picture.py: {arguments.results}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
