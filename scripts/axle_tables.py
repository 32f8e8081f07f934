"""Readers of axle loads: formations in the format of screen_fleet, mixes of them, and weigh-in-motion records.

Tables have a line of column names and cells separated by commas or semicolons; # begins a comment. Loads are in N,
distances in m, speeds in m/s after reading. A wrong table raises ValueError with file and line.
"""

import datetime
import os
import pathlib
from typing import NamedTuple

from input_files import LARGEST_TABLE, text_of

LOADS = {"load_kN": 1e3, "load_t": 9810.0, "load_N": 1.0}
MOST_ROWS = 2_000_000
FAST_TRAIN, FAST_LORRY = 128.0, 60.0          # m/s: 1.2 times a line speed of 384 km/h; faster than on any road
HEAVIEST_AXLE, LIGHTEST_AXLE = 392.4e3, 20e3  # N: the heaviest on rails has 40 t; each table has an axle of 2 t
LONGEST_SPACING = 50.0                        # m, between neighbouring axles
DECIMAL_POINT = "a comma separates cells, decimals need a point"


class Passage(NamedTuple):
    name: str
    speed: float  # m/s
    loads: tuple  # N, of each axle from the front
    distances: tuple  # m, of each axle behind the first
    count: float  # a day


def rows_of(path, allowed):
    """[(where, {column: text})] of a table; where is "FILE:LINE"."""
    rows, columns = [], None
    for number, line in enumerate(text_of(path, LARGEST_TABLE).splitlines(), 1):
        line = line.split("#")[0].strip()
        if not line:
            continue
        cells, where = [cell.strip() for cell in line.replace(";", ",").split(",")], f"{path}:{number}"
        if ";" in line and "," in line:
            raise ValueError(f"{where}: commas and semicolons in one row; {DECIMAL_POINT}")
        if columns is None:
            columns = cells
            for column in columns:
                if column not in allowed or columns.count(column) > 1:
                    raise ValueError(f"{where}: column '{column}'; allowed, each once: {', '.join(allowed)}")
            continue
        if len(cells) != len(columns):
            hint = f"; {DECIMAL_POINT}" if "," in line else ""
            raise ValueError(f"{where}: {len(cells)} cells, expected {len(columns)}{hint}")
        rows.append((where, dict(zip(columns, cells))))
        if len(rows) > MOST_ROWS:
            raise ValueError(f"{where}: allowed: at most {MOST_ROWS} rows")
    if not rows:
        raise ValueError(f"{path}: expected a line of column names and at least one row")
    return rows


def numbers(where, text, least=0.0):
    """The numbers of a cell, separated by blanks."""
    try:
        values = [float(word) for word in text.split()]
    except ValueError:
        values = []
    if not values or not all(least <= value < 1e9 for value in values):
        raise ValueError(f"{where}: '{text}'; allowed: numbers from {least:g} on, separated by blanks")
    return values


def number(where, text, least=0.0):
    values = numbers(where, text, least)
    if len(values) > 1:
        raise ValueError(f"{where}: '{text}'; allowed: one number")
    return values[0]


def speed_of(where, text):
    factor = 1.0 / 3.6 if text.endswith("km/h") else 1.0
    speed = factor * number(where, text.removesuffix("km/h").removesuffix("m/s"))
    if not 0.0 < speed < 300.0:
        raise ValueError(f"{where}: speed '{text}'; allowed: above 0, in m/s, or in km/h as in 80 km/h")
    return speed


def loads_column(where, row, names):
    found = [name for name in names if name in row]
    if len(found) != 1:
        raise ValueError(f"{where}: allowed: one of the columns {', '.join(names)}")
    return found[0]


