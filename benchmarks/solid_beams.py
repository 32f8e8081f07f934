"""The values of solid_cases.py by beams without Traverse: on skew bearings (solid_beam.py), and Vlasov's series."""

import numpy as np
import solid_beam
from solid_cases import FORCE, TORQUE, Girder, Slab, mirrored, of_statics
from solid_section import Section

PIECES = 0.2 * np.arange(-4, 5)  # m, of the force on the slab along the axis


def beam_of(kind, material=None, parts=8):
    """The constants of a body's section."""
    return solid_beam.of_section(Section(kind.y, mirrored(kind.z), kind.solid, parts), material or kind.material)


def skew():
    """The values of the slab."""
    kind, beam, middle = Slab, beam_of(Slab), Slab.span / 2
    x = np.unique(np.round(np.concatenate([np.linspace(-2, kind.span + 2, 171), [at for at, _ in kind.bearings]]), 9))
    model = solid_beam.OnBearings(beam, x, [(round(at, 9), y) for at, y in kind.bearings])
    spread = [(middle + way, kind.bearing, -FORCE / len(PIECES)) for way in PIECES]
    deflections, twists, reactions = model.static(spread)
    values = {(f"frequency {i + 1}", "Hz"): f for i, f in enumerate(model.frequencies(6))}
    values |= {(f"a force: reaction at x {at:.3f} m, y {y:g} m", "kN"): 1e-3 * force
               for (at, y), force in zip(kind.bearings, reactions)}
    return values | of_statics(x, deflections, twists, "a force", (middle,))


def vlasov(kind, beam, torque, length, places):
    """Twists under a torque spread over a length in the middle, between forks that leave the warping free."""
    k = np.arange(1, 4001) * np.pi / kind.span
    loads = 2 * torque / kind.span * np.sin(k * kind.span / 2) * np.sinc(k * length / (2 * np.pi))
    return [float(np.sum(loads * np.sin(k * x) / (beam.GJ * k**2 + beam.ECw * k**4))) for x in places]


def girder():
    """The values of the girder's torsion."""
    kind, beam, places = Girder, beam_of(Girder), (Girder.span / 4, Girder.span / 2)
    twists = vlasov(kind, beam, TORQUE, 1.0, places)
    k = np.arange(1, 4) * np.pi / kind.span
    warping = beam.ECw / kind.material[0] * kind.material[2]
    frequencies = k / (2 * np.pi) * np.sqrt((beam.GJ + beam.ECw * k**2) / (beam.polar + warping * k**2))
    return ({(f"a torque: twist at {place:g} m", "mrad"): 1e3 * twist for place, twist in zip(places, twists)}
            | {(f"frequency of torsion {i + 1}", "Hz"): f for i, f in enumerate(frequencies)})
