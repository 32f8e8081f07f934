"""The parts of vehicles and mechanisms for the drawing: outlines of bodies, wheels, rods, ropes, springs, pins."""

import functools

import numpy as np
from picture_data import spring_names
from picture_model import body_boxes, rods
from picture_motion import nearest

SMALL = 0.5        # m: smaller bodies are drawn through their points, as body_boxes draws none lower than this
FREE_SWAY, FREE_TURN = 0.2, 0.1  # m, rad: bodies that move more are drawn to scale


@functools.cache
def numbers(model, kind):
    """{name: number} of the bodies of a vehicle type."""
    return {name: i for i, name in enumerate(model.body_names(kind))}


@functools.cache
def attached(model, kind):
    """For each body its centre and the points of its springs, joints and wheels."""
    points = [[(x, y)] for x, y, _ in model.rows(kind, "bodies", 3)]
    for x1, y1, x2, y2, first, second in [*model.rows(kind, "springs", 6), *model.falls(kind)[0],
                                          *model.joint_ends(kind)]:
        for body, at in ((int(first), (x1, y1)), (int(second), (x2, y2))):
            if body >= 0 and min(np.hypot(*(np.array(points[body]) - at).T)) > 1e-9:
                points[body].append(at)
    return [np.array(of_body) for of_body in points]


def turn(a, b, c):
    """Positive if the way from a by b to c turns counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


def hull(points):
    """The corners of the convex hull, counter-clockwise."""
    points = sorted(map(tuple, points))
    if len(points) < 3:
        return points
    sides = []
    for order in (points, points[::-1]):
        side = []
        for point in order:
            while len(side) > 1 and turn(side[-2], side[-1], point) <= 0.0:
                side.pop()
            side.append(point)
        sides += side[:-1]
    return sides


def outlines(model, kind, on_bridge):
    """{body: corners}: boxes of vehicles on a bridge; otherwise, and of small bodies, the hull of attached points."""
    points, boxes = attached(model, kind), body_boxes(model, kind)
    found = {}
    for body, at in enumerate(points):
        size = np.ptp(at, axis=0).max()
        if body in boxes and (size == 0.0 or size >= SMALL) and on_bridge:
            left, low, width, height = boxes[body]
            found[body] = [(left, low), (left + width, low), (left + width, low + height), (left, low + height)]
        elif body in boxes:
            found[body] = hull(at)
    return found


@functools.cache
def parts_of(results, model, kind, on_bridge):
    """All parts of a vehicle type. Points are [body, x, y] from the centre of the body; those of the ground,
    body -1, from the origin of the vehicle."""
    centres = model.rows(kind, "bodies", 3)[:, :2]

    def point(body, x, y):
        body = int(body)
        centre = centres[body] if body >= 0 else (0.0, 0.0)
        return [body, round(float(x - centre[0]), 5), round(float(y - centre[1]), 5)]

    parts = [{"is": "body", "points": [point(body, *corner) for corner in corners]}
             for body, corners in outlines(model, kind, on_bridge).items()]
    for x1, y1, x2, y2, first, second in rods(model, kind):
        parts.append({"is": "rod", "points": [point(first, x1, y1), point(second, x2, y2)]})
    names, of_type = spring_names(results, model, kind), f"vehicle_{model.type_name(kind)}"
    for i, (x1, y1, x2, y2, first, second) in enumerate(model.rows(kind, "springs", 6)):
        rope = len(names) > i and results.options.get(f"{of_type}_{names[i]}_side") == "tension"
        parts.append({"is": "rope" if rope else "spring", "points": [point(first, x1, y1), point(second, x2, y2)]})
    for x1, y1, x2, y2, first, second in model.falls(kind)[0]:
        parts.append({"is": "rope", "points": [point(first, x1, y1), point(second, x2, y2)]})
    for (x, y, *_, first, second), (_, joint) in zip(model.joint_ends(kind), model.joint_names(kind)):
        if joint == "revolute":
            parts.append({"is": "pin", "ground": bool(min(first, second) < 0),
                          "points": [point(max(first, second), x, y)]})
    for x, y, radius in model.rows(kind, "wheels", 3):
        parts.append({"is": "wheel", "radius": float(radius), "points": [point(nearest(centres, (x, y)), x, y)]})
    return parts


def is_free(position):
    """Whether a body moves too much to be drawn with exaggerated displacements."""
    return bool(np.ptp(position[:, 1]) > FREE_SWAY or np.ptp(position[:, 2]) > FREE_TURN)
