#!/usr/bin/python3
"""What the derivatives of all peaks with respect to eight parameters cost, in passages:
/usr/bin/python3 benchmarks/gradient.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest]

A quarter car on a beam on springs (options/studies/gradient.yml), and a coach on a bridge with ballasted track. Times a
single passage, the analysis with eight runs in the lanes of a vector, and the analysis by single runs. Prints and writes
gradient.csv: scene, seconds of a passage, seconds of both analyses, both in passages, and the largest error of an
elasticity in lanes, the difference of one-sided differences relative to 1 + its magnitude. Then a fit of four options to
two records of the quarter car with 2 % noise, in lanes and by single runs, as gradient_fit.csv: number of runs, seconds,
estimates.
"""

import os
import tempfile

import h5py
import numpy
import runs

QUARTER_CAR = os.path.join(runs.ROOT, "options", "studies", "gradient.yml")
COACH = f"""
options_file: {runs.scene("four_coaches_ballasted_bridge")}
beam: {{spans: 50.0}}
train: {{vehicles: coach}}
output: {{probes: 25.0}}
model: {{vehicles: linear}}
ts_dt: 1.0e-3
study:
  sensitivity: local
  vary:
    beam_EI: {{normal: [1.7955e12, 5.0e10]}}
    beam_mass: {{normal: [6.9e4, 2.0e3]}}
    beam_damping_ratios: {{normal: [0.01, 0.001]}}
    track_ballast_k: {{normal: [1.3775e8, 1.0e7]}}
    track_subballast_k: {{normal: [7.75e7, 1.0e7]}}
    vehicle_coach_car_mass: {{normal: [32000.0, 1000.0]}}
    vehicle_coach_front_secondary_stiffness: {{normal: [8.6e5, 5.0e4], also: vehicle_coach_rear_secondary_stiffness}}
    train_speed: {{normal: [83.333, 1.0]}}
"""


def seconds(build, folder, text, options, repeats):
    """The shortest time of the runs of a study, s, and its results file."""
    scene, file = os.path.join(folder, "scene.yml"), os.path.join(folder, "results.h5")
    with open(scene, "w", encoding="utf-8") as out:
        out.write(text)
    times = []
    for _ in range(repeats):
        with h5py.File(runs.Run(build, {"options_file": scene} | options, file).file) as results:
            times.append(float(results["summary"].attrs["wall_seconds"]))
    return min(times), file


def measured(build, folder, name, text, repeats):
    passage, _ = seconds(build, folder, text[:text.index("\nstudy:")] + "\n",
                         {"study_vary_beam_damping_ratios": 0.01, "sweep_lanes": 0}, repeats)
    single, _ = seconds(build, folder, text, {"sweep_lanes": 0}, 1)
    lanes, file = seconds(build, folder, text, {}, repeats)
    with h5py.File(file) as results:
        elasticity, derivative = results["sensitivity/elasticity"][:], results["sensitivity/derivative"][:]
        error = numpy.abs(elasticity * results["sensitivity/derivative_error"][:] / derivative)
    return {"scene": name, "passage": f"{passage:.4g}", "in_lanes": f"{lanes:.4g}", "single": f"{single:.4g}",
            "passages": f"{lanes / passage:.2f}", "passages_single": f"{single / passage:.2f}",
            "largest_error": f"{numpy.nanmax(error / (1.0 + numpy.abs(elasticity))):.1e}"}


FIT = """
fit:
  vary:
    beam_EI: [1.0e9, 4.0e9]
    beam_damping_ratios: [0.005, 0.06]
    foundation_vertical_k: [2.0e6, 5.0e7]
    vehicle_car_box_mass: [3.0e3, 8.0e3]
  to:
    deflection: {series: deflection.csv, quantity: deflection, x: 15.0}
    acceleration: {series: acceleration.csv, quantity: acceleration, x: 15.0}
"""
TRUE_VALUES = {"beam_EI": 1.9e9, "beam_damping_ratios": 0.024, "vehicle_car_box_mass": 5300.0}
NOISE = 0.02  # of the largest value


def fits(build, folder, text):
    """Rows of the fits in lanes and by single runs."""
    scene, file = os.path.join(folder, "scene.yml"), os.path.join(folder, "results.h5")
    text = text[:text.index("\nstudy:")] + "\n"
    with open(scene, "w", encoding="utf-8") as out:
        out.write(text)
    random = numpy.random.default_rng(1)
    with h5py.File(runs.Run(build, {"options_file": scene, "output_interval": 2e-3} | TRUE_VALUES, file).file) as results:
        time = results["time"][:]
        for name in ("deflection", "acceleration"):
            record = results["probes/" + name][:len(time), 1]
            record += random.normal(0.0, NOISE * numpy.abs(record).max(), len(time))
            numpy.savetxt(os.path.join(folder, name + ".csv"), numpy.column_stack([time, record]), delimiter=",")
    with open(scene, "w", encoding="utf-8") as out:
        out.write(text + FIT)
    rows = []
    for lanes in (8, 0):
        with h5py.File(runs.Run(build, {"options_file": scene, "sweep_lanes": lanes}, file).file) as results:
            summary = results["summary"].attrs
            rows.append({"lanes": lanes, "runs": int(summary["runs"]), "seconds": f"{summary['wall_seconds']:.3f}"}
                        | dict(zip(results["unknown"].asstr()[:], (f"{x:.6g}" for x in results["fit/estimate"][:]))))
    return rows


def table(path, rows):
    for row in rows:
        print("  ".join(f"{key} {value}" for key, value in row.items()))
    runs.write_table(path, rows[0].keys(), [row.values() for row in rows])


def main():
    chosen = runs.given(runs.parser(__doc__))
    with open(QUARTER_CAR, encoding="utf-8") as file:
        scenes = [("quarter car", file.read())] + ([] if chosen.smallest else [("coach on ballast", COACH)])
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, text in scenes:
            rows.append(measured(chosen.build, folder, name, text, 1 if chosen.smallest else 5))
        table(os.path.join(chosen.out, "gradient.csv"), rows)
        table(os.path.join(chosen.out, "gradient_fit.csv"), fits(chosen.build, folder, scenes[0][1]))


if __name__ == "__main__":
    main()