def formations(path):
    """{name: (loads, distances)} of a table of axles, or of all tables of a folder."""
    path, found = pathlib.Path(path), {}
    for file in sorted(path.glob("*.csv")) if os.path.isdir(path) else [path]:
        for where, row in rows_of(file, ["name", "speed", *LOADS, "position", "spacing"]):
            name = row.get("name", file.stem)
            if not name or ("position" in row) == ("spacing" in row):
                raise ValueError(f"{where}: expected a name, and one of the columns position and spacing")
            column = loads_column(where, row, LOADS)
            loads, places = found.setdefault(name, ([], []))
            loads.append(LOADS[column] * number(where, row[column]))
            if "spacing" in row:
                places.append(places[-1] + number(where, row["spacing"]) if places else 0.0)
            else:
                places.append(number(where, row["position"], -1e9))
    return {name: (tuple(loads), tuple(abs(x - places[0]) for x in places)) for name, (loads, places) in found.items()}


def mix(path, fleet):
    """The passages of a mix. Columns: name of a formation of the fleet, count a day, speed."""
    passages = []
    for where, row in rows_of(path, ["name", "count", "speed"]):
        if set(row) != {"name", "count", "speed"}:
            raise ValueError(f"{where}: expected the columns name, count and speed")
        if row["name"] not in fleet:
            raise ValueError(f"{where}: there is no formation '{row['name']}' in the fleet")
        loads, distances = fleet[row["name"]]
        passages.append(Passage(row["name"], speed_of(where, row["speed"]), loads, distances,
                                number(where, row["count"])))
    return passages


def day_of(where, text):
    """A time in days: a number of seconds, or a date and time of ISO 8601."""
    try:
        return float(text) / 86400.0
    except ValueError:
        pass
    try:
        return datetime.datetime.fromisoformat(text).timestamp() / 86400.0
    except ValueError:
        raise ValueError(f"{where}: time '{text}'; allowed: seconds, or as in 2024-05-31T14:02:10") from None


def weighed(path, days=None):
    """The passages of a weigh-in-motion record, one a row. Columns: time (s, or ISO 8601), speed (m/s or km/h),
    loads_kN or loads_t (of each axle, separated by blanks), spacings (m, between neighbouring axles, separated by
    blanks; empty for one axle). days: the duration of the record; default: from the first to the last time, at least
    one day."""
    records, times = [], []
    for where, row in rows_of(path, ["time", "speed", "loads_kN", "loads_t", "spacings"]):
        column = loads_column(where, row, ["loads_kN", "loads_t"])
        if not {"time", "speed", "spacings"} <= set(row):
            raise ValueError(f"{where}: expected the columns time, speed and spacings")
        loads = [LOADS[column.replace("loads", "load")] * load for load in numbers(where, row[column])]
        spacings = numbers(where, row["spacings"]) if row["spacings"] else []
        if len(spacings) != len(loads) - 1:
            raise ValueError(f"{where}: {len(loads)} loads and {len(spacings)} spacings; expected one spacing less")
        distances = [0.0]
        for spacing in spacings:
            distances.append(distances[-1] + spacing)
        times.append(day_of(where, row["time"]))
        records.append((row["time"], speed_of(where, row["speed"]), tuple(loads), tuple(distances)))
    days = days or max(max(times) - min(times), 1.0)
    return [Passage(*record, 1.0 / days) for record in records]


def unusual(passages, fast=FAST_TRAIN):
    """Sentences on numbers of a table that are usual in another unit. fast: the speed (m/s) that nothing exceeds."""
    said = []
    fastest = max(passages, key=lambda one: one.speed)
    if fastest.speed > fast:
        said.append(f"{fastest.name}: {fastest.speed:g} m/s is {3.6 * fastest.speed:g} km/h; speeds are in m/s, or in "
                    "km/h as in 80 km/h")
    heaviest = max(passages, key=lambda one: max(one.loads))
    load = max(heaviest.loads)
    if not LIGHTEST_AXLE <= load <= HEAVIEST_AXLE:
        words = "the heaviest on rails have 40 t" if load > HEAVIEST_AXLE else "the heaviest of the table"
        said.append(f"{heaviest.name}: an axle of {1e-3 * load:.4g} kN, {words}; loads are possibly given in another "
                    "unit than the name of their column")
    spacings = [(b - a, one.name) for one in passages for a, b in zip(one.distances, one.distances[1:])]
    if spacings and max(spacings)[0] > LONGEST_SPACING:
        said.append(f"{max(spacings)[1]}: {max(spacings)[0]:g} m between two axles; the unit of distances is m")
    return said
