#!/usr/bin/python3
"""Passages side by side in the lanes of vectors: what each takes, and how far its peaks are off.
/usr/bin/python3 benchmarks/lanes.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest] [--beside OTHER_BUILD_FOLDER]

Runs sweeps of moving forces (options/scenes/hslm_sweep.yml with one station, hslm_two_spans.yml with 41) and of eight
coaches (fifty_metre_train.yml by 20 elements, also under the limits of EN 1990) and of a coach on ballasted track (r8_ballasted_bridge.yml), in turn with
one, four and eight runs side by side on one rank, with eight on two, and the coaches' one by one too, which PETSc's TS then
drives; takes the quickest of several rounds. Peaks are held against those of a finer sweep: forces looked at 400 times a
period (sweep_instants), coaches with a quarter of the step and twice the elements. The error is the largest difference of
any run and station, over the largest of the run's stations.
--beside adds another build of the program, an older one say. Prints a table; writes lanes.csv.
"""

import os
import tempfile

import h5py
import numpy as np
import runs

FORCES = {"lanes": [1, 4, 8], "options": {}, "fine": {"sweep_instants": "400"}, "rounds": 9,
          "smallest": {"sweep_hslm_a": "1,9", "sweep_speed": "60,64,0.4"}}
COACHES = {"lanes": [0, 1, 4, 8], "rounds": 3,
           "options": {"sweep_speed": "77,84,1", "model_vehicles": "linear", "ts_dt": "6e-4",
                       "beam_elements_per_span": "20", "step_probes": "true"},
           "fine": {"ts_dt": "1.5e-4", "beam_elements_per_span": "40"},
           "smallest": {"train_vehicles": "coach", "sweep_speed": "77,84,7", "beam_elements_per_span": "6", "ts_dt": "2e-3"}}
BALLAST = {"lanes": [0, 1, 4, 8], "rounds": 3,
           "options": {"sweep_speed": "77,84,1", "model_vehicles": "linear", "ts_dt": "1e-3",
                       "track_elements_per_bay": "2", "step_probes": "true"},
           "fine": {"ts_dt": "2.5e-4", "track_elements_per_bay": "4"},
           "smallest": {"sweep_speed": "77,84,7", "track_elements_per_bay": "1", "ts_dt": "4e-3"}}
LIMITED = COACHES | {"lanes": [0, 8],
                     "options": COACHES["options"] | {"limits": os.path.join(runs.ROOT, "options", "limits", "en1990.yml")}}
SCENES = {"hslm_sweep": FORCES, "hslm_two_spans": FORCES, "fifty_metre_train": COACHES, "under limits": LIMITED,
          "r8_ballasted_bridge": BALLAST}
QUANTITIES = {"deflection": "peak_deflection", "acceleration": "peak_acceleration", "moment": "peak_moment",
              "wheel force": "greatest_wheel_force"}


def sweep(build, options, folder, ranks=1):
    """ms a passage, and the peaks as [train][speed][station], none where there are no wheels."""
    file = os.path.join(folder, "sweep.h5")
    run = runs.Run(build, options, file, ranks)
    with h5py.File(file) as results:
        stored = results["sweep"]
        peaks = {name: stored[of][...] for name, of in QUANTITIES.items() if of in stored}
    if "wheel force" in peaks:
        peaks["wheel force"] = peaks["wheel force"][..., np.newaxis]
    return 1e3 * run.seconds / peaks["deflection"][..., 0].size, peaks


def off(peaks, fine):
    return [(np.abs(peaks[name] - fine[name]) / fine[name].max(axis=2, keepdims=True)).max() if name in peaks else 0.0
            for name in QUANTITIES]


def measured(given, scene, how, folder):
    """Rows of the table."""
    options = {"options_file": runs.scene("fifty_metre_train" if how is LIMITED else scene)} | how["options"] | (how["smallest"] if given.smallest else {})
    cases = {f"{lanes} side by side" if lanes else "one by one": (given.build, {"sweep_lanes": lanes}, 1)
             for lanes in how["lanes"]}
    cases["8, two ranks"] = (given.build, {"sweep_lanes": 8}, 2)
    if given.beside:
        cases["the other build"] = (given.beside, {}, 1)
    _, fine = sweep(given.build, options | how["fine"], folder)
    taken, found = {name: [] for name in cases}, {}
    for _ in range(1 if given.smallest else how["rounds"]):
        for name, (build, own, ranks) in cases.items():
            ms, found[name] = sweep(build, options | own, folder, ranks)
            taken[name].append(ms)
    for name in cases:
        yield [scene, name, found[name]["deflection"][..., 0].size, min(taken[name]), *off(found[name], fine)]


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("--beside", metavar="OTHER_BUILD_FOLDER", help="another build, run in turn with this one")
    given = runs.given(arguments)
    print(f"{'':20}{'':18}{'passages':>10}{'ms each':>10}" + "".join(f"{name:>14}" for name in QUANTITIES))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for scene, how in SCENES.items():
            for row in measured(given, scene, how, folder):
                print("{:20}{:18}{:10}{:10.3g}".format(*row[:4]) + "".join(f"{e:14.1e}" for e in row[4:]), flush=True)
                rows.append(row)
    runs.write_table(os.path.join(given.out, "lanes.csv"),
                     ["scene", "runs", "passages", "ms each", *(f"error of {name}" for name in QUANTITIES)], rows)


if __name__ == "__main__":
    main()
