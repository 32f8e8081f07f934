#!/usr/bin/python3
"""Passages per second of sweeps, and their peaks against another program's: hslm_sweep.py [BUILD_FOLDER] [OUT_FOLDER]

Runs options/scenes/hslm_sweep.yml (10 HSLM-A trains, 100 to 360 km/h by 2: 1,310 passages) by three modes on one and on
two ranks, a part of it by elements, and eight S300 coaches over the same bridge. Prints a table; writes hslm_sweep.csv
(the table), hslm_sweep.h5 and hslm_sweep.png (envelopes of the peaks over the speed) into OUT_FOLDER (results).
"""

import csv
import os
import resource
import subprocess
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SCENE = os.path.join(ROOT, "options", "scenes", "hslm_sweep.yml")
STATIONS = ",".join(f"{1.25 * i:g}" for i in range(1, 20))
COARSE = "27.7777778,100,5.5555556"  # m/s: every 20 km/h

ELEMENTS = f"""beam: {{spans: 25.0, EI: 3.0e10, mass: 1.5e4, damping_ratios: 0.01}}
support: {{types: [pinned, roller]}}
sweep: {{speed: [{COARSE}]}}
scene: {{tail: 1.0}}
"""
TRAINS = "sweep_hslm_a: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n"
COACHES = f"""vehicle: {{coach: {{file: {ROOT}/options/vehicles/s300.yml}}}}
train: {{vehicles: coach*8}}
"""

CASES = [  # name, the scene as text or none, words
    ("3 modes", None, []),
    ("3 modes, 19 stations", None, ["-output_probes", STATIONS]),
    ("10 elements, every 20 km/h", ELEMENTS + TRAINS, []),
    ("8 coaches, every 20 km/h", ELEMENTS + COACHES, []),
]


def run(program, scene, words, ranks, file):
    """Seconds by the clock, of the processors, and the results."""
    command = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [program, "-options_file", scene]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command + words + ["-output_file", file, "-output_quiet"], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    with h5py.File(file) as results:
        names = ("speed", "peak_deflection", "peak_acceleration")
        sweep = {name: results["sweep"][name][...] for name in names}
        return results.attrs["wall_seconds"], after.ru_utime - before.ru_utime, sweep


def errors(sweep, listed):
    """Largest relative difference of peaks from the list, over the trains; None where speeds were left out."""
    if sweep["peak_deflection"].shape[:2] != (10, 131):
        return None, None
    deflection = 1e3 * sweep["peak_deflection"].max(axis=(1, 2)) / listed[:, 1] - 1
    acceleration = sweep["peak_acceleration"].max(axis=(1, 2)) / listed[:, 3] - 1
    return np.abs(deflection).max(), np.abs(acceleration).max()


def picture(sweep, listed, file):
    speed = 3.6 * sweep["speed"]
    fig, axes = plt.subplots(2, 1, figsize=(9, 8), sharex=True)
    for ax, name, scale, column, label in (
            (axes[0], "peak_deflection", 1e3, 1, "peak deflection, mm"),
            (axes[1], "peak_acceleration", 1.0, 3, "peak acceleration, m/s2")):
        peaks = scale * sweep[name].max(axis=2)
        for row in peaks:
            ax.plot(speed, row, color="#B8B8B8", lw=0.8)
        ax.plot(speed, peaks.max(axis=0), color="#0072B2", lw=2, label="envelope of A1 to A10")
        at = speed[peaks.argmax(axis=1)]
        ax.plot(at, listed[:, column], "o", mfc="none", color="#D55E00", label="the other program's peaks")
        ax.set_ylabel(label)
        ax.grid(color="#DDDDDD", lw=0.6)
        ax.legend(frameon=False, loc="upper left")
    axes[1].set_xlabel("speed, km/h")
    axes[0].set_title("HSLM-A over a simply supported bridge of 25 m, 1 % damping", loc="left", weight="bold")
    fig.tight_layout()
    fig.savefig(file, dpi=120)


def main():
    build = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "build")
    out = sys.argv[2] if len(sys.argv) > 2 else "results"
    os.makedirs(out, exist_ok=True)
    listed = np.loadtxt(os.path.join(ROOT, "tests", "data", "hslm_peaks.csv"), delimiter=",")
    written = os.path.join(out, "hslm_sweep_case.yml")
    rows = []
    print(f"{'':28}{'ranks':>6}{'passages':>10}{'per second':>12}{'ms each':>10}{'CPU ms':>10}{'deflection':>12}"
          f"{'acceleration':>14}")
    for name, text, words in CASES:
        if text:
            with open(written, "w") as file:
                file.write(text)
        for ranks in (1, 2):
            file = os.path.join(out, "hslm_sweep.h5")
            seconds, processor, sweep = run(os.path.join(build, "traverse"), written if text else SCENE, words, ranks,
                                            file)
            passages = sweep["peak_deflection"].shape[0] * len(sweep["speed"])
            deflection, acceleration = errors(sweep, listed)
            rows.append([name, ranks, passages, passages / seconds, 1e3 * seconds / passages,
                         1e3 * processor / passages, deflection, acceleration])
            shown = [f"{e:.1e}" if e is not None else "" for e in (deflection, acceleration)]
            print(f"{name:28}{ranks:6}{passages:10}{passages / seconds:12.4g}{rows[-1][4]:10.3g}{rows[-1][5]:10.3g}"
                  f"{shown[0]:>12}{shown[1]:>14}", flush=True)
        if "stations" in name:
            picture(sweep, listed, os.path.join(out, "hslm_sweep.png"))
    os.remove(written)
    with open(os.path.join(out, "hslm_sweep.csv"), "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["case", "ranks", "passages", "passages per second", "ms each", "CPU ms each",
                         "deflection against the list", "acceleration against the list"])
        writer.writerows(rows)


if __name__ == "__main__":
    main()
