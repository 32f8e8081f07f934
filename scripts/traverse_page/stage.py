"""The drawing of the page: the bridge with its supports, what moves, and where it is at each drawn instant."""

import numpy as np
from animate import DRAWN, MARGIN, WIDEST, rounded
from picture_model import MOST_SYMBOLS, Model, vertical_reach
from picture_motion import HOLDS_HEIGHT, Body, Motion
from traverse_report.language import number, t

from .packing import packed
from .vehicles import attached, is_free, numbers, parts_of

MOST_FRAMES, MOST_VALUES = 800, 190_000  # of drawn samples; of their numbers together, about 1 MB
NARROWEST = 1.0  # m of the track in the drawing, for bodies without extent
SWAY = 0.02  # of the ends of a body, as a share of the width
TRAVELS = "The train moves at the speed of the chosen run; the file has no deflections over time."
POINTS = 160  # of the deflected line in the width of the drawing


def symbols(model):
    """Supports, hinges, springs and beds of the bridge."""
    springs = []
    for kind, rows in model.foundation.items():
        base = kind.removesuffix("_bed")
        places = np.unique(rows[:, 0]) if base == kind else np.linspace(*model.span_ends[[0, -1]], 33)[1:-1]
        if len(places) > MOST_SYMBOLS:
            places = places[np.linspace(0, len(places) - 1, MOST_SYMBOLS).round().astype(int)]
        gaps = set(rows[rows[:, 3] > 0.0, 0]) if base == kind else set()
        springs += [[float(x), base, x in gaps] for x in places]
    return {"supports": [[float(x), kind, joint] for x, (kind, joint) in zip(model.span_ends, model.supports)],
            "hinges": model.hinges.tolist(), "cracks": model.cracks.tolist(), "springs": springs}


def bodies_without_bridge(results):
    return [Body(k, name, position, float(position[0, 1])) for k, vehicle in enumerate(results.vehicles)
            for name in vehicle if "position" in vehicle[name]
            for position in [results.over_time(vehicle[name]["position"])]]


def standing(model):
    """One row of positions of all bodies as the model has them at the start."""
    return [Body(k, name, np.array([[origin + x, y, 0.0]]), float(y)) for k, (kind, origin) in enumerate(model.train)
            for name, (x, y, _) in zip(model.body_names(kind), model.rows(kind, "bodies", 3))]


def extents(results, model, bodies):
    """(left, bottom, right, top) of all that vehicles and mechanisms reach, m."""
    boxes = []
    for body in bodies:
        kind = int(model.train[body.vehicle, 0])
        points, x, y = attached(model, kind)[numbers(model, kind)[body.name]], *body.position[:, :2].T
        reach = np.hypot(*(points - points[0]).T).max() if is_free(body.position) else 0.0
        boxes.append([x.min() - reach, y.min() - reach, x.max() + reach, y.max() + reach])
    for first in {body.vehicle: body for body in bodies}.values():
        kind = int(model.train[first.vehicle, 0])
        low, high = vertical_reach(model, kind)
        boxes += [[boxes[0][0], low, boxes[0][2], high]] if model.length() else []
        for part in parts_of(results, model, kind, False):
            for body, x, y in part["points"]:
                boxes += [[*(ground_of(model, kind, first) + [x, y])] * 2] if body < 0 else []
    boxes = np.array(boxes)
    return [*boxes[:, :2].min(axis=0), *boxes[:, 2:].max(axis=0)]


def ground_of(model, kind, body):
    """Where the origin of the body's vehicle is at the start, m."""
    return body.position[0, :2] - model.rows(kind, "bodies", 3)[numbers(model, kind)[body.name], :2]


def packed_vehicles(results, model, bodies, rows, on_bridge):
    """(types, vehicles): parts of each type; positions of the bodies of each vehicle, [frames, 3] one after another."""
    kinds = sorted({int(model.train[body.vehicle, 0]) for body in bodies})
    types = [parts_of(results, model, kind, on_bridge) for kind in kinds]
    vehicles = []
    for vehicle in sorted({body.vehicle for body in bodies}):
        kind = int(model.train[vehicle, 0])
        own = {body.name: body for body in bodies if body.vehicle == vehicle}
        in_order = [own[name] for name in numbers(model, kind)]
        vehicles.append({
            "type": kinds.index(kind), "name": model.type_name(kind), "bodies": [body.name for body in in_order],
            "origin": ground_of(model, kind, in_order[0]).tolist(),
            "heights": [body.height for body in in_order], "turns": [float(body.position[0, 2]) for body in in_order],
            "free": [is_free(body.position) for body in in_order],
            "frames": packed(np.stack([body.position[rows] for body in in_order]))})
    return types, vehicles


