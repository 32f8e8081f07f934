"""A layered track in a picture: rail, pads, sleepers and ballast as symbols, and forces over the place."""

from typing import NamedTuple

import numpy as np
from engineering_units import shown
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.patches import Rectangle
from matplotlib.transforms import blended_transform_factory
from picture_axes import COLOURS, LABEL_SIZE, PALE, RED, STYLES, note_beside
from picture_data import MOST_WHEELS, part_name, thin
from picture_model import DARK, Model
from picture_table import draw_curve, keep

MOST_SLEEPERS = 240   # drawn in the shape; of more, every second, third, ...
FEWEST_SPRINGS = 20   # foundation springs that are drawn over the place
BALLAST, SLEEPER, PAD = (0.0, 0.42), (0.50, 0.70), (0.70, 0.90)  # layers, as shares of the height of the strip


class Track(NamedTuple):
    spacing: float       # m
    pads: bool
    ballast: bool
    hanging: np.ndarray  # m, places of hanging sleepers
    gaps: np.ndarray     # m, the greatest openings of their gaps


def track_of(results):
    """The layered track of a run; None if it has none."""
    try:
        spacing = float(results.options.get("track_spacing", 0.0))
    except ValueError:
        return None
    if "rail/deflection" not in results.file or not spacing > 0.0:
        return None
    hanging, gaps = results.values("track/hanging/x"), results.values("track/hanging/gap")
    hanging = np.zeros(0) if hanging is None else hanging
    return Track(spacing, "track_pad_k" in results.options, "track_ballast_k" in results.options, hanging,
                 np.zeros(0) if gaps is None else gaps[:results.rows].max(axis=0))


def draw_track(ax, track, foot, height):
    """Draws the track as a strip of this height (shares of the height of the axes) from `foot` on; returns the names of
    its symbols."""
    place, (low, high) = blended_transform_factory(ax.transData, ax.transAxes), ax.get_xlim()
    one = track.hanging[0] if len(track.hanging) else 0.0  # a sleeper
    first, last = np.ceil((low - one) / track.spacing), np.floor((high - one) / track.spacing)
    every = max(int(np.ceil((last - first + 1) / MOST_SLEEPERS)), 1)
    numbers = np.arange(first, last + 1, every)
    sleepers, hangs = one + track.spacing * numbers, np.isin(numbers, np.round((track.hanging - one) / track.spacing))
    wide = 0.55 * track.spacing * every

    def y(part):
        return foot + part * height

    def blocks(places, layer, **look):
        """One block for each sleeper."""
        boxes = [Rectangle((x - 0.5 * wide, y(layer[0])), wide, height * (layer[1] - layer[0])) for x in places]
        ax.add_collection(PatchCollection(boxes, transform=place, lw=0, **look))

    if track.ballast:
        ax.add_patch(Rectangle((low, y(BALLAST[0])), high - low, height * (BALLAST[1] - BALLAST[0]), transform=place,
                               fc="#EFEBE3", ec="#B9AD94", hatch="....", lw=0.0, zorder=2))
        blocks(sleepers[~hangs], (BALLAST[1], SLEEPER[0]), fc="#D9CFBB", zorder=2)  # touched by those that do not hang
    blocks(sleepers, SLEEPER, fc=[RED if hanging else "#7A7A7A" for hanging in hangs], zorder=3)
    if track.pads:
        lines = [[(x, y(PAD[0])), (x, y(PAD[1]))] for x in sleepers]
        points = 72.0 * ax.get_position().width * ax.figure.get_figwidth() / (high - low)  # of 1 m
        ax.add_collection(LineCollection(lines, transform=place, colors=COLOURS[1], lw=min(2.0, 0.5 * points * wide),
                                         zorder=3))
    ax.plot([low, high], [y(PAD[1])] * 2, color=DARK, lw=2.0, transform=place, zorder=4)
    words = f"sleepers every {track.spacing:g} m" + (f", drawn: one of {every}" if every > 1 else "")
    names = ["━ rail" + (", on pads" if track.pads else ""), f"▪ {words}"]
    names += ["▒ ballast"] if track.ballast else []
    if hangs.any():
        unit, factor = shown("deflection")
        names.append(f"▪ red: hanging, open by\nup to {factor * track.gaps.max():.3g} {unit}")
    return names


def wheel_paths(results):
    """Yields (number of the vehicle, name, x, force) of every wheel over the samples, m and N, from the front of the
    train."""
    model = Model(results)
    for k, (kind, _) in enumerate(model.train[:len(results.vehicles)]):
        vehicle, names, bodies = results.vehicles[k], model.body_names(kind), model.rows(kind, "bodies", 3)
        forces = [name for name in wheel_names(results, model, kind) if name in vehicle]
        wheels = model.rows(kind, "wheels", 3)
        for name, (x, y, _) in zip(forces, wheels) if len(forces) == len(wheels) else ():
            body = int(np.argmin(np.hypot(*(bodies[:, :2] - (x, y)).T)))
            place = results.over_time(vehicle[names[body]]["position"])[:, 0] + x - bodies[body, 0]
            yield k, name, place, results.over_time(vehicle[name]["normal_force"])


