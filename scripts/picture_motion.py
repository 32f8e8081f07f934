"""The motion of bridge and vehicles from a results file: deflections between the stations, motions of bodies."""

from typing import NamedTuple

import numpy as np
from picture_model import Model, body_boxes, rods
from traverse_report.language import num, t

HOLDS_HEIGHT = ("pinned", "roller", "clamped")
HOLDS_SLOPE = ("clamped", "guided")
POINTS, FEWEST_POINTS, MOST_POINTS = 24, 400, 20000  # points per span, and limits for the whole bridge


class Body(NamedTuple):
    """A body of a vehicle, and the initial height of its centre above the undeflected bridge."""
    vehicle: int
    name: str
    position: np.ndarray  # [n, 3]: x, y, angle
    height: float         # m


def spline_matrix(knots, x, flat=(False, False)):
    """The matrix [len(x), len(knots)] from values at the knots to those of the cubic spline at x.

    The spline has no curvature at its ends or, if `flat`, no slope; outside of them it is linear."""
    knots, x = np.asarray(knots, dtype=float), np.asarray(x, dtype=float)
    n = len(knots)
    if n == 1:
        return np.ones((len(x), 1))
    h = np.diff(knots)
    differences = np.diff(np.eye(n), axis=0) / h[:, None]  # slopes of the chords
    left, right = np.zeros((n, n)), np.zeros((n, n))       # left @ slopes = right @ values
    for i in range(1, n - 1):
        left[i, i - 1:i + 2] = 1.0 / h[i - 1], 2.0 / h[i - 1] + 2.0 / h[i], 1.0 / h[i]
        right[i] = 3.0 * (differences[i - 1] / h[i - 1] + differences[i] / h[i])
    for end, beside, chord in ((0, 1, 0), (n - 1, n - 2, n - 2)):
        left[end, end] = 1.0 if flat[end > 0] else 2.0
        if not flat[end > 0]:
            left[end, beside] = 1.0
            right[end] = 3.0 * differences[chord]
    slopes = np.linalg.solve(left, right)
    piece = np.clip(np.searchsorted(knots, x, side="right") - 1, 0, n - 2)
    s = np.clip((x - knots[piece]) / h[piece], 0.0, 1.0)[:, None]
    values, size = np.eye(n), h[piece][:, None]
    result = ((1 + 2 * s) * (1 - s) ** 2 * values[piece] + s**2 * (3 - 2 * s) * values[piece + 1]
              + size * s * (1 - s) ** 2 * slopes[piece] + size * s**2 * (s - 1) * slopes[piece + 1])
    beyond = np.minimum(x - knots[0], 0.0)[:, None], np.maximum(x - knots[-1], 0.0)[:, None]
    return result + beyond[0] * slopes[0] + beyond[1] * slopes[-1]


def within(ascending, edges, open_ends=False):
    """Slices of ascending values between neighbouring edges, with those at the edges or, with open ends, without."""
    first, last = (np.searchsorted(ascending, edges, side=side) for side in ("left", "right"))
    starts, stops = (last[:-1], first[1:]) if open_ends else (first[:-1], last[1:])
    return [slice(int(start), max(int(start), int(stop))) for start, stop in zip(starts, stops)]


