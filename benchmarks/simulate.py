#!/usr/bin/python3
"""Runs from Python in one process, against the same study by the program.
/usr/bin/python3 benchmarks/simulate.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest]

A force, and a quarter car, cross a bridge of 25 m at 1,000 speeds: traverse.simulate of 1,000 problems, whose making
counts too, and traverse.study, which starts the program and reads its results file. Prints the seconds of both, the
median of three in turns, their ratio and the greatest difference of the deflections; writes simulate.csv to OUT_FOLDER.
"""

import os
import statistics
import sys
import time
import warnings

import numpy as np
import runs

BRIDGE = {"beam": {"spans": [25.0], "EI": 2.8e10, "mass": 1.5e4, "damping_ratios": 0.01}}
QUARTER_CAR = {
    "bodies": ["wheel", "body"], "joints": ["guide"], "springs": ["suspension"], "drivers": ["level"], "wheels": ["tyre"],
    "wheel": {"mass": 1000.0, "inertia": 100.0, "position": [0.0, 0.46]},
    "body": {"mass": 9000.0, "inertia": 100.0, "position": [0.0, 1.5]},
    "guide": {"type": "prismatic", "bodies": ["wheel", "body"], "point": [0.0, 1.0], "axis": [0.0, 1.0]},
    "suspension": {"bodies": ["wheel", "body"], "from": [0.0, 0.46], "to": [0.0, 1.5], "stiffness": 1.6e6, "damping": 2e4},
    "level": {"body": "wheel", "coordinate": "phi", "value": 0.0},
    "tyre": {"body": "wheel", "radius": 0.46, "law": "linear", "stiffness": 1e9}}
CASES = {"force": ({"load": {"forces": 1e5}}, "load_speed"),
         "quarter car": ({"vehicle": {"quarter": QUARTER_CAR}, "train": {"vehicles": "quarter"}}, "train_speed")}


def main():
    given = runs.given(runs.parser(__doc__))
    os.environ["TRAVERSE_BINARY"] = os.path.abspath(runs.traverse(given.build))
    sys.path.insert(0, os.path.join(runs.ROOT, "python"))
    import traverse

    warnings.simplefilter("ignore", traverse.UnusualInput)
    speeds = np.linspace(20.0, 80.0, 20 if given.smallest else 1000)

    def simulated(scene, option):
        return traverse.simulate([traverse.Problem(scene, **{option: speed}) for speed in speeds])

    def studied(scene, option):
        return traverse.study(scene, {option: speeds.tolist()})

    rows = []
    for name, (crossing, option) in CASES.items():
        scene, seconds, found = BRIDGE | crossing, {simulated: [], studied: []}, {}
        for _ in range(1 if given.smallest else 3):
            for call in seconds:
                begin = time.perf_counter()
                found[call] = call(scene, option)["peak_deflection"].values
                seconds[call].append(time.perf_counter() - begin)
        one, other = (statistics.median(seconds[call]) for call in (simulated, studied))
        difference = float(abs(found[simulated] / found[studied] - 1.0).max())
        rows.append([name, len(speeds), f"{one:.4g}", f"{other:.4g}", f"{one / other:.3g}", f"{difference:.1e}"])
        print(f"{name:12} {len(speeds)} runs: simulate {one:.3g} s, study {other:.3g} s, ratio {one / other:.2f}, "
              f"difference {difference:.0e}")
    file = os.path.join(given.out, "simulate.csv")
    runs.write_table(file, ["case", "runs", "seconds by simulate", "seconds by study", "ratio", "difference"], rows)
    print(file)


if __name__ == "__main__":
    main()