def known(motion):
    """Whether each point of the line is between stations and supports, or as near to them as they are to each other."""
    held = [x for x, (kind, _) in zip(motion.model.span_ends, motion.model.supports) if kind in HOLDS_HEIGHT]
    knots = np.concatenate([motion.stations, held])
    apart = np.ptp(knots) if len(knots) > 1 else np.inf
    return (motion.x >= knots.min() - apart) & (motion.x <= knots.max() + apart)


class Lines:
    """The deflected line of each track at the drawn instants; in long bridges only the part in sight."""

    def __init__(self, motion, rows, view, middles):
        gap = max(1, int(view["width"] / POINTS / np.diff(motion.x).mean()))
        shown = np.union1d(np.arange(0, len(motion.x), gap), np.searchsorted(motion.x, motion.model.span_ends))
        shown = shown[shown < len(motion.x)]
        self.x = motion.x[shown]
        left = np.clip(middles - 0.5 * view["width"], view["left"], max(view["right"] - view["width"], view["left"]))
        first = np.clip(np.searchsorted(self.x, left) - 1, 0, len(self.x) - 1)
        last = np.clip(np.searchsorted(self.x, left + view["width"]) + 1, 0, len(self.x))
        self.count = int((last - first).max())
        self.first = np.clip(first, 0, len(self.x) - self.count)
        unknown = ~known(motion)[shown]
        self.values = np.empty((len(motion.at_tracks), len(rows), self.count))
        for i, (first, row) in enumerate(zip(self.first, rows)):
            part = shown[first:first + self.count]
            for values, at_stations in zip(self.values, motion.at_tracks):
                values[i] = motion.matrix[part] @ at_stations[row] + motion.settled[part]
                values[i, unknown[first:first + self.count]] = np.nan

    def packed(self):
        return {"x": packed(self.x), "count": self.count, "first": packed(self.first),
                "tracks": [packed(values) for values in self.values]}


