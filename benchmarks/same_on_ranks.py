#!/usr/bin/python3
"""Prints by how much the results of one long bridge on 2, 4 and 8 ranks differ from those on one: every rank takes steps.
/usr/bin/python3 benchmarks/same_on_ranks.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest]

1,000 continuous spans under sixteen coaches, 0.1 s. There may be fewer cores than ranks: the results are what counts.
Writes same_on_ranks.csv to OUT_FOLDER.
"""

import os
import tempfile

import h5py
import numpy as np
import runs

RANKS = (2, 4, 8)
GROUPS = ("probes", "supports", "vehicles")


def scene(spans, coaches, steps):
    """The train across the middle, where ranks meet; probes at midspans below it."""
    middle = 16.0 * spans
    probes = [middle + 16.0 + 32.0 * span for span in range(-coaches // 2, coaches // 2)]
    return {
        "beam_spans": f"32.0*{spans}", "beam_EI": 3.795e11, "beam_mass": 3.0e4, "beam_damping_ratios": 0.02,
        "beam_elements_per_span": 10, "beam_continuity": "continuous", "support_types": "roller",
        "vehicle_coach_file": os.path.join(runs.ROOT, "options", "vehicles", "s300.yml"),
        "train_vehicles": f"coach*{coaches}", "train_speed": 83.333333, "train_positions": middle + 12.5 * coaches,
        "train_spacing": 25.0, "output_probes": ",".join(map(str, probes)), "step_ranks": "all",
        "ts_dt": 1e-3, "ts_max_time": 1e-3 * steps, "output_interval": 1e-3}


def series(file):
    """Every series of the groups, by name."""
    found = {}

    def take(name, item):
        if isinstance(item, h5py.Dataset) and item.ndim and item.dtype.kind == "f" and name.split("/")[0] in GROUPS:
            found[name] = item[:]

    with h5py.File(file) as results:
        results.visititems(take)
    return found


def difference(one, other):
    """The largest over the series of the same quantity, of its largest value."""
    return max(float(np.abs(one[name] - other[name]).max() / (np.abs(one[name]).max() or 1.0)) for name in one)


def main():
    given = runs.given(runs.parser(__doc__))
    options = scene(12, 2, 20) if given.smallest else scene(1000, 16, 100)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        one = series(runs.Run(given.build, options, os.path.join(folder, "1.h5")).file)
        print(f"{'ranks':>5}{'deflections differ by':>24}{f'{len(one)} series differ by':>26}")
        for ranks in RANKS:
            other = series(runs.Run(given.build, options, os.path.join(folder, f"{ranks}.h5"), ranks).file)
            deflection = difference({"d": one["probes/deflection"]}, {"d": other["probes/deflection"]})
            rows.append([ranks, deflection, difference(one, other)])
            print(f"{ranks:5}{rows[-1][1]:24.1e}{rows[-1][2]:26.1e}")
    runs.write_table(os.path.join(given.out, "same_on_ranks.csv"),
                     ["ranks", "deflections differ by", "all series differ by"], rows)


if __name__ == "__main__":
    main()
