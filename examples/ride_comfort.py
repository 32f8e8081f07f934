# %% [markdown]
# How comfortable is a coach at 250 km/h on a rough line, and on how many random tracks is the answer known?
# doc/guide/example_ride_comfort.md explains the steps and the numbers that this file prints.
#
#     PYTHONPATH=python:scripts /usr/bin/python3 examples/ride_comfort.py [FOLDER] [--quick]
#
# All 200 tracks take some minutes; examples/ride_comfort.csv keeps their results. --quick computes three of the tracks,
# compares them with the file, reads the others from it, and draws no figure. The numbers are the same.

# %%
import argparse
import csv
import math
import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np
import yaml
from comfort import comfort, weighting_b
from engineering_units import shown

import traverse

parser = argparse.ArgumentParser()
parser.add_argument("folder", nargs="?", default="results", help="of the figure")
parser.add_argument("--quick", action="store_true", help="compute three tracks, read the others, draw no figure")
arguments = parser.parse_args()
folder = pathlib.Path(arguments.folder)
folder.mkdir(exist_ok=True)
STORE = pathlib.Path(__file__).with_suffix(".csv")

TRACKS = 200
INTERVAL, SETTLED, WINDOW = 0.01, 5.0, 5.0  # s: between samples, until the ride is stationary, of EN 12299
WAVES = [2.0, 150.0]  # m, the shortest and the longest wave
LOW, HIGH = 4.032e-7, 1.080e-6  # rad m: of the low and of the high disturbance spectrum of German railways
SPEED = 250.0 / shown("speed")[1]  # m/s
with pathlib.Path("options/vehicles/velaro.yml").open(encoding="utf-8") as file:
    coach = yaml.safe_load(file)
scene = {"vehicle": {"coach": {"file": "../vehicles/velaro.yml"}}, "train": {"vehicles": "coach", "speed": SPEED},
         "track": {"profile": "german_low", "wavelengths": WAVES}, "ts": {"dt": 0.0025, "max_time": SETTLED + WINDOW},
         "output": {"interval": INTERVAL}}


def ride(seed, profile="german_low"):
    """One track: its seed; the peak of the acceleration, its rms, the rms weighted by Wb and Sperling's index at the
    centre of the car body; the weighted rms above the rear bogie."""
    results = traverse.run(scene, folder="options/scenes", track_seed=seed, track_profile=profile)
    car = results["vehicles_0_car_acceleration"].sel(time=slice(SETTLED, SETTLED + WINDOW - INTERVAL / 2.0))
    centre, bogie = (car.sel(coordinate="y").values + x * car.sel(coordinate="angle").values
                     for x in (0.0, coach["rear_bogie"]["position"][0]))
    felt = comfort(centre, INTERVAL)
    return [seed, abs(centre).max(), felt.rms, felt.weighted, felt.sperling, comfort(bogie, INTERVAL).weighted]


