"""Quantities as engineers write them: 260 GN.m2, 19 t/m, 250 km/h.

Units are those of engineering_units.csv, and N with the prefixes k, M and G.
"""

import re
from typing import NamedTuple

from engineering_units import printed, table

from .rules import CheckError

PREFIXES = {"k": 1e3, "M": 1e6, "G": 1e9}
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


class Kind(NamedTuple):
    row: str             # of engineering_units.csv
    of_bridges: tuple    # the least and the greatest value of any railway bridge, in SI: others are errors
    least: float = 0.0   # a number without a unit must be above it, otherwise its unit is in doubt
    alone: str = ""      # unit of a number without a unit; empty: the SI unit
    example: str = ""


# No bridge has a stiffness of 1e7 N m2, a mass of 500 kg/m or a polar inertia of 500 kg m: smaller numbers may be meant in
# MN m2, t/m or t m. No line speed is 140 m/s: a larger number can only be meant in km/h, a smaller one in m/s too.
KINDS = {
    "span": Kind("length", (0.5, 2e3)),
    "EI": Kind("bending_stiffness", (1e5, 1e16), 1e7, example="260 GN.m2"),
    "mass": Kind("mass_per_length", (50.0, 1e6), 500.0, example="19 t/m"),
    "GJ": Kind("bending_stiffness", (1e5, 1e16), 1e7, example="90 GN.m2"),
    "eccentricity": Kind("length", (0.01, 30.0)),
    "polar-inertia": Kind("rotational_inertia_per_length", (50.0, 1e7), 500.0, example="160 t.m"),
    "frequency": Kind("frequency", (0.01, 500.0)),
    "torsional-frequency": Kind("frequency", (0.01, 1e3)),
    "line-speed": Kind("speed", (1.0, 200.0), 140.0, "km/h", example="250 km/h"),
    "load-spread": Kind("length", (0.05, 10.0)),
}


def plain(unit):
    """A unit without the signs that may stand between its parts: N.m2, N m², N*m^2 become Nm2."""
    return re.sub(r"[\s.·*^]", "", unit).replace("²", "2").replace("³", "3")


def to_si(name):
    """{unit: function that converts a value to SI} for a quantity; the names as people write them."""
    si, usual, factor = table()[KINDS[name].row]
    known = {si: lambda value: value, usual: lambda value: value / factor}
    if si.startswith("N"):
        known |= {prefix + si: lambda value, by=by: value * by for prefix, by in PREFIXES.items()}
    return known


def in_words(name, value):
    """A value in SI as text in its engineering unit."""
    _, usual, factor = table()[KINDS[name].row]
    return f"{value * factor:.6g} {printed(usual)}"


def parts_of(name, text):
    """[(number, unit)] of a text such as "240, 280 GN.m2": a number without a unit has that of the next one."""
    parts = []
    for word in re.split(r"[,;\s]+", text.strip()):
        number = NUMBER.match(word)
        if number:
            parts.append([float(number[0]), word[number.end():]])
        elif parts:
            parts[-1][1] += word
        else:
            raise CheckError(f"{name} {text}: it must begin with a number")
    for earlier, later in reversed(list(zip(parts[:-1], parts[1:]))):
        earlier[1] = earlier[1] or later[1]
    return parts


def values(name, text):
    """All values of a quantity in SI."""
    kind, known = KINDS[name], to_si(name)
    by_plain = {plain(unit): convert for unit, convert in known.items()}
    found = []
    for number, unit in parts_of(name, text):
        if not unit and kind.least and number <= kind.least:
            raise CheckError(f"{name} {text}: the number needs its unit, such as {name} {kind.example}")
        convert = by_plain.get(plain(unit or kind.alone or table()[kind.row][0]))
        if convert is None:
            raise CheckError(f"{name} {text}: the unit {unit} is not known here; allowed: {', '.join(known)}")
        if not 0.0 < convert(number) < float("inf"):
            raise CheckError(f"{name} {text}: allowed: numbers above 0")
        if not kind.of_bridges[0] <= convert(number) <= kind.of_bridges[1]:
            raise CheckError(f"{name} {text}: no railway bridge has {in_words(name, convert(number))}; allowed: from "
                             f"{in_words(name, kind.of_bridges[0])} to {in_words(name, kind.of_bridges[1])}")
        found.append(convert(number))
    return found
