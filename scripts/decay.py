#!/usr/bin/python3
"""Reads frequencies and damping ratios from a free decay: decay.py SERIES.csv [--from S] [--to S] [--modes N]

The table contains for each mode frequency, damping ratio and amplitude with their standard errors: the least-squares
fit of damped sines and a constant. With one mode it also contains the logarithmic decrement of successive maxima. The
series is a table of times and values at equal intervals, like those of fits; the decay must be free of loads.
"""

import argparse
import sys
from typing import NamedTuple

import numpy as np
import output_files
from input_files import LARGEST_TABLE, InputError, text_of

FEWEST = 20             # values
MOST_COLUMNS = 400      # of the matrix of delayed values
EVEN = 1e-3             # largest relative difference of the intervals
MOST_MODES = 10
MOST_ITERATIONS = 60
SMALLEST_STEP = 1e-12   # relative change of the parameters at which the iteration ends
FEWEST_MAXIMA = 3
LEAST_MAXIMUM = 0.05    # relative to the largest value
LEAST_OVER_NOISE = 5.0


class Mode(NamedTuple):
    frequency: float        # Hz, damped
    ratio: float
    amplitude: float        # at the first value
    frequency_error: float  # standard errors
    ratio_error: float


class Decrement(NamedTuple):
    value: float   # logarithmic decrement
    maxima: int
    frequency: float  # Hz
    ratio: float


def basis(t, lambdas):
    """Columns exp(-d t) cos(w t), exp(-d t) sin(w t) of each lambda = -d + i w, and a constant."""
    columns = []
    for one in lambdas:
        wave = np.exp(one * t)
        columns += [wave.real, wave.imag]
    return np.column_stack([*columns, np.ones_like(t)])


