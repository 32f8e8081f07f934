#!/usr/bin/python3
"""Prints wall times against those of VBI-2D, TTB-2D and ROSE, same size and steps, then at equal error: factors, errors.
/usr/bin/python3 benchmarks/peers.py [BUILD_FOLDER] [OUT_FOLDER] [ROUNDS] [--smallest]; writes peers.csv and peers.png.

The peers' seconds are those of OUT_FOLDER/peers_here.csv where benchmarks/peers_here.py has measured them on this
machine, else those that were measured once on one core of another machine of this kind; the table says which. Ours are
medians of ROUNDS (7) runs, all cases of a kind in turn, with all results stored at every step. Loop stands against
loop, and where the peer's whole run is known, its processor seconds stand against those of our whole process, start
included, which do not depend on what else the machine does. Of the settings that are tried for equal error those that
the program refuses, as too long a step, are left out and counted.
"""

import csv
import itertools
import os
import tempfile
from dataclasses import dataclass, replace

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import runs  # noqa: E402

INTEGRATORS = {
    "esdirk4": {"ts_type": "esdirk4"},
    "genalpha": {"ts_type": "genalpha"},
}
SEARCHED = INTEGRATORS | {"genalpha of radius 1": {"ts_type": "genalpha", "ts_genalpha_radius": 1.0}}
OPTIONS = os.path.join(runs.ROOT, "options")
# Without rail and sleepers: their mass, and the ballast's, ride on the beam. 121.28 + (251 + 531.4)/0.6 kg/m.
ON_THE_BRIDGE = {
    "options_file": os.path.join(OPTIONS, "bridges", "xia_fifty_metres.yml"),
    "vehicle_coach_file": os.path.join(OPTIONS, "vehicles", "manchester.yml"),
    "beam_mass": 69000.0 + 121.28 + (251.0 + 531.4) / 0.6,
}


@dataclass
class Case:
    name: str
    program: str
    seconds: float       # the peer's, of its time loop
    error: float         # the peer's, of the peak deflection; what equal error means
    references: list     # m, converged peak at every probe
    same: dict           # the peer's mesh and steps
    models: dict         # what equal error is looked for with: name, options
    grid: dict           # and their values, all combined; from coarse to fine
    interval: float      # s, the peer's step
    whole: float = 0.0   # s, the peer's whole run; 0: not known
    machine: str = "another machine"  # that the peer's seconds are from
    modes: int = 0       # at the same size and steps: so many modes under linear vehicles as well; 0: not tried


def grid_of(option, values, steps):
    return {option: values, "ts_dt": steps}


SPRUNG_MASS = {"sprung mass": {"options_file": runs.scene("r3_sprung_mass")}}
SPRUNG_MASS_GRID = grid_of("beam_elements_per_span", [2, 3, 4, 6, 8], [0.05, 0.04, 0.025, 0.0125])
TWO_MASSES = {"options_file": runs.scene("r7_two_masses")}
R8 = {"options_file": runs.scene("r8_ballasted_bridge"), "track_approach": 57.6}
COACHES = {"options_file": runs.scene("four_coaches_ballasted_bridge")}
AS_THE_PEERS_TRACK = {"track_elements_per_bay": 2}  # TTB-2D has 1,918 unknowns for R8

