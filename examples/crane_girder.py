# %% [markdown]
# An overhead crane on a girder of 22 m: how much do hoisting and travelling add to the static forces, and how far does
# the load sway after braking? doc/guide/example_crane_girder.md explains the steps and the numbers printed here.
#
#     PYTHONPATH=python:scripts /usr/bin/python3 examples/crane_girder.py [FOLDER] [--quick]
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

parser = argparse.ArgumentParser()
parser.add_argument("folder", nargs="?", default="results", help="of the tables and of the figure")
parser.add_argument("--quick", action="store_true", help="draw no figure")
arguments = parser.parse_args()
folder = pathlib.Path(arguments.folder).resolve()
folder.mkdir(exist_ok=True)

SCENE = "options/scenes/overhead_crane.yml"
MODEL = {"beam_elements_per_span": 8, "ts_dt": 0.005}  # as accuracy 1e-3 chooses them, without its trial runs
GRAVITY = 9.81  # m/s2, the default of the program
HOISTING, TRAVELLING = 0.2, 1.2  # m/s: the speeds of the winch and of the trolley
STARTS, CRUISES = 5.0, 5.0  # s: when the trolley starts, and for how long its speed is constant
HANGING = 8.0  # m: the length of the ropes at the start
FALLS, BODIES = ("front_fall", "rear_fall"), ("trolley", "front_axle", "rear_axle", "load")


def unit(quantity, value):
    """A value in SI units, in those that engineers use."""
    word, factor = shown(quantity)
    return f"{value * factor:.{0 if abs(value * factor) >= 1000 else 1}f} {word}"


def table(name, rows):
    """The path of a table for the program."""
    path = folder / f"crane_{name}.csv"
    np.savetxt(path, rows, delimiter=",", fmt="%.9f")
    return str(path)


# %% Travelling: the girder under the trolley with its load, against static values in closed form
crossing = traverse.run(SCENE, **MODEL)
options = dict(line.split(" ", 1) for line in crossing.attrs["options"].splitlines())


def option(name):
    return float(options[name])


span, stiffness, load = option("beam_spans"), option("beam_EI"), option("vehicle_trolley_load_mass")
wheel = GRAVITY / 2.0 * sum(option(f"vehicle_trolley_{body}_mass") for body in BODIES)
# m, from a support to the nearest wheel, with the trolley at midspan
arm = span / 2.0 - float(options["vehicle_trolley_front_axle_position"].split(",")[0])
line = GRAVITY * option("beam_mass")  # N/m
static = wheel * arm * (3.0 * span**2 - 4.0 * arm**2) / (24.0 * stiffness) + 5.0 * line * span**4 / (384.0 * stiffness)
own, moving = line * span**2 / 8.0, wheel * arm
print(f"static deflection: {unit('deflection', crossing.attrs['summary_static_deflection'])}, in closed form "
      f"{unit('deflection', static)}")
print(f"static moment: {unit('moment', own + moving)}, of which {unit('moment', own)} by the weight of the girder")
moment = crossing.attrs["summary_moment"]
print(f"largest moment of the run: {unit('moment', moment)}; factor of the moving part {(moment - own) / moving:.3f}")


# %% Hoisting: the winch reaches its speed suddenly or slowly; the load already hangs on the ropes
def wound(path):
    return {f"vehicle_trolley_{fall}_winding_table": path for fall in FALLS}


def hoist(start):
    """The greatest force in the ropes over the weight of the load; the winch needs the time start, s, to its speed."""
    time = np.arange(0.0, 3.0, 0.0125)
    since = np.clip(time - 0.5, 0.0, None)
    length = -HOISTING * np.where(since < start, since**2 / (2.0 * start), since - start / 2.0)
    results = traverse.run(SCENE, **MODEL, ts_max_time=2.5, output_interval=0.005,
                           **wound(table(f"hoist_{start}", np.column_stack([time, length]))))
    return sum(results[f"vehicles_0_{fall}_force"].values for fall in FALLS).max() / (GRAVITY * load)


