"""Bodies that hang from a vehicle or from the ground on one joint, like the load of a crane: swing angle, and force in
the rope or pin."""

from typing import NamedTuple

import numpy as np
from picture_axes import time_panel
from picture_data import MOST_CURVES, choose, ordinal
from picture_model import Model

TURNS = ("revolute", "distance")  # joints that allow a swing


class Hanging(NamedTuple):
    """Swing angle from the vertical over the samples, degrees, positive with the load ahead along x, and force, N."""
    vehicle: int
    body: str
    joint: str
    swing: np.ndarray
    force: np.ndarray


def swinging(model, kind):
    """Yields (joint, body, end on the supporting body, supporting body or -1) of a vehicle type."""
    ends, names, bodies = model.joint_ends(kind), model.joint_names(kind), model.rows(kind, "bodies", 3)
    held = [int(body) for joint in [*ends, *model.rows(kind, "springs", 6)] for body in joint[4:] if body >= 0]
    wheels = {int(np.argmin(np.hypot(*(bodies[:, :2] - wheel[:2]).T))) for wheel in model.rows(kind, "wheels", 3)}
    for joint, (_, type_name) in enumerate(names):
        for own, end, other in ((5, ends[joint, :2], 4), (4, ends[joint, 2:4], 5)):
            body = int(ends[joint, own])
            if body >= 0 and type_name in TURNS and held.count(body) == 1 and body not in wheels and \
                    end[1] > bodies[body, 1] + 1e-6:
                yield joint, body, end, int(ends[joint, other])


def hanging_of(results):
    """All hanging bodies of a run."""
    model, found = Model(results), []
    for k, (kind, _) in enumerate(model.train[:len(results.vehicles)]):
        group, names = results.vehicles[k], model.body_names(kind)
        centres = model.rows(kind, "bodies", 3)[:, :2]
        for joint, body, end, other in swinging(model, kind):
            name = model.joint_names(kind)[joint][0]
            place = results.over_time(group[names[body]]["position"])
            if other >= 0:
                holder = results.over_time(group[names[other]]["position"])
                turned, arm = holder[:, 2] - holder[0, 2], end - centres[other]
                top = holder[:, :2] + np.column_stack([np.cos(turned) * arm[0] - np.sin(turned) * arm[1],
                                                       np.sin(turned) * arm[0] + np.cos(turned) * arm[1]])
            else:
                top = place[0, :2] + end - centres[body]
            swing = np.degrees(np.arctan2(place[:, 0] - top[:, 0], top[:, 1] - place[:, 1]))
            force = np.hypot(*results.over_time(group[name]["reaction"])[:, :2].T)
            found.append(Hanging(k, names[body], name, swing, force))
    return found


def draw(ax, results, hanging, what):
    """Draws the 'swing' or the 'force' over time."""
    count = len(results.vehicles)
    values = [getattr(one, what) * (1.0 if what == "swing" else 1e-3) for one in hanging]
    chosen = choose(len(values), MOST_CURVES, np.array([np.abs(v).max() for v in values]))
    note = "" if len(chosen) == len(values) else f" ({len(chosen)} of {len(values)})"
    curves = [(f"{ordinal(hanging[i].vehicle, count, 'vehicle')}, "
               f"{(hanging[i].body if what == 'swing' else hanging[i].joint).replace('_', ' ')}", values[i]) for i in chosen]
    if what == "swing":
        time_panel(ax, results, f"Angle of the hanging body from the vertical, positive ahead{note}", "°", curves)
    else:
        time_panel(ax, results, f"Force of its joint{note}", "kN", curves)
