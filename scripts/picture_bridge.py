"""Panels of a bridge in a single run: its shape at the largest deflection, and its stations and bearings over time."""

import matplotlib.pyplot as plt
import numpy as np
from engineering_units import shown
from matplotlib.transforms import blended_transform_factory
from picture_axes import COLOURS, GREY, LABEL_SIZE, PALE, legible, time_panel
from picture_data import MOST_CURVES, choose, choose_probes, place_in_words, spring_gaps
from picture_model import MOST_SYMBOLS, Model, draw_forces, draw_foundation, draw_supports, symbols_in_words
from picture_table import draw_curve
from picture_track import draw_track, track_of
from picture_words import worst_in_words

# Panels over time: the dataset of the probes, its title, and the row of engineering_units.csv.
QUANTITIES = {"deflection": ("Deflection of the bridge, upward positive", "deflection"),
              "acceleration": ("Vertical acceleration of the bridge, unfiltered", "acceleration"),
              "moment": ("Bending moment of the bridge, positive in sagging", "moment"),
              "shear": ("Shear force of the bridge", "force")}
# Panels of scene_analysis envelope.
STATIC = {"deflection": "Static deflection over all positions of the load, upward positive",
          "moment": "Bending moment, positive in sagging", "shear": "Shear force"}
SHORT = 0.2  # of the duration of a run
STRIP, ABOVE = 0.16, 0.24  # shares of the height of the shape for a layered track, and for what moves above it


def draw_probes(ax, results, name, worst=None, group="probes"):
    """Draws a quantity of the bridge, or of the rail above it, at the probes over time: at all, or at those at midspans
    if there are many. worst: the instant of the largest deflection."""
    title, kind = QUANTITIES[name]
    title = title.replace("bridge", "rail") if group == "rail" else title
    unit, factor = shown(kind)
    values = factor * results.over_time(results.file[f"{group}/{name}"])
    chosen = choose_probes(results, np.abs(values).max(axis=0))
    note = "" if len(chosen) == values.shape[1] else f" ({len(chosen)} of {values.shape[1]} places)"
    curves = [(place_in_words(results.probes[i], results.supports) + results.beside_axis(i), values[:, i]) for i in chosen]
    time_panel(ax, results, title + note, unit, curves, worst=worst)
    show_motion(ax, results.time, values[:, chosen])
    if name == "deflection" and group == "probes":
        draw_gaps(ax, spring_gaps(results), factor)


def show_motion(ax, time, values):
    """Restricts the axes to the time in which values [n, curves] differ from zero, if this is short."""
    moving = time[(np.abs(values) > 0.02 * np.abs(values).max()).any(axis=1)]
    length = moving[-1] - moving[0] if len(moving) else np.inf
    if length < SHORT * (time[-1] - time[0]):
        ax.set_xlim(max(moving[0] - 0.5 * length, time[0]), min(moving[-1] + 0.5 * length, time[-1]))
        ax.set_xlabel("time (s), only while these places move")


def draw_gaps(ax, gaps, factor):
    """Draws the deflections at which springs below gaps begin to act, if they are in the range of the axes."""
    low, high = ax.get_ylim()
    for gap in np.unique([gap for _, gap in gaps]):
        if low < -factor * gap < high:
            ax.axhline(-factor * gap, color=GREY, lw=1.0, ls=(0, (1.2, 1.2)))
            ax.text(0.995, -factor * gap, f"the spring below a gap of {factor * gap:.4g} {ax.get_ylabel()} acts",
                    fontsize=8.5, color=GREY, va="bottom", ha="right", transform=ax.get_yaxis_transform())


