"""The values of solid_cases.py by beams of solid_beam.py, with warping or without it."""

import numpy as np
import solid_beam
from solid_cases import FORCE, TORQUE, Cross, Girder, Slab, mirrored, of_bending_and_twist, of_statics, places_of
from solid_section import Section


def beam_of(kind, material=None, parts=8):
    """The constants of a body's section."""
    return solid_beam.of_section(Section(kind.y, mirrored(kind.z), kind.solid, parts), material or kind.material)


def on_forks(beam, kind, spans, step):
    return solid_beam.OnBearings(beam, np.arange(0, spans * kind.span + step / 2, step),
                                 [(i * kind.span, y) for i in range(spans + 1) for y in (-1.0, 1.0)])


def cross(beam, spans):
    """The values of one or two spans."""
    model, half = on_forks(beam, Cross, spans, 0.5), Cross.span / 2
    values = of_bending_and_twist(*model.modes(12))
    for load, low, high in (("a force", half - 2, half + 2), ("a line load", 0, spans * Cross.span)):
        deflections, twists, _ = model.static(model.spread(low, high, Cross.track, -FORCE))
        values |= of_statics(model.x, deflections, twists, load, places_of(spans))
    return values


def skew(beam):
    """The values of the slab."""
    kind, middle = Slab, Slab.span / 2
    bearings = [(round(at, 9), y) for at, y in kind.bearings]
    x = np.unique(np.concatenate([np.arange(-2, kind.span + 2.25, 0.5), [at for at, _ in bearings]]))
    model = solid_beam.OnBearings(beam, x, bearings)
    deflections, twists, reactions = model.static(model.spread(middle - 1, middle + 1, kind.bearing, -FORCE))
    values = {(f"frequency {i + 1}", "Hz"): f for i, f in enumerate(model.modes(6)[0])}
    values |= {(f"a force: reaction at x {at:.3f} m, y {y:g} m", "kN"): 1e-3 * force
               for (at, y), force in zip(kind.bearings, reactions)}
    return values | of_statics(x, deflections, twists, "a force", (middle,))


def girder(beam):
    """The values of the girder's torsion."""
    kind, half = Girder, Girder.span / 2
    model = on_forks(beam, kind, 1, 0.125)
    couple = [force for y in (-1.0, 1.0) for force in model.spread(half - 0.5, half + 0.5, y, y * TORQUE / 2)]
    _, twists, _ = model.static(couple)
    frequencies, deflections, shapes = model.modes(8)
    values = {(f"a torque: twist at {place:g} m", "mrad"): 1e3 * twists[model.node(place)] for place in (half / 2, half)}
    values |= of_bending_and_twist(frequencies, deflections, shapes)
    return {key: value for key, value in values.items() if "bending" not in key[0]}
