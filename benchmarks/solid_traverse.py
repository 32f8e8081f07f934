"""The values of solid_cases.py by Traverse: with a beam, and with the modes of the body as given modes."""

import os

import h5py
import numpy as np
import runs
from solid_cases import FORCE, HIGHEST, RATIO, STEP, Cross, of_bending_and_twist, of_statics, places_of


class ByABeam:
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
        places = places_of(self.spans)
        return (self.frequencies() | self.static("a force", places, half - 1.9 + 0.2 * np.arange(20))
                | self.static("a line load", places, (np.arange(200) + 0.5) * length / 200))

    def passage(self, train, hslm_a, t):
        """Deflections at the middle of the left track, the axis and the right edge at instants t, and the acceleration of
        the train's own track by the modes below 30 Hz."""
        e = Cross.track if train.track == "LEFT" else -Cross.track
        below = sum(f < HIGHEST for f in self.frequencies().values())
        with self.results(model_modes=below, model_damping_ratios=RATIO, track_eccentricity=e,
                          **of_train(train, hslm_a, t)) as found:
            deflection, twist, acceleration = (
                history(found, f"probes/{name}", t) for name in ("deflection", "twist", "acceleration"))
        places = {"LEFT": Cross.track, "AXIS": 0.0, "EDGE": -Cross.edge}
        return {name: deflection + (y - e) * twist for name, y in places.items()}, {train.track: acceleration}


def of_train(train, hslm_a, t):
    """Options of a passage."""
    behind = train.enters * abs(train.speed)
    return {"load_hslm_a": hslm_a, "load_speed": train.speed, "output_probes": Cross.span / 2, "output_interval": STEP,
            "load_positions": -behind if train.speed > 0 else Cross.span + behind, "ts_max_time": t[-1]}


def history(results, name, t):
    time = results["time"][:]
    return np.interp(t, time, results[name][:].reshape(len(time), -1)[:, 0])


class ByTheBody:
    """Runs with the modes of a body (frequencies, shapes, x) as given modes."""

    def __init__(self, build, folder, frequencies, shapes, x):
        self.build, self.folder, self.modes = build, folder, (frequencies, shapes, x)

    def results(self, below, train, hslm_a, t):
        """By the modes below a frequency."""
        frequencies, shapes, x = self.modes
        low, file = frequencies < below, os.path.join(self.folder, "modes.csv")
        with open(file, "w") as text:
            def line(*words):
                print(*(word if isinstance(word, str) else f"{word:.9g}" for word in words), sep=", ", file=text)
            line("frequency", *frequencies[low])
            line("modal_mass", *np.ones(low.sum()))
            line("damping_ratio", RATIO)
            for place, shape in shapes.items():
                line("output", place, "m", *shape[low, int(np.abs(x - Cross.span / 2).argmin())])
            for track, place in enumerate(("LEFT", "RIGHT"), 1):
                line("track", float(track))
                for at, values in zip(x, shapes[place][low].T):
                    line(at, *values)
        options = {"bridge_modes_file": file, "bridge_track": 1 if train.track == "LEFT" else 2}
        found = os.path.join(self.folder, "by_the_body.h5")
        runs.Run(self.build, options | of_train(train, hslm_a, t), found)
        return h5py.File(found)

    def passage(self, train, hslm_a, t):
        """As ByABeam.passage."""
        with self.results(np.inf, train, hslm_a, t) as found:
            deflections = {place: history(found, f"outputs/{place}", t) for place in ("LEFT", "AXIS", "EDGE")}
        with self.results(HIGHEST, train, hslm_a, t) as found:
            return deflections, {train.track: history(found, "probes/acceleration", t)}
