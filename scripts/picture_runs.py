"""The runs of a sweep or of a study as arrays over their axes, in the units of engineering_units.csv, and limits."""

from typing import NamedTuple

import engineering_units
import numpy as np
from option_words import option_in_words
from traverse_report.language import capital, decimal, known, t
from traverse_report.quantities import QUANTITIES, words_of

# Limits of quantities with another name in the results.
SAME = {"unfiltered_deck_acceleration": "peak_acceleration", "contact_loss": "longest_loss"}
SPAN = "of the span"  # the unit of a deflection over the span
ROWS = {"m": "length", "N/m": "spring_stiffness"}  # of options, where several rows have the same SI unit


def engineering(kind):
    """(unit for print, factor from SI) of a row of engineering_units.csv; without a unit for ''."""
    return engineering_units.shown(kind) if kind else ("", 1.0)


def engineering_of_si(unit):
    """(unit for print, factor) of an option or a quantity with this SI unit."""
    rows = [ROWS[unit]] if unit in ROWS else [kind for kind, row in engineering_units.table().items() if row[0] == unit]
    return engineering(rows[0]) if rows else (engineering_units.printed(unit) if unit != "1" else "", 1.0)


def grouped(value, form):
    """A number with narrow spaces between its thousands; form: a format with a comma."""
    return decimal(format(value, form))


def digits(value):
    """A number with four significant digits, without a power of ten if possible."""
    short = f"{value:.4g}"
    return grouped(float(short), ",.0f") if "e+" in short and abs(value) < 1e7 else decimal(short)


def in_words(value, unit):
    """A value with its unit: '3.5 m/s²', and a deflection over the span as engineers write it: 'L/600'."""
    if unit == SPAN:
        return f"L/{grouped(float(f'{1.0 / value:.4g}'), ',.0f')}" if value > 0.0 else "0"
    return f"{digits(value)} {unit}".strip()


class Axis(NamedTuple):
    """One direction of the table of runs."""
    name: str           # of the option; 'train' for the trains of HSLM-A
    unit: str
    values: np.ndarray  # in this unit
    random: bool = False
    others: tuple = ()  # options that change together with this one

    @property
    def said(self):
        """The option, or the random ones, in words."""
        return " and ".join(known(option_in_words(name)) for name in self.name.split(" and "))

    def label(self):
        name = " with ".join([self.said, *map(option_in_words, self.others)])
        return f"{name} ({self.unit})" if self.unit else name

    def words(self, i):
        """The name of the i-th value: 'A3', '100 MN/m' or 'seed 7'."""
        if self.name == "train":
            return f"A{self.values[i]:.0f}"
        return f"{digits(self.values[i])} {self.unit}" if self.unit else f"{self.said} {digits(self.values[i])}"

    def full_words(self, i):
        """The same with the option in words, which a speed does not need; of several random options the draw."""
        if self.random and " and " in self.name:
            return t("draw {number}", number=i + 1)
        named = self.unit and not self.name.endswith("speed")
        return f"{self.said} {self.words(i)}" if named else self.words(i)


class Limit(NamedTuple):
    value: float  # in the unit of the panel
    short: str    # 'limit 3.5 m/s²'
    words: str    # with the clause