def hoist_undamped(start):
    """The same for a mass on a spring whose upper end accelerates for the time start, without damping."""
    rise = 2.0 if start > math.pi / omega else 2.0 * math.sin(omega * start / 2.0)
    return 1.0 + HOISTING / start / GRAVITY * rise


place = option("train_positions")
ropes = len(FALLS) * option("vehicle_trolley_front_fall_stiffness")
girder = 3.0 * stiffness * span / (place * (span - place)) ** 2
omega = 1.0 / math.sqrt(load / ropes + load / girder)  # 1/s
print(f"load on ropes and girder: {omega / (2.0 * math.pi):.2f} Hz")
starts = [0.05, 0.15, 0.3, 0.6, 1.2]
factors = [hoist(start) for start in starts]
for start, factor in zip(starts, factors):
    print(f"winch starts within {start} s: factor {factor:.2f}, in closed form without damping "
          f"{hoist_undamped(start):.2f}")
classes = {f"HC{k}": 1.0 + 0.05 * k + 0.17 * k * HOISTING for k in (1, 2, 3, 4)}  # EN 1991-3, table 2.5
print("phi2 of EN 1991-3: " + ", ".join(f"{name} {value:.2f}" for name, value in classes.items()))


# %% Braking: the sway of the load below the trolley
def period(length):
    return 2.0 * math.pi * math.sqrt(length / GRAVITY)


def travel(brake, length):
    """Time, s, and sway, m; the trolley accelerates within the period of the load and brakes within another time."""
    time = np.arange(0.0, STARTS, 0.0625)
    winding = table(f"lift_{length}", np.column_stack([time, np.interp(time, [0.5, 2.5], [0.0, length - HANGING])]))
    cruises = STARTS + period(length)
    brakes = cruises + CRUISES
    law = [(0.0, 0.0), (STARTS, 0.0), (cruises, TRAVELLING), (brakes, TRAVELLING), (brakes + brake, 0.0)]
    results = traverse.run(SCENE, **MODEL, **wound(winding), ts_max_time=brakes + brake + 8.0,
                           train_speed_file=table(f"speed_{brake:.2f}_{length}", law))
    load_at, trolley_at = (results[f"vehicles_0_{body}_position"].sel(coordinate="x") for body in ("load", "trolley"))
    return results["time"].values - brakes, (load_at - trolley_at).values


print(f"period at 6 m: {period(6.0):.3f} s, at 7 m: {period(7.0):.3f} s")
runs = []
for words, brake, length in (("1 s", 1.0, 6.0), ("2.5 s", 2.5, 6.0), ("the period", period(6.0), 6.0),
                             ("the period of 6 m", period(6.0), 7.0)):
    time, sway = travel(brake, length)
    runs.append((f"load at {length:.0f} m, braking within {words}", time, sway))
    exact = 2.0 * TRAVELLING / brake * length / GRAVITY * abs(math.sin(math.pi * brake / period(length)))
    print(f"{runs[-1][0]}: sway after the stop {np.abs(sway[time > brake]).max():.3f} m, in closed form {exact:.3f} m")

# %% The figure
if not arguments.quick:
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.6), layout="constrained")
    left.plot(starts, factors, "o", label="computed")
    fine = np.linspace(0.02, 1.3, 200)
    left.plot(fine, [hoist_undamped(start) for start in fine], lw=1.0, label="closed form, undamped")
    for name, value in classes.items():
        left.axhline(value, color="gray", lw=0.8, ls=":")
        left.text(1.3, value, f"$\\varphi_2$ {name}", fontsize=8, ha="right", va="bottom")
    left.set(xlabel="time of the winch to its speed, s", ylabel="rope force over weight", ylim=(1.0, 1.45))
    left.legend(fontsize=8, loc="upper right")
    for words, time, sway in runs:
        right.plot(time[time > -2.0], sway[time > -2.0], lw=1.2, label=words)
    right.set(xlabel="time from the start of braking, s", ylabel="sway of the load, m", ylim=(-1.1, 1.9))
    right.legend(fontsize=8, loc="upper left")
    figure.savefig(folder / "example_crane_girder.png", dpi=110)
