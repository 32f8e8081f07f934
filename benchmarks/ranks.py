#!/usr/bin/python3
"""Prints what one and two ranks take: beam solves and steps of long bridges, and a small scene, where ranks do not pay.
/usr/bin/python3 benchmarks/ranks.py [BUILD_FOLDER] [OUT_FOLDER] [ROUNDS] [--smallest]

Medians of ROUNDS (5) rounds. Writes ranks.csv and ranks.png to OUT_FOLDER. Needs the program step_parts_benchmark.
"""

import csv
import os
import statistics
import subprocess
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import runs  # noqa: E402

UNKNOWNS, SMALLEST = 200_000, 1000  # of the bridge whose step's parts are taken
PART_ROUNDS = 15
PARTS = ["bare solve", "esdirk4 stage", "esdirk4 step", "genalpha step"]
OPTIONS = os.path.join(runs.ROOT, "options")
LONG, SHORT = "5,150 isolated spans, 16 coaches, every span stepped", "three spans, eight coaches"
TRAFFIC = "5,150 isolated spans, 11 trains each way, shared"
SCENES = {
    LONG: {
        "options_file": os.path.join(OPTIONS, "bridges", "danyang_kunshan.yml"),
        "vehicle_coach_file": os.path.join(OPTIONS, "vehicles", "s300.yml"),
        "train_vehicles": "coach*16", "train_speed": 83.333, "model_window": 0,
        "ts_dt": 1e-3, "ts_max_time": 10.0, "ts_max_steps": 200, "output_interval": 1.0},
    TRAFFIC: runs.two_way_traffic(5150, 11) | {
        "output_probes": "7504.0,12512.0", "ts_max_time": 300.0, "output_interval": 60.0},
    SHORT: {"options_file": runs.scene("three_span_train"), "beam_elements_per_span": 10, "ts_dt": 1e-3},
}
FEW_STEPS = {
    "3 isolated spans, 16 coaches, 50 steps": SCENES[LONG] | {"beam_spans": "32.0*3", "ts_max_time": 0.05},
    "200 isolated spans, a train each way, 10 steps": runs.two_way_traffic(200, 1, 60.0) | {
        "output_probes": 5040.0, "ts_max_time": 0.2, "output_interval": 0.1},
    f"{SHORT}, 50 steps": SCENES[SHORT] | {"ts_max_time": 0.05},
}


def parts(build, folder, ranks, unknowns, rounds):
    """Seconds of the parts of a step, on a continuous bridge of so many unknowns, twenty a span; medians of rounds."""
    file = os.path.join(folder, "parts.csv")
    program = runs.benchmark_program(build, "step_parts_benchmark")
    subprocess.run(runs.on_ranks(ranks) + [program, file, *map(str, (unknowns, unknowns, rounds))], check=True,
                   stdout=subprocess.DEVNULL, env=runs.environment())
    with open(file, newline="") as table:
        lines = [r for r in csv.DictReader(table) if r["bridge"] == "continuous" and r["part"] in PARTS]
    return {f"{r['part']}, {unknowns // 20:,} spans": float(r["seconds"]) for r in lines}


def taken_in(given, folder):
    """Seconds of every round: {name: {ranks: list}}."""
    unknowns, part_rounds, scenes = UNKNOWNS, PART_ROUNDS, SCENES
    if given.smallest:
        unknowns, part_rounds, scenes = SMALLEST, 1, FEW_STEPS
    taken = {}
    for _ in range(1 if given.smallest else given.rounds):
        for ranks in (1, 2):
            for name, seconds in parts(given.build, folder, ranks, unknowns, part_rounds).items():
                taken.setdefault(name, {1: [], 2: []})[ranks].append(seconds)
            for name, options in scenes.items():
                run = runs.Run(given.build, options, os.path.join(folder, "run.h5"), ranks)
                taken.setdefault(f"esdirk4 step, {name}", {1: [], 2: []})[ranks].append(run.seconds / run.steps)
    return taken


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("rounds", nargs="?", type=int, default=5, metavar="ROUNDS")
    given = runs.given(arguments, "step_parts_benchmark")
    with tempfile.TemporaryDirectory() as folder:
        taken = taken_in(given, folder)
    rows = []
    print(f"{'':68}{'1 rank, us':>12}{'2 ranks, us':>12}{'faster by':>11}")
    for name, times in taken.items():
        one, two = (statistics.median(times[ranks]) for ranks in (1, 2))
        rows.append([name, one, two, one / two])
        print(f"{name:68}{1e6 * one:12.4g}{1e6 * two:12.4g}{one / two:11.2f}")
    runs.write_table(os.path.join(given.out, "ranks.csv"), ["part", "1 rank, s", "2 ranks, s", "faster by"], rows)
    figure, axes = plt.subplots(figsize=(9, 3.5), layout="constrained")
    bars = axes.barh([r[0] for r in rows], [r[3] for r in rows])
    axes.bar_label(bars, fmt="%.2f")
    axes.axvline(1.0, color="grey", lw=0.8)
    axes.invert_yaxis()
    axes.set_xlabel("time on one rank over time on two")
    figure.savefig(os.path.join(given.out, "ranks.png"), dpi=120)
    print(os.path.join(given.out, "ranks.png"))


if __name__ == "__main__":
    main()
