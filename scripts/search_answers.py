"""The answers of a search (find_option) in a results file: ratios to the bound, the intervals within it, and what
governs beyond their ends. All values are in the units of the file."""

import math
import re
from typing import NamedTuple, Optional

import numpy as np
import yaml


class Governing(NamedTuple):
    """What has the greatest ratio at a searched value."""
    quantity: str
    ratio: float  # NaN: not every run determines the quantities
    run: int


class Interval(NamedTuple):
    """Values within the bound. at_end: whether an end is one of the searched range; beyond: what governs next to each
    end, None at the ends of the range."""
    ends: tuple
    at_end: tuple
    beyond: tuple


class Answer(NamedTuple):
    """The answer for all runs, or for those with the same values of find_for_each."""
    parts: list         # [(option, value)]; empty for all runs
    ratio: np.ndarray   # at each searched value
    intervals: list
    closest: Optional[tuple]  # (value, Governing) of the least ratio, if no value is within the bound


class Search:
    """option, unit, value, accuracy: of the search; answers: that of all runs is the last."""

    def __init__(self, results):
        file, group = results.file, results.file["find"]
        self.option, self.accuracy = str(group.attrs["option"]), float(group.attrs["accuracy"])
        self.value, self.unit = group["value"][:], str(group["value"].attrs["unit"])
        options = results.options
        self.asked = options.get("find_quantity", "")
        self.equals = float(options["find_equals"]) if self.asked else None
        self.kept = options.get("find_keep", "limits")
        self.also = [name.strip() for name in options.get("find_also", "").split(",") if name.strip()]
        limited = file["criterion"].asstr()[:] if "criterion" in file else []
        self.factors = factors_of(results)
        self._tables = group["ratio"][:], group["run"][:].astype(int), group["limit"][:].astype(int)
        self._limited = list(limited)
        rows = list(zip(group["interval_answer"][:].astype(int), group["interval"][:], group["interval_at_end"][:]))
        self.answers = [self._answer(i, parts_of(name), [row[1:] for row in rows if row[0] == i])
                        for i, name in enumerate(file["answer"].asstr()[:])]

    def governing(self, answer, place):
        """What governs at the searched value number `place`."""
        ratio, run, limit = (table[answer, place] for table in self._tables)
        return Governing(self.asked or self._limited[limit], float(ratio), int(run))

    def digits(self):
        """Significant digits of the ends of intervals."""
        return max(2 + math.ceil(-math.log10(self.accuracy)), 4)

    def run_at_bound(self):
        """The run with the greatest ratio within the bound, otherwise that with the least ratio of all values."""
        ratio, run, _ = (table[-1] for table in self._tables)
        within = np.where(ratio <= 1.0, ratio, -np.inf)
        return int(run[within.argmax() if np.isfinite(within).any() else np.nanargmin(ratio)])

    def beyond(self):
        """What governs next to the ends of the intervals of all runs, outside of them."""
        return [one for interval in self.answers[-1].intervals for one in interval.beyond if one is not None]

    def _answer(self, number, parts, rows):
        intervals = []
        for ends, at_end in rows:
            first, last = np.searchsorted(self.value, ends)
            beyond = (None if at_end[0] else self.governing(number, first - 1),
                      None if at_end[1] else self.governing(number, last + 1))
            intervals.append(Interval(tuple(ends), tuple(map(bool, at_end)), beyond))
        ratio, closest = self._tables[0][number], None
        if not intervals and np.isfinite(ratio).any():
            least = int(np.nanargmin(ratio))
            closest = self.value[least], self.governing(number, least)
        return Answer(parts, ratio, intervals, closest)


def factors_of(results):
    """{quantity: factor of neglected effects} of the file of limits, a copy of which the results file has."""
    copies = dict(results.file["input/files"].asstr()[:]) if "input/files" in results.file else {}
    rows = yaml.safe_load(copies.get(results.options.get("limits"), "")) or []
    return {row["quantity"]: float(row["factor"]) for row in rows if "factor" in row}


def parts_of(name):
    """[(option, value)] of the name of an answer: 'load_hslm_a 3, beam_mass 2e+04'; empty for 'all'."""
    return [(option, float(value)) for option, value in re.findall(r"(\w+) ([^\s,]+)", name)]
