"""Modes of a finite element model along tracks, as a file of given modes (doc/guide/given_modes.md).

The deflection is that of the nodes on the line of a track. Where too few are on it, it is interpolated between the
nodes beside it, by cubic polynomials on triangles with continuous slopes (matplotlib.tri), never outside of them.
"""

import re
from typing import NamedTuple

import numpy as np
from convert_lines import LARGEST_VALUE
from input_files import InputError

AXES = "xyz"
FEWEST, MOST = 5, 2000  # stations of a track
# In lengths of a track: distances of the nodes that are used, to the side and in height, of which the first that
# suffices counts; the distance of nodes that are on it; how far its ends may be outside of the nodes, by rounding.
NEIGHBOURHOODS, ON_THE_LINE, ENDS = (0.05, 0.1, 0.2), 1e-4, 2e-4
WIDEST = 2.5  # gap between two nodes on the line, in distances between neighbouring nodes
ENOUGH = 8    # stations in a half wave
# Powers of force and length in the units of outputs, and the units of the components that have only one.
UNITS = {"Pa": (1, -2), "N": (1, 0), "N m": (1, 1), "N/m": (1, -1), "N m/m": (1, 0), "m": (0, 1)}
SHELL = {**dict.fromkeys(("FX", "FY", "FXY", "QX", "QY"), "N/m"), **dict.fromkeys(("MX", "MY", "MXY"), "N m/m")}
BAR = {**dict.fromkeys(("M1A", "M2A", "M1B", "M2B", "TRQ"), "N m"), **dict.fromkeys(("V1", "V2", "AF"), "N")}
SECTION = {**dict.fromkeys(("FX", "FY", "FZ"), "N"), **dict.fromkeys(("MX", "MY", "MZ"), "N m")}
KNOWN = {"QUAD4": SHELL, "TRIA3": SHELL, "BAR": BAR, "SECTION": SECTION, "DISP": dict.fromkeys(AXES, "m")}


class Field(NamedTuple):
    """Results of a mode: DISP at nodes, others at nodes, elements or sections."""
    components: list
    ids: np.ndarray     # numbers, or names of sections
    values: np.ndarray  # [number, component]


class Mode(NamedTuple):
    number: int
    frequency: float  # Hz
    mass: float       # of the model's unit, for these shapes; None: not given
    ratio: float      # of damping; None: not given
    place: str        # file and row
    fields: dict      # {name: Field}


class Model(NamedTuple):
    """Nodes with displacements; lengths and masses in units of the model."""
    ids: np.ndarray
    points: np.ndarray  # [node, axis]
    modes: list
    shapes: np.ndarray  # [node, axis, mode]
    length: float       # m in a unit of the model
    mass: float         # kg in a unit of the model


class Track(NamedTuple):
    x: np.ndarray       # in the model's unit, from the first point
    shapes: np.ndarray  # [station, mode]
    words: str          # about its nodes


def places_of(ids, wanted):
    """The places of numbers that occur once in a list."""
    order = np.argsort(ids)
    return order[np.searchsorted(ids, wanted, sorter=order)]


def model_of(ids, points, modes, length, mass):
    """The model of nodes and modes; InputError where they do not belong together."""
    for one in modes:
        shape = one.fields.get("DISP")
        if shape is None or len(shape.components) < 3:
            raise InputError(f"{one.place}: mode {one.number} has no displacements along x, y and z")
        if not one.frequency > 0.0:
            raise InputError(f"{one.place}: mode {one.number} has {one.frequency:g} Hz, a motion of the whole body; "
                             "leave it out by --modes, or support the model")
        of = np.sort(shape.ids)
        if one is modes[0]:
            known = of
        elif not np.array_equal(of, known):
            raise InputError(f"{one.place}: mode {one.number} has {len(of)} nodes, other ones than the {len(known)} of mode "
                             f"{modes[0].number}: the file is cut off, or not of one model")
    if np.any(np.diff(known) == 0) or np.any(np.diff(np.sort(ids)) == 0):
        raise InputError(f"{modes[0].place}: a node is in the file twice")
    if len(without := np.setdiff1d(known, ids)):
        raise InputError(f"{modes[0].place}: {len(without)} nodes have displacements but no coordinates, such as {without[0]}")
    shapes = [one.fields["DISP"].values[places_of(one.fields["DISP"].ids, known), :3] for one in modes]
    return Model(known, points[places_of(ids, known)], modes, np.stack(shapes, axis=2), length, mass)


