#!/usr/bin/python3
"""Prints by how much the results of two long bridges on 2, 4 and 8 ranks differ from those on one: every rank takes steps.
/usr/bin/python3 benchmarks/same_on_ranks.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest]

1,000 continuous spans under sixteen coaches, 0.1 s, and eleven trains each way on separate spans, which ranks share, 4 s in which they
meet. There may be fewer cores than ranks: the results are what counts.
Writes same_on_ranks.csv to OUT_FOLDER.
"""

import os
import tempfile

import h5py
import numpy as np
import runs

RANKS = (2, 4, 8)
GROUPS = ("probes", "supports", "vehicles")
TRAFFIC = {"output_probes": "5040.0,5104.0", "output_interval": 0.1}


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
    """The largest over all series, of the largest value of the same quantity of any of them."""
    largest = {}
    for name, values in one.items():
        quantity = name.split("/")[-1]
        largest[quantity] = max(largest.get(quantity, 0.0), float(np.abs(values).max()))
    return max(float(np.abs(one[name] - other[name]).max() / (largest[name.split("/")[-1]] or 1.0)) for name in one)


def main():
    given = runs.given(runs.parser(__doc__))
    scenes = {"one bridge, divided": scene(12, 2, 20) if given.smallest else scene(1000, 16, 100),
              "trains, shared": TRAFFIC | (runs.two_way_traffic(200, 1, 60.0) | {"ts_max_time": 0.5} if given.smallest
                                           else runs.two_way_traffic(5150, 11, 60.0) | {"ts_max_time": 4.0})}
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        print(f"{'':22}{'ranks':>5}{'deflections differ by':>24}{'all series differ by':>26}")
        for name, options in scenes.items():
            one = series(runs.Run(given.build, options, os.path.join(folder, "1.h5")).file)
            for ranks in RANKS:
                other = series(runs.Run(given.build, options, os.path.join(folder, f"{ranks}.h5"), ranks).file)
                deflection = difference({"d": one["probes/deflection"]}, {"d": other["probes/deflection"]})
                rows.append([name, ranks, deflection, difference(one, other)])
                print(f"{name:22}{ranks:5}{rows[-1][2]:24.1e}{rows[-1][3]:26.1e}  of {len(one)}")
    runs.write_table(os.path.join(given.out, "same_on_ranks.csv"),
                     ["scene", "ranks", "deflections differ by", "all series differ by"], rows)


if __name__ == "__main__":
    main()