def draw_bearings(ax, results):
    """Forces of supports and foundation springs; the greatest ones if there are many."""
    found, (unit, factor) = [], shown("force")
    if "supports/reaction" in results.file:
        forces = factor * results.over_time(results.file["supports/reaction"])[:, :, 1]
        found += [(f"support at {x:.6g} m", forces[:, i]) for i, x in enumerate(results.supports) if forces[:, i].any()]
    if "foundation/vertical/force" in results.file:
        forces = factor * results.over_time(results.file["foundation/vertical/force"])
        found += [(f"spring at {x:.6g} m", forces[:, i])
                  for i, x in enumerate(results.values("foundation/vertical/x"))]
    chosen = choose(len(found), MOST_CURVES, np.array([np.abs(values).max() for _, values in found]))
    note = "" if len(chosen) == len(found) else f" ({len(chosen)} of {len(found)})"
    time_panel(ax, results, f"Bearing forces on the bridge, upward positive{note}", unit, [found[i] for i in chosen])


def draw_symbols(ax, results, low, high):
    """Draws supports, springs and hinges under the undeflected line; returns their names."""
    model = Model(results)
    kinds = draw_foundation(ax, model, low, high) | draw_supports(ax, model, low, high)
    return [words for words in symbols_in_words(kinds).split("    ") if words]


def draw_train(ax, results, time, foot):
    """Draws the positions of vehicles and forces at this time, as boxes and arrows above the bridge. foot: where the
    wheels are, as a share of the height of the axes."""
    above = blended_transform_factory(ax.transData, ax.transAxes)
    low, high = ax.get_xlim()
    middle = []
    row = int(np.argmin(np.abs(results.time - time))) if results.rows else 0
    for vehicle in results.vehicles if results.rows else []:
        xs = [vehicle[name]["position"][row, 0] for name in vehicle if "position" in vehicle[name]]
        if not xs or max(xs) < low or min(xs) > high:
            continue
        left, width = max(min(xs), low), max(min(max(xs), high) - max(min(xs), low), 0.004 * (high - low))
        ax.add_patch(plt.Rectangle((left, foot + 0.04), width, 0.07, transform=above, color="#9DB7C9", lw=0))
        middle.append(left + width / 2)
    forces = Model(results).forces_at(time, results.options)
    places = forces[:, 0]
    there = (places >= low) & (places <= high)
    draw_forces(ax, places[there], forces[there, 1], 0.14, foot, above)
    middle += list(places[there])
    if middle:
        name = what_moves(results, len(forces))
        ax.text(np.clip(np.mean(middle), low, high), foot + 0.155, name, transform=above, ha="center", va="bottom",
                fontsize=9, color=GREY)


def what_moves(results, forces):
    """The name of the moving loads, such as 'the train'."""
    trains = len(np.unique(Model(results).trains[:, 0]))
    vehicles = ("the trains" if trains > 1 else "the train" if len(results.vehicles) > 1 else
                "the vehicle" if results.vehicles else "")
    return " and ".join(filter(None, (vehicles, "moving forces" if forces > 1 else "a moving force" if forces else "")))


def shown_part(results, x, shape):
    """(low, high, note): the bridge and hanging sleepers before it, or the deflected part of a long bridge."""
    low, high, track = x[0], x[-1], track_of(results)
    if results.supports is None or not np.any(shape):
        return low, high, ""
    moved = x[np.abs(shape) > 0.03 * np.abs(shape).max()]
    width, span = moved[-1] - moved[0], np.diff(results.supports).max()
    if width > MOST_SYMBOLS * span:
        worst, width = x[np.argmax(np.abs(shape))], 0.2 * MOST_SYMBOLS * span
        moved = np.array([worst - 0.5 * width, worst + 0.5 * width])
    if width < 0.25 * (high - low):
        margin = 0.3 * width + min(2.0 * span, width)
        return max(low, moved[0] - margin), min(high, moved[-1] + margin), \
            f"The bridge is {high - low:,.0f} m long,\nonly {'a' if span < width else 'the'} deflected part is shown."
    places = [low, high, *(track.hanging if track else [])]
    return min(places), max(places), ""


