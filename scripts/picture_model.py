"""The model from /model of a results file, and its symbols: supports, springs, hinges, vehicles, forces."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyBboxPatch
from matplotlib.transforms import ScaledTranslation

from picture_data import speed_of

DARK, GREY, BODY, FORCE = "#333333", "#666666", "#C9D8E3", "#B03A00"
CONCRETE = 2400.0  # kg/m3
MOST_SYMBOLS = 80  # of one kind
GAP = -8.0  # points, top of a spring that the beam reaches only when a gap has closed
MARKERS = {"pinned": "^", "roller": "o", "clamped": "s", "guided": "D"}
WORDS = {"pinned": "pinned", "roller": "roller", "clamped": "clamped", "guided": "guided: moves vertically",
         "vertical": "spring", "gap": "spring below a gap", "longitudinal": "spring along the track",
         "rotational": "spring against rotation",
         "hinge": "hinge", "crack": "crack, a rotational spring", "separate": "joint of separate spans"}


def way_gone(times, speeds, end):
    """The distance since t = 0, m: speeds are linear between the times, and constant outside."""
    inside = times[(times > min(0.0, end)) & (times < max(0.0, end))]
    at = np.concatenate([[0.0], inside, [end]])
    return float(np.trapezoid(np.interp(at, times, speeds), at) if hasattr(np, "trapezoid")
                 else np.trapz(np.interp(at, times, speeds), at))


class Model:
    """The data of /model; in a file without it, the supports from the options."""

    def __init__(self, results):
        file = results.file
        self.group = file["model"] if "model" in file else {}
        self.span_ends = np.zeros(0) if results.supports is None else np.asarray(results.supports, dtype=float)
        kinds = results.support_types() if results.supports is not None else []
        self.supports = [(kind, "") for kind in (kinds if len(kinds) == len(self.span_ends) else [])]
        if "supports" in self.group:
            self.supports = [tuple(row) for row in self.group["supports"].asstr()[:]]
        if not len(self.span_ends) and "spans" in self.group:
            self.span_ends = np.concatenate([[0.0], np.cumsum(self.group["spans"][:])])
        self.hinges, self.cracks = self.array("hinges"), self.array("cracks", 2)[:, 0]
        settled = self.array("settlement")
        self.settlement = settled if len(settled) else np.zeros(len(self.span_ends))
        self.notes = [row[1] for row in self.group["notes"].asstr()[:]] if "notes" in self.group else []
        self.foundation = {kind: data[:] for kind, data in self.group.get("foundation", {}).items()}
        self.train = self.array("train", 2)
        self.trains, self.loads = self.array("trains", 4), self.array("loads", 4)
        forces = self.group.get("forces", {})
        self.forces = {name: forces[name][:] for name in sorted(forces, key=lambda name: (len(name), name))}

    def array(self, name, columns=1):
        empty = np.zeros((0, columns) if columns > 1 else 0)
        return self.group[name][:] if name in self.group else empty

    def rows(self, index, name, columns):
        """A dataset of the vehicle type with this index."""
        group = self.group[f"vehicles/{int(index)}"]
        return group[name][:] if name in group else np.zeros((0, columns))

    def joint_ends(self, index):
        """[j, 6]: x, y of each joint on its first and its second body, and the two bodies (-1: the ground)."""
        at = self.rows(index, "joints", 4)
        ends = self.rows(index, "joint_ends", 4)
        return np.column_stack([ends if len(ends) else at[:, [0, 1, 0, 1]], at[:, 2:]])

    def falls(self, index):
        """[r, 6]: the straight parts of all ropes over several points, as the rows of springs; and [r], the numbers
        of their ropes."""
        rope, x, y, body = self.rows(index, "ropes", 4).T
        inside = rope[1:] == rope[:-1]
        rows = np.column_stack([x[:-1], y[:-1], x[1:], y[1:], body[:-1], body[1:]])
        return rows[inside], rope[1:][inside].astype(int)

    def joint_names(self, index):
        """(name, type) of each joint, if the file contains them."""
        group = self.group[f"vehicles/{int(index)}"]
        return [tuple(row) for row in group["joint_names"].asstr()[:]] if "joint_names" in group else []

    def type_name(self, index):
        return str(self.group[f"vehicles/{int(index)}/names"].asstr()[0, 0])

    def body_names(self, index):
        return list(self.group[f"vehicles/{int(index)}/names"].asstr()[:, 1])

    def forces_at(self, time, options):
        """[f, 2]: positions of the moving forces at this time, m, and their magnitudes, N."""
        forces = self.forces.get("load", np.zeros((0, 2)))
        speed = speed_of(options.get("load_speed", 0.0)) if len(forces) and not len(self.loads) else 0.0
        way = np.full(len(forces), time * speed)
        for number in np.unique(self.loads[:, 0]):
            rows = self.loads[self.loads[:, 0] == number]
            way[int(rows[0, 1]):] = way_gone(rows[:, 2], rows[:, 3], time)
        return np.column_stack([forces[:, 0] + way, forces[:, 1]])

    def length(self):
        return float(self.span_ends[-1] - self.span_ends[0]) if len(self.span_ends) else 0.0


def draw_points(ax, at, points, width=1.0, colour=DARK):
    """Draws a line through points in 1/72 inch from the position `at` of the axes."""
    dx, dy = np.asarray(points, dtype=float).T / 72.0
    place = ax.figure.dpi_scale_trans + ScaledTranslation(*at, ax.transData)
    ax.add_line(Line2D(dx, dy, color=colour, lw=width, transform=place, clip_on=False, zorder=5))


def draw_spring(ax, x, kind, low=-2.0):
    """Draws a foundation point at x: a vertical or horizontal spring, or a coil."""
    t = np.linspace(0.0, 1.0, 11)
    side = 3.2 * np.array([0, 0, 1, -1, 1, -1, 1, -1, 1, 0, 0])
    if kind == "vertical":
        draw_points(ax, (x, 0.0), np.stack([side, low - 15.0 * t], axis=1))
        draw_points(ax, (x, 0.0), [(-5.5, low - 15.0), (5.5, low - 15.0)], 1.8)
    elif kind == "longitudinal":
        draw_points(ax, (x, 0.0), np.stack([4.0 + 15.0 * t, low - 5.0 + side], axis=1))
        draw_points(ax, (x, 0.0), [(19.0, low - 10.0), (19.0, low)], 1.8)
    else:
        angle = np.linspace(0.5 * np.pi, 4.5 * np.pi, 60)
        radius = np.linspace(1.5, 6.0, 60)
        coil = np.stack([radius * np.cos(angle), low - 7.0 + radius * np.sin(angle)], axis=1)
        draw_points(ax, (x, 0.0), coil)


def draw_foundation(ax, model, low, high):
    """Draws points as springs and beds as rows of springs; returns the drawn kinds."""
    drawn = set()
    for kind, data in model.foundation.items():
        base = kind.replace("_bed", "")
        places = np.linspace(low, high, 32)[1:-1] if kind.endswith("_bed") else np.unique(data[:, 0])
        places = places[(places >= low) & (places <= high)]
        if len(places) > MOST_SYMBOLS:
            places = places[np.linspace(0, len(places) - 1, MOST_SYMBOLS).round().astype(int)]
        open_below = {x for x, _, _, gap, *_ in data if gap > 0.0} if kind == "vertical" else set()
        for x in places:
            draw_spring(ax, x, base, -2.0 if x not in open_below else GAP)
            if x in open_below:
                draw_points(ax, (x, 0.0), [(-5.5, GAP), (5.5, GAP)], 1.8, FORCE)
            drawn.add("gap" if x in open_below else base)
    return drawn


def draw_supports(ax, model, low, high):
    """Draws the usual symbols of supports below the line; returns the drawn kinds."""
    drawn = set()
    place = ax.transData + ScaledTranslation(0, -6.5 / 72, ax.figure.dpi_scale_trans)
    for i, (x, (kind, joint)) in enumerate(zip(model.span_ends, model.supports)):
        if not low <= x <= high:
            continue
        if kind in MARKERS:
            ax.plot([x], [0.0], MARKERS[kind], ms=11, color="white", mec=DARK, mew=1.4, transform=place, clip_on=False,
                    zorder=6)
            drawn.add(kind)
        if joint in ("hinge", "separate"):
            draw_hinge(ax, x, joint)
            drawn.add(joint)
    for kind, places in (("hinge", model.hinges), ("crack", model.cracks)):
        for x in places[(places >= low) & (places <= high)]:
            draw_hinge(ax, x, kind)
            drawn.add(kind)
    return drawn


def draw_hinge(ax, x, joint):
    if joint == "hinge":
        ax.plot([x], [0.0], "o", ms=6.5, color="white", mec=DARK, mew=1.3, zorder=7, clip_on=False)
    elif joint == "crack":
        draw_points(ax, (x, 0.0), [(-1.5, -5.0), (1.5, -1.5), (-1.5, 1.5), (1.5, 5.0)], 1.2)
    else:
        draw_points(ax, (x, 0.0), [(-1.3, -4.0), (-1.3, 7.0)], 1.0)
        draw_points(ax, (x, 0.0), [(1.3, -4.0), (1.3, 7.0)], 1.0)


def symbols_in_words(kinds):
    """The drawn kinds as text: '△ pinned    ○ roller    spring'."""
    shapes = {"pinned": "△ ", "roller": "○ ", "clamped": "□ ", "guided": "◇ ", "hinge": "∘ ", "crack": "≀ ",
              "separate": "‖ "}
    return "    ".join(shapes.get(kind, "") + WORDS[kind] for kind in WORDS if kind in kinds)


def body_boxes(model, index):
    """{body: (x, y, width, height)} of the drawn box of every body except axles: the hull of its centre and of its ends
    of springs and joints. Bodies without a height are 0.5 m high. A body without any extent is a cube of its mass with
    the density of concrete."""
    bodies, wheels = model.rows(index, "bodies", 3), model.rows(index, "wheels", 3)
    points = [[(x, y)] for x, y, _ in bodies]
    for x1, y1, x2, y2, first, second in [*model.rows(index, "springs", 6), *model.falls(index)[0],
                                          *model.joint_ends(index)]:
        for body, at in ((first, (x1, y1)), (second, (x2, y2))):
            if body >= 0:
                points[int(body)].append(at)
    hulls = {}
    for body, (centre, hull) in enumerate(zip(bodies, points)):
        if len(wheels) and np.any(np.hypot(*(wheels[:, :2] - centre[:2]).T) < 1e-6):
            continue  # an axle, drawn as a wheel
        hull = np.array(hull)
        hulls[body] = (hull.min(axis=0), hull.max(axis=0))
    highest = max((high[1] for _, high in hulls.values()), default=0.0)
    boxes = {}
    for body, (low, high) in hulls.items():
        width, height = high - low
        if max(width, height) < 1e-6:
            side = max((bodies[body, 2] / CONCRETE) ** (1.0 / 3.0), 0.5)
            boxes[body] = (low[0] - 0.5 * side, low[1] - 0.5 * side, side, side)
            continue
        car = high[1] >= highest - 1e-9 and width > 3.0
        spare = 0.10 * width if car else 0.25
        boxes[body] = (low[0] - spare, low[1], width + 2.0 * spare, max(height, 0.5) + (1.6 if car else 0.0))
    return boxes


def rods(model, index):
    """[r, 6]: joints with a distance between their ends."""
    ends = model.joint_ends(index)
    return ends[np.hypot(ends[:, 2] - ends[:, 0], ends[:, 3] - ends[:, 1]) > 1e-6]


def vertical_reach(model, index):
    """(lowest, highest) point of a drawn vehicle, m."""
    boxes, wheels = body_boxes(model, index).values(), model.rows(index, "wheels", 3)
    return (min([low for _, low, _, _ in boxes] + list(wheels[:, 1] - wheels[:, 2]), default=0.0),
            max([low + height for _, low, _, height in boxes] + list(wheels[:, 1] + wheels[:, 2]), default=0.0))


def draw_vehicle(ax, model, index, x, springs=False):
    """Draws a vehicle in the scale of the axes, with its origin at x."""
    for x1, y1, x2, y2, _, _ in [*rods(model, index), *model.falls(index)[0]]:
        ax.plot([x + x1, x + x2], [y1, y2], color=DARK, lw=1.0, zorder=2.5)
    for left, low, width, height in body_boxes(model, index).values():
        ax.add_patch(FancyBboxPatch((x + left, low), width, height, fc=BODY, ec=DARK, lw=0.6,
                                    boxstyle="round,pad=0,rounding_size=0.12", zorder=3))
    for wheel_x, wheel_y, radius in model.rows(index, "wheels", 3):
        ax.add_patch(Circle((x + wheel_x, wheel_y), radius, fc="white", ec=DARK, lw=0.8, zorder=4))
    if springs:
        for x1, y1, x2, y2, _, _ in model.rows(index, "springs", 6):
            t = np.linspace(0.0, 1.0, 11)
            side = 0.12 * np.array([0, 0, 1, -1, 1, -1, 1, -1, 1, 0, 0])
            ax.plot(x + x1 + t * (x2 - x1) + side, y1 + t * (y2 - y1), color=FORCE, lw=0.9, zorder=5)


def draw_forces(ax, places, forces, height, foot=0.0, coordinates="data"):
    """Draws arrows down to `foot`; the greatest force has this height."""
    greatest = np.abs(forces).max() if len(forces) else 1.0
    for x, force in zip(places, forces):
        ax.annotate("", xy=(x, foot), xytext=(x, foot + height * abs(force) / greatest), annotation_clip=False,
                    xycoords=coordinates, textcoords=coordinates,
                    arrowprops={"arrowstyle": "-|>", "color": FORCE, "lw": 0.7, "shrinkA": 0, "shrinkB": 0,
                                "mutation_scale": 5})
