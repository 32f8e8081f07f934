#!/usr/bin/python3
"""Fits bending stiffness, mass and damping to one measured passage, in several draws of true values and noise:
/usr/bin/python3 benchmarks/fit_draws.py [BUILD_FOLDER] [OUT_FOLDER] [--draws N] [--smallest]

The measurements are made here in closed form, without Traverse: the deflection of a simply supported beam under six
moving forces near resonance, 500 values in 6 s with 2 % noise, by a clock of its own. Prints, for every draw, the errors
of the estimates over their standard errors and the time of the program, and how many are below 2. Writes
fit_draws.csv.
"""

import csv
import os
import subprocess
import tempfile
import time

import h5py
import numpy
import runs

SPAN, STATION, MODES, EXACT_MODES = 30.0, 13.0, 5, 60  # m, m; of the scene and of the measurement
FORCE, SPACING, COUNT, SPEED = 1.7e5, 18.0, 6, 29.0  # N, m, m/s
SAMPLES, INTERVAL, NOISE = 500, 0.012, 0.02  # s; relative to the largest deflection
OPTIONS = ("beam_EI", "beam_mass", "model_damping_ratios")
SCENE = f"""
beam: {{spans: {SPAN}, EI: 1.0e10, mass: 9.0e3}}
load: {{forces: {FORCE}*{COUNT}, positions: [{", ".join(str(-SPACING * i) for i in range(COUNT))}], speed: {SPEED}}}
model: {{modes: {MODES}, damping_ratios: 0.02}}
output: {{quiet: true}}
fit:
  vary: {{beam_EI: [5.0e9, 2.0e10], beam_mass: [4.5e3, 1.8e4], model_damping_ratios: [0.002, 0.08]}}
  to:
    midspan: {{series: measured.csv, quantity: deflection, x: {STATION}, align: true, factor: -1.0e-3, sd: SD}}
"""


def deflection(t, EI, mass, ratio, span=SPAN, x=STATION, modes=EXACT_MODES, forces=((FORCE, 0.0),), speed=SPEED):
    """The deflection (m, downward) at x of a simply supported beam at the instants t (s).

    Every mode is an oscillator under sin(n pi v tau/L) while a force is on the beam: the particular solution, and free
    oscillations from rest and from the instant at which it leaves. forces: (N, s at which it enters the beam).
    L. Fryba, Vibration of Solids and Structures under Moving Loads, chapter 1.
    """
    total = numpy.zeros_like(t)
    for n in range(1, modes + 1):
        omega = (n * numpy.pi / span) ** 2 * numpy.sqrt(EI / mass)
        driving, decay = n * numpy.pi * speed / span, ratio * omega
        damped = omega * numpy.sqrt(1.0 - ratio**2)
        crossing = span / speed
        # sin part a, cos part b of the particular solution of q'' + 2 decay q' + omega^2 q = sin(driving tau)
        denominator = (omega**2 - driving**2) ** 2 + (2.0 * decay * driving) ** 2
        a, b = (omega**2 - driving**2) / denominator, -2.0 * decay * driving / denominator

        def free(tau, q, rate):
            return numpy.exp(-decay * tau) * (q * numpy.cos(damped * tau) + (rate + decay * q) / damped * numpy.sin(damped * tau))

        def loaded(tau):
            return a * numpy.sin(driving * tau) + b * numpy.cos(driving * tau) + free(tau, -b, -a * driving)

        step = 1e-6  # s, for the speed of the mode as the force leaves, by a central difference of order four
        at_exit = loaded(crossing)
        rate = (8.0 * (loaded(crossing + step) - loaded(crossing - step))
                - (loaded(crossing + 2 * step) - loaded(crossing - 2 * step))) / (12.0 * step)
        q = numpy.zeros_like(t)
        for force, enters in forces:
            tau = t - enters
            on, after = (tau >= 0.0) & (tau <= crossing), tau > crossing
            q[on] += force * loaded(tau[on])
            q[after] += force * free(tau[after] - crossing, at_exit, rate)
        total += 2.0 / (mass * span) * q * numpy.sin(n * numpy.pi * x / span)
    return total


def measurement(EI, mass, ratio, shift, noise, seed):
    """(time, deflection in mm downward, standard deviation in m) of a record whose clock shows `shift` at the start."""
    t = INTERVAL * numpy.arange(SAMPLES)
    forces = [(FORCE, SPACING * i / SPEED) for i in range(COUNT)]
    exact = deflection(t - shift, EI, mass, ratio, forces=forces)
    sd = noise * abs(exact).max()
    return t, 1e3 * (exact + sd * numpy.random.default_rng(seed).standard_normal(t.size)), sd


def write_series(path, t, values):
    with open(path, "w", encoding="utf-8") as file:
        file.write("# time (s), deflection (mm, downward)\n")
        file.writelines(f"{a:.17g}, {b:.17g}\n" for a, b in zip(t, values))


def fit(program, folder, scene, *words):
    """(estimates, standard errors, seconds) of a scene in the folder, by the names of the unknowns."""
    with open(os.path.join(folder, "scene.yml"), "w", encoding="utf-8") as file:
        file.write(scene)
    results = os.path.join(folder, "fit.h5")
    begin = time.perf_counter()
    subprocess.run([program, "-options_file", os.path.join(folder, "scene.yml"), "-output_file", results, *words], check=True,
                   stdout=subprocess.DEVNULL)
    seconds = time.perf_counter() - begin
    with h5py.File(results) as file:
        names = file["unknown"].asstr()[()]
        group = file["fit"]
        return dict(zip(names, group["estimate"][()])), dict(zip(names, group["standard_error"][()])), seconds


def draw(program, folder, number):
    """One row of the table: true values and noise by the number of the draw."""
    random = numpy.random.default_rng([7, number])
    true = dict(zip(OPTIONS, [1e10 * random.uniform(0.85, 1.2), 9e3 * random.uniform(0.85, 1.2), random.uniform(0.01, 0.03)]))
    true["midspan_shift"] = random.uniform(0.1, 0.5)
    t, values, sd = measurement(*true.values(), NOISE, [11, number])
    write_series(os.path.join(folder, "measured.csv"), t, values)
    estimate, error, seconds = fit(program, folder, SCENE.replace("SD", f"{sd:.6g}"))
    row = {"draw": number, "seconds": f"{seconds:.3f}"}
    for name, value in true.items():
        row |= {name: f"{value:.6g}", f"{name} estimate": f"{estimate[name]:.6g}",
                f"{name} error": f"{(estimate[name] - value) / error[name]:.3f}"}
    return row


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("--draws", type=int, default=20, help="number of draws; left out: 20")
    chosen = runs.given(arguments)
    rows = []
    for number in range(2 if chosen.smallest else chosen.draws):
        with tempfile.TemporaryDirectory() as folder:
            rows.append(draw(runs.traverse(os.path.abspath(chosen.build)), folder, number))
        errors = "  ".join(f"{name} {float(rows[-1][f'{name} error']):+.2f}" for name in OPTIONS)
        print(f"draw {number:2d}: errors over standard errors: {errors}   {rows[-1]['seconds']} s")
    for name in OPTIONS:
        inside = sum(abs(float(row[f"{name} error"])) < 2.0 for row in rows)
        print(f"{name}: {inside} of {len(rows)} true values within 2 standard errors")
    print(f"{max(float(row['seconds']) for row in rows):.2f} s for the slowest fit")
    path = os.path.join(chosen.out, "fit_draws.csv")
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    print(path)


if __name__ == "__main__":
    main()
