#!/usr/bin/python3
"""Whether every run of a sweep keeps what -accuracy promises: scenes drawn at random, each at eight speeds.
/usr/bin/python3 benchmarks/sweep_promises.py [BUILD_FOLDER] [OUT_FOLDER] [--drawn FIRST LAST] [--smallest]

Every run's greatest peaks are compared with those of a sweep by elements with the mechanisms, whose step and mesh are
halved until no peak changes by more than a quarter of the accuracy; a peak that does not get there is not judged.
Prints, for every scene and accuracy, the largest true error of what is promised over the accuracy, of which run and
quantity, and how the sweep was computed. Writes sweep_promises.csv. --smallest takes one scene.
"""

import os
import re
import tempfile
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np
import runs
from scene_texts import drawn

QUANTITIES = {"deflection": "peak_deflection", "acceleration": "peak_acceleration", "moment": "peak_moment",
              "wheel force": "greatest_wheel_force"}
ACCURACIES = [1e-2, 1e-3]
SPEEDS, SLOWEST, FASTEST = 8, 0.7, 1.05  # times the scene's own
REFERENCE = (32, 5e-4)                   # elements in the longest span and s, halved
MOST_HALVINGS, LONGEST = 5, 90.0         # s of a reference
JUDGED = 0.25                            # of the accuracy may be in doubt
HEADER = ["scene", "accuracy", "worst", "of", "speed", "judged", "broken", "not promised", "chosen"]


def peaks(file):
    """Of every run: the largest one of all probes."""
    with h5py.File(file) as results:
        sweep = results["sweep"]
        found = {q: sweep[name][0] for q, name in QUANTITIES.items() if name in sweep}
        return {q: p.max(axis=1) if p.ndim == 2 else p for q, p in found.items()}


def promised(file):
    """Which runs keep the accuracy, and of which quantities."""
    with h5py.File(file) as results:
        errors = results["summary"].attrs
        named = [q for q in QUANTITIES if "expected_error_" + q.replace(" ", "_") in errors]
        return results["sweep/promised"][0] == 1 if named else np.zeros(SPEEDS, bool), named


def reference(build, options, file):
    """Peaks, and how far off each may be: what halving step and elements once more has changed."""
    (elements, step), before = REFERENCE, {}
    for _ in range(MOST_HALVINGS):
        run = runs.Run(build, options | {"beam_elements_per_span": elements, "ts_dt": step, "step_probes": "true",
                                         "sweep_lanes": 0, "model_vehicles": "full", "contact_seats": "true"}, file)
        found = peaks(file)
        doubt = {q: np.abs(before[q] / p - 1.0) if before else np.ones(SPEEDS) for q, p in found.items()}
        if all((d < JUDGED * ACCURACIES[-1]).all() for d in doubt.values()) or 4.0 * run.process_seconds > LONGEST:
            break
        before, elements, step = found, 2 * elements, 0.5 * step
    return found, doubt


def judge(build, name, text, accuracies):
    """Rows of the table."""
    speed = float(re.search(r"\bspeed: *([0-9.]+)", text)[1])
    slowest, step = round(SLOWEST * speed, 3), round((FASTEST - SLOWEST) * speed / (SPEEDS - 1), 3)
    speeds = slowest + step * np.arange(SPEEDS)
    with tempfile.TemporaryDirectory() as folder:
        scene, file = os.path.join(folder, "scene.yml"), os.path.join(folder, "sweep.h5")
        with open(scene, "w") as written:
            written.write(text)
        options = {"options_file": scene, "sweep_speed": f"{slowest:.3f},{speeds[-1]:.3f},{step:.3f}"}
        truth, doubt = reference(build, options, file)
        for accuracy in accuracies:
            run = runs.Run(build, options | {"accuracy": accuracy}, file)
            found, (keeps, named) = peaks(file), promised(file)
            of, worst, where, judged, broken = "", 0.0, 0.0, 0, 0
            for q in truth.keys() & named:
                errors = np.abs(found[q] / truth[q] - 1.0) / accuracy
                counts = keeps & (doubt[q] <= JUDGED * accuracy)
                judged += counts.sum()
                broken += (errors[counts] > 1.0).sum()
                if counts.any() and errors[counts].max() > worst:
                    of, worst, where = q, errors[counts].max(), speeds[np.where(counts, errors, 0.0).argmax()]
            chosen = re.search(r"((batched runs|all runs|accuracy [^:]*): .*)", run.text)
            yield [name, accuracy, worst, of, where, judged, broken, "; ".join(q for q in truth if q not in named),
                   chosen[0] if chosen else ""]


def show(name, accuracy, worst, of, speed, judged, broken, refused, chosen):
    print(f"{name:42}{accuracy:7.0e}{worst:8.2f} {of:13}{speed:7.1f} m/s {judged:4} judged{broken:4} broken  {chosen}"
          + (f"; error not estimated: {refused}" if refused else ""), flush=True)


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("--drawn", nargs=2, type=int, default=[0, 39], metavar=("FIRST", "LAST"))
    given = runs.given(arguments)
    first, last = (2, 2) if given.smallest else given.drawn
    accuracies = ACCURACIES[:1] if given.smallest else ACCURACIES
    rows = []
    with ThreadPoolExecutor(2) as pool:
        scenes = [drawn(i) for i in range(first, last + 1)]
        for some in pool.map(lambda scene: list(judge(given.build, *scene, accuracies)), scenes):
            for row in some:
                show(*row)
            rows += some
    judged, broken = sum(row[5] for row in rows), sum(row[6] for row in rows)
    print(f"{judged - broken} of {judged} peaks of single runs that are promised and could be judged keep it")
    runs.write_table(os.path.join(given.out, "sweep_promises.csv"), HEADER, rows)


if __name__ == "__main__":
    main()
