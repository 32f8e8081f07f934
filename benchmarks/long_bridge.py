#!/usr/bin/python3
"""Prints how much faster than the train 164.8 km of spans and 1,000 continuous spans are computed, with each run's error.
/usr/bin/python3 benchmarks/long_bridge.py [BUILD_FOLDER] [OUT_FOLDER] [SECONDS]; SECONDS of train time (10) of the long
runs, 0: the whole crossing with what rests left out. Writes long_bridge.csv and long_bridge.png to OUT_FOLDER."""

import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import runs  # noqa: E402

COACHES = {
    "vehicle_coach_file": os.path.join(runs.ROOT, "options", "vehicles", "s300.yml"),
    "train_vehicles": "coach*16", "train_spacing": 25.0, "train_speed": 83.333333,
    "support_types": "roller", "beam_EI": 3.795e11, "beam_mass": 3.0e4, "beam_damping_ratios": 0.02,
    "beam_elements_per_span": 10}
METHODS = {
    "esdirk4, 38 ms": {"ts_dt": 0.038, "step_kinks": "false"},
    "esdirk4, 20 ms": {"ts_dt": 0.02, "step_kinks": "false"},
    "genalpha, 4 ms": {"ts_type": "genalpha", "ts_dt": 4e-3, "step_kinks": "false"},
    "genalpha, 1 ms": {"ts_type": "genalpha", "ts_dt": 1e-3, "step_kinks": "false"}}
PROBES = [48.0, 336.0, 656.0]


def bridge(spans, continuity):
    return COACHES | {"beam_spans": f"32.0*{spans}", "beam_continuity": continuity,
                      "output_probes": ",".join(map(str, PROBES))}


def peak_errors(build, out, continuity, window):
    """Of the largest deflections at three midspans of a short bridge, against esdirk4 at 1 ms with every span stepped."""
    short = bridge(40, continuity) | {"train_positions": -20.0, "ts_max_time": 14.0}
    file = os.path.join(out, "benchmark_run.h5")
    fine = {"ts_dt": 1e-3, "output_interval": 0.01, "model_window": 0}
    runs.Run(build, short | fine, file)
    exact = [runs.peak(file, i) for i in range(len(PROBES))]
    errors = {}
    for name, method in METHODS.items():
        runs.Run(build, short | method | {"output_interval": method["ts_dt"], "model_window": window}, file)
        errors[name] = max(abs(runs.peak(file, i) / exact[i] - 1.0) for i in range(len(PROBES)))
    return errors


def main():
    build, out = runs.folders(sys.argv[1:3])
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 10.0
    train = {"train_positions": 420.0, "output_interval": seconds or 1.0} | (
        {"ts_max_time": seconds} if seconds > 0.0 else {"train_positions": -20.0})
    cases = {  # bridge, window, methods
        "5,150 spans apart, every span stepped": (5150, "simply_supported", 0, METHODS),
        "5,150 spans apart, what rests left out": (5150, "simply_supported", "auto", METHODS),
        "1,000 spans continuous, every span stepped": (1000, "continuous", 0, METHODS),
        "1,000 spans continuous, window 1e-4": (1000, "continuous", 1e-4, METHODS)}
    if seconds == 0.0:
        cases = {name: case for name, case in cases.items() if case[2] == "auto"}
    rows = []
    print(f"{'':46}{'':16}{'1 rank':>9}{'2 ranks':>9}   times real time{'peaks wrong by':>17}")
    for name, (spans, continuity, window, methods) in cases.items():
        errors = peak_errors(build, out, continuity, window)
        for method, options in methods.items():
            file = os.path.join(out, "benchmark_run.h5")
            scene = bridge(spans, continuity) | train | options | {"model_window": window}
            factors = []
            for ranks in (1, 2):
                run = runs.Run(build, scene, file, ranks)
                factors.append(run.steps * options["ts_dt"] / run.seconds)
            rows.append([name, method, *factors, errors[method]])
            print(f"{name:46}{method:16}{factors[0]:9.1f}{factors[1]:9.1f}{errors[method]:34.1e}", flush=True)
    os.remove(os.path.join(out, "benchmark_run.h5"))
    runs.write_table(os.path.join(out, "long_bridge.csv"),
                     ["bridge", "method", "times real time, 1 rank", "2 ranks", "peaks wrong by"], rows)
    figure, axes = plt.subplots(figsize=(10, 5), layout="constrained")
    labels = [f"{r[0]}: {r[1]}" for r in rows]
    for i, ranks in enumerate(("1 rank", "2 ranks")):
        bars = axes.barh([y + 0.4 * i for y in range(len(rows))], [r[2 + i] for r in rows], 0.4, label=ranks)
        axes.bar_label(bars, fmt="%.1f", fontsize=7)
    axes.set_yticks([y + 0.2 for y in range(len(rows))], labels, fontsize=8)
    axes.axvline(1.0, color="grey", lw=0.8)
    axes.invert_yaxis()
    axes.set_xlabel("train time over computing time")
    axes.legend()
    figure.savefig(os.path.join(out, "long_bridge.png"), dpi=120)
    print(os.path.join(out, "long_bridge.png"))


if __name__ == "__main__":
    main()