def wheel_names(results, model, kind):
    """The names of the wheels of a vehicle type, in the order of its rows."""
    return [name.strip() for name in results.options.get(f"vehicle_{model.type_name(kind)}_wheels", "").split(",")]


def draw_bridge_ends(ax, results):
    """Marks the supports, and names the bridge, in a panel over the place."""
    ends = results.supports
    low, high = ax.get_xlim()
    for end in ends if ends is not None else []:
        if low < end < high:
            ax.axvline(end, color=PALE, lw=1.0, zorder=0.8)
    ax.set_xlabel("place along the track (m)")


def draw_wheel_paths(ax, results, wheels):
    """Draws the wheel forces over the place of each wheel: of a few wheels, or pale with the first and the last in
    colours."""
    unit, factor = shown("force")
    count = len(results.vehicles)
    named = range(len(wheels)) if len(wheels) <= MOST_WHEELS else (0, len(wheels) - 1)
    for i, (k, name, x, force) in enumerate(wheels):
        x, force = thin(x, factor * force)
        words = part_name(k, count, name)
        own = {"color": COLOURS[list(named).index(i)], "zorder": 3, "label": words, "lw": 1.1} if i in named else \
            {"color": PALE, "lw": 0.6}
        draw_curve(ax, x, force, words, **own)
    ax.set(title="Wheel forces over the place of the wheel", ylabel=unit)
    ax.set_xlim(min(x.min() for _, _, x, _ in wheels), max(x.max() for _, _, x, _ in wheels))
    draw_bridge_ends(ax, results)
    ax.legend(loc="center left", bbox_to_anchor=(1.03, 0.5), frameon=False, fontsize=LABEL_SIZE)
    others = "; grey: the other wheels" if len(wheels) > MOST_WHEELS else ""
    note_beside(ax, f"vertical lines: supports of the bridge{others}")


def seats_of(results):
    """[(words, x, greatest force over time)] of the seats of the rail in the file: pads, ballast, hanging sleepers,
    springs."""
    found = []
    for dataset, at, words in (("track/sleepers/pad_force", "track/sleepers/x", "pads"),
                               ("track/sleepers/ballast_force", "track/sleepers/x", "ballast"),
                               ("track/hanging/force", "track/hanging/x", "hanging sleepers"),
                               ("foundation/vertical/force", "foundation/vertical/x", "springs under the rail")):
        x = results.values(at)
        if x is not None and dataset in results.file and (dataset[0] == "t" or len(x) >= FEWEST_SPRINGS):
            found.append((words, x, results.over_time(results.file[dataset]).max(axis=0)))
    return found


def draw_seats(ax, results, seats):
    """Draws the greatest force over time at each seat over its place."""
    unit, factor = shown("force")
    for i, (words, x, force) in enumerate(seats):
        if len(x) > 60:
            draw_curve(ax, x, factor * force, words, color=COLOURS[i], ls=STYLES[0], label=words)
        else:
            keep(ax, words, x, factor * force)
            ax.vlines(x, 0.0, factor * force, color=COLOURS[i], lw=1.2, alpha=0.6)
            ax.plot(x, factor * force, "os^D"[i], color=COLOURS[i], ms=5, label=words)
    places = np.concatenate([x for _, x, _ in seats])
    margin = 0.05 * max(np.ptp(places), 1.0)
    ax.set(title="Greatest force at each seat of the track, compression positive", ylabel=unit,
           xlim=(places.min() - margin, places.max() + margin))
    ax.set_ylim(min(0.0, ax.get_ylim()[0]), 1.08 * ax.get_ylim()[1])
    draw_bridge_ends(ax, results)
    ax.legend(loc="center left", bbox_to_anchor=(1.03, 0.5), frameon=False, fontsize=LABEL_SIZE)


def draw_losses(ax, results):
    """Leaves gaps in the curves of wheel forces over time where contact is lost, with bars at the force 0."""
    if "separations/start" not in results.file:
        return
    for line in ax.get_lines():
        y = np.asarray(line.get_ydata(), dtype=float)
        lost = y == 0.0
        if len(y) > 2:  # zeros beside other values remain, for the lines to these values
            inside = lost & np.append(lost[1:], True) & np.append(True, lost[:-1])
            line.set_ydata(np.where(inside, np.nan, y))
    start, duration = results.values("separations/start"), results.values("separations/duration")
    ax.hlines(np.zeros(len(start)), start, start + duration, color=RED, lw=3.0, zorder=4)
    note_beside(ax, f"red bars: {len(start)} losses of contact" if len(start) > 1 else "red bar: no contact")
