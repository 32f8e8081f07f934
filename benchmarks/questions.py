#!/usr/bin/env python3
"""Times searches and sensitivity analyses on two ranks: the least stiffness of a bridge for ten trains HSLM-A from 100 to
300 km/h (options/studies/least_stiffness.yml), and Sobol' indices of six properties for ten trains and 40 speeds
(options/studies/sensitivity.yml).

Writes questions.csv: question, number of runs, seconds by the clock, and the answer: the end of the interval in N m2 with
its relative distance to the neighbouring value that exceeds the limit, or the largest half width of the intervals of the
total indices of the acceleration.
"""

import os
import subprocess
import tempfile
import time

import h5py
import numpy

import runs

STUDIES = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "options", "studies")
TRAINS = "1,2,3,4,5,6,7,8,9,10"


def computed(program, folder, study, ranks, *words):
    """Seconds of a study by the clock, and its results file."""
    results = os.path.join(folder, "results.h5")
    begin = time.perf_counter()
    subprocess.run([*runs.on_ranks(ranks), program, "-options_file", os.path.join(STUDIES, study), "-output_file", results,
                    "-output_quiet", *words], check=True, stdout=subprocess.DEVNULL, env=runs.environment())
    return time.perf_counter() - begin, h5py.File(results)


def search(program, folder, ranks, smallest):
    words = ("-sweep_hslm_a", "9,10", "-sweep_speed", "70,84,2") if smallest else ()
    seconds, file = computed(program, folder, "least_stiffness.yml", ranks, *words)
    with file:
        end, values = file["find/interval"][0, 0], file["find/value"][:]
        below = values[values < end][-1]
        return {"question": "least EI", "runs": file["summary"].attrs["runs"], "seconds": f"{seconds:.2f}",
                "answer": f"{end:.6g}", "uncertainty": f"{(end - below) / end:.2e}"}


def sobol(program, folder, ranks, smallest):
    words = ("-study_draws", "8") if smallest else ("-study_draws", "1000", "-sweep_hslm_a", TRAINS,
                                                    "-sweep_speed", "40,79,1")
    seconds, file = computed(program, folder, "sensitivity.yml", ranks, *words)
    with file:
        row = list(file["quantity"].asstr()[:]).index("peak_acceleration")
        total, low, high = (file[f"sensitivity/total{end}"][row] for end in ("", "_low", "_high"))
        return {"question": "Sobol' indices", "runs": file["summary"].attrs["runs"], "seconds": f"{seconds:.2f}",
                "answer": f"{total.max():.4g}", "uncertainty": f"{numpy.max(high - low) / 2.0:.2e}"}


def main():
    chosen = runs.given(runs.parser(__doc__))
    program = runs.traverse(os.path.abspath(chosen.build))
    ranks = 1 if chosen.smallest else 2
    rows = []
    for question in (search, sobol):
        with tempfile.TemporaryDirectory() as folder:
            rows.append(question(program, folder, ranks, chosen.smallest))
        print("  ".join(f"{name} {value}" for name, value in rows[-1].items()))
    runs.write_table(os.path.join(chosen.out, "questions.csv"), rows[0].keys(), [row.values() for row in rows])


if __name__ == "__main__":
    main()
