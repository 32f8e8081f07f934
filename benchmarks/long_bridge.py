#!/usr/bin/python3
"""Prints how much faster than the train 164.8 km of spans and 1,000 continuous spans are computed, with each run's error.
/usr/bin/python3 benchmarks/long_bridge.py [BUILD_FOLDER] [OUT_FOLDER] [SECONDS] [--smallest]

SECONDS of train time (10) of the long runs, 0: the whole crossing with what rests left out. Writes long_bridge.csv and
long_bridge.png to OUT_FOLDER.
"""

import os
import tempfile
from dataclasses import dataclass

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import runs  # noqa: E402

COACHES = {
    "vehicle_coach_file": os.path.join(runs.ROOT, "options", "vehicles", "s300.yml"), "train_spacing": 25.0, "train_speed": 83.333333,
    "support_types": "roller", "beam_EI": 3.795e11, "beam_mass": 3.0e4, "beam_damping_ratios": 0.02,
    "beam_elements_per_span": 10}
METHODS = {
    "esdirk4, 38 ms": {"ts_dt": 0.038, "step_kinks": "false"},
    "esdirk4, 20 ms": {"ts_dt": 0.02, "step_kinks": "false"},
    "genalpha, 4 ms": {"ts_type": "genalpha", "ts_dt": 4e-3, "step_kinks": "false"},
    "genalpha, 1 ms": {"ts_type": "genalpha", "ts_dt": 1e-3, "step_kinks": "false"}}


@dataclass
class Size:
    apart: int        # spans, each a beam of its own
    continuous: int   # spans
    coaches: int
    front: float      # m, of the train on the long bridges at the start, so that all of it is on them
    short: int        # spans of the bridge that errors are taken from
    probes: list      # m, midspans of it
    crossing: float   # s, on it
    methods: list     # of METHODS


WHOLE = Size(5150, 1000, 16, 420.0, 40, [48.0, 336.0, 656.0], 14.0, list(METHODS))
SMALLEST = Size(20, 10, 2, 60.0, 6, [48.0, 80.0, 112.0], 2.0, ["esdirk4, 20 ms", "genalpha, 4 ms"])


def bridge(size, spans, continuity):
    return COACHES | {"beam_spans": f"32.0*{spans}", "beam_continuity": continuity,
                      "train_vehicles": f"coach*{size.coaches}", "output_probes": ",".join(map(str, size.probes))}


def peak_errors(build, file, size, continuity, window):
    """Of the largest deflections at midspans of a short bridge, against esdirk4 at 1 ms with every span stepped."""
    short = bridge(size, size.short, continuity) | {"train_positions": -20.0, "ts_max_time": size.crossing}
    fine = {"ts_dt": 1e-3, "output_interval": 0.01, "model_window": 0}
    runs.Run(build, short | fine, file)
    exact = [runs.peak(file, i) for i in range(len(size.probes))]
    errors = {}
    for name in size.methods:
        method = METHODS[name]
        runs.Run(build, short | method | {"output_interval": method["ts_dt"], "model_window": window}, file)
        errors[name] = max(abs(runs.peak(file, i) / value - 1.0) for i, value in enumerate(exact))
    return errors


def cases_of(size):
    """Bridges: {name: (spans, continuity, window)}."""
    apart, continuous = f"{size.apart:,} spans apart", f"{size.continuous:,} spans continuous"
    return {f"{apart}, every span stepped": (size.apart, "simply_supported", 0),
            f"{apart}, what rests left out": (size.apart, "simply_supported", "auto"),
            f"{continuous}, every span stepped": (size.continuous, "continuous", 0),
            f"{continuous}, window 1e-4": (size.continuous, "continuous", 1e-4)}


def measured(build, file, size, cases, train):
    """Lines of the table: bridge, method, train time over computing time on one rank and on two, error."""
    for name, (spans, continuity, window) in cases.items():
        errors = peak_errors(build, file, size, continuity, window)
        for method in size.methods:
            options = METHODS[method]
            scene = bridge(size, spans, continuity) | train | options | {"model_window": window}
            factors = []
            for ranks in (1, 2):
                run = runs.Run(build, scene, file, ranks)
                factors.append(run.steps * options["ts_dt"] / run.seconds)
            print(f"{name:46}{method:16}{factors[0]:9.1f}{factors[1]:9.1f}{errors[method]:34.1e}", flush=True)
            yield [name, method, *factors, errors[method]]


def picture(rows, file):
    figure, axes = plt.subplots(figsize=(10, 5), layout="constrained")
    for i, ranks in enumerate(("1 rank", "2 ranks")):
        bars = axes.barh([y + 0.4 * i for y in range(len(rows))], [r[2 + i] for r in rows], 0.4, label=ranks)
        axes.bar_label(bars, fmt="%.1f", fontsize=7)
    axes.set_yticks([y + 0.2 for y in range(len(rows))], [f"{r[0]}: {r[1]}" for r in rows], fontsize=8)
    axes.axvline(1.0, color="grey", lw=0.8)
    axes.invert_yaxis()
    axes.set_xlabel("train time over computing time")
    axes.legend()
    figure.savefig(file, dpi=120)
    print(file)


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("seconds", nargs="?", type=float, default=10.0, metavar="SECONDS")
    given = runs.given(arguments)
    size, seconds = (SMALLEST, 0.5) if given.smallest else (WHOLE, given.seconds)
    cases = cases_of(size)
    if seconds > 0.0:
        train = {"train_positions": size.front, "output_interval": seconds, "ts_max_time": seconds}
    else:
        train = {"train_positions": -20.0, "output_interval": 1.0}
        cases = {name: case for name, case in cases.items() if case[2] == "auto"}
    print(f"{'':46}{'':16}{'1 rank':>9}{'2 ranks':>9}   times real time{'peaks wrong by':>17}")
    with tempfile.TemporaryDirectory() as folder:
        rows = list(measured(given.build, os.path.join(folder, "run.h5"), size, cases, train))
    runs.write_table(os.path.join(given.out, "long_bridge.csv"),
                     ["bridge", "method", "times real time, 1 rank", "2 ranks", "peaks wrong by"], rows)
    picture(rows, os.path.join(given.out, "long_bridge.png"))


if __name__ == "__main__":
    main()