def chosen_frames(results, size):
    """Rows of the samples that are drawn, at equal distances. `size`: numbers of each."""
    frames = int(np.clip(MOST_VALUES // max(size, 1), 2, min(MOST_FRAMES, results.rows)))
    return np.unique(np.linspace(0, results.rows - 1, frames).round().astype(int))


def middles_of(bodies, forces, rows, width):
    """x of the middle of all that moves, at each of the rows; if it does not fit into the width, of what is first."""
    places = np.concatenate([np.array([body.position[rows, 0] for body in bodies]).reshape(-1, len(rows)), forces.T])
    if not len(places):
        return np.zeros(len(rows))
    return places[0] if np.ptp(places, axis=0).max() > width else 0.5 * (places.min(axis=0) + places.max(axis=0))


def view_of(low, high, bottom, top):
    """The visible part: m along the track, and above it."""
    width = min(max((1.0 + 2.0 * MARGIN) * (high - low), NARROWEST), WIDEST)
    spare = max(MARGIN * min(high - low, width), 0.5 * (width - (high - low)))
    return {"left": low - spare, "right": high + spare, "width": width, "bottom": bottom, "top": top}


def moving(results):
    """The drawing of a run over time."""
    model = Model(results)
    motion = Motion(results) if "probes/deflection" in results.file and len(results.probes) else None
    bodies = motion.bodies if motion else bodies_without_bridge(results)
    bodies = [body for body in bodies if body.vehicle < len(model.train)]
    rows = chosen_frames(results, 3 * len(bodies) + (POINTS * len(motion.tracks) if motion else 0) + len(model.forces.get("load", ())))
    forces = np.array([model.forces_at(results.time[row], results.options)[:, 0] for row in rows]) if motion else \
        np.zeros((len(rows), 0))
    left, bottom, right, top = extents(results, model, bodies) if bodies else (0.0, 0.0, 0.0, 0.0)
    stage = {"low": None, "factor": 1.0, "line": None, "words": t("Drawn to scale.")}
    if motion:
        left, right = motion.low, motion.high
        view = view_of(left, right, bottom, top)
        stage["factor"] = exaggeration(motion, bodies, view["width"])
        drop = stage["factor"] * motion.greatest()
        view.update(bottom=min(bottom, -drop), top=max(top, drop))
    elif bodies:
        view = view_of(left, right, bottom, top)
    else:
        return None
    middles = middles_of(bodies, forces, rows, view["width"])
    if motion:
        stage.update(low=left, high=right, line=Lines(motion, rows, view, middles).packed(), **symbols(model),
                     words=" ".join([*exaggeration_in_words(stage["factor"], bodies),
                                     t("The line is drawn {how}.", how=motion.in_words()),
                                     *([] if known(motion).all() else [t("Far from them it is not known.")])]))
    types, vehicles = packed_vehicles(results, model, bodies, rows, motion is not None)
    sizes = model.forces.get("load", np.zeros((0, 2)))[:, 1]
    return {**stage, "view": view, "frames": len(rows), "of": results.rows, "time": packed(results.time[rows]),
            "middles": packed(middles), "types": types, "vehicles": vehicles, "rail": "rail" in results.file,
            "ground": any(part["is"] == "wheel" for parts in types for part in parts),
            "forces": [{"name": "load", "x": packed(forces), "sizes": packed(sizes)}]}


def exaggeration(motion, bodies, width):
    """The factor of vertical displacements: those of bridge and ends of bodies have limited shares of the width."""
    sway = 0.0
    for body in bodies:
        if not is_free(body.position):
            kind = int(motion.model.train[body.vehicle, 0])
            points = attached(motion.model, kind)[numbers(motion.model, kind)[body.name]]
            turn = np.abs(body.position[:, 2] - body.position[0, 2]) * np.abs(points[:, 0] - points[0, 0]).max()
            sway = max(sway, (np.abs(body.position[:, 1] - body.height) + turn).max())
    return rounded(width * min(DRAWN / max(motion.greatest(), 1e-12), SWAY / max(sway, 1e-12)))


def exaggeration_in_words(factor, bodies):
    if factor == 1.0:
        return [t("Drawn to scale.")]
    words = "Vertical displacements of bridge and vehicles are drawn {factor} times too large, all else to scale." \
        if bodies else "Vertical displacements are drawn {factor} times too large, all else to scale."
    free = any(is_free(body.position) for body in bodies)
    return [t(words, factor=number(factor)), *([t("Bodies with large motions are to scale.")] if free else [])]


def still(results, travels=False):
    """The drawing of a file without a run over time. A train that is nowhere at rest is in the middle of the bridge or,
    if it travels, where it starts: the page then moves it at the speed of the chosen run."""
    model = Model(results)
    if not len(model.span_ends):
        return None
    low, high = model.span_ends[0], model.span_ends[-1]
    at_rest, zero = results.rows == 1, np.zeros(1, dtype=int)
    bodies = bodies_without_bridge(results) if at_rest else standing(model)
    _, bottom, _, top = extents(results, model, bodies) if bodies else (0.0, 0.0, 0.0, 0.0)
    middle = 0.5 * (low + high)
    stays = at_rest or travels
    if bodies and not stays:
        shift = middle - middles_of(bodies, np.zeros((1, 0)), zero, np.inf)[0]
        bodies = [body._replace(position=body.position + [shift, 0.0, 0.0]) for body in bodies]
    frames = 2 if travels else 1
    types, vehicles = packed_vehicles(results, model, bodies, np.repeat(zero, frames), True)
    forces = [{"name": name, "sizes": packed(rows[:, 1]), "x": packed(np.tile(
        rows[:, 0] + (0.0 if stays else middle - rows[[0, -1], 0].mean()), frames))}
              for name, rows in model.forces.items()]
    placed = "" if at_rest or not (bodies or forces) else t(TRAVELS) if travels else \
        t("For the picture, the load is in the middle of the bridge.")
    return {"low": low, "high": high, "factor": 1.0, "line": None, **symbols(model),
            "view": view_of(low, high, bottom, top), "words": f"{t('The model to scale, undeflected.')} {placed}".strip(),
            "travels": travels, "frames": frames, "of": frames, "time": packed(np.arange(frames)),
            "middles": packed(np.full(frames, middle)), "types": types, "vehicles": vehicles,
            "rail": "rail" in results.file or "rail_forces" in results.file, "ground": True, "forces": forces}
