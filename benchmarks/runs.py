"""Runs of the program for the benchmarks here: what a run took, how large it was, and its peaks."""

import csv
import os
import re
import statistics
import subprocess
import time

import h5py
import numpy as np

PEAKS = {"deflection": "deflection", "acceleration": "acceleration", "moment": "moment",
         "wheel force": "greatest_wheel_force"}
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def scene(name):
    return os.path.join(ROOT, "options", "scenes", name + ".yml")


def folders(arguments):
    """Where the program is and where tables and pictures go: arguments [BUILD_FOLDER] [OUT_FOLDER]."""
    build = arguments[0] if arguments else os.path.join(ROOT, "build")
    out = arguments[1] if len(arguments) > 1 else os.path.join(ROOT, "results")
    os.makedirs(out, exist_ok=True)
    return build, out


def words(options):
    return [part for name, value in options.items() for part in ("-" + name, str(value))]


class Run:
    """One run: seconds of its time loop and of the whole process, steps, unknowns, and the results file."""

    def __init__(self, build, options, file, ranks=1):
        command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
        command += [os.path.join(build, "traverse")] + words(options | {"output_file": file, "output_quiet": "true"})
        begin = time.monotonic()
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.process_seconds = time.monotonic() - begin
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}\n{done.stdout}")
        self.text = done.stdout
        self.unknowns = unknowns(done.stdout)
        self.file = file
        with h5py.File(file) as results:
            self.seconds = float(results.attrs["wall_seconds"])
            self.steps = int(results.attrs["steps"])


def unknowns(text):
    """Of all nodes, held ones included, of sleepers, ballast and vehicles, from what the program says it modelled."""

    def number(pattern):
        found = re.search(pattern, text)
        return int(found.group(1)) if found else 0

    spans = number(r"(\d+) spans? \(each of its own\)") or 1
    per_node = number(r"elements, (\d+) unknowns a node") or 2
    total = per_node * (number(r"spans?[^,]*, (\d+) elements") + spans) + number(r"degrees of freedom (\d+)")
    track = re.search(r"track from (\S+) to (\S+) m: rail with (\d+) elements, sleepers every (\S+) m", text)
    if track:
        length, elements, spacing = float(track[2]) - float(track[1]), int(track[3]), float(track[4])
        bridge = float(re.search(r"beam of (\S+) m", text)[1])
        sleepers = round(length / spacing) + 1
        total += 2 * (elements + 1) + sleepers + round((length - bridge) / spacing)  # ballast moves on the ground only
    return total


def peak(file, probe=None):
    """The largest deflection at a probe (or the first): between samples the cubic through deflections and velocities."""
    with h5py.File(file) as results:
        t = results["time"][:]
        v = results["probes/deflection"][: len(t), probe or 0]
        w = results["probes/velocity"][: len(t), probe or 0]
    at = np.linspace(0.0, 1.0, 21)[1:-1, None]
    h = np.diff(t)
    between = ((1 + 2 * at) * (1 - at) ** 2 * v[:-1] + at**2 * (3 - 2 * at) * v[1:]
               + at * (1 - at) * h * ((1 - at) * w[:-1] - at * w[1:]))
    values = np.concatenate([v, between.ravel()])
    return float(values[np.abs(values).argmax()])


def peaks(file):
    """What the run says were its greatest deflection, acceleration, moment and wheel force, without signs."""
    with h5py.File(file) as results:
        summary = results["summary"].attrs
        found = {name: abs(float(summary.get(key, 0.0))) for name, key in PEAKS.items()}
    return {name: value for name, value in found.items() if value > 0.0}


def in_turn(build, cases, rounds, out, ranks=1):
    """Runs every case once a round, so that what else the machine does meets all alike: medians of seconds, by name.

    cases: {name: options}; ranks: a number, or {name: number}. Returns {name: (median seconds, last Run)}.
    """
    taken, last = {name: [] for name in cases}, {}
    for _ in range(rounds):
        for name, options in cases.items():
            count = ranks[name] if isinstance(ranks, dict) else ranks
            last[name] = Run(build, options, os.path.join(out, "benchmark_run.h5"), count)
            taken[name].append(last[name].seconds)
    return {name: (statistics.median(taken[name]), last[name]) for name in cases}


def write_table(file, header, rows):
    with open(file, "w", newline="") as table:
        writer = csv.writer(table)
        writer.writerow(header)
        writer.writerows(rows)
    print(file)