def scale_of_shape(ax, shape, share):
    """Gives the shape the lower part of the axes, this share of their height, and the scale to this part only."""
    deepest, highest = min(shape.min(), 0.0), max(shape.max(), 0.0)
    reach = max(highest - deepest, 1e-9)
    low, top = deepest - 0.35 * reach, highest + 0.1 * reach
    ax.set_ylim(low, low + (top + 0.1 * reach - low) / share)
    ax.set_yticks([tick for tick in ax.get_yticks() if low <= tick <= top])
    ax.spines["left"].set_bounds(low, top)


def draw_shape(ax, results):
    """Draws the bridge at its largest deflection with its supports, track and train; returns the instant."""
    unit, factor = shown("deflection")
    x, shape = results.values("shape/x"), factor * results.values("shape/deflection")
    unit, smaller = legible(unit, [shape])
    shape, metres = smaller * shape, 1.0 / (smaller * factor)
    time = float(results.file["shape/deflection"].attrs["time"])
    low, high, note = shown_part(results, x, shape)
    inside = (x >= low) & (x <= high)
    ax.axhline(0.0, color=PALE, lw=1.0)
    ax.set_ylabel(unit)
    ax.set_xlabel("place along the track (m)")
    draw_curve(ax, x[inside], shape[inside], "bridge", color=COLOURS[0], lw=3.2, solid_capstyle="round")
    moves, track = results.vehicles or Model(results).forces, track_of(results)
    foot, strip = 1.0 - (ABOVE if moves else 0.0), STRIP if track else 0.0
    scale_of_shape(ax, shape, foot - strip)
    ax.set_xlim(low - 0.02 * (high - low), high + 0.02 * (high - low))
    symbols = draw_symbols(ax, results, low, high)
    if track:
        symbols += draw_track(ax, track, foot - strip, strip)
    symbols += ["Above the bridge: symbols,\nnot to this scale."] if moves or track else []
    draw_train(ax, results, time, foot)
    worst = int(np.argmax(np.abs(shape)))
    if np.any(shape):
        down = shape[worst] < 0.0
        ax.annotate(worst_in_words(results, x[worst], metres * shape[worst]), xy=(x[worst], shape[worst]),
                    xytext=(0, -6 if down else 6), textcoords="offset points", ha="center",
                    va="top" if down else "bottom", color=COLOURS[0], fontsize=LABEL_SIZE)
    box = ax.get_position()
    width = box.width * ax.figure.get_figwidth()
    height = box.height * ax.figure.get_figheight()
    scale = (np.ptp(ax.get_xlim()) / width) / (metres * np.ptp(ax.get_ylim()) / height)
    ax.set_title(f"The bridge at its largest deflection, {time:.4g} s" if results.rows > 1 else
                 "The bridge under its load")
    times = f"{float(f'{scale:.2g}'):,.0f}"
    said = "\n".join([f"Deflection is drawn\n{times} times too large.", *symbols, *([note] if note else [])])
    ax.text(1.035, 0.5, said, transform=ax.transAxes, va="center", fontsize=LABEL_SIZE, color=GREY, linespacing=1.4)
    return time


def draw_static(ax, results, name):
    """Least and greatest value of every load along the bridge, over all positions of the load."""
    unit, factor = shown(QUANTITIES[name][1])
    x, values = results.values("static/x"), factor * results.values(f"static/{name}")
    ax.set(title=STATIC[name], ylabel=unit, xlabel="place along the bridge (m)", xlim=(x[0], x[-1]))
    for i, (load, _) in enumerate(results.file["static/load"].asstr()[:]):
        for side, word in enumerate(("least", "greatest")):
            draw_curve(ax, x, values[i, :, side], f"{load}, {word}", color=COLOURS[i % len(COLOURS)],
                       label=None if side else load)
    ax.axhline(0.0, color=PALE, lw=1.0)
    ax.legend(loc="center left", bbox_to_anchor=(1.03, 0.5), frameon=False, fontsize=LABEL_SIZE)