CASES = [
    Case("R3, 60 elements", "VBI-2D", 0.89, 2e-4, [-4.18626809e-4],
         SPRUNG_MASS["sprung mass"] | {"beam_elements_per_span": 60}, SPRUNG_MASS, SPRUNG_MASS_GRID, 1e-3,
         modes=16),
    Case("R3, 960 elements", "VBI-2D", 16.9, 2e-4, [-4.18626809e-4],
         SPRUNG_MASS["sprung mass"] | {"beam_elements_per_span": 960}, SPRUNG_MASS, SPRUNG_MASS_GRID, 1e-3,
         modes=16),
    # The peer rounds the span to 50.1 m: 5.5e-3 of the peak. (At that span its own error is 1.8e-4.)
    Case("R8, ballasted bridge", "TTB-2D", 17.1, 5e-3, [-5.38333e-4],
         R8 | AS_THE_PEERS_TRACK | {"ts_max_time": 3.961},
         {"track": R8 | {"track_elements_per_bay": 1},
          "track, the coach starts 5 m before the bridge": R8 | {"track_elements_per_bay": 1, "train_positions": -15.8,
                                                                "track_approach": 28.8}},
         {"ts_dt": [0.05, 0.03, 0.02, 0.015, 0.01, 0.005]}, 1e-3),
    Case("four coaches, 4 x 50 m", "TTB-2D", 95.0, 5e-3, [-1.31188e-3, -1.30910e-3, -1.31006e-3, -1.31081e-3],
         COACHES | AS_THE_PEERS_TRACK | {"ts_max_time": 4.285},
         {"track": COACHES | {"track_elements_per_bay": 1}},
         {"ts_dt": [0.02, 0.015, 0.01, 0.005, 0.003]}, 1e-3),
    # The reference is the refined run of the scene; the peer's two integrators are 1e-3 away from it.
    Case("R7, 100 elements", "ROSE", 0.27, 1e-3, [-3.263210e-2],
         TWO_MASSES | {"beam_elements_per_span": 100}, {"two masses": TWO_MASSES},
         grid_of("beam_elements_per_span", [2, 3, 4, 6, 8], [0.1, 0.05, 0.025, 0.0125]), 0.9e-3),
]
COACH_OFF_TRACK = ON_THE_BRIDGE | {"train_vehicles": "coach", "train_positions": -15.8, "train_speed": 100 / 3,
                                   "output_probes": "25.0"}
COACHES_OFF_TRACK = ON_THE_BRIDGE | {"train_vehicles": "coach*4", "train_positions": -15.8, "train_speed": 250 / 3,
                                     "beam_spans": "50.0*4", "beam_continuity": "simply_supported",
                                     "support_types": "pinned", "output_probes": "25.0,75.0,125.0,175.0"}
OFF_TRACK = "no track, its mass on the bridge"
OFF_TRACK_GRID = grid_of("beam_elements_per_span", [2, 3, 4], [0.05, 0.03, 0.02, 0.015, 0.01])


def error(case, run):
    """The largest over the probes, of the largest peak."""
    off = [abs(runs.peak(run.file, i) - value) for i, value in enumerate(case.references)]
    return max(off) / max(abs(value) for value in case.references)


def timed_here(cases, folder):
    """The cases with the peers' seconds of this machine, where these were measured."""
    file = os.path.join(folder, "peers_here.csv")
    if not os.path.exists(file):
        return cases
    with open(file, newline="") as table:
        here = {line["case"]: line for line in csv.DictReader(table)}
    return [replace(case, seconds=float(here[case.name]["seconds of the loop"]),
                    whole=float(here[case.name]["seconds in all"]), machine="this machine")
            if case.name in here else case for case in cases]


def same_size(build, folder, rounds, case):
    options = case.same | {"ts_dt": case.interval, "output_interval": case.interval}
    kinds = dict(INTEGRATORS)
    if case.modes:
        kinds |= {f"{name}, {case.modes} modes": kind | {"model_modes": case.modes, "model_vehicles": "linear"}
                  for name, kind in INTEGRATORS.items()}
    measured = runs.in_turn(build, {name: options | kind for name, kind in kinds.items()}, rounds, folder)
    for name, (seconds, run) in measured.items():
        yield row(case, "same size and steps", name, seconds, run, error(case, run))


def tried(build, folder, options):
    """A run, or none where the program refuses so long a step."""
    try:
        return runs.Run(build, options, os.path.join(folder, "tried.h5"))
    except runs.Failed as failed:
        if failed.step_is_too_long:
            return None
        raise


def equal_error(build, folder, rounds, case, model, options, grid):
    """The cheapest of the grid, by any of the integrators, whose error is no larger than the peer's."""
    found, refused = {}, 0
    for values in itertools.product(*grid.values()):
        chosen = dict(zip(grid, values))
        for name, kind in SEARCHED.items():
            these = options | chosen | kind | {"output_interval": chosen["ts_dt"]}
            run = tried(build, folder, these)
            if run is None:
                refused += 1
            elif error(case, run) <= case.error:
                how = ", ".join([f"{model}: {name}"] + [f"{k} {v:g}" for k, v in chosen.items()])
                found[how] = (run.seconds, these)
    if refused:
        print(f"{case.name}, {model}: {refused} settings left out, their steps are too long")
    cheapest = sorted(found, key=lambda name: found[name][0])[:4]
    measured = runs.in_turn(build, {name: found[name][1] for name in cheapest}, rounds, folder)
    if measured:
        name = min(measured, key=lambda key: measured[key][0])
        seconds, run = measured[name]
        yield row(case, "equal error", name, seconds, run, error(case, run))
    else:
        print(f"{case.name}, {model}: none of the grid is right to {case.error:g}")


