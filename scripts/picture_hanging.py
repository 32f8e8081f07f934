"""Bodies that hang from a vehicle or from the ground on one joint or on ropes, like the load of a crane: where they
are, swing, and force in the ropes or in the pin."""

from typing import NamedTuple

import numpy as np
from engineering_units import shown
from picture_axes import COLOURS, GREY, PALE, time_panel
from picture_data import MOST_CURVES, choose, listed_names, part_name, spring_names
from picture_model import Model
from picture_table import draw_curve

TURNS = ("revolute", "distance")  # joints that allow a swing


class Hanging(NamedTuple):
    """Swing over the samples, positive with the load ahead along x: the angle from the vertical, degrees, or on ropes
    the distance along x, m; and force, N."""
    vehicle: int
    body: str
    joint: str  # or the names of the ropes
    swing: np.ndarray
    force: np.ndarray
    top: np.ndarray   # [n, 2], m: where it hangs
    place: np.ndarray  # [n, 2], m: of the body, or of the lower end of the ropes
    ropes: bool = False
    travels: bool = False


def swinging(model, kind):
    """Yields (joint, body, end on the supporting body, supporting body or -1) of a vehicle type."""
    ends, names, bodies = model.joint_ends(kind), model.joint_names(kind), model.rows(kind, "bodies", 3)
    held = [int(body) for joint in [*ends, *model.rows(kind, "springs", 6), *model.falls(kind)[0]]
            for body in joint[4:] if body >= 0]
    wheels = {int(np.argmin(np.hypot(*(bodies[:, :2] - wheel[:2]).T))) for wheel in model.rows(kind, "wheels", 3)}
    for joint, (_, type_name) in enumerate(names):
        for own, end, other in ((5, ends[joint, :2], 4), (4, ends[joint, 2:4], 5)):
            body = int(ends[joint, own])
            if body >= 0 and type_name in TURNS and held.count(body) == 1 and body not in wheels and \
                    end[1] > bodies[body, 1] + 1e-6:
                yield joint, body, end, int(ends[joint, other])


def on_ropes(results, model, kind):
    """Yields (names, body, end on it, supporting body, end on that): bodies that hang on ropes and on springs in
    tension only, with the means of their ends. A rope has its name once for each of its falls."""
    names, springs = spring_names(results, model, kind), model.rows(kind, "springs", 6)
    bodies = model.rows(kind, "bodies", 3)
    tense = [results.options.get(f"vehicle_{model.type_name(kind)}_{name}_side") == "tension" for name in names]
    (falls, of_rope), ropes = model.falls(kind), listed_names(results, model, kind, "ropes")
    if len(names) == len(springs) and (len(of_rope) == 0 or of_rope.max() < len(ropes)):
        names, springs = names + [ropes[i] for i in of_rope], np.concatenate([springs, falls])
        tense += [True] * len(falls)
    jointed = {int(body) for joint in model.joint_ends(kind) for body in joint[4:]}
    for body in range(len(bodies)):
        own = [i for i, spring in enumerate(springs) if body in spring[4:].astype(int)]
        others = {int(springs[i, 4] + springs[i, 5]) - body for i in own}
        if body in jointed or len(names) == 0 or not own or not all(tense[i] for i in own) or len(others) != 1:
            continue
        ends = [springs[i, [2, 3, 0, 1]] if springs[i, 5] == body else springs[i, :4] for i in own]
        ends = np.array(ends).mean(axis=0)
        if ends[3] > ends[1]:
            yield [names[i] for i in own], body, ends[:2], others.pop(), ends[2:]


def carried(position, centre, point):
    """[n, 2]: a point of a body over the samples."""
    turned, arm = position[:, 2] - position[0, 2], point - centre
    return position[:, :2] + np.column_stack([np.cos(turned) * arm[0] - np.sin(turned) * arm[1],
                                              np.sin(turned) * arm[0] + np.cos(turned) * arm[1]])


