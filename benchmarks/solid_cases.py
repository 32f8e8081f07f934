"""The bodies of solid_bridge.py, and their values by CalculiX: frequencies, static values, responses to trains.

Each has an upper half in z only, as of solid_ccx.UpperHalf. parts: into how many elements each interval of the coarse mesh is
divided, along x, y and z. Deflections are positive upwards, twists where the left side goes up; the forces act downwards.
"""

import numpy as np
import solid_ccx
import solid_train
from solid_mesh import ALL, Body, divided

CONCRETE, STEEL = (34e9, 0.2, 2500.0), (210e9, 0.3, 7850.0)  # E, Poisson's ratio, density
WITHOUT_POISSON = (34e9, 0.0, 2500.0)
FORCE, TORQUE = 1e6, 1e4  # N, N m
RATIO, HIGHEST = 0.01, 30.0  # damping of each mode; Hz, of the modes in accelerations
STEP = 5e-4  # s, of the recursion for the modes


def mirrored(lines):
    return np.unique(np.concatenate([-np.asarray(lines), lines]))


class Cross:
    """A deck of 5.0 m by 0.8 m and a girder of 1.0 m by 3.2 m through its middle, of concrete; two tracks 2 m beside it."""
    material, span, track, edge = CONCRETE, 40.0, 2.0, 2.5
    y, z = mirrored([0, 0.4, 0.5, 0.6, 1.0, 1.5, 2.0, 2.5]), [0, 0.3, 0.4, 0.5, 0.9, 1.6]  # finer about the corner
    strip = ((1.5, 2.5), (0, 0.4))  # of the left track in the section

    @staticmethod
    def solid(y, z):
        return (abs(y) < 0.5) | (abs(z) < 0.4)

    @classmethod
    def x(cls, spans):
        """Lines of the coarse mesh: a piece of 4 m in the middle of each span."""
        of_one = np.array([0, 5, 10, 14, 18, 22, 26, 30, 35, 40])
        return np.unique(np.concatenate([cls.span * i + of_one for i in range(spans)]))


class Slab:
    """34 m by 5.0 m by 1.5 m of concrete on four bearings of 1 m by 1 m, each 1.8 m beside the axis, on two lines at 30
    degrees to the section, 30 m apart along the axis."""
    material, span, bearing, half = CONCRETE, 30.0, 1.8, 0.5
    shift = 1.8 * np.tan(np.pi / 6)  # of a bearing along the axis
    y, z = mirrored([0, 0.65, 1.3, 2.3, 2.5]), [0, 0.75]
    strip = ((1.3, 2.3), (0, 0.75))
    bearings = [(-shift, -1.8), (shift, 1.8), (span - shift, -1.8), (span + shift, 1.8)]  # right and left of each line

    @staticmethod
    def solid(y, z):
        return True

    @classmethod
    def x(cls):
        ends = np.concatenate([at + np.array([-cls.half, cls.half]) for at in (-cls.shift, cls.shift)])
        return np.concatenate([[-2], ends, np.linspace(4, 14, 5), np.linspace(16, 26, 5), cls.span + ends, [cls.span + 2]])


class Girder:
    """A welded girder of steel, 12 m: flanges of 300 mm by 25 mm, 800 mm apart between their middles, web of 20 mm."""
    material, span = STEEL, 12.0
    y, z = mirrored([0.01, 0.07, 0.15]), [0, 0.13, 0.26, 0.3875, 0.4125]
    flange = ((-0.15, 0.15), (0.3875, 0.4125))

    @staticmethod
    def solid(y, z):
        return (abs(y) < 0.01) | (abs(z) > 0.3875)


def body(kind, x, parts):
    return Body(divided(x, parts), divided(kind.y, parts), divided(kind.z, parts), kind.solid)


def on_forks(kind, x, forks, parts, material=None):
    """A model with rigid diaphragms that cannot move in their plane, and warp freely."""
    model = solid_ccx.UpperHalf(body(kind, x, parts), material or kind.material)
    for at in forks:
        model.hold(model.body.where(x=at), 2, 3)
    return model


def named_lines(model, **places):
    """Names the nodes along the body with z = 0 and these y."""
    for name, y in places.items():
        model.name(name, model.body.where(y=y, z=0))


def of_bending_and_twist(frequencies, axis, twist, count=3):
    """The first frequencies of the modes that move the axis, and of those that turn it."""
    bent = np.abs(axis).max(axis=1) > np.abs(twist).max(axis=1)
    values = {}
    for name, chosen in (("bending", bent), ("torsion", ~bent)):
        values |= {(f"frequency of {name} {i + 1}", "Hz"): f for i, f in enumerate(frequencies[chosen][:count])}
    return values


def of_statics(x, axis, twist, load, places):
    values = {}
    for place in places:
        at = int(np.abs(x - place).argmin())
        values |= {(f"{load}: deflection of the axis at {place:g} m", "mm"): 1e3 * axis[at],
                   (f"{load}: twist at {place:g} m", "mrad"): 1e3 * twist[at]}
    return values