def row(case, kind, how, seconds, run, off):
    whole = case.whole / run.processor_seconds if case.whole else None
    print(f"{case.name:24}{kind:21}{run.unknowns:7}{run.steps:7}{1e3 * seconds:10.3g}{case.seconds / seconds:9.4g}"
          f"{'' if whole is None else format(whole, '.3g'):>8}{off:10.1e}  {how}", flush=True)
    return [case.name, case.program, case.seconds, case.error, kind, how, run.unknowns, run.steps, seconds,
            case.seconds / seconds, off, run.processor_seconds, whole, case.machine]


def picture(rows, file):
    names = list(dict.fromkeys(r[0] for r in rows))
    machines = {r[0]: r[13] for r in rows}
    kinds = {"esdirk4": "same size and steps, esdirk4", "genalpha": "same size and steps, genalpha"}
    figure, axes = plt.subplots(figsize=(9, 4.5), layout="constrained")
    series = {label: [next(r[9] for r in rows if r[0] == n and r[5] == how) for n in names]
              for how, label in kinds.items()}
    series["equal error, the same model"] = [
        max((r[9] for r in rows if r[0] == n and r[4] == "equal error" and not r[5].startswith(OFF_TRACK)), default=0)
        for n in names]
    series["equal error, " + OFF_TRACK] = [
        max((r[9] for r in rows if r[0] == n and r[5].startswith(OFF_TRACK)), default=0) for n in names]
    for i, (label, factors) in enumerate(series.items()):
        places = [x + 0.2 * (i - 1.5) for x, factor in enumerate(factors) if factor]
        bars = axes.bar(places, [factor for factor in factors if factor], 0.19, label=label)
        axes.bar_label(bars, fmt="%.0f", fontsize=7)
    axes.set(yscale="log", ylabel="the peer's wall time over ours")
    axes.set_xticks(range(len(names)), [f"{name}\n(peer on {machines[name]})" for name in names], fontsize=8)
    axes.grid(True, axis="y", alpha=0.4)
    axes.legend(fontsize=8, loc="upper right")
    figure.savefig(file, dpi=120)
    print(file)


def measured(build, folder, rounds, cases, off_track, narrowed):
    """Rows of the table; narrowed(grid): what is tried of a grid."""
    rows = []
    for case in cases:
        rows += same_size(build, folder, rounds, case)
    for case in cases:
        for model, options in case.models.items():
            rows += equal_error(build, folder, rounds, case, model, options, narrowed(case.grid))
    for case, options in off_track:
        rows += equal_error(build, folder, rounds, case, OFF_TRACK, options, narrowed(OFF_TRACK_GRID))
    return rows


def finest_of(grid):
    return {option: values[-1:] for option, values in grid.items()}


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("rounds", nargs="?", type=int, default=7, metavar="ROUNDS")
    given = runs.given(arguments)
    cases = timed_here(CASES, given.out)
    for case in cases:
        print(f"{case.name}: {case.program} took {case.seconds:g} s in its loop on {case.machine}"
              + (f", {case.whole:g} s in all" if case.whole else ""))
    print(f"{'':45}{'size':>7}{'steps':>7}{'ms':>10}{'factor':>9}{'whole':>8}{'error':>10}")
    with tempfile.TemporaryDirectory() as folder:
        if given.smallest:
            rows = measured(given.build, folder, 1, cases[0::2], [(cases[2], COACH_OFF_TRACK)], finest_of)
        else:
            off_track = [(cases[2], COACH_OFF_TRACK), (cases[3], COACHES_OFF_TRACK)]
            rows = measured(given.build, folder, given.rounds, cases, off_track, dict)
    runs.write_table(os.path.join(given.out, "peers.csv"),
                     ["case", "peer", "peer's seconds", "peer's error", "kind", "how", "unknowns", "steps", "seconds",
                      "factor", "error", "processor seconds", "factor of the whole", "the peer's machine"], rows)
    picture(rows, os.path.join(given.out, "peers.png"))


if __name__ == "__main__":
    main()