def hanging_of(results):
    """All hanging bodies of a run."""
    model, found = Model(results), []
    for k, (kind, _) in enumerate(model.train[:len(results.vehicles)]):
        group, names = results.vehicles[k], model.body_names(kind)
        centres = model.rows(kind, "bodies", 3)[:, :2]

        def position(body):
            return results.over_time(group[names[body]]["position"])

        for joint, body, end, other in swinging(model, kind):
            name, place = model.joint_names(kind)[joint][0], position(body)
            top = carried(position(other), centres[other], end) if other >= 0 else place[:1, :2] + end - centres[body]
            swing = np.degrees(np.arctan2(place[:, 0] - top[:, 0], top[:, 1] - place[:, 1]))
            force = np.hypot(*results.over_time(group[name]["reaction"])[:, :2].T)
            found.append(Hanging(k, names[body], name, swing, force, top, place[:, :2], travels=other >= 0))
        for ropes, body, end, other, above in on_ropes(results, model, kind):
            place = carried(position(body), centres[body], end)
            top = carried(position(other), centres[other], above) if other >= 0 else np.array([above])
            force = sum(results.over_time(group[name]["force"]) for name in ropes)
            found.append(Hanging(k, names[body], " and ".join(dict.fromkeys(ropes)), place[:, 0] - top[:, 0], force, top, place, True,
                                 other >= 0))
    return found


def draw_places(ax, results, hanging):
    """Draws the loads under their ropes at some instants, and their paths; the height is not in the scale of the
    length."""
    low, high = min(one.place[:, 1].min() for one in hanging), max(one.top[:, 1].max() for one in hanging)
    ends = [x for one in hanging for x in one.place[:, 0]]
    ends += [] if results.supports is None else list(results.supports)
    left, right = min(ends), max(ends)
    ax.set(xlim=(left - 0.02 * (right - left), right + 0.02 * (right - left)),
           ylim=(low - 0.22 * (high - low), high + 0.12 * (high - low)))
    ax.axhline(0.0, color=PALE, lw=1.0)
    for one, colour in zip(hanging, COLOURS):
        draw_curve(ax, *one.place.T, f"path of the {one.body.replace('_', ' ')}", color=colour, lw=1.0)
        last = None
        for i in np.linspace(0, results.rows - 1, 200).round().astype(int):
            if last is None or np.hypot(*((one.place[i] - one.place[last]) / (right - left, high - low))) > 0.1:
                last = i
                (x, y), (u, v) = one.place[i], one.top[min(i, len(one.top) - 1)]
                ax.plot([u, x], [v, y], color=GREY, lw=1.0)
                ax.plot([x], [y], "s", ms=8, color=colour, zorder=4)
                ax.plot([u], [v], "o", ms=5, color="white", mec=GREY, zorder=4)
                ax.annotate(f"{results.time[i]:.1f} s", (x, y), (8, -6), textcoords="offset points", va="top",
                            fontsize=8.5, color=GREY)
    ax.set(title="The load under its rope at some instants, and its path", ylabel="m",
           xlabel="place along the track (m)")


def draw(ax, results, hanging, what):
    """Draws the 'swing' or the 'force' over time."""
    count = len(results.vehicles)
    ropes, (unit, factor) = all(one.ropes for one in hanging), shown("force") if what == "force" else ("", 1.0)
    values = [factor * getattr(one, what) for one in hanging]
    chosen = choose(len(values), MOST_CURVES, np.array([np.abs(v).max() for v in values]))
    note = "" if len(chosen) == len(values) else f" ({len(chosen)} of {len(values)})"
    names = [one.body if what == "swing" else one.joint for one in hanging]
    curves = [(part_name(hanging[i].vehicle, count, names[i]), values[i]) for i in chosen]
    if what == "force":
        where = "of the ropes of the load together" if ropes else "in the joint of the hanging body"
        time_panel(ax, results, f"Force {where}{note}", unit, curves)
    elif ropes:
        time_panel(ax, results, f"Sway: the load relative to the top of its ropes, positive ahead{note}", "m", curves)
    else:
        time_panel(ax, results, f"Angle of the hanging body from the vertical, positive ahead{note}", "°", curves)