class Motion:
    """A run over time; ValueError if the file has no deflections of a bridge over time."""

    def __init__(self, results):
        if results.rows < 2 or "probes/deflection" not in results.file or not len(results.probes):
            what = next((name for name in ("sweep", "study") if name in results.file), "")
            why = f": it is that of a {what}; run one of its cases alone" if what else ""
            raise ValueError(f"holds no deflections of a bridge over time{why}")
        self.results, self.model, self.time = results, Model(results), results.time
        self.tracks = results.probes_of_tracks()
        self.stations = np.asarray(results.probes, dtype=float)[next(iter(self.tracks.values()))]
        deflections = results.over_time(results.file["probes/deflection"])
        self.at_tracks = [deflections[:, own] for own in self.tracks.values()]  # each track has the same stations
        self.at_stations = self.at_tracks[0]
        ends = self.model.span_ends if len(self.model.span_ends) else self.stations
        self.low, self.high = float(ends[0]), float(ends[-1])
        points = int(np.clip(POINTS * (len(ends) - 1), FEWEST_POINTS, MOST_POINTS))
        self.x = np.unique(np.concatenate([np.linspace(self.low, self.high, points), ends, self.stations]))
        self.settled = np.zeros(len(self.x))  # m, displacement of the line due to settlements
        self.matrix = self.between_stations()
        self.at_start = np.nan_to_num(self.deflection(0))
        self.bodies = [self.body(k, name, results.over_time(vehicle[name]["position"]))
                       for k, vehicle in enumerate(results.vehicles) for name in vehicle if "position" in vehicle[name]]

    def body(self, vehicle, name, position):
        on_bridge = self.low <= position[0, 0] <= self.high
        sunk = np.interp(position[0, 0], self.x, self.at_start) if on_bridge else 0.0
        return Body(vehicle, name, position, float(position[0, 1] - sunk))

    def between_stations(self):
        """[points, stations]: cubic splines through stations and supports, one between two joints; NaN in a span
        without a station."""
        ends, kinds = self.model.span_ends, self.model.supports
        held = np.array([i for i, (kind, _) in enumerate(kinds) if kind in HOLDS_HEIGHT], dtype=int)
        flat = [x for x, (kind, _) in zip(ends, kinds) if kind in HOLDS_SLOPE]
        breaks = [x for x, (_, joint) in zip(ends, kinds) if joint in ("hinge", "separate")]
        cuts = np.unique(np.concatenate([[self.low, self.high], breaks, self.model.hinges, self.model.cracks]))
        matrix = np.zeros((len(self.x), len(self.stations)))
        order = np.argsort(self.stations, kind="stable")
        pieces = zip(within(self.x, cuts), within(self.stations[order], cuts), within(ends[held], cuts))
        for inside, own, fixed in pieces:
            own, fixed = order[own], held[fixed]
            fixed = fixed[[not np.any(np.abs(self.stations[own] - x) < 1e-9) for x in ends[fixed]]]
            if len(own) or np.any(self.model.settlement[fixed]):
                matrix[inside] = 0.0  # the joint to the piece before
                knots = np.concatenate([self.stations[own], ends[fixed]])
                ascending = np.argsort(knots)
                clamped = [np.any(np.isclose(flat, knots[ascending][end])) for end in (0, -1)]
                piece = np.empty((inside.stop - inside.start, len(knots)))
                piece[:, ascending] = spline_matrix(knots[ascending], self.x[inside], clamped)
                matrix[inside, own] = piece[:, :len(own)]
                self.settled[inside] = piece[:, len(own):] @ self.model.settlement[fixed]
        free = np.sort(self.stations[~np.isin(self.stations, ends[held])])
        for edges in (ends, cuts):
            for inside, stations in zip(within(self.x, edges, open_ends=True), within(free, edges)):
                if stations.start == stations.stop:
                    matrix[inside] = np.nan
        return matrix

    def deflection(self, row, track=0):
        """The deflection of a track at self.x, m upward; NaN if unknown."""
        return self.matrix @ self.at_tracks[track][row] + self.settled

    def greatest(self):
        """The greatest deflection at a station, m."""
        return max(np.abs(values).max() for values in self.at_tracks)

    def in_words(self):
        said = [t("between the {count} stations and the supports: cubic splines", count=len(self.stations))
                if len(self.stations) > 1 else t("between the one station and the supports: a cubic spline")]
        if len(self.tracks) > 1:
            first, *others = (f"{num(e, '+.4g')} m" for e in self.tracks)
            said.append(t("thick: the track at {first}, thin: {others}", first=first, others=", ".join(others)))
        return t("; ").join(said + [t("spans without a station are not drawn")] * bool(np.isnan(self.matrix).any()))

    def forces(self, row):
        """[f, 2]: positions of the moving forces and the forces, m and N."""
        return self.model.forces_at(self.time[row], self.results.options)

    def sway(self):
        """The greatest vertical displacement of a body while it is on the bridge, m."""
        on_bridge = [(body, (body.position[:, 0] >= self.low) & (body.position[:, 0] <= self.high))
                     for body in self.bodies]
        return max((np.abs(body.position[rows, 1] - body.height).max(initial=0.0) for body, rows in on_bridge),
                   default=0.0)


class Shape(NamedTuple):
    """The centre of a wheel with its radius, the corners of a body, or the ends of a rod or rope."""
    points: np.ndarray  # [k, 2], m
    radius: float = 0.0


def outline(motion, row, factor):
    """Wheels and bodies of all vehicles at a sample, with vertical displacements and angles times the factor."""
    shapes, model = [], motion.model
    for vehicle, (kind, _) in enumerate(model.train[:len(motion.results.vehicles)]):
        bodies = {body.name: body for body in motion.bodies if body.vehicle == vehicle}
        names, centres = model.body_names(kind), model.rows(kind, "bodies", 3)[:, :2]

        def moved(body, points):
            x, y, angle = bodies[names[body]].position[row]
            sway = y - bodies[names[body]].height
            across = np.asarray(points) - centres[body]
            return np.column_stack([x + across[:, 0],
                                    centres[body, 1] + factor * (sway + angle * across[:, 0]) + across[:, 1]])

        for body, (left, low, width, height) in body_boxes(model, kind).items():
            corners = [(left, low), (left + width, low), (left + width, low + height), (left, low + height)]
            shapes.append(Shape(moved(body, corners)))
        for *ends, first, second in rods(model, kind):
            shapes.append(Shape(np.vstack([moved(int(body), [at]) if body >= 0 else [at] for body, at in
                                           ((first, ends[:2]), (second, ends[2:]))])))
        for x, y, radius in model.rows(kind, "wheels", 3):
            shapes.append(Shape(moved(nearest(centres, (x, y)), [(x, y)]), radius))
    return shapes


def nearest(centres, point):
    return int(np.argmin(np.hypot(*(centres - point).T)))


def wheel_places(motion, rows):
    """Yields x of every wheel and moving force at the samples, m."""
    model = motion.model
    for vehicle, (kind, _) in enumerate(model.train[:len(motion.results.vehicles)]):
        names, centres = model.body_names(kind), model.rows(kind, "bodies", 3)[:, :2]
        for x, y, _ in model.rows(kind, "wheels", 3):
            body = nearest(centres, (x, y))
            position = motion.results.vehicles[vehicle][names[body]]["position"]
            yield motion.results.over_time(position)[rows, 0] + x - centres[body, 0]
    forces = np.array([motion.forces(row)[:, 0] for row in rows])
    yield from forces.T
