#!/usr/bin/python3
"""Computes ranges, damage and life of stored series: fatigue.py RESULTS.h5[=PASSAGES_A_DAY]... --of SERIES

SERIES is any dataset over time, e.g. /probes/moment, /supports/reaction[0,1], /vehicles/0/leading/reaction. Of a
dataset with several columns, each column is evaluated, or the one in brackets. Cycles are counted by rainflow (ASTM
E1049-85, three points; the residue counts as half cycles) between the stored instants, so that output_interval must be
short enough for the peaks. Several files are the trains of a day, each with its number of passages; each passage is
evaluated separately.
"""

import argparse
import re
import sys
from typing import NamedTuple

import checked_results
import h5py
import numpy as np
import output_files

DAYS_A_YEAR = 365.25
HEAD = ["series", "range", "mean", "count"]  # of the table of cycles


class Cycle(NamedTuple):
    range: float
    mean: float
    count: float  # 1, or 0.5 for a half cycle


def reversals(values):
    """The first value, all local extremes, and the last value."""
    values = np.asarray(values, dtype=float)
    values = values[np.diff(values, prepend=np.nan) != 0.0]  # a plateau becomes one value
    if len(values) < 3:
        return values
    steps = np.diff(values)
    return values[np.concatenate([[True], steps[:-1] * steps[1:] < 0.0, [True]])]


def rainflow(values):
    """The cycles of a series by ASTM E1049-85, 5.4.4."""
    cycles, kept = [], []

    def count(i, weight):
        cycles.append(Cycle(abs(kept[i + 1] - kept[i]), 0.5 * (kept[i] + kept[i + 1]), weight))

    for value in reversals(values):
        kept.append(value)
        while len(kept) >= 3:
            last, before = abs(kept[-1] - kept[-2]), abs(kept[-2] - kept[-3])
            if last < before:
                break
            if len(kept) == 3:  # the range contains the start
                count(0, 0.5)
                del kept[0]
            else:
                count(len(kept) - 3, 1.0)
                del kept[-3:-1]
    for i in range(len(kept) - 1):
        count(i, 0.5)
    return cycles


class Line(NamedTuple):
    """An S-N curve: the number of cycles N = cycles (range at/range)^slope in each piece."""
    name: str
    pieces: tuple  # (least range, range at, cycles, slope), by descending range; smaller ranges cause no damage

    def damage(self, cycles):
        total = 0.0
        for cycle in cycles:
            for least, at, repeated, slope in self.pieces:
                if cycle.range >= least:
                    total += cycle.count * (cycle.range / at) ** slope / repeated if cycle.range > 0.0 else 0.0
                    break
        return total

    @property
    def slope(self):
        return self.pieces[0][3]


def en1993(category):
    """EN 1993-1-9, direct stress: slope 3 up to 5e6 cycles, 5 up to 1e8, with the cut-off limit there."""
    constant = category * (2.0 / 5.0) ** (1.0 / 3.0)
    cut_off = constant * (5.0 / 100.0) ** (1.0 / 5.0)
    return Line(f"EN 1993-1-9, category {category:g}",
                ((constant, category, 2e6, 3.0), (cut_off, constant, 5e6, 5.0)))


def line_of(text):
    kind, _, numbers = text.partition(":")
    try:
        values = [float(number) for number in numbers.split(",")]
        if min(values) > 0.0 and (kind, len(values)) == ("en1993", 1):
            return en1993(values[0])
        if min(values) > 0.0 and (kind, len(values)) == ("slope", 3):
            slope, at, cycles = values
            return Line(f"slope {slope:g} through {at:g} at {cycles:g} cycles", ((0.0, at, cycles, slope),))
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"{text}: allowed: en1993:CATEGORY or slope:M,RANGE,CYCLES, numbers above 0")


def equivalent_range(cycles, slope, repeated):
    """The constant range that causes the damage of all cycles with this number of repetitions."""
    return (sum(c.count * c.range**slope for c in cycles) / repeated) ** (1.0 / slope)


def number(text):
    """A number, or a quotient such as 1/0.35."""
    try:
        above, _, below = text.partition("/")
        return float(above) / float(below or 1.0)
    except (ValueError, ZeroDivisionError):
        raise argparse.ArgumentTypeError(f"{text}: allowed: a number, or one over another")


