#!/usr/bin/python3
"""Prints what one and two ranks take: beam solves and steps of long bridges, and a small scene, where ranks do not pay.
/usr/bin/python3 benchmarks/ranks.py [BUILD_FOLDER] [OUT_FOLDER] [ROUNDS]; writes ranks.csv and ranks.png to OUT_FOLDER."""

import csv
import os
import statistics
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import runs  # noqa: E402

UNKNOWNS = 200_000
PARTS = ["bare solve", "esdirk4 stage", "esdirk4 step", "genalpha step"]
OPTIONS = os.path.join(runs.ROOT, "options")
SCENES = {
    "5,150 isolated spans, 16 coaches, every span stepped": {
        "options_file": os.path.join(OPTIONS, "bridges", "danyang_kunshan.yml"),
        "vehicle_coach_file": os.path.join(OPTIONS, "vehicles", "s300.yml"),
        "train_vehicles": "coach*16", "train_speed": 83.333, "model_window": 0,
        "ts_dt": 1e-3, "ts_max_time": 10.0, "ts_max_steps": 200, "output_interval": 1.0},
    "three spans, eight coaches": {"options_file": runs.scene("three_span_train"), "ts_dt": 1e-3},
}


def parts(build, out, ranks):
    """Seconds of the parts of a step, on a continuous bridge of 10,000 spans."""
    file = os.path.join(out, "ranks_parts.csv")
    command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    command += [os.path.join(build, "benchmarks", "step_parts_benchmark"), file, str(UNKNOWNS), str(UNKNOWNS)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(file, newline="") as table:
        lines = [r for r in csv.DictReader(table) if r["bridge"] == "continuous" and r["part"] in PARTS]
    os.remove(file)
    return {r["part"]: float(r["seconds"]) for r in lines}


def main():
    build, out = runs.folders(sys.argv[1:3])
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    taken = {}
    for _ in range(rounds):
        for ranks in (1, 2):
            for name, seconds in parts(build, out, ranks).items():
                taken.setdefault(f"{name}, 10,000 spans", {1: [], 2: []})[ranks].append(seconds)
            for name, options in SCENES.items():
                run = runs.Run(build, options, os.path.join(out, "benchmark_run.h5"), ranks)
                taken.setdefault(f"esdirk4 step, {name}", {1: [], 2: []})[ranks].append(run.seconds / run.steps)
    os.remove(os.path.join(out, "benchmark_run.h5"))
    rows = []
    print(f"{'':68}{'1 rank, us':>12}{'2 ranks, us':>12}{'faster by':>11}")
    for name, times in taken.items():
        one, two = (statistics.median(times[ranks]) for ranks in (1, 2))
        rows.append([name, one, two, one / two])
        print(f"{name:68}{1e6 * one:12.4g}{1e6 * two:12.4g}{one / two:11.2f}")
    runs.write_table(os.path.join(out, "ranks.csv"), ["part", "1 rank, s", "2 ranks, s", "faster by"], rows)
    figure, axes = plt.subplots(figsize=(9, 3.5), layout="constrained")
    bars = axes.barh([r[0] for r in rows], [r[3] for r in rows])
    axes.bar_label(bars, fmt="%.2f")
    axes.axvline(1.0, color="grey", lw=0.8)
    axes.invert_yaxis()
    axes.set_xlabel("time on one rank over time on two")
    figure.savefig(os.path.join(out, "ranks.png"), dpi=120)
    print(os.path.join(out, "ranks.png"))


if __name__ == "__main__":
    main()