def point_of(word, model):
    """A point of a track: x,y,z or the number of a node."""
    if word.isdecimal():
        at = np.flatnonzero(model.ids.astype(str) == word)
        if not len(at):
            raise InputError(f"--track {word}: there is no node {word} with displacements")
        return model.points[at[0]]
    try:
        point = np.array([float(one) for one in word.split(",")])
    except ValueError:
        point = np.empty(0)
    if point.shape != (3,) or not np.all(np.abs(point) < LARGEST_VALUE):
        raise InputError(f"--track {word}: allowed: points x,y,z in the unit of the model, and numbers of nodes")
    return point


def on_polyline(corners, points):
    """(arc lengths, distances) of points beside a polyline in a plane."""
    best = np.full(len(points), np.inf)
    arc, start = np.zeros(len(points)), 0.0
    for first, last in zip(corners[:-1], corners[1:]):
        length = np.linalg.norm(last - first)
        along = np.clip((points - first) @ (last - first) / length, 0.0, length)
        distance = np.linalg.norm(points - first - np.outer(along / length, last - first), axis=1)
        nearer = distance < best
        best[nearer], arc[nearer] = distance[nearer], start + along[nearer]
        start += length
    return arc, best


def neighbours(model, corners, up, within):
    """The nodes near a track: (groups of nodes at one place in plan, their arc lengths, distances and places).
    Of nodes above each other, the nearest in height count."""
    plan = [axis for axis in range(3) if axis != up]
    arc, side = on_polyline(corners[:, plan], model.points[:, plan])
    ends = np.linalg.norm(np.diff(corners[:, plan], axis=0), axis=1).cumsum()
    height = np.abs(model.points[:, up] - np.interp(arc, [0.0, *ends], corners[:, up]))
    step, groups = ON_THE_LINE * ends[-1], {}
    for i in np.flatnonzero((side <= within) & (height <= within)):
        x, y = np.round(model.points[i, plan] / step).astype(np.int64)
        beside = [(x + a, y + b) for a in (0, -1, 1) for b in (0, -1, 1)]
        groups.setdefault(next((one for one in beside if one in groups), (x, y)), []).append(i)
    nearest = [[i for i in group if height[i] <= min(height[group]) + step] for group in groups.values()]
    firsts = np.array([group[0] for group in nearest], dtype=int)
    return nearest, arc[firsts], side[firsts], model.points[firsts][:, plan]


def track_of(words, model, up, within=None, supported=False):
    """The shapes along a track. words: its points; up: (axis, sign); supported: the shapes are 0 at both ends."""
    corners = np.array([point_of(word, model) for word in words])
    lengths = np.linalg.norm(np.diff(np.delete(corners, up[0], axis=1), axis=0), axis=1)
    name = f"track {' '.join(words[:2])}{' ...' if len(words) > 2 else ''}"
    if len(corners) < 2 or not np.all(lengths > 0.0):
        raise InputError(f"{name}: allowed: at least two points, one after the other along the track")
    for part in NEIGHBOURHOODS if within is None else (within / lengths.sum(),):
        try:
            return track_within(name, corners, model, up, part * lengths.sum(), lengths.sum(), supported)
        except InputError as error:
            last = error
    raise last


def track_within(name, corners, model, up, within, length, supported):
    """The shapes along a track by the nodes within a distance of it."""
    (axis, sign), step = up, ON_THE_LINE * length
    groups, arc, side, points = neighbours(model, corners, axis, within)
    if len(groups) < FEWEST - (2 if supported else 0):
        raise InputError(f"{name}: {len(groups)} nodes within {within:g} of it; allowed: at least {FEWEST}, see --within. "
                         f"The nodes are in {box_of(model)}")
    deflection = sign * np.array([model.shapes[group, axis].mean(axis=0) for group in groups])
    on = np.flatnonzero(side <= step)
    on = on[np.argsort(arc[on])]
    on = on[np.diff(arc[on], prepend=-1.0 - step) > step]
    x, shapes = arc[on], deflection[on]
    if supported:
        inner = (x > step) & (x < length - step)
        x, shapes = np.r_[0.0, x[inner], length], np.pad(shapes[inner], ((1, 1), (0, 0)))
    if len(x) >= FEWEST and x[0] <= step and x[-1] >= length - step:
        if len(on) == len(groups) or np.diff(x).max() <= WIDEST * spacing(points):
            x[0], x[-1] = 0.0, length
            return Track(x, shapes, f"{len(on)} nodes on it" + (", its ends at rest" if supported else ""))
    if len(on) == len(groups):
        raise InputError(f"{name}: {len(on)} nodes on it, from {arc[on].min():g} to {arc[on].max():g} of {length:g}; allowed: "
                         f"at least {FEWEST}, also at its ends; name another track, or --supported-ends")
    return between(name, corners, axis, points, deflection, within, spacing(points))


