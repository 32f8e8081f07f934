#!/usr/bin/python3
"""Draws what the program beam_solver_benchmark has written: ns per unknown over the number of unknowns, of each solver.
/usr/bin/python3 benchmarks/beam_solver_picture.py FILE.csv [PICTURE.png]; left out: FILE.png."""

import csv
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

table = sys.argv[1]
picture = sys.argv[2] if len(sys.argv) > 2 else table.removesuffix(".csv") + ".png"

lines = defaultdict(list)
with open(table, newline="") as rows:
    for row in csv.DictReader(rows):
        lines[row["solver"]].append((int(row["unknowns"]), float(row["ns_per_unknown"])))

figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
for solver, points in lines.items():
    style = dict(linestyle="--", color="grey") if solver == "moving it" else dict(marker="o", markersize=4)
    axes.loglog(*zip(*points), label="moving the numbers" if solver == "moving it" else solver, **style)
axes.set(xlabel="unknowns", ylabel="ns per unknown and solve")
axes.set_title("Continuous beam, two unknowns a node, one core", fontsize=10)
axes.grid(True, which="major", alpha=0.4)
axes.legend(loc="upper right", fontsize=8)
figure.savefig(picture, dpi=150)
print(picture)
