#!/usr/bin/python3
"""Prints what a step of 1 ms and its parts take per unknown, 10 to 1,000,000 unknowns, stage over bare solve, and memory.
/usr/bin/python3 benchmarks/step_parts.py [BUILD_FOLDER] [OUT_FOLDER] [LARGEST] [--smallest]

LARGEST (1,000,000) is the number of unknowns to stop at. Writes step_parts.csv and step_parts.png to OUT_FOLDER. Needs the
program step_parts_benchmark.
"""

import csv
import os
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import runs  # noqa: E402


BRIDGES = ("continuous", "simply supported", "layered track")


def picture(lines, file):
    figure, all_axes = plt.subplots(1, len(BRIDGES), figsize=(15, 4.5), sharey=True, layout="constrained")
    for axes, bridge in zip(all_axes, BRIDGES):
        curves = {}
        for r in lines:
            if r["bridge"] == bridge:
                curves.setdefault(r["part"], []).append((int(r["unknowns"]), float(r["per_unknown"])))
        for i, (part, points) in enumerate(curves.items()):
            style = "-" if part.startswith("esdirk4") else "--" if part.startswith("genalpha") else ":"
            axes.loglog(*zip(*points), style, marker="o", markersize=3, label=part, color=f"C{i % 5}")
        axes.set(title=bridge, xlabel="unknowns")
        axes.grid(True, alpha=0.4)
    all_axes[0].set_ylabel("ns per unknown")
    all_axes[-1].legend(fontsize=7)
    figure.savefig(file, dpi=120)
    print(file)


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("largest", nargs="?", type=int, default=1_000_000, metavar="LARGEST")
    given = runs.given(arguments, "step_parts_benchmark")
    table = os.path.join(given.out, "step_parts.csv")
    program = runs.benchmark_program(given.build, "step_parts_benchmark")
    sizes = ["100", "10", "1"] if given.smallest else [str(given.largest)]
    subprocess.run([program, table, *sizes], check=True, env=runs.environment())
    with open(table, newline="") as file:
        lines = [r for r in csv.DictReader(file) if r["seconds"]]
    print("\nstage over bare solve, and cost of a step per unknown over that at 10,000 unknowns (or next to that)")
    for bridge in BRIDGES:
        of = {(int(r["unknowns"]), r["part"]): r for r in lines if r["bridge"] == bridge}
        sizes = sorted({size for size, part in of if part == "bare solve"})
        middle = min(sizes, key=lambda size: abs(size - 10_000))
        for size in sizes:
            words = f"{bridge:17}{size:9}"
            for name in ("esdirk4", "genalpha"):
                step = f"{name} step without vehicles"
                ratio = float(of[size, step]["per_unknown"]) / float(of[middle, step]["per_unknown"])
                words += f"   {name}: stage {float(of[size, name + ' stage']['of_bare_solve']):5.2f}, step {ratio:6.2f}"
            print(words)
    print(table)
    picture(lines, os.path.join(given.out, "step_parts.png"))


if __name__ == "__main__":
    main()