def series_of(file, wanted):
    """{name: values over time} of the columns of a dataset, or of one of them."""
    found = re.fullmatch(r"/?([^\[\]]+)(?:\[([\d, ]+)\])?", wanted)
    if not found or found[1] not in file or not isinstance(file[found[1]], h5py.Dataset) or "time" not in file:
        sys.exit(f"fatigue.py: {file.filename} has no series {wanted} over /time")
    data, rows = file[found[1]], len(file["time"])
    if data.ndim == 0 or data.shape[0] < rows or data.dtype.kind != "f":
        sys.exit(f"fatigue.py: {wanted} of {file.filename} is no series over /time")
    columns = [tuple(int(i) for i in found[2].split(","))] if found[2] else list(np.ndindex(data.shape[1:]))
    for column in columns:
        if len(column) != data.ndim - 1 or any(i >= n for i, n in zip(column, data.shape[1:])):
            sys.exit(f"fatigue.py: {wanted}: its columns are {list(data.shape[1:])}")
    values = data[:rows]
    return {f"/{found[1]}" + (f"[{','.join(map(str, c))}]" if c else ""): values[(slice(None), *c)] for c in columns}


def passages(text):
    path, equals, count = text.rpartition("=")
    if not equals:
        return text, 1.0
    try:
        if float(count) > 0.0:
            return path, float(count)
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"{text}: passages a day are a number above 0")


def counted(runs, wanted, factor):
    """{series: cycles of a day} of all runs, with ranges and means multiplied by the factor."""
    days = {}
    for path, times in runs:
        try:
            with checked_results.opened(path) as file:
                series = series_of(file, wanted)
        except checked_results.ResultsError as error:
            sys.exit(f"fatigue.py: {path} {error}")
        except Exception as error:
            sys.exit(f"fatigue.py: {path}: {checked_results.in_one_line(error)}")
        for name, values in series.items():
            days.setdefault(name, []).extend(
                Cycle(c.range * abs(factor), c.mean * factor, c.count * times) for c in rainflow(values))
    return days


def table(days, line, repeated):
    """Lines of text, one for each series."""
    slope = line.slope if line else None
    head = f"{'series':44}{'cycles':>10}{'largest range':>15}"
    lines = [head + (f"{'damage a day':>14}{'years':>10}{f'range at {repeated:g}':>17}" if line else "")]
    for name, cycles in days.items():
        text = f"{name:44}{sum(c.count for c in cycles):10.6g}{max((c.range for c in cycles), default=0.0):15.6g}"
        if line:
            damage = line.damage(cycles)
            years = f"{1.0 / (damage * DAYS_A_YEAR):10.4g}" if damage > 0.0 else f"{'no end':>10}"
            text += f"{damage:14.4e}{years}{equivalent_range(cycles, slope, repeated):17.6g}"
        lines.append(text)
    return lines


def main():
    arguments = argparse.ArgumentParser(prog="fatigue.py", description=__doc__,
                                        formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("runs", nargs="+", type=passages, metavar="RESULTS.h5[=PASSAGES_A_DAY]")
    arguments.add_argument("--of", required=True, metavar="SERIES", help="a dataset over time, or a column of it")
    arguments.add_argument("--factor", type=number, default=1.0,
                           help="the stress that a unit of the series makes, e.g. 1/0.35 for a moment and a modulus")
    arguments.add_argument("--line", type=line_of, help="en1993:CATEGORY, or slope:M,RANGE,CYCLES, in the stress's unit")
    arguments.add_argument("--cycles", type=float, default=2e6, help="of the equivalent range; left out: 2e6")
    arguments.add_argument("--csv", metavar="OUT.csv", help="every cycle of a day: series, range, mean, count")
    given = arguments.parse_args()
    if not given.cycles > 0.0:
        arguments.error("--cycles: allowed: a number above 0")
    if given.csv:
        output_files.check_or_exit("fatigue.py", given.csv, "csv", [path for path, _ in given.runs], HEAD)
    days = counted(given.runs, given.of, given.factor)
    if given.line:
        print(f"damage by {given.line.name}; the range at {given.cycles:g} cycles by its first slope, "
              f"{given.line.slope:g}, for the passages of one day")
    print("\n".join(table(days, given.line, given.cycles)))
    if given.csv:
        output_files.write_table_or_exit("fatigue.py", given.csv, HEAD,
                                         ([name, *cycle] for name, cycles in days.items() for cycle in cycles))


if __name__ == "__main__":
    output_files.run(main)
