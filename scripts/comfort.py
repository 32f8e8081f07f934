#!/usr/bin/python3
"""Computes ride comfort indices of runs: comfort.py RESULTS.h5... [--body NAME] [--at METRES,...]

For the vertical acceleration of the car body of each vehicle, at its centre and at the given distances from it, the
table contains the root mean square, unweighted and weighted by Wb, the comfort index of EN 12299 and Sperling's ride
index. The model is planar: the index N_MV is that of the vertical direction only, 6 times the 95th percentile of the
weighted root mean squares of windows of 5 s. A shorter run is one window; the table contains the number of windows.
"""

import argparse
import sys
from typing import NamedTuple

import checked_results
import numpy as np
import output_files
from picture_data import Results, car_body

WINDOW = 5.0  # s


class Comfort(NamedTuple):
    rms: float       # m/s2
    weighted: float  # m/s2, largest of all windows
    windows: int
    n_mv: float
    sperling: float


def weighting_b(f):
    """|H| of Wb at f (Hz), EN 12299: band 0.4 to 100 Hz, transition at 16 Hz, step from 2.5 to 4 Hz, gain 0.4."""
    s = 2j * np.pi * np.asarray(f, dtype=float)

    def w(hertz):
        return 2.0 * np.pi * hertz

    def second(hertz, q):
        return 1.0 + s / (q * w(hertz)) + (s / w(hertz)) ** 2

    band = (s / w(0.4)) ** 2 / second(0.4, 0.7071) / second(100.0, 0.7071)
    transition = (1.0 + s / w(16.0)) / second(16.0, 0.63)
    step = second(2.5, 0.8) / second(4.0, 0.8)
    return np.abs(0.4 * band * transition * step)


def sperling_b(f):
    """Sperling's weighting of vertical accelerations at f (Hz)."""
    f = np.asarray(f, dtype=float)
    return 0.588 * np.sqrt((1.911 * f**2 + (0.25 * f**2) ** 2)
                           / ((1.0 - 0.277 * f**2) ** 2 + (1.563 * f - 0.0368 * f**3) ** 2))


def weighted(values, interval):
    """The series filtered by Wb; appended zeros separate its end from its start."""
    n = len(values)
    spectrum = np.fft.rfft(values, 2 * n)
    return np.fft.irfft(spectrum * weighting_b(np.fft.rfftfreq(2 * n, interval)), 2 * n)[:n]


def sperling(values, interval):
    """Wz = (2 integral of (100 B)^2 S df)^0.15, with the one-sided spectral density S of the acceleration, m2/s4/Hz."""
    n = len(values)
    power = 2.0 * np.abs(np.fft.rfft(values)) ** 2 / n**2
    power[0] /= 2.0
    if n % 2 == 0:
        power[-1] /= 2.0
    return (2.0 * np.sum((100.0 * sperling_b(np.fft.rfftfreq(n, interval))) ** 2 * power)) ** 0.15


def comfort(values, interval):
    values = np.asarray(values, dtype=float)
    felt = weighted(values, interval) ** 2
    a_window = max(1, min(len(felt), round(WINDOW / interval)))
    windows = len(felt) // a_window
    means = np.sqrt(felt[:windows * a_window].reshape(windows, a_window).mean(axis=1))
    return Comfort(np.sqrt(np.mean(values**2)), means.max(), windows, 6.0 * np.quantile(means, 0.95),
                   sperling(values, interval))


def complain(text):
    sys.exit(f"comfort.py: {text}")


def of_file(path, body, distances):
    """Yields the rows of one file: path, vehicle, body, distance, Comfort."""
    try:
        with checked_results.opened(path) as file:
            results = Results(file)
            if results.time is None or len(results.time) < 3 or not results.vehicles:
                complain(f"{path} holds no vehicles over time")
            steps = np.diff(results.time)
            if np.ptp(steps) > 1e-6 * steps[0]:
                complain(f"{path}: its samples are not evenly spaced")
            for i, vehicle in enumerate(results.vehicles):
                name = body or car_body(vehicle)
                if name is None or f"{name}/acceleration" not in vehicle:
                    complain(f"{path}: vehicle {i} has no body {name or 'with a mass'}")
                a = results.over_time(vehicle[f"{name}/acceleration"])
                for x in distances:
                    yield path, i, name, x, comfort(a[:, 1] + x * a[:, 2], steps[0])
    except checked_results.ResultsError as error:
        complain(f"{path} {error}")
    except Exception as error:
        complain(f"{path}: {checked_results.in_one_line(error)}")


def main():
    arguments = argparse.ArgumentParser(prog="comfort.py", description=__doc__,
                                        formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("runs", nargs="+", metavar="RESULTS.h5")
    arguments.add_argument("--body", help="of every vehicle; left out: the one that the pictures take for its car")
    arguments.add_argument("--at", default="0", metavar="METRES,...", help="distances from the body's centre, + forward")
    given = arguments.parse_args()
    try:
        distances = [float(x) for x in given.at.split(",")]
    except ValueError:
        arguments.error("--at: allowed: numbers of metres with commas between them")
    rows = [row for path in given.runs for row in of_file(path, given.body, distances)]
    print(f"{'run':32}{'vehicle':>8} {'body':12}{'at m':>7}{'rms m/s2':>10}{'Wb m/s2':>9}{'windows':>9}{'N_MV z':>8}"
          f"{'Sperling':>10}")
    for path, i, name, x, felt in rows:
        print(f"{path:32}{i:8} {name:12}{x:7.4g}{felt.rms:10.4f}{felt.weighted:9.4f}{felt.windows:9}{felt.n_mv:8.3f}"
              f"{felt.sperling:10.3f}")


if __name__ == "__main__":
    output_files.run(main)
