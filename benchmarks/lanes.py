#!/usr/bin/python3
"""Passages of moving forces side by side in the lanes of vectors: what each takes, and how far its peaks are off.
/usr/bin/python3 benchmarks/lanes.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest] [--beside OTHER_BUILD_FOLDER]

Runs the sweeps of options/scenes/hslm_sweep.yml (one station) and hslm_two_spans.yml (41) with one, four and eight runs
side by side on one rank, in turn, and takes the quickest of several rounds. Peaks are held against those of the same
sweep looked at 400 times a period (sweep_instants): the largest difference of any run and station, over the largest of
the run's stations. --beside adds another build of the program, an older one say. Prints a table; writes lanes.csv.
"""

import os
import tempfile

import h5py
import numpy as np
import runs

SCENES = ["hslm_sweep", "hslm_two_spans"]
LANES = [1, 4, 8]
QUANTITIES = ["deflection", "acceleration", "moment"]
FINE = {"sweep_instants": "400"}
SMALLEST = {"sweep_hslm_a": "1,9", "sweep_speed": "60,64,0.4"}
ROUNDS = 9


def sweep(build, options, folder):
    """ms a passage, and the peaks as [train][speed][station]."""
    file = os.path.join(folder, "sweep.h5")
    run = runs.Run(build, options, file)
    with h5py.File(file) as results:
        peaks = {name: results["sweep/peak_" + name][...] for name in QUANTITIES}
    return 1e3 * run.seconds / peaks["deflection"][..., 0].size, peaks


def off(peaks, fine):
    return [(np.abs(peaks[name] - fine[name]) / fine[name].max(axis=2, keepdims=True)).max() for name in QUANTITIES]


def measured(given, scene, options, folder):
    """Rows of the table."""
    options = {"options_file": runs.scene(scene)} | options
    cases = {f"{lanes} side by side": (given.build, {"sweep_lanes": lanes}) for lanes in LANES}
    if given.beside:
        cases["the other build"] = (given.beside, {})
    _, fine = sweep(given.build, options | FINE, folder)
    taken, found = {name: [] for name in cases}, {}
    for _ in range(1 if given.smallest else ROUNDS):
        for name, (build, own) in cases.items():
            ms, found[name] = sweep(build, options | own, folder)
            taken[name].append(ms)
    for name in cases:
        yield [scene, name, found[name]["deflection"][..., 0].size, min(taken[name]), *off(found[name], fine)]


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("--beside", metavar="OTHER_BUILD_FOLDER", help="another build, run in turn with this one")
    given = runs.given(arguments)
    print(f"{'':16}{'':18}{'passages':>10}{'ms each':>10}" + "".join(f"{name:>14}" for name in QUANTITIES))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for scene in SCENES:
            for row in measured(given, scene, SMALLEST if given.smallest else {}, folder):
                print("{:16}{:18}{:10}{:10.3g}".format(*row[:4]) + "".join(f"{e:14.1e}" for e in row[4:]), flush=True)
                rows.append(row)
    runs.write_table(os.path.join(given.out, "lanes.csv"),
                     ["scene", "runs", "passages", "ms each", *(f"error of {name}" for name in QUANTITIES)], rows)


if __name__ == "__main__":
    main()
