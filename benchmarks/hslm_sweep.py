#!/usr/bin/python3
"""Passages per second of sweeps, and their peaks against another program's.
/usr/bin/python3 benchmarks/hslm_sweep.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest]

Runs options/scenes/hslm_sweep.yml (10 HSLM-A trains, 100 to 360 km/h by 2: 1,310 passages) by three modes on one and on
two ranks, a part of it by elements, and eight S300 coaches over the same bridge. Prints a table; writes hslm_sweep.csv
(the table), hslm_sweep.h5 (the passages by three modes at all stations) and hslm_sweep.png (envelopes of their peaks over
the speed) to OUT_FOLDER.
"""

import os
import resource
import tempfile

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
import runs  # noqa: E402

SCENE = runs.scene("hslm_sweep")
STATIONS = ",".join(f"{1.25 * i:g}" for i in range(1, 20))
COARSE = "27.7777778,100,5.5555556"  # m/s: every 20 km/h

ELEMENTS = """beam: {spans: 25.0, EI: 3.0e10, mass: 1.5e4, damping_ratios: 0.01}
support: {types: [pinned, roller]}
scene: {tail: 1.0}
"""
COACHES = f"""vehicle: {{coach: {{file: {runs.ROOT}/options/vehicles/s300.yml}}}}
train: {{vehicles: coach*8}}
"""
WITH_STATIONS = "3 modes, 19 stations"
CASES = {  # name: the scene as text or none, options
    "3 modes": (None, {}),
    WITH_STATIONS: (None, {"output_probes": STATIONS}),
    "10 elements, every 20 km/h": (ELEMENTS, {"sweep_speed": COARSE, "sweep_hslm_a": "1,2,3,4,5,6,7,8,9,10"}),
    "8 coaches, every 20 km/h": (ELEMENTS + COACHES, {"sweep_speed": COARSE}),
}
SMALLEST = {  # all passages at one station, as they take half a second; few of the others
    "3 modes": (None, {}),
    WITH_STATIONS: (None, {"output_probes": STATIONS, "sweep_speed": COARSE}),
    "elements, two speeds": (ELEMENTS, {"sweep_speed": "60,80,20", "sweep_hslm_a": "1", "beam_elements_per_span": 4}),
    "a coach, two speeds": (ELEMENTS + COACHES, {"sweep_speed": "60,80,20", "train_vehicles": "coach",
                                                 "beam_elements_per_span": 4, "ts_dt": 5e-3}),
}


def run(build, scene, options, ranks, file):
    """Seconds by the clock, of the processors, and the results."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    runs.Run(build, {"options_file": scene} | options, file, ranks)
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
    print(file)


def measured(build, out, cases, listed):
    """Lines of the table; draws the case with stations."""
    for name, (text, options) in cases.items():
        with tempfile.TemporaryDirectory() as folder:
            scene, file = SCENE, os.path.join(folder, "sweep.h5")
            if text:
                scene = os.path.join(folder, "scene.yml")
                with open(scene, "w") as written:
                    written.write(text)
            if name == WITH_STATIONS:
                file = os.path.join(out, "hslm_sweep.h5")
            for ranks in (1, 2):
                seconds, processor, sweep = run(build, scene, options, ranks, file)
                passages = sweep["peak_deflection"].shape[0] * len(sweep["speed"])
                off = errors(sweep, listed)
                row = [name, ranks, passages, passages / seconds, 1e3 * seconds / passages, 1e3 * processor / passages]
                print("{:28}{:6}{:10}{:12.4g}{:10.3g}{:10.3g}".format(*row)
                      + "".join(f"{e:12.1e}  " for e in off if e is not None), flush=True)
                yield [*row, *off]
        if name == WITH_STATIONS:
            print(file)
            picture(sweep, listed, os.path.join(out, "hslm_sweep.png"))


def main():
    given = runs.given(runs.parser(__doc__))
    listed = np.loadtxt(os.path.join(runs.ROOT, "tests", "data", "hslm_peaks.csv"), delimiter=",")
    print(f"{'':28}{'ranks':>6}{'passages':>10}{'per second':>12}{'ms each':>10}{'CPU ms':>10}{'deflection':>12}"
          f"{'acceleration':>14}")
    rows = list(measured(given.build, given.out, SMALLEST if given.smallest else CASES, listed))
    runs.write_table(os.path.join(given.out, "hslm_sweep.csv"),
                     ["case", "ranks", "passages", "passages per second", "ms each", "CPU ms each",
                      "deflection against the list", "acceleration against the list"], rows)


if __name__ == "__main__":
    main()
