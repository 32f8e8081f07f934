#!/usr/bin/python3
"""Roughness and quality of a track: track_quality.py PROFILE [--train NAME] [--length M] [--from M] [--to M]

PROFILE is a table of x and height (m), or a results file of a run with output_profile. For parts of the track and for
all of it the table contains the International Roughness Index (IRI), and the standard deviations in the wavelengths D1
(3 to 25 m) and D2 (25 to 70 m) of EN 13848-1. A line gives the class of ISO 8608.
"""

import argparse
import re
import sys
from typing import NamedTuple

import checked_results
import numpy as np
import output_files
from input_files import LARGEST_TABLE, InputError, text_of

FEWEST = 20          # rows
EVEN = 1e-3          # largest relative difference of the distances of rows that count as equal
MOST_STATIONS = 5_000_000
ALLOWED_ROWS = "allowed: x and height in m, two numbers with decimal points"

# The quarter car of the IRI, divided by its sprung mass: M. W. Sayers, On the calculation of International Roughness
# Index from longitudinal road profile, Transportation Research Record 1501 (1995) 1-12; ASTM E1926.
TYRE, SPRING, DAMPER, AXLE = 653.0, 63.3, 6.0, 0.15  # 1/s2, 1/s2, 1/s, 1
SPEED = 80.0 / 3.6       # m/s
MOVING_AVERAGE = 0.25    # m
START_LENGTH = 11.0      # m: the car starts on the mean slope of this length
LARGEST_SPACING = 0.61   # m

BANDS = {"D1": (3.0, 25.0), "D2": (25.0, 70.0)}  # m, wavelengths of EN 13848-1
SLOPE = 8                # power of the frequency at each end of a band: of a Butterworth filter of order 4
LENGTHS = 2.0            # of the longest wave of a band, which a profile must contain

# ISO 8608: Gd(n) = Gd(n0) (n/n0)^-w; class A ends at twice its geometric mean, each further class at four times more.
N0 = 0.1                                    # cycles/m
LOWEST, HIGHEST = 0.011, 2.83               # cycles/m
CLASSES, END_OF_A, FACTOR = "ABCDEFGH", 32e-6, 4.0  # m3
SEGMENT = 256.0          # m, longest segment of the mean spectrum
WAVES_IN_SEGMENT = 4.0   # of the longest wave that is used
STATIONS_IN_WAVE = 4.0   # of the shortest one
FEWEST_BANDS = 4
LARGEST_DROP = 30.0      # a third of an octave with less than the median over this is left out


class Spectrum(NamedTuple):
    density: float        # Gd(n0) of the line with w = 2, m3
    exponent: float       # w of the line with a free exponent
    longest: float        # m, wavelengths
    shortest: float


def transition(spacing):
    """The matrices of a step between stations, state = matrix @ state + vector * slope, exact for a straight profile.

    The state is the slope of the body's path, its rate (1/s), the slope of the axle's path, and its rate.
    """
    a = np.array([[0.0, 1.0, 0.0, 0.0], [-SPRING, -DAMPER, SPRING, DAMPER], [0.0, 0.0, 0.0, 1.0],
                  [SPRING / AXLE, DAMPER / AXLE, -(TYRE + SPRING) / AXLE, -DAMPER / AXLE]])
    values, vectors = np.linalg.eig(a)
    matrix = ((vectors * np.exp(values * spacing / SPEED)) @ np.linalg.inv(vectors)).real
    return matrix, np.linalg.solve(a, (matrix - np.eye(4)) @ np.array([0.0, 0.0, 0.0, TYRE / AXLE]))


def rectified_slopes(height, spacing):
    """The rectified slope between axle and body (1) for each step from the first station on; its mean is the IRI."""
    reach = max(1, int(MOVING_AVERAGE / spacing + 0.5))  # the mean over 0.25 m changes by the difference of its ends
    slopes = (height[reach:] - height[:-reach]) / (reach * spacing)
    matrix, vector = transition(spacing)
    start = min(len(height) - 1, max(1, round(START_LENGTH / spacing)))
    mean = (height[start] - height[0]) / (start * spacing)
    state, rectified = np.array([mean, 0.0, mean, 0.0]), np.empty(len(slopes))
    for i, slope in enumerate(slopes):
        state = matrix @ state + vector * slope
        rectified[i] = abs(state[2] - state[0])
    return rectified


