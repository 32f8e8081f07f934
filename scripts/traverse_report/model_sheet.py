"""The page of the model: drawings of bridge and train, their properties, and the error estimates."""

import numpy as np
from picture_model import (
    WORDS, draw_forces, draw_foundation, draw_supports, draw_vehicle, symbols_in_words, vertical_reach)

from .page import GREY, INK, LEFT, RIGHT, table
from .source import digits

MOST_TRAIN_ROWS = 10
TALLEST = 3.0  # inches, of a drawn vehicle


def draw_bridge(page, source, height=0.42):
    """Draws the bridge with its supports, springs and hinges; spans to scale."""
    model = source.model
    ends = model.span_ends
    ax = page.axes(height, left=0.2, right=0.2, above=0.25, below=0.35)
    ax.axis("off")
    ax.set(xlim=(ends[0] - 0.02 * model.length(), ends[-1] + 0.02 * model.length()), ylim=(-1.0, 1.0))
    ax.plot([ends[0], ends[-1]], [0, 0], color=INK, lw=3.0, solid_capstyle="butt")
    kinds = draw_foundation(ax, model, ends[0], ends[-1]) | draw_supports(ax, model, ends[0], ends[-1])
    spans = np.diff(ends)
    if len(spans) <= 12:
        for left, span in zip(ends[:-1], spans):
            ax.text(left + 0.5 * span, 0.35, f"{span:.4g} m", ha="center", va="bottom", fontsize=8, color=INK)
    else:
        ax.text(0.5 * (ends[0] + ends[-1]), 0.35, f"{len(spans)} spans, {model.length():.5g} m in all", ha="center",
                va="bottom", fontsize=8, color=INK)
    if kinds:
        page.text(LEFT, symbols_in_words(kinds), size=7.5, colour=GREY)
    page.y -= 0.08


def scale_bar(ax, length, y):
    nice = [step * 10.0 ** power for power in range(0, 5) for step in (1, 2, 5)]
    bar = max([one for one in nice if one <= 0.25 * length] or [length])
    left = ax.get_xlim()[0]
    ax.plot([left, left + bar], [y, y], color=GREY, lw=1.5, solid_capstyle="butt", clip_on=False)
    ax.text(left + bar, y, f"  {bar:.0f} m", color=GREY, fontsize=7, va="center", clip_on=False)


def draw_train(page, source):
    """Draws the whole train to scale, the first vehicle of each type larger; or the forces of each train."""
    model = source.model
    if len(model.train):
        draw_vehicles(page, source)
    elif model.forces:
        draw_force_trains(page, source)


def draw_vehicles(page, source):
    model = source.model
    places = [(x + wheel[0], wheel[2]) for index, x in model.train for wheel in model.rows(index, "wheels", 3)]
    if not places:
        return
    low, high = min(x for x, _ in places) - 6.0, max(x for x, _ in places) + 6.0
    width = RIGHT - LEFT - 0.4
    reaches = [vertical_reach(model, index) for index in {int(index) for index, _ in model.train}]
    bottom, top = min(0.0, *(1.05 * low for low, _ in reaches)), max(5.0, *(1.05 * high for _, high in reaches))  # m
    tall = top - bottom
    if len(model.train) > 1:
        page.text(LEFT, f"The train to scale, front on the right: {source.train_in_words()}", size=8)
        ax = page.axes(max(tall * width / (high - low), 0.12), left=0.2, right=0.2, above=0.05, below=0.3)
        ax.set(xlim=(low, high), ylim=(bottom, top))
        ax.axis("off")
        ax.set_aspect("equal", adjustable="datalim")
        ax.plot([low, high], [0, 0], color=GREY, lw=0.7)
        for index, x in model.train:
            draw_vehicle(ax, model, index, x)
        scale_bar(ax, high - low, bottom - 0.5 * tall)
    for index in list(dict.fromkeys(int(i) for i, _ in model.train))[:2]:
        wheels = model.rows(index, "wheels", 3)
        reach = max(wheels[:, 0].max(), -wheels[:, 0].min()) + 4.0
        page.text(LEFT, f"{model.type_name(index)}, to scale; masses {masses_in_words(model, index)}", size=8)
        inches = min(width, 2.0 * reach / 5.0 * 1.1, 2.0 * reach / tall * TALLEST)
        ax = page.axes(tall * inches / (2.0 * reach), left=0.2 + 0.5 * (width - inches),
                       right=0.2 + 0.5 * (width - inches), above=0.05, below=0.3)
        ax.set(xlim=(-reach, reach), ylim=(bottom, top))
        ax.set_aspect("equal", adjustable="datalim")
        ax.axis("off")
        ax.plot([-reach, reach], [0, 0], color=GREY, lw=0.8)
        draw_vehicle(ax, model, index, 0.0, springs=True)
        scale_bar(ax, 2.0 * reach, bottom - 0.07 * tall)


def masses_in_words(model, index):
    masses = model.rows(index, "bodies", 3)[:, 2]
    return " + ".join(f"{mass / 1e3:.3g} t" for mass in masses[:8]) + (" + ..." if len(masses) > 8 else "")