def spacing(points):
    """The median distance between neighbouring nodes."""
    order = points[np.lexsort(points.T)]
    nearest = [np.sort(np.linalg.norm(order - one, axis=1))[1] for one in order[::max(1, len(order) // 200)]]
    return float(np.median(nearest))


def between(name, corners, axis, points, deflection, within, step):
    """The shapes at even stations, interpolated on triangles between the nodes."""
    import matplotlib.tri
    plan = np.delete(corners, axis, axis=1)
    places = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(plan, axis=0), axis=1))])
    x = np.linspace(0.0, places[-1], int(np.clip(np.ceil(2.0 * places[-1] / step), FEWEST, MOST)) + 1)
    centre, scale = points.mean(axis=0), places[-1]
    try:
        triangles = matplotlib.tri.Triangulation(*((points - centre) / scale).T)
        surfaces = [matplotlib.tri.CubicTriInterpolator(triangles, one, kind="geom") for one in deflection.T]
    except (RuntimeError, ValueError, np.linalg.LinAlgError):
        raise InputError(f"{name}: the nodes beside it are all on one line; name a track on nodes") from None
    for ends in (1e-9, ENDS):
        inside = np.clip(x, ends * x[-1], (1.0 - ends) * x[-1])
        stations = np.column_stack([np.interp(inside, places, plan[:, i]) for i in (0, 1)])
        shapes = np.column_stack([np.ma.filled(one(*((stations - centre) / scale).T), np.nan) for one in surfaces])
        if np.all(np.isfinite(shapes)):
            break
    distance = np.array([np.linalg.norm(points - one, axis=1).min() for one in stations])
    outside = np.flatnonzero(~np.all(np.isfinite(shapes), axis=1) | (distance > within))
    if len(outside):
        raise InputError(f"{name}: at {x[outside[0]]:g} of {x[-1]:g} it leaves the nodes within {within:g} of it; shorten it, "
                         "move it, or see --within: shapes are not continued beyond nodes")
    return Track(x, shapes, f"{len(x)} stations between {len(points)} nodes, the nearest at most {distance.max():.3g} away")


def box_of(model):
    return ", ".join(f"{axis} {model.points[:, i].min():g} to {model.points[:, i].max():g}" for i, axis in enumerate(AXES))


def output_of(text, model):
    """(name, unit, values of the modes for a deflection coordinate of 1 m) of NAME=FIELD:COMPONENT@NUMBER[:UNIT];
    a minus before FIELD reverses the sign"""
    found = re.fullmatch(r"([A-Za-z0-9_-]+)=(-?)(\w+):(\w+)@([^:]+)(?::(.+))?", text)
    if not found:
        raise InputError(f"--output {text}: allowed: NAME=FIELD:COMPONENT@NUMBER, such as sag=DISP:z@12, and then :UNIT")
    name, minus, field, component, number, unit = found.groups()
    values = []
    for one in model.modes:
        if field not in one.fields:
            raise InputError(f"--output {text}: mode {one.number} has {', '.join(one.fields)}")
        results = one.fields[field]
        at = np.flatnonzero(results.ids.astype(str) == number)
        if component not in results.components or not len(at):
            raise InputError(f"--output {text}: {field} of mode {one.number} has {', '.join(results.components)} at "
                             f"{len(results.ids)} places: {', '.join(map(str, results.ids[:5]))}, ...")
        values.append(results.values[at[0], results.components.index(component)])
    unit = unit or KNOWN.get(field, {}).get(component, "Pa" if field == "STRESS" else "")
    if unit not in UNITS:
        raise InputError(f"--output {text}: add its unit, {', '.join(f':{one}' for one in UNITS)}")
    force, length = UNITS[unit]
    factor = (model.mass * model.length) ** force * model.length ** (length - 1)
    return name, unit, [(-factor if minus else factor) * value for value in values]


def text_of(model, tracks, ratios, masses, outputs, about):
    """The file of given modes."""
    def row(*cells):
        return ", ".join(one if isinstance(one, str) else f"{one:.9g}" for one in cells)

    lines = [*(f"# {one}" for one in about), row("frequency", *(one.frequency for one in model.modes)),
             row("modal_mass", *masses), row("damping_ratio", *ratios)]
    lines += [row("output", name, unit, *values) for name, unit, values in outputs]
    for i, track in enumerate(tracks, 1):
        lines.append(f"track, {i}")
        lines += [row(x, *shapes) for x, shapes in zip(model.length * track.x, track.shapes)]
    return "\n".join(lines) + "\n"


def half_waves(shape, largest):
    """The half waves of a shape, by the signs of what exceeds a hundredth of its largest value; 0 if it hardly deflects."""
    if np.abs(shape).max() < 1e-3 * largest:
        return 0
    signs = np.sign(shape[np.abs(shape) > 0.01 * np.abs(shape).max()])
    return 1 + int(np.count_nonzero(np.diff(signs)))