def in_band(height, spacing, shortest, longest):
    """The profile's part in a band of wavelengths (m) without a shift of phase; reflected at both ends."""
    line = np.polyval(np.polyfit(np.arange(len(height)), height, 1), np.arange(len(height)))
    level = height - line
    beside = min(len(level) - 1, int(np.ceil(LENGTHS * longest / spacing)))
    mirrored = np.concatenate([2.0 * level[0] - level[beside:0:-1], level, 2.0 * level[-1] - level[-2:-beside - 2:-1]])
    n = np.fft.rfftfreq(len(mirrored), spacing)
    gain = np.zeros_like(n)
    gain[1:] = 1.0 / np.sqrt((1.0 + (n[1:] * shortest)**SLOPE) * (1.0 + (n[1:] * longest)**-SLOPE))
    return np.fft.irfft(np.fft.rfft(mirrored) * gain, len(mirrored))[beside:beside + len(level)]


def density(height, spacing):
    """Wavenumbers (cycles/m) and the one-sided density (m3): the mean of half-overlapping segments with Hann windows."""
    count = min(len(height), int(SEGMENT / spacing))
    places, window = np.arange(count), np.hanning(count + 1)[:-1]
    squares = []
    for first in range(0, len(height) - count + 1, max(1, count // 2)):
        part = height[first:first + count]
        squares.append(np.abs(np.fft.rfft(window * (part - np.polyval(np.polyfit(places, part, 1), places))))**2)
    return np.fft.rfftfreq(count, spacing), 2.0 * spacing * np.mean(squares, axis=0) / np.sum(window**2)


def spectrum_of(height, spacing):
    """The lines through the densities of thirds of octaves; None if the profile has too few of these."""
    n, g = density(height, spacing)
    low = max(LOWEST, WAVES_IN_SEGMENT * n[1])
    high = min(HIGHEST, 1.0 / (STATIONS_IN_WAVE * spacing))
    edges = low * 2.0**(np.arange(int(max(0.0, 3.0 * np.log2(high / low))) + 1) / 3.0)
    if len(edges) <= FEWEST_BANDS or not edges[0] <= N0 <= edges[-1]:
        return None
    power = np.concatenate([[0.0], np.cumsum(0.5 * (g[1:] + g[:-1]) * np.diff(n))])
    means = np.diff(np.interp(edges, n, power)) / np.diff(edges)
    x = np.log(np.sqrt(edges[1:] * edges[:-1]) / N0)
    levels = means * np.exp(2.0 * x)
    used = levels > np.median(levels) / LARGEST_DROP  # the profile may end at some wavelength
    if np.count_nonzero(used) < FEWEST_BANDS:
        return None
    y = np.log(np.maximum(means, np.finfo(float).tiny))
    x, y, first, last = x[used], y[used], np.argmax(used), len(used) - np.argmax(used[::-1])
    return Spectrum(np.exp(np.mean(y + 2.0 * x)), -np.polyfit(x, y, 1)[0], 1.0 / edges[first], 1.0 / edges[last])


def class_of(density_at_n0):
    """The class of ISO 8608 with this Gd(n0), m3."""
    return next((name for k, name in enumerate(CLASSES[:-1]) if density_at_n0 < END_OF_A * FACTOR**k), CLASSES[-1])


def of_results(path, train):
    """x and height of a results file."""
    with checked_results.opened(path) as file:
        name = f"track/profile_of/{train}" if train else "track/profile"
        others = list(file.get("track/profile_of", ()))
        if name not in file:
            raise ValueError(f"holds no /{name}; " + (f"allowed: --train {' or '.join(others)}" if others else
                                                      "run it with -output_profile auto, on a track that is not level"))
        return file[f"{name}/x"][:], file[f"{name}/height"][:]


def of_table(path):
    """x and height of a table, whose first line may contain names."""
    rows, named = [], False
    for number, text in enumerate(text_of(path, LARGEST_TABLE).splitlines(), 1):
        line = text.partition("#")[0]
        try:
            row = [float(word) for word in line.replace(",", " ").replace(";", " ").split()]
        except ValueError:
            if rows or named or any(unit != "m" for unit in re.findall(r"[\[(]\s*([^\s\])]*)", line)):
                raise InputError(f"{path}:{number}: {ALLOWED_ROWS}") from None
            named = True
            continue
        if len(row) == 2:
            rows.append(row)
        elif row:
            raise InputError(f"{path}:{number}: {ALLOWED_ROWS}")
    columns = np.array(rows).reshape(-1, 2).T
    return columns[0], columns[1]


def at_even_stations(x, height, first, last):
    """(x, height, spacing, whether they are interpolated) between two places."""
    if not (np.all(np.isfinite(x)) and np.all(np.isfinite(height))):
        raise ValueError("contains numbers that are not finite")
    chosen = (x >= first) & (x <= last)
    x, height = x[chosen], height[chosen]
    if len(x) < FEWEST:
        raise ValueError(f"has {len(x)} rows there; allowed: at least {FEWEST}")
    steps = np.diff(x)
    if not np.all(steps > 0.0):
        raise ValueError("x does not increase from row to row")
    spacing = np.mean(steps)
    if np.max(np.abs(steps - spacing)) <= EVEN * spacing:
        return x, height, spacing, False
    spacing = np.median(steps)
    count = int((x[-1] - x[0]) / spacing) + 1
    if count > MOST_STATIONS:
        raise ValueError(f"has rows at very different distances; allowed: at most {MOST_STATIONS:,} stations at the "
                         f"median distance, {spacing:.3g} m")
    even = x[0] + spacing * np.arange(count)
    return even, np.interp(even, x, height), spacing, True


def parts(x, length):
    """Slices of the stations: whole lengths (m) from the first station on if there are several, and all stations."""
    count = int((x[-1] - x[0]) / length * (1.0 + 1e-12))
    count = count if count > 1 else 0
    if count > len(x):
        raise ValueError(f"--length {length:g}: allowed: at least the distance of the stations")
    ends = np.searchsorted(x, x[0] + length * np.arange(count + 1) - 1e-9 * length)
    return [*(slice(a, b) for a, b in zip(ends, ends[1:])), slice(0, len(x))]


def report(x, height, spacing, length):
    """Yields the printed lines."""
    rectified = rectified_slopes(height, spacing) if spacing <= LARGEST_SPACING else None
    bands = {name: in_band(height, spacing, *waves) if x[-1] - x[0] >= LENGTHS * waves[1] and spacing <= waves[0] / 4
             else None for name, waves in BANDS.items()}

    def number(values, scale):
        return f"{scale(values):12.4g}" if values is not None and len(values) else f"{'-':>12}"
    yield f"{'from (m)':>12} {'to (m)':>12} {'IRI (mm/m)':>12} {'D1 (mm)':>12} {'D2 (mm)':>12}"
    for part in parts(x, length):
        last = min(part.stop, len(x) - 1)
        cells = [number(None if rectified is None else rectified[part], lambda values: 1e3 * np.mean(values))]
        cells += [number(None if band is None else band[part], lambda values: 1e3 * np.std(values))
                  for band in bands.values()]
        yield f"{x[part.start]:12.6g} {x[last]:12.6g} {' '.join(cells)}"
    if rectified is None:
        yield f"no IRI: the stations are {spacing:.3g} m apart; allowed: up to {LARGEST_SPACING:g} m"
    for name, band in bands.items():
        if band is None:
            yield (f"no {name}: it needs {LENGTHS * BANDS[name][1]:g} m of track with stations at most "
                   f"{BANDS[name][0] / 4:g} m apart")
    found = spectrum_of(height, spacing)
    yield ("no class of ISO 8608: the profile has too few wavelengths around 10 m" if found is None else
           f"ISO 8608: Gd(n0) {found.density:.4g} m3, class {class_of(found.density)}, by waves of {found.shortest:.3g} to "
           f"{found.longest:.3g} m with w = 2; the best w is {found.exponent:.3g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("profile", metavar="PROFILE", help="a table of x and height (m), or RESULTS.h5")
    parser.add_argument("--train", help="of a results file: the train with a running surface of its own")
    parser.add_argument("--length", type=float, default=100.0, metavar="M", help="of the parts (default: 100 m)")
    parser.add_argument("--from", dest="first", type=float, default=-np.inf, metavar="M", help="first x that is used")
    parser.add_argument("--to", dest="last", type=float, default=np.inf, metavar="M", help="last x that is used")
    given = parser.parse_args()
    try:
        if not 0.0 < given.length < np.inf:
            raise ValueError(f"--length {given.length:g}: allowed: above 0")
        is_results = given.profile.endswith(".h5")
        if given.train and not is_results:
            raise ValueError("--train: allowed with a results file")
        x, height = of_results(given.profile, given.train) if is_results else of_table(given.profile)
        x, height, spacing, interpolated = at_even_stations(x, height, given.first, given.last)
        lines = list(report(x, height, spacing, given.length))
    except InputError as error:
        sys.exit(f"track_quality.py: {error}")
    except Exception as error:
        sys.exit(f"track_quality.py: {given.profile}: {checked_results.in_one_line(error)}")
    if interpolated:
        lines.append(f"the rows are not evenly spaced: straight lines between them, every {spacing:.4g} m")
    print(*lines, sep="\n")


if __name__ == "__main__":
    output_files.run(main)