def draw_force_trains(page, source):
    model = source.model
    names = list(model.forces)[:MOST_TRAIN_ROWS]
    longest = max(np.ptp(model.forces[name][:, 0]) for name in names)
    longest = max(longest, 0.5 * model.length(), 1.0)
    left_out = "" if len(names) == len(model.forces) else f" (the first {len(names)} of {len(model.forces)})"
    page.text(LEFT, f"Moving forces to scale, front on the right{left_out}; the thick line is the bridge", size=8)
    ax = page.axes(0.27 * (len(names) + 1), left=0.35, right=0.9, above=0.05, below=0.35)
    ax.set(xlim=(-longest, 0.0), ylim=(-1.0, len(names)))
    ax.axis("off")
    for i, name in enumerate(names):
        places, forces = model.forces[name].T
        y = len(names) - 1.0 - i
        ax.plot([places.min() - places.max(), 0.0], [y, y], color=GREY, lw=0.4)
        draw_forces(ax, places - places.max(), forces, 0.62, y)
        kilonewtons = f"{len(forces)} × {1e-3 * forces.max():.4g} kN" if np.ptp(forces) == 0 else \
            f"{len(forces)}, up to {1e-3 * forces.max():.4g} kN"
        ax.text(0.0, y, f"  {kilonewtons}", fontsize=7, va="bottom", clip_on=False)
        ax.text(-longest, y, f"{'' if name == 'load' else name}  ", fontsize=7.5, va="bottom", ha="right", clip_on=False)
    length = min(model.length(), longest)
    ax.plot([-length, 0.0], [-0.5, -0.5], color=INK, lw=3.0, solid_capstyle="butt")
    scale_bar(ax, longest, -0.5)


def range_in_words(data, unit):
    low, high = data[:, 1].min(), data[:, 1].max()
    return f"{low:.5g} {unit}" if low == high else f"{low:.5g} to {high:.5g} {unit}, variable along the bridge"


def properties(source):
    """Rows (name, value) of bridge, track and train."""
    model, options, rows = source.model, source.options, []
    spans = np.diff(model.span_ends)
    if len(spans):
        shown = " + ".join(f"{span:.4g}" for span in spans[:12]) + (" + ..." if len(spans) > 12 else "")
        rows.append(("Spans", f"{shown} m"))
    for name, what, unit in (("EI", "Bending stiffness EI", "N m²"), ("mass", "Mass", "kg/m")):
        if name in model.group:
            rows.append((what, range_in_words(model.group[name][:], unit)))
    for name, what in (("beam_damping_ratios", "Damping ratios"), ("model_damping_ratios", "Damping ratio of each mode"),
                       ("beam_rayleigh", "Rayleigh's a, b")):
        if name in options:
            rows.append((what, options[name]))
    if "modes/frequency" in source.file:
        shown = ", ".join(f"{f:.4g}" for f in source.file["modes/frequency"][:6])
        rows.append(("Natural frequencies", f"{shown} Hz"))
    for kind, data in model.foundation.items():
        values = np.unique(data[:, 1])
        shown = digits(values[0]) if len(values) == 1 else f"{digits(values[0])} to {digits(values[-1])}"
        unit = ("N m/rad" if kind.startswith("rotational") else "N/m") + ("/m" if kind.endswith("_bed") else "")
        where = "along the whole bridge" if kind.endswith("_bed") else \
            f"at {len(data)} station{'' if len(data) == 1 else 's'}"
        if data.shape[1] > 3:
            where += ", one-sided" if data[:, 4].any() else ""
            gap = f"{1e3 * data[:, 3].max():.4g} {'mrad' if 'rad' in unit else 'mm'}"
            where += f", gap up to {gap}" if data[:, 3].any() else ""
            where += ", with a cubic term" if data[:, 5].any() else ""
            where += f", sliding at {digits(1e-3 * data[:, 6].max())} kN" if data[:, 6:].any() else ""
        if source.runs is not None and f"foundation_{kind}_k" in source.runs.parameters:
            shown = "varied: " + ", ".join(digits(k) for k in np.unique(source.runs.parameters[f"foundation_{kind}_k"])[:8])
        rows.append((f"Foundation: {WORDS[kind.replace('_bed', '')]}", f"{shown} {unit}, {where}"))
    rows.append(("Train", source.train_in_words()))
    if options.get("track_profile", "none") != "none":
        rows.append(("Running surface", f"{options['track_profile']}, seed {options.get('track_seed', '1')}"
                     if "study_vary_track_seed" not in options else f"{options['track_profile']}, several seeds"))
    if "track_rail_EI" in options:
        rows.append(("Track", "rail, pads and sleepers modelled in layers"))
    if "track_rail_expansion_devices" in options:
        rows.append(("Rail expansion devices", f"at {options['track_rail_expansion_devices']} m"))
    return rows


def promises(source):
    """Rows (quantity, estimated error) of the peaks."""
    rows = []
    for name in ("deflection", "acceleration", "moment") + (("wheel_force",) if len(source.model.train) else ()):
        error = source.summary.get(f"expected_error_{name}")
        rows.append((f"peaks of the {name.replace('_', ' ')}",
                     f"expected relative error {error:.1g}" if error is not None else
                     "not estimated: mesh, modes or step were given, or the trial runs did not determine it"))
    return rows


def sheet(report, source):
    page = report.page(f"Model: {source.title()}")
    if len(source.model.span_ends) > 1:
        draw_bridge(page, source)
    draw_train(page, source)
    page = table(report, page, [("model", 2.0, "left"), ("", 4.7, "left")], properties(source))
    if not source.is_rail:
        page = table(report, page, [("estimated error", 2.0, "left"), ("", 4.7, "left")], promises(source))
    if source.model.notes:
        rows = [(str(i), note) for i, note in enumerate(source.model.notes, 1)]
        table(report, page, [("", 0.3, "left"), ("notes of the program on its model", 6.4, "left")], rows)


