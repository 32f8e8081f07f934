"""The curves of a picture as a table: a CSV file with one column for each curve, and one for its places or times."""

import numpy as np
import output_files


def keep(ax, name, x, values, unit=None):
    """Notes a curve that the axes show, for the table. Title, label and unit are those of the axes."""
    if not hasattr(ax, "kept_curves"):
        ax.kept_curves = []
    ax.kept_curves.append((name, np.asarray(x), np.asarray(values), unit))


def draw_curve(ax, x, values, name, **look):
    """Draws a curve and notes it for the table; returns the line."""
    keep(ax, name, x, values)
    return ax.plot(x, values, **look)[0]


def every_axes(figure):
    """The axes of a figure from top to bottom, each followed by the axes inside it."""
    return [inner for ax in figure.axes for inner in [ax, *ax.child_axes]]


def columns(figure):
    """(heading with the unit, values) of each column; curves with the same places share the column of the places."""
    found, taken = [], set()

    def add(heading, values):
        number, unique = 1, heading
        while unique in taken:
            number += 1
            unique = f"{heading} [{number}]"
        taken.add(unique)
        found.append((unique, values))

    for ax in every_axes(figure):
        title, last = one_line(ax.get_title(loc="left") or ax.get_title()), None
        for name, x, values, unit in getattr(ax, "kept_curves", []):
            if last is None or len(x) != len(last) or not np.array_equal(x, last):
                add(f"{title}: {one_line(ax.get_xlabel())}", x)
                last = x
            unit = one_line(ax.get_ylabel()) if unit is None else unit
            add(f"{title}: {one_line(name)}" + (f" ({unit})" if unit else ""), values)
    return found


def one_line(text):
    return " ".join(str(text).split())


def write(figure, path):
    """Writes the table with all digits of the drawn numbers; shorter columns end with empty cells."""
    table = columns(figure)
    rows = ([cell(values[i]) if i < len(values) else "" for _, values in table]
            for i in range(max((len(values) for _, values in table), default=0)))
    output_files.write_table(path, [heading for heading, _ in table], rows)


def cell(value):
    if isinstance(value, str):
        return value
    return "" if np.isnan(value) else repr(float(value))