class Runs:
    """axes: the directions with several values in ascending order; the random one, if any, is the last."""

    def __init__(self, results):
        self.results, self.file = results, results.file
        swept = "sweep/speed" in self.file
        self.group = self.file["sweep" if swept else "study"]
        self.shape = tuple(self.group["peak_deflection"].shape[:2] if swept else self.group["shape"][:].astype(int))
        self.all_axes = self._sweep_axes() if swept else self._study_axes()
        kept = [i for i, axis in enumerate(self.all_axes) if len(axis.values) > 1]
        self.order = sorted(kept, key=lambda i: self.all_axes[i].random)
        self.ascending = [np.argsort(self.all_axes[i].values, kind="stable") for i in self.order]
        self.axes = [self.all_axes[i]._replace(values=self.all_axes[i].values[ascending])
                     for i, ascending in zip(self.order, self.ascending)]
        random = [axis for axis in self.axes if axis.random]
        if len(random) > 1:  # all draws together
            size = int(np.prod([len(axis.values) for axis in random]))
            self.axes = [*self.listed, Axis(" and ".join(axis.name for axis in random), "", np.arange(size), True)]

    @property
    def listed(self):
        """The axes with given values; their runs differ in more than a random draw."""
        return [axis for axis in self.axes if not axis.random]

    def _sweep_axes(self):
        unit, factor = engineering("speed")
        trains = self.group["hslm_a"][:] if "hslm_a" in self.group else np.arange(1.0, self.shape[0] + 1.0)
        return [Axis("train", "", trains), Axis("speed", unit, factor * self.group["speed"][:])]

    def _study_axes(self):
        """An axis for each of the study; options that change together have that of the speed, or of the first one."""
        names, found = str(self.group.attrs["dimensions"]).split(","), []
        averaged = set(names) - set(self.group["statistics"]) if "statistics" in self.group else set()
        for number in range(len(self.shape)):
            own = [name for name in names if int(self.group[name].attrs["axis"]) == number]
            random = any(self.group[name].attrs["law"] != "list" for name in own) or \
                all(name.endswith("seed") or name in averaged for name in own)
            name = next((name for name in own if name.endswith("speed")), own[0])
            column = np.moveaxis(self.group[name][:].reshape(self.shape), number, 0)
            column = column.reshape(self.shape[number], -1)[:, 0]
            unit, factor = engineering("speed") if name.endswith("speed") else \
                engineering_of_si(str(self.group[name].attrs.get("unit", "1")))
            if len(np.unique(column)) < len(column) and not random:
                name, unit, factor, column = "row", "", 1.0, np.arange(1.0, len(column) + 1.0)
            words = "train" if name.endswith("hslm_a") else " and ".join(own) if random else name
            others = () if random else tuple(one for one in own if one != name)
            found.append(Axis(words, unit, factor * column, random, others))
        return found

    def run_in_words(self, row, without=()):
        """The values of the varied options in a run: 'bending stiffness EI 100 MN m², 280 km/h'. without: the names of
        axes that are left out."""
        places = zip(self.all_axes, np.unravel_index(row, self.shape))
        return ", ".join(axis.full_words(i) for axis, i in places if len(axis.values) > 1 and axis.name not in without)

    def values(self, name):
        """[axes]: one value for each run in the unit of its panel, NaN without a result; None if the file has none."""
        judged = self._column(name)
        if judged is not None:
            raw = self.group["judged"][:].reshape(*self.shape, -1)[..., judged]
        elif SAME.get(name, name) in self.group:
            raw = self.group[SAME.get(name, name)][:].reshape(*self.shape, -1)
            known = ~np.isnan(raw).any(axis=-1)
            raw = np.where(known, np.abs(np.where(known[..., None], raw, 0.0)).max(axis=-1), np.nan)
        else:
            return None
        if np.isnan(raw).all():
            return None
        unused = tuple(i for i in range(len(self.shape)) if i not in self.order)
        raw = np.transpose(raw, [*self.order, *unused]).reshape([len(ascending) for ascending in self.ascending])
        raw = raw[np.ix_(*self.ascending)] if self.ascending else raw
        return self.factor(name) * raw.reshape([len(axis.values) for axis in self.axes])

    def _column(self, name):
        if "judged" not in self.group or "verdicts/quantity" not in self.file:
            return None
        quantities = list(self.file["verdicts/quantity"].asstr()[:, 0])
        return quantities.index(name) if name in quantities else None

    def _unit_row(self, name):
        """(unit of the panel, factor from the unit of the file)."""
        if name == "deflection_over_span":
            return SPAN, 1.0
        if name in QUANTITIES:
            return engineering(QUANTITIES[name].kind)
        units = dict(self.file["verdicts/quantity"].asstr()[:]) if "verdicts/quantity" in self.file else {}
        return engineering_of_si(str(units.get(name, "1")))

    def unit(self, name):
        return self._unit_row(name)[0]

    def factor(self, name):
        return self._unit_row(name)[1]

    def title(self, name):
        """The quantity in words, with the factor of its limit that its values contain."""
        return capital(words_of(name)) + ("" if self.contained(name) == 1.0 else f" × {self.contained(name):.5g}")

    def factors(self):
        """The factor of neglected effects of each limit; the judged values contain it."""
        group = self.file["verdicts"]
        return group["factor"][:] if "factor" in group else np.ones(len(group["limit"]))

    def contained(self, name):
        """The factor that the values of a quantity contain."""
        column = self._column(name)
        return 1.0 if column is None else float(self.factors()[column])

    def limits(self, name):
        """The limits of a quantity, in the unit of its panel."""
        if "verdicts/limit" not in self.file:
            return []
        unit, factor = self._unit_row(name)
        found, group = [], self.file["verdicts"]
        rows = zip(group["quantity"].asstr()[:, 0], group["limit"][:], group["clause"].asstr()[:, 0], self.factors())
        for quantity, limit, clause, of_limit in rows:
            over_span = quantity == "deflection_over_span" and name == "peak_deflection" and self.equal_span()
            if SAME.get(quantity, quantity) != name and not over_span:
                continue
            words = f"limit {in_words(limit, SPAN) if over_span else in_words(factor * limit, unit)}"
            ratio = of_limit / self.contained(name)  # of the limited value to the drawn one
            words += "" if ratio == 1.0 else f" of {ratio:.5g} times the value"
            value = factor * float(limit) * (over_span or 1.0) / ratio
            found.append(Limit(value, words, f"{words} ({clause})"))
        return found

    def equal_span(self):
        """The length of the spans if all are equal, otherwise None; m."""
        ends = self.results.supports
        lengths = [] if ends is None or self.spans_vary() else np.unique(np.round(np.diff(ends), 6))
        return float(lengths[0]) if len(lengths) == 1 else None

    def spans_vary(self):
        return any(name.startswith("beam_spans") for name in str(self.group.attrs.get("dimensions", "")).split(","))

    def drawn(self, asked=()):
        """The quantities of the picture: the deflection, those with limits, and those on request."""
        limited = []
        if "verdicts/quantity" in self.file:
            limited = [SAME.get(name, name) for name in self.file["verdicts/quantity"].asstr()[:, 0]]
        if self.equal_span():
            limited = [name for name in limited if name != "deflection_over_span"]
        names = ["peak_deflection", *limited, *(f"peak_{name}" for name in asked),
                 *(["greatest_wheel_force", "least_wheel_force"] if "wheels" in asked else [])]
        if "deck_acceleration" not in limited:
            names.insert(1, "peak_acceleration")
        return [name for name in dict.fromkeys(names) if self.values(name) is not None]


def worst_over(runs, name, label):
    """(x, values): the worst value of all other axes over the axis with this label; None without the quantity."""
    values, place = runs.values(name), next((i for i, axis in enumerate(runs.axes) if axis.label() == label), None)
    if values is None or place is None:
        return None
    moved = np.moveaxis(values, place, -1).reshape(-1, len(runs.axes[place].values))
    return runs.axes[place].values, worst_of(moved, sign_of(name))


def sign_of(name):
    """1 for a quantity whose greatest value governs, -1 for one whose least value does."""
    return -1.0 if name.startswith("least") else 1.0


def worst_of(values, sign=1.0):
    """The greatest (for sign -1 the least) of all lines at each place, NaN where all are unknown."""
    known = ~np.isnan(values)
    return np.where(known.any(axis=0), sign * np.where(known, sign * values, -np.inf).max(axis=0), np.nan)