# %% The tracks: computed, or read from the file after a comparison
NAMES = ["seed", "peak", "rms", "weighted", "sperling", "weighted_at_bogie"]
if arguments.quick:
    with STORE.open(encoding="utf-8", newline="") as file:
        rows = [[float(row[name]) for name in NAMES] for row in csv.DictReader(file)]
    for seed in (1, TRACKS // 2, TRACKS):
        if not np.allclose(ride(seed), rows[seed - 1], rtol=1e-4):
            sys.exit(f"ride_comfort.py: track {seed} is not the one of {STORE.name}: run it without --quick")
else:
    rows = [ride(seed) for seed in range(1, TRACKS + 1)]
    with STORE.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([NAMES, *([f"{value:.6g}" for value in row] for row in rows)])
tracks = dict(zip(NAMES, np.array(rows).T))


# %% The ride in closed form: heave of the car body on two suspensions, and the spectrum of the track
def heave(hertz):
    """Acceleration of the centre of the car body over the height of the track, 1/s2."""
    s = 2j * math.pi * hertz
    car, bogie = coach["car"]["mass"] / 2.0, coach["front_bogie"]["mass"]  # kg, of half a coach
    upper, lower = (count * (float(spring["stiffness"]) + float(spring["damping"]) * s) for count, spring in (
        (1.0, coach["front_secondary"]), (2.0, coach["primary_1"])))
    wheels = np.mean([np.exp(s * coach[f"wheelset_{k}"]["position"][0] / SPEED) for k in (1, 2, 3, 4)], axis=0)
    return s**2 * wheels * lower * upper / ((car * s**2 + upper) * (bogie * s**2 + lower + upper) - upper**2)


def expected(weighting, longest=WAVES[1]):
    """The rms of the weighted acceleration, m/s2, by the one-sided spectrum of the low-disturbance track."""
    low, high = SPEED / longest, SPEED / WAVES[0]
    hertz = low + (high - low) * (np.arange(20000) + 0.5) / 20000
    squared = (2.0 * math.pi * hertz / SPEED) ** 2
    density = LOW * 0.8246**2 / ((squared + 0.0206**2) * (squared + 0.8246**2)) * 2.0 * math.pi / SPEED
    return math.sqrt(np.mean(np.abs(heave(hertz) * weighting(hertz)) ** 2 * density) * (high - low))


def interval(values, level, confidence=0.95):
    """The bounds of a quantile for any distribution, by the ranks of the ordered values; inf: no bound."""
    n, side = len(values), 0.5 * (1.0 - confidence)
    below = np.cumsum([math.comb(n, k) * level**k * (1.0 - level) ** (n - k) for k in range(n + 1)])
    bounded = [-math.inf, *sorted(values), math.inf]
    return bounded[np.sum(below <= side)], bounded[1 + np.argmax(below >= 1.0 - side)]


for name, weighting in (("rms", np.ones_like), ("weighted", weighting_b)):
    print(f"{name} at the centre: {math.sqrt(np.mean(tracks[name] ** 2)):.4f} m/s², in closed form "
          f"{expected(weighting):.4f} m/s², with waves up to 80 m {expected(weighting, 80.0):.4f} m/s²")

# %% Convergence with the number of tracks
converged = []
for count in (25, 50, 100, TRACKS):
    peaks = tracks["peak"][:count]
    low, high = interval(peaks, 0.98)
    mean, half, quantile = peaks.mean(), 1.96 * peaks.std(ddof=1) / math.sqrt(count), np.quantile(peaks, 0.98)
    converged.append((count, mean, half, quantile))
    bounds = f"at least {low:.3f}, " + (f"at most {high:.3f}" if high < math.inf else "no upper bound")
    print(f"{count} tracks: mean peak {mean:.3f} ± {half:.3f} m/s², 98 % quantile {quantile:.3f} m/s², {bounds}")
    print(f"  all of {count} tracks are below the 98 % quantile with the probability {100.0 * 0.98**count:.1f} %")

# %% The answer
print(f"largest of the {TRACKS} tracks: {tracks['peak'].max():.3f} m/s²")
for place, name in (("centre", "weighted"), ("rear bogie", "weighted_at_bogie")):
    print(f"N_MV above the {place}: {6.0 * np.quantile(tracks[name], 0.95):.2f} (up to 1.5: very comfortable)")
print(f"Sperling: mean {tracks['sperling'].mean():.2f}, largest {tracks['sperling'].max():.2f} (2: clearly noticeable)")
with pathlib.Path("options/limits/en1990.yml").open(encoding="utf-8") as file:
    limits = {one["text"]: one["value"] for one in yaml.safe_load(file) if one["quantity"] == "car_acceleration"}
for text, limit in limits.items():
    print(f"{text}, {limit} m/s²: the roughness may be {limit / high:.1f} times as high")
ratio = ride(1, "german_high")[1] / rows[0][1]
print(f"german_high over german_low: {ratio:.3f}, in closed form {math.sqrt(HIGH / LOW):.3f}")

# %% The figure
if not arguments.quick:
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.4), layout="constrained")
    left.step(np.sort(tracks["peak"]), np.arange(1, TRACKS + 1) / TRACKS, where="post")
    left.axhline(0.98, color="tab:orange", lw=1.0)
    left.axvspan(low, high, color="tab:orange", alpha=0.2, label="98 % quantile with its interval of 95 %")
    left.set(xlabel="peak acceleration of a track, m/s²", ylabel="fraction of the tracks", xlim=(0.1, 0.5))
    left.legend(fontsize=8, loc="lower right")
    counts, means, halves, quantiles = np.array(converged).T
    right.errorbar(counts, means, halves, marker="o", capsize=3, label="mean with its interval of 95 %")
    right.plot(counts, quantiles, marker="s", color="tab:orange", label="98 % quantile")
    right.vlines(TRACKS, low, high, color="tab:orange", alpha=0.4, lw=4.0)
    right.set(xlabel="number of tracks", ylabel="peak acceleration, m/s²", ylim=(0.0, 0.5))
    right.legend(fontsize=8, loc="lower left")
    figure.savefig(folder / "example_ride_comfort.png", dpi=110)
