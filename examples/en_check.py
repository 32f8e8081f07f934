# %% [markdown]
# A prestressed concrete bridge of 28 m fails the dynamic check by EN 1991-2. What has to change: its mass, its stiffness,
# or both? doc/guide/example_en_check.md explains the steps and the numbers that this file prints.
#
#     PYTHONPATH=python:scripts /usr/bin/python3 examples/en_check.py [FOLDER] [--quick]
#
# --quick draws no figure; the numbers are the same.

# %%
import argparse
import math
import pathlib

import matplotlib.pyplot as plt
import numpy as np
from engineering_units import shown

import traverse

arguments = argparse.ArgumentParser()
arguments.add_argument("folder", nargs="?", default="results", help="of the results files and the figure")
arguments.add_argument("--quick", action="store_true", help="draw no figure")
given = arguments.parse_args()
folder = pathlib.Path(given.folder)
folder.mkdir(exist_ok=True)

SPAN = 28.0  # m
DEPTH, EI, MASS = 1.8, 6.8e10, 1.8e4  # m, N m2, kg/m: of the planned girder
LIMIT = 3.5  # m/s2, the first limit of the file that is checked
LIMITS = str(pathlib.Path("options/limits/en1991_2.yml").resolve())
KMH, PER_METRE, METRES = (shown(quantity)[1] for quantity in ("speed", "mass_per_length", "moment"))


def scene(stiffness=EI, mass=MASS):
    return {"beam": {"spans": SPAN, "EI": stiffness, "mass": mass}, "support": {"types": ["pinned", "roller"]},
            "model": {"modes": 3, "damping_bound": "prestressed"},
            "sweep": {"speed": ["144 km/h", "300 km/h", "2 km/h"], "hslm_a": list(range(1, 11))},
            "scene": {"tail": 1.0}, "output": {"probes": [7.0, 11.2, 14.0, 16.8]}}


def first_frequency(stiffness, mass):
    return math.pi / (2.0 * SPAN**2) * np.sqrt(stiffness / mass)


def check(name, stiffness, mass):
    """The check by EN 1991-2 and EN 1990 with all limits; prints its outcome."""
    result = traverse.run(scene(stiffness, mass) | {"norm": {"load_models": "lm71", "track": "careful"}},
                          output=folder / f"en_check_{name}.h5", limits=LIMITS)
    clauses, words = result["verdicts_clause"].values[:, 0], result["verdicts_quantity"].values[:, 0]
    for clause, word, verdict, value, limit in zip(clauses, words, result["verdicts_verdict"].values[:, 0],
                                                   result["verdicts_value"].values, result["verdicts_limit"].values):
        if verdict != "not judged":
            print(f"  {clause} {word}: {value:.3g}, limit {limit:.3g}: {verdict}")
    for effect, ratio in zip(result["norm_effect"].values[:, 0], result["norm_train_over_model"].values):
        print(f"  {effect}: trains over LM71 with Phi {ratio:.2f}")
    return result


def vary(words, stiffness, mass):
    """The largest accelerations at the resonances, for pairs of stiffness and mass; prints them."""
    scenes = scene()
    scenes["study"] = {"combine": "together", "vary": {"beam_EI": list(stiffness), "beam_mass": list(mass)}}
    peaks = abs(traverse.study(scenes)["peak_acceleration"])
    largest = peaks.max([name for name in peaks.dims if name != "row"]).values
    for word, frequency, value in zip(words, first_frequency(np.array(stiffness), np.array(mass)), largest):
        print(f"  {word}: f1 = {frequency:.2f} Hz, largest acceleration {value:.2f} m/s2")
    return largest


# %% The planned bridge: which limit does it exceed?
print(f"planned: f1 = {first_frequency(EI, MASS):.2f} Hz")
planned = check("planned", EI, MASS)
print(planned)