def places_of(spans):
    """Where static values of one or two spans are taken."""
    half = Cross.span / 2
    return (half / 2, half) if spans == 1 else (half / 2, half, half + Cross.span)


def cross(spans, parts, folder, material=None):
    """(values, frequencies, shapes, x) of one or two spans on forks."""
    kind, half = Cross, Cross.span / 2
    ends = np.arange(spans + 1) * kind.span
    model = on_forks(kind, kind.x(spans), ends, parts, material)
    named_lines(model, LEFT=kind.track, AXIS=0.0, RIGHT=-kind.track, EDGE=-kind.edge)
    x = model.body.nodes[model.sets["AXIS"], 0]
    loads = {"a force": model.force(((half - 2, half + 2), *kind.strip), 3, -FORCE),
             "a line load": model.force((ALL, *kind.strip), 3, -FORCE)}
    values = {}
    for load, (moved, _) in zip(loads, solid_ccx.statics(model, loads.values(), folder)):
        twist = (moved["LEFT"] - moved["RIGHT"])[:, 2] / (2 * kind.track)
        values |= of_statics(x, moved["AXIS"][:, 2], twist, load, places_of(spans))
    frequencies, shapes = solid_ccx.modes(model, 24, folder)
    shapes = {name: shape[:, :, 2] for name, shape in shapes.items()}
    twist = (shapes["LEFT"] - shapes["RIGHT"]) / (2 * kind.track) * kind.edge
    return of_bending_and_twist(frequencies, shapes["AXIS"], twist) | values, frequencies, shapes, x


def passage(frequencies, shapes, x, trains, until):
    """(t, deflections, accelerations) at midspan, by the name of the line of nodes."""
    t = np.arange(0, until, STEP)
    forces = solid_train.modal_forces(trains, shapes, x, t)
    place, acceleration = solid_train.responses(frequencies, RATIO, forces, STEP)
    middle, low = int(np.abs(x - np.mean(x[[0, -1]])).argmin()), frequencies < HIGHEST
    return (t, {name: shape[:, middle] @ place for name, shape in shapes.items()},
            {name: shape[low, middle] @ acceleration[low] for name, shape in shapes.items()})


def skew(parts, folder):
    """Values of the slab; a bearing holds the mean of its prism through the slab."""
    kind = Slab
    model = solid_ccx.UpperHalf(body(kind, kind.x(), parts), kind.material)
    for i, (at, y) in enumerate(kind.bearings):
        region = ((at - kind.half, at + kind.half), (y - kind.half, y + kind.half), ALL)
        model.hold_mean(region, 3)
        model.name(f"BEARING{i}", model.body.shares(region)[0])
    named_lines(model, LEFT=1.3, AXIS=0.0, RIGHT=-1.3)
    x = model.body.nodes[model.sets["AXIS"], 0]
    [(moved, reactions)] = solid_ccx.statics(
        model, [model.force(((kind.span / 2 - 1, kind.span / 2 + 1), *kind.strip), 3, -FORCE)], folder)
    values = {(f"a force: reaction at x {at:.3f} m, y {y:g} m", "kN"): 1e-3 * reactions[f"BEARING{i}"][2]
              for i, (at, y) in enumerate(kind.bearings)}
    twist = (moved["LEFT"] - moved["RIGHT"])[:, 2] / 2.6
    values |= of_statics(x, moved["AXIS"][:, 2], twist, "a force", (kind.span / 2,))
    frequencies, _ = solid_ccx.modes(model, 6, folder)
    return {(f"frequency {i + 1}", "Hz"): f for i, f in enumerate(frequencies)} | values


def girder(parts, folder):
    """Values of the girder's torsion."""
    kind, half = Girder, Girder.span / 2
    model = on_forks(kind, [0, 1, 2, 3, 4, 5, 5.5, 6.5, 7, 8, 9, 10, 11, 12], (0, kind.span), parts)
    named_lines(model, AXIS=0.01)
    model.name("TOP", model.body.where(y=0.15, z=0.4125))
    x = model.body.nodes[model.sets["TOP"], 0]
    # Opposite forces on the flanges, whose middles are 0.8 m apart: the lower half has those with the other sign.
    [(moved, _)] = solid_ccx.statics(
        model, [model.force(((half - 0.5, half + 0.5), *kind.flange), 2, -2 * TORQUE / 0.8)], folder)
    twist = -moved["TOP"][:, 1] / 0.4125
    values = {(f"a torque: twist at {place:g} m", "mrad"): 1e3 * twist[np.abs(x - place).argmin()]
              for place in (half / 2, half)}
    frequencies, shapes = solid_ccx.modes(model, 6, folder)
    values |= of_bending_and_twist(frequencies, shapes["AXIS"][:, :, 2], shapes["TOP"][:, :, 1] / 0.4125 * 0.15)
    return {key: value for key, value in values.items() if "bending" not in key[0]}
