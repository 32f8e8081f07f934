"""The values of solid_cases.py by beams: Traverse, a beam on skew bearings (solid_beam.py), Vlasov's series."""

import os

import h5py
import numpy as np
import runs
import solid_beam
from solid_cases import FORCE, HIGHEST, RATIO, STEP, TORQUE, Cross, Girder, Slab, mirrored, of_bending_and_twist, of_statics
from solid_section import Section


def beam_of(kind, material=None, parts=8):
    return solid_beam.of_section(Section(kind.y, mirrored(kind.z), kind.solid, parts), material or kind.material)


class Traverse:
    """Runs of a bridge on forks with the constants of the beam."""

    def __init__(self, build, folder, beam, spans):
        self.build, self.file, self.spans = build, os.path.join(folder, "beam.h5"), spans
        self.bridge = {"beam_spans": f"{Cross.span:g}*{spans}", "beam_EI": beam.EI, "beam_GA": beam.GA, "beam_GJ": beam.GJ,
                       "beam_mass": beam.mass, "beam_rotary_inertia": beam.rotary, "beam_polar_inertia": beam.polar,
                       "support_types": ",".join(["pinned"] + spans * ["roller"])}

    def results(self, **options):
        runs.Run(self.build, self.bridge | options, self.file)
        return h5py.File(self.file)

    def frequencies(self):
        with self.results(scene_analysis="modes", modes_count=12) as found:
            twisting = found["modes/twisting"][:].reshape(-1, 1)
            return of_bending_and_twist(found["modes/frequency"][:], 1 - twisting, twisting)

    def static(self, load, places, positions):
        """Under equal forces on the left track, 1 MN together, at rest."""
        forces = len(positions) * [FORCE / len(positions)]
        with self.results(model_modes=20, model_damping_ratios=RATIO, track_eccentricity=Cross.track, load_speed=0,
                          load_forces=",".join(map(str, forces)), load_positions=",".join(map(str, positions)),
                          output_probes=",".join(map(str, places)), ts_max_time=0.01, output_interval=0.01) as found:
            twist = found["probes/twist"][0]
            return of_statics(np.array(places), found["probes/deflection"][0] - Cross.track * twist, twist, load, places)

    def values(self):
        half, length = Cross.span / 2, self.spans * Cross.span
        places = (half / 2, half) if self.spans == 1 else (half / 2, half, half + Cross.span)
        return (self.frequencies() | self.static("a force", places, half - 1.9 + 0.2 * np.arange(20))
                | self.static("a line load", places, (np.arange(200) + 0.5) * length / 200))

    def passage(self, train, hslm_a, t):
        """Deflections at the middle of the left track, the axis and the right edge at instants t, and the acceleration of
        the train's own track by the modes below 30 Hz."""
        e = Cross.track if train.track == "LEFT" else -Cross.track
        behind = train.enters * abs(train.speed)
        below = sum(f < HIGHEST for f in self.frequencies().values())
        with self.results(model_modes=below, model_damping_ratios=RATIO, track_eccentricity=e, load_hslm_a=hslm_a,
                          load_speed=train.speed, load_positions=-behind if train.speed > 0 else Cross.span + behind,
                          output_probes=Cross.span / 2, output_interval=STEP, ts_max_time=t[-1]) as found:
            time, deflection, twist, acceleration = (
                np.asarray(found[name]).reshape(len(found["time"]), -1)[:, 0]
                for name in ("time", "probes/deflection", "probes/twist", "probes/acceleration"))
        places = {"LEFT": Cross.track, "AXIS": 0.0, "EDGE": -Cross.edge}
        return ({name: np.interp(t, time, deflection + (y - e) * twist) for name, y in places.items()},
                {train.track: np.interp(t, time, acceleration)})


def skew():
    kind, beam, middle = Slab, beam_of(Slab), Slab.span / 2
    x = np.unique(np.round(np.concatenate([np.linspace(-2, kind.span + 2, 171), [at for at, _ in kind.bearings]]), 9))
    model = solid_beam.OnBearings(beam, x, [(round(at, 9), y) for at, y in kind.bearings])
    spread = [(middle + way, kind.bearing, -FORCE / len(PIECES)) for way in PIECES]
    deflections, twists, reactions = model.static(spread)
    values = {(f"frequency {i + 1}", "Hz"): f for i, f in enumerate(model.frequencies(6))}
    values |= {(f"a force: reaction at x {at:.3f} m, y {y:g} m", "kN"): 1e-3 * force
               for (at, y), force in zip(kind.bearings, reactions)}
    return values | of_statics(x, deflections, twists, "a force", (middle,))


PIECES = 0.2 * np.arange(-4, 5)  # of the force on the slab, along 2 m


def vlasov(kind, beam, torque, length, places):
    """Twists under a torque spread over a length in the middle, between forks that leave the warping free."""
    k = np.arange(1, 4001) * np.pi / kind.span
    loads = 2 * torque / kind.span * np.sin(k * kind.span / 2) * np.sinc(k * length / (2 * np.pi))
    return [float(np.sum(loads * np.sin(k * x) / (beam.GJ * k**2 + beam.ECw * k**4))) for x in places]


def girder():
    kind, beam, places = Girder, beam_of(Girder), (Girder.span / 4, Girder.span / 2)
    twists = vlasov(kind, beam, TORQUE, 1.0, places)
    k = np.arange(1, 4) * np.pi / kind.span
    warping = beam.ECw / kind.material[0] * kind.material[2]
    frequencies = k / (2 * np.pi) * np.sqrt((beam.GJ + beam.ECw * k**2) / (beam.polar + warping * k**2))
    return ({(f"a torque: twist at {place:g} m", "mrad"): 1e3 * twist for place, twist in zip(places, twists)}
            | {(f"frequency of torsion {i + 1}", "Hz"): f for i, f in enumerate(frequencies)})