def first_lambdas(values, interval, count):
    """The `count` strongest oscillations by the matrix pencil of delayed values.

    Y. Hua, T. K. Sarkar, IEEE Trans. Acoust. Speech Signal Process. 38 (1990) 814.
    """
    columns = min(len(values) // 3, MOST_COLUMNS)
    delayed = np.lib.stride_tricks.sliding_window_view(values, columns + 1)
    rank = min(4 * count + 1, columns)
    right = np.linalg.svd(delayed, full_matrices=False)[2][:rank].T
    poles = np.linalg.eigvals(np.linalg.pinv(right[:-1]) @ right[1:])
    lambdas = np.log(poles[np.abs(poles) > 0.0].astype(complex)) / interval
    lambdas = lambdas[(lambdas.imag > 0.0) & (lambdas.imag < 0.999 * np.pi / interval)]
    if len(lambdas) < count:
        raise ValueError(f"the series has {len(lambdas)} oscillations; allowed: at most as many modes")
    t = interval * np.arange(len(values))
    lambdas = np.minimum(lambdas.real, 0.0) + 1j * lambdas.imag
    parts = basis(t, lambdas)
    factors = np.linalg.lstsq(parts, values, rcond=None)[0]
    energy = [np.sum((parts[:, 2 * i:2 * i + 2] @ factors[2 * i:2 * i + 2]) ** 2) for i in range(len(lambdas))]
    return lambdas[np.argsort(energy)[::-1][:count]]


def linearised(t, lambdas, values):
    """Residuals, and their derivatives with respect to d, w and the two factors of each mode, and to the constant."""
    parts = basis(t, lambdas)
    factors = np.linalg.lstsq(parts, values, rcond=None)[0]
    columns = []
    for i in range(len(lambdas)):
        a, b = factors[2 * i:2 * i + 2]
        cosine, sine = parts[:, 2 * i], parts[:, 2 * i + 1]
        columns += [-t * (a * cosine + b * sine), t * (b * cosine - a * sine), cosine, sine]
    return values - parts @ factors, np.column_stack([*columns, parts[:, -1]]), factors


def modes_of(values, interval, count):
    """The fitted modes by ascending frequency, the constant, and the root mean square of the residuals.

    values: [n], at equal intervals (s). ValueError if the series has fewer oscillations or the fit does not converge.
    """
    t = interval * np.arange(len(values))
    lambdas = first_lambdas(values - np.mean(values), interval, count)
    residuals, jacobian, factors = linearised(t, lambdas, values)
    for _ in range(MOST_ITERATIONS):
        step = np.linalg.lstsq(jacobian, residuals, rcond=None)[0]
        change = np.array([-step[4 * i] + 1j * step[4 * i + 1] for i in range(count)])
        share = 1.0
        while share > 1e-6:  # shorter steps until the residuals decrease
            tried = linearised(t, lambdas + share * change, values)
            if tried[0] @ tried[0] <= residuals @ residuals:
                break
            share /= 2.0
        else:
            break
        lambdas = lambdas + share * change
        residuals, jacobian, factors = tried
        if np.max(np.abs(change / lambdas)) < SMALLEST_STEP:
            break
    freedom = max(len(values) - jacobian.shape[1], 1)
    covariance = np.linalg.pinv(jacobian.T @ jacobian) * (residuals @ residuals / freedom)
    found = []
    for i, one in enumerate(lambdas):
        decay, omega, size = -one.real, one.imag, abs(one)
        slope = np.array([omega**2, -decay * omega]) / size**3  # of decay/size with respect to decay and omega
        block = covariance[4 * i:4 * i + 2, 4 * i:4 * i + 2]
        found.append(Mode(omega / (2 * np.pi), decay / size, np.hypot(*factors[2 * i:2 * i + 2]),
                          np.sqrt(block[1, 1]) / (2 * np.pi), np.sqrt(slope @ block @ slope)))
    return sorted(found), factors[-1], np.sqrt(residuals @ residuals / len(values))


def decrement_of(values, interval, frequency, noise=0.0):
    """The logarithmic decrement of the maxima above rest, which is 0; None with fewer than three maxima.

    A maximum is the largest value within 0.4 periods of the frequency (Hz) on either side, in place and height that of a
    parabola through the values within a tenth of a period. Maxima below five times the noise are left out.
    """
    beside, near = (max(1, round(part / (frequency * interval))) for part in (0.4, 0.1))
    least, places, logs = max(LEAST_MAXIMUM * values.max(), LEAST_OVER_NOISE * noise), [], []
    for i in range(near, len(values) - near):
        if values[i] < least or values[i] < values[max(i - beside, 0):i + beside + 1].max():
            continue
        bend, slope, height = np.polyfit(np.arange(-near, near + 1), values[i - near:i + near + 1], 2)
        places.append(i - 0.5 * slope / bend)
        logs.append(np.log(height - 0.25 * slope**2 / bend))
    if len(logs) < FEWEST_MAXIMA:
        return None
    numbers = np.arange(len(logs))
    value = -np.polyfit(numbers, logs, 1)[0]
    return Decrement(value, len(logs), 1.0 / (np.polyfit(numbers, places, 1)[0] * interval),
                     value / np.sqrt(4.0 * np.pi**2 + value**2))


def is_number(word):
    try:
        float(word)
    except ValueError:
        return False
    return True


def read(path, column, first, last):
    """(values, interval) of a column of a table between two times. A line of names may be above the numbers."""
    lines = [line.partition("#")[0].replace(",", " ").replace(";", " ").split()
             for line in text_of(path, LARGEST_TABLE).splitlines()]
    rows = [line for line in lines if line]
    if rows and not is_number(rows[0][0]):
        del rows[0]
    if not rows or column < 2 or min(map(len, rows)) < column:
        raise ValueError(f"has no column {column} in every line")
    table = np.array([[float(row[0]), float(row[column - 1])] for row in rows])
    table = table[(table[:, 0] >= first) & (table[:, 0] <= last)]
    if len(table) < FEWEST or not np.all(np.isfinite(table)):
        raise ValueError(f"has {len(table)} finite rows between these times; allowed: at least {FEWEST}")
    steps = np.diff(table[:, 0])
    if not np.mean(steps) > 0.0 or np.max(np.abs(steps - np.mean(steps))) > EVEN * np.mean(steps):
        raise ValueError("its times are not at equal intervals")
    return table[:, 1], np.mean(steps)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("series", help="a table of times (s) and values, with decimal points")
    parser.add_argument("--from", dest="first", type=float, default=-np.inf, help="time at which the loads have left (s)")
    parser.add_argument("--to", dest="last", type=float, default=np.inf, help="last time that is used (s)")
    parser.add_argument("--column", type=int, default=2, help="column of the values (default: 2)")
    parser.add_argument("--modes", type=int, default=1, help="number of modes (default: 1)")
    given = parser.parse_args()
    try:
        if not 1 <= given.modes <= MOST_MODES:
            raise ValueError(f"--modes {given.modes}: allowed: 1 to {MOST_MODES}")
        values, interval = read(given.series, given.column, given.first, given.last)
        modes, constant, rest = modes_of(values, interval, given.modes)
    except InputError as error:
        sys.exit(f"decay.py: {error}")
    except (ValueError, np.linalg.LinAlgError) as error:
        sys.exit(f"decay.py: {given.series}: {error}")
    print(f"{'mode':>4} {'frequency (Hz)':>24} {'damping ratio':>24} {'amplitude':>12}")
    for number, mode in enumerate(modes, 1):
        print(f"{number:4d} {mode.frequency:12.6g} +- {mode.frequency_error:8.2g} {mode.ratio:12.5g} +- "
              f"{mode.ratio_error:8.2g} {mode.amplitude:12.4g}")
    print(f"root mean square of the residuals {rest:.3g}, of {len(values)} values")
    decrement = decrement_of(values - constant, interval, modes[0].frequency, rest) if given.modes == 1 else None
    if decrement:
        print(f"logarithmic decrement {decrement.value:.4g} of {decrement.maxima} maxima: damping ratio "
              f"{decrement.ratio:.4g}, frequency {decrement.frequency:.5g} Hz")


if __name__ == "__main__":
    output_files.run(main)
