"""Records over time of one or several channels, and their tables: one for all channels with the same times."""

import re
from typing import NamedTuple

import numpy as np
from convert_lines import LARGEST_VALUE
from engineering_units import table as units_table
from input_files import InputError

MOST_CHANNELS = 10_000


class Channel(NamedTuple):
    name: str
    unit: str      # '': not known
    times: np.ndarray   # s
    values: np.ndarray
    about: str     # where it is in its file


class Table(NamedTuple):
    channels: list
    head: list


def plain(unit):
    """A unit without the signs that people set between its parts, as tables are read."""
    for sign, with_ in ((" ", ""), ("*", ""), ("^", ""), ("·", ""), ("²", "2"), ("³", "3"), ("µ", "u"), ("sec", "s")):
        unit = unit.replace(sign, with_)
    return unit


def known_unit(unit):
    """The unit as tables know it, '' for another one."""
    names = {plain(name): name for si, engineering, _ in units_table().values() for name in (engineering, si)}
    return names.get(plain(unit), "")


def in_a_head(text):
    """A name without the signs that separate or begin something in a table."""
    words = " ".join(re.sub(r"[^\w.+/%°-]", " ", text).split()).lstrip("+-") or "record"
    return words if re.search(r"[^\W\d]", words) else f"channel {words}"


def tables_of(channels):
    """The tables of channels: those with the same times together."""
    if len(channels) > MOST_CHANNELS:
        raise InputError(f"{len(channels)} channels; allowed: at most {MOST_CHANNELS}, see --channels")
    groups = {}
    for one in channels:
        groups.setdefault((len(one.times), one.times[0], one.times[-1]), []).append(one)
    tables = []
    for group in groups.values():
        while group:
            first = group[0].times
            same = [one for one in group if np.array_equal(one.times, first)]
            group, names = [one for one in group if not np.array_equal(one.times, first)], []
            for one in same:
                name, i = in_a_head(one.name), 1
                while (new := name if i == 1 else f"{name} {i}") in names:
                    i += 1
                names.append(new)
            heads = [f"{name} [{in_a_head(one.unit)}]" if one.unit else name for name, one in zip(names, same)]
            tables.append(Table(same, ["time [s]", *heads]))
    return tables


def rows_of(table):
    """The rows as texts: twelve digits."""
    columns = [table.channels[0].times, *(one.values for one in table.channels)]
    return zip(*([f"{value:.12g}" for value in column] for column in columns))


def chosen(channels, names):
    """The channels with these names; all without names. Their values must be finite."""
    for name in names:
        if name not in [one.name for one in channels]:
            raise InputError(f"there is no channel {name}; there are {', '.join(one.name for one in channels[:20])}")
    found = [one for one in channels if not names or one.name in names]
    for one in found:
        good = np.abs(one.values) < LARGEST_VALUE
        if not np.all(good):
            raise InputError(f"{one.about}: value {np.argmin(good) + 1} is no finite number; --channels leaves out a channel")
    return found
