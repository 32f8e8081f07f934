"""The values of solid_cases.py by Traverse: with beams, and with the modes of the body as given modes."""

import os

import h5py
import numpy as np
import runs
from solid_cases import FORCE, HIGHEST, RATIO, STEP, TORQUE, Cross, Girder, Slab, of_bending_and_twist, of_statics, places_of

STIFF = 1e12  # N/m, of a bearing: it moves by a micrometre


def listed(values):
    return ",".join(f"{value:.12g}" for value in values)


class Bridge:
    """A beam with these constants and options. step: largest length of an element, m."""

    def __init__(self, build, folder, beam, spans, step=1.0, **options):
        self.build, self.file = build, os.path.join(folder, "beam.h5")
        self.options = {"beam_spans": listed(spans), "beam_EI": beam.EI, "beam_GA": beam.GA, "beam_GJ": beam.GJ,
                        "beam_mass": beam.mass, "beam_rotary_inertia": beam.rotary, "beam_polar_inertia": beam.polar,
                        "beam_elements_per_span": round(max(spans) / step)} | options
        if beam.ECw:
            self.options["beam_ECw"] = beam.ECw

    def results(self, **options):
        runs.Run(self.build, self.options | options, self.file)
        return h5py.File(self.file)

    def statics(self, places, **options):
        """The results under forces at rest, with probes at these places."""
        return self.results(load_speed=0, output_probes=listed(places), ts_max_time=0.01, output_interval=0.01, **options)

    def frequencies(self):
        with self.results(scene_analysis="modes", modes_count=12) as found:
            twisting = found["modes/twisting"][:].reshape(-1, 1)
            return of_bending_and_twist(found["modes/frequency"][:], 1 - twisting, twisting)


def on_forks(kind, spans):
    return {"support_types": ",".join(["pinned"] + spans * ["roller"])}


class ByABeam(Bridge):
    """The cross on one or two spans."""

    def __init__(self, build, folder, beam, spans):
        super().__init__(build, folder, beam, spans * [Cross.span], **on_forks(Cross, spans))
        self.spans = spans

    def static(self, load, places, positions):
        """Under equal forces on the left track, 1 MN together, at rest."""
        forces = len(positions) * [FORCE / len(positions)]
        with self.statics(places, track_eccentricity=Cross.track, load_forces=listed(forces),
                          load_positions=listed(positions)) as found:
            twist = found["probes/twist"][0]
            return of_statics(np.array(places), found["probes/deflection"][0] - Cross.track * twist, twist, load, places)

    def values(self):
        half, length = Cross.span / 2, self.spans * Cross.span
        places = places_of(self.spans)
        return (self.frequencies() | self.static("a force", places, half - 1.9 + 0.2 * np.arange(20))
                | self.static("a line load", places, (np.arange(200) + 0.5) * length / 200))

    def passage(self, trains, hslm_a, t):
        """Deflections at the middle of the left track, the axis and the right edge at instants t, and accelerations there by
        the modes below 30 Hz."""
        below = sum(f < HIGHEST for f in self.frequencies().values())
        places = {"LEFT": Cross.track, "AXIS": 0.0, "EDGE": -Cross.edge, "RIGHT": -Cross.track}
        options = {"tracks": ",".join(places), "loads": ",".join(f"train{i}" for i in range(len(trains)))}
        options |= {f"{name}_eccentricity": y for name, y in places.items()}
        for i, train in enumerate(trains):
            options |= {f"train{i}_{key.removeprefix('load_')}" if key.startswith("load_") else key: value
                        for key, value in of_train(train, hslm_a, t).items()} | {f"train{i}_track": train.track}
        with self.results(model_modes=below, model_damping_ratios=RATIO, **options) as found:
            time = found["time"][:]
            return tuple({name: np.interp(t, time, found[f"probes/{what}"][:, i])
                          for i, name in enumerate(places) if name != "RIGHT"} for what in ("deflection", "acceleration"))


def skew(build, folder, beam):
    """The values of the slab, on bearings beside the axis."""
    kind, over = Slab, 2.0  # m: the slab continues beyond the lines of the bearings
    middle = kind.span / 2
    along, aside = zip(*kind.bearings)
    bridge = Bridge(build, folder, beam, [kind.span + 2 * over], 0.25, support_types="free,free",
                    foundation_vertical_x=listed(over + at for at in along), foundation_vertical_k=STIFF,
                    foundation_vertical_eccentricity=listed(aside))
    with bridge.results(scene_analysis="modes", modes_count=6) as found:
        values = {(f"frequency {i + 1}", "Hz"): f for i, f in enumerate(found["modes/frequency"][:6])}
    positions = over + middle - 0.95 + 0.1 * np.arange(20)
    with bridge.statics([over + middle], track_eccentricity=kind.bearing, load_forces=listed(20 * [FORCE / 20]),
                        load_positions=listed(positions)) as found:
        values |= {(f"a force: reaction at x {at:.3f} m, y {y:g} m", "kN"): 1e-3 * force
                   for (at, y), force in zip(kind.bearings, found["foundation/vertical/force"][0])}
        twist = found["probes/twist"][0]
        return values | of_statics(np.array([middle]), found["probes/deflection"][0] - kind.bearing * twist, twist,
                                   "a force", (middle,))


def girder(build, folder, beam):
    """The values of the girder's torsion: the torque is that of opposite forces on two tracks."""
    half = Girder.span / 2
    bridge = Bridge(build, folder, beam, [Girder.span], 0.125, **on_forks(Girder, 1))
    positions = half - 0.475 + 0.05 * np.arange(20)
    options = {"tracks": "left,right", "left_eccentricity": 1.0, "right_eccentricity": -1.0, "loads": "down,up"}
    for name, track, sign in (("down", "right", 1.0), ("up", "left", -1.0)):
        options |= {f"{name}_forces": listed(20 * [sign * TORQUE / 40]), f"{name}_positions": listed(positions),
                    f"{name}_speed": 0, f"{name}_track": track}
    with bridge.results(output_probes=listed([half / 2, half]), ts_max_time=0.01, output_interval=0.01, **options) as found:
        values = {(f"a torque: twist at {place:g} m", "mrad"): 1e3 * found["probes/twist"][0, i]
                  for i, place in enumerate((half / 2, half))}
    values |= bridge.frequencies()
    return {key: value for key, value in values.items() if "bending" not in key[0]}


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

    def passage(self, trains, hslm_a, t):
        """As ByABeam.passage: of several trains by superposition, and without accelerations."""
        deflections = dict.fromkeys(("LEFT", "AXIS", "EDGE"), 0.0)
        for train in trains:
            with self.results(np.inf, train, hslm_a, t) as found:
                for place in deflections:
                    deflections[place] = deflections[place] + history(found, f"outputs/{place}", t)
        if len(trains) > 1:
            return deflections, {}
        with self.results(HIGHEST, trains[0], hslm_a, t) as found:
            return deflections, {trains[0].track: history(found, "probes/acceleration", t)}
