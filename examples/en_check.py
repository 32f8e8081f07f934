# %% [markdown]
# A prestressed concrete bridge of 28 m fails the dynamic check by EN 1991-2. Does more mass help, more stiffness, or a
# deeper girder? doc/guide/example_en_check.md explains the steps and the numbers that this file prints.
#
#     PYTHONPATH=python:scripts /usr/bin/python3 examples/en_check.py [FOLDER] [--quick]
#
# --quick draws no figure; the numbers are the same.

# %%
import argparse
import math
import pathlib

import matplotlib.pyplot as plt
from engineering_units import shown

import traverse

parser = argparse.ArgumentParser()
parser.add_argument("folder", nargs="?", default="results", help="of the results files and the figure")
parser.add_argument("--quick", action="store_true", help="draw no figure")
arguments = parser.parse_args()
folder = pathlib.Path(arguments.folder)
folder.mkdir(exist_ok=True)

SPAN = 28.0  # m
EI, MASS = 6.8e10, 1.8e4  # N m2, kg/m, of the planned girder with ballast and track
DEPTH, DEEPER = 1.7, 2.8  # m, of the planned and of the changed girder


def unit(quantity, value):
    """A value in SI units, in those that engineers use."""
    word, factor = shown(quantity)
    return f"{value * factor:.{0 if value * factor >= 1000 else 1}f} {word}"


def scene(stiffness, mass):
    """HSLM-A from 40 m/s to 1.2 times the line speed of 250 km/h."""
    return {"beam": {"spans": SPAN, "EI": stiffness, "mass": mass}, "support": {"types": ["pinned", "roller"]},
            "model": {"modes": 3, "damping_bound": "prestressed"}, "scene": {"tail": 1.0},
            "sweep": {"speed": ["144 km/h", "300 km/h", "2 km/h"], "hslm_a": list(range(1, 11))},
            "output": {"probes": [8.4, 11.2, 14.0, 16.8]}}


def frequency(stiffness, mass):
    """The first natural frequency of a simple beam, Hz."""
    return math.pi / (2.0 * SPAN**2) * math.sqrt(stiffness / mass)


def of_depth(depth):
    """EI and mass of a girder with another depth: EI grows with its power 2.5, 35 % of the mass with the depth."""
    return EI * (depth / DEPTH) ** 2.5, MASS * (0.65 + 0.35 * depth / DEPTH)


def check(name, girder):
    """The check by EN 1991-2 and EN 1990 with all limits; prints its outcome."""
    stiffness, mass = girder
    print(f"{name}: EI {unit('bending_stiffness', stiffness)}, mass {unit('mass_per_length', mass)}, "
          f"f1 {frequency(stiffness, mass):.2f} Hz")
    result = traverse.run(scene(stiffness, mass), norm_load_models="lm71", norm_track="careful",
                          limits="options/limits/en1991_2.yml", output=folder / f"en_check_{name}.h5")
    for k, (verdict, place) in enumerate(result["verdicts_verdict"].values):
        if verdict != "not judged":
            value, limit = result["verdicts_value"].values[k], result["verdicts_limit"].values[k]
            print(f"  {result['criterion'].values[k]}: {value:.3g} of {limit:.3g}, {verdict}; {place}")
    for effect, ratio in zip(result["norm_effect"].values, result["norm_train_over_model"].values):
        print(f"  {effect}: HSLM over LM71 {ratio:.2f}")
    return result


def compare(title, words, girders, results):
    """Prints f1 and the largest acceleration of each girder, and returns both."""
    print(title)
    curve = []
    for word, girder, peaks in zip(words, girders, results):
        accelerations = peaks["peak_acceleration"].max("x")
        place = accelerations[accelerations.argmax(["hslm_a", "speed"])]
        curve.append((frequency(*girder), place.item()))
        print(f"  {word}: f1 {curve[-1][0]:.2f} Hz, largest acceleration {curve[-1][1]:.2f} m/s², "
              f"A{place['hslm_a'].item():.0f} at {unit('speed', place['speed'].item())}")
    return zip(*curve)


def study(option, values):
    """The peaks of a study of one option, for each of its values."""
    peaks = traverse.study(scene(EI, MASS), {option: values}).rename(load_hslm_a="hslm_a", load_speed="speed")
    return [peaks.sel({option: value}) for value in values]


# %% The planned bridge, and where its resonances are
planned = check("planned", (EI, MASS))
for train, distance, predicted, found, order in zip(*(planned[f"resonances_{name}"].values for name in (
        "hslm_a", "distance", "speed", "acceleration_speed", "order"))):
    if order == 1:
        peak = planned["peak_acceleration"].sel(hslm_a=train).max().item()
        print(f"  A{train:.0f}: f1 d = {unit('speed', predicted)} with d = {distance:.0f} m, found "
              f"{unit('speed', found)}; largest acceleration at any speed {peak:.2f} m/s²")
print(f"  cancellation: 2 f1 L/3 = {unit('speed', planned['cancellations_speed'].values[0])}")
moment = planned["static_moment"].sel(static_load="LM71", extreme="greatest").sel(static_x=SPAN / 2, method="nearest")
# four forces of 250 kN at distances of 1.6 m, one of them at midspan, and 80 kN/m except between -2.4 and 4.0 m
exact = 250e3 * (SPAN - 3.2) + 80e3 * (SPAN**2 / 8 - 1.6 * SPAN + (2.4**2 + 4.0**2) / 4)
print(f"  LM71 at midspan: {unit('moment', moment.item())}, in closed form {unit('moment', exact)}")

# %% More mass, more stiffness, and a deeper girder, which has more of both
factors = [1.0, 1.25, 1.5, 2.0, 3.0]
times = [f"{factor:.2f} times" for factor in factors]
depths = [DEPTH, 2.0, 2.2, 2.4, 2.6, DEEPER]
masses, stiffnesses = [factor * MASS for factor in factors], [factor * EI for factor in factors]
heavier = compare("mass alone", times, [(EI, mass) for mass in masses], study("beam_mass", masses))
stiffer = compare("stiffness alone", times, [(stiffness, MASS) for stiffness in stiffnesses],
                  study("beam_EI", stiffnesses))
deeper = compare("depth of the girder", [f"{depth} m" for depth in depths], [of_depth(depth) for depth in depths],
                 [traverse.run(scene(*of_depth(depth))) for depth in depths])

# %% The changed bridge, with all limits
changed = check("deeper", of_depth(DEEPER))

# %% The figure
if not arguments.quick:
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.6), layout="constrained")
    for name, result in ((f"{DEPTH} m", planned), (f"{DEEPER} m", changed)):
        left.plot(result["speed_kmh"], result["peak_acceleration"].max(["hslm_a", "x"]), label=f"depth {name}")
    left.set(xlabel="speed, km/h", ylabel="largest acceleration, m/s²")
    for name, (frequencies, largest) in (("mass", heavier), ("stiffness", stiffer), ("depth", deeper)):
        right.plot(frequencies, largest, marker="o", label=f"more {name}")
    right.set(xlabel="first natural frequency, Hz")
    for axes in (left, right):
        axes.axhline(planned["verdicts_limit"].values[0], color="tab:red", lw=1.0, label="limit, ballasted deck")
        axes.set_ylim(bottom=0.0)
        axes.legend(fontsize=8)
    figure.savefig(folder / "example_en_check.png", dpi=110)
