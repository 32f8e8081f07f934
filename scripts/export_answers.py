"""Tables of searches, sensitivity analyses, fits and screens for export.py, one row for each answer, effect, estimate, value or
pair."""

import numpy as np


def texts(file, name):
    return file[name].asstr()[:]


def of_find(file, add):
    """A row for each value of the searched option: its greatest ratio to the bound for each answer."""
    add(str(file["find"].attrs["option"]), file["find/value"].attrs["unit"], file["find/value"][:])
    for answer, ratio in zip(texts(file, "answer"), file["find/ratio"][:]):
        add(f"ratio of {answer}", "1", ratio)


def of_intervals(file, add):
    """A row for each interval in which the condition holds."""
    answer = file["find/interval_answer"][:].astype(int)
    add("answer", "text", texts(file, "answer")[answer])
    for k, end in enumerate(("from", "to")):
        add(end, file["find/interval"].attrs["unit"], file["find/interval"][:, k])
        add(f"{end} is an end of the range", "1", file["find/interval_at_end"][:, k].astype(int))


def of_sensitivity(file, add):
    """A row for each quantity and factor."""
    quantities, factors = texts(file, "sensitivity/units"), texts(file, "factor")
    add("quantity", "text", np.repeat(quantities[:, 0], len(factors)))
    add("unit", "text", np.repeat(quantities[:, 1], len(factors)))
    add("factor", "text", np.tile(factors, len(quantities)))
    for name, measure in file["sensitivity"].items():
        if name != "units":
            add(name, "1" if measure.attrs["unit"] == "1" else "", measure[:].ravel())


def of_estimates(file, add):
    """A row for each unknown of a fit."""
    add("unknown", "text", texts(file, "unknown"))
    add("unit", "text", str(file["fit/estimate"].attrs["unit"]).split(", "))
    for name in ("estimate", "standard_error", "low", "high", "start"):
        add(name, "", file[f"fit/{name}"][:])
    add("at_bound", "1", file["fit/at_bound"][:].astype(int))


def of_pairs(file, add):
    """A row for each bridge and formation of a screen."""
    bridges, formations = texts(file, "bridge"), texts(file, "formation")
    add("bridge", "text", np.repeat(bridges, len(formations)))
    add("formation", "text", np.tile(formations, len(bridges)))
    for name in ("ratio", "bound", "permitted_speed", "governing_speed", "exceeding_speeds", "decided_by"):
        add(name, file[f"screen/{name}"].attrs["unit"], file[f"screen/{name}"][:].ravel())


def of_series(name):
    """The table of a fitted series: measured and computed values by the clock of the measurement."""
    def table(file, add):
        for column in ("time", "measured", "computed"):
            add(column, file[f"{name}/{column}"].attrs["unit"], file[f"{name}/{column}"][:])
    return table


TABLES = {"find/ratios": ("find/value", of_find), "find/intervals": ("find/interval", of_intervals),
          "sensitivity": ("sensitivity/units", of_sensitivity), "fit/estimates": ("fit/estimate", of_estimates),
          "screen": ("screen/ratio", of_pairs)}


def tables(file):
    """The tables of this file: name and function(file, add), with add(name, unit, values)."""
    found = {name: write for name, (dataset, write) in TABLES.items() if dataset in file}
    for name in file.get("fit/series", ()):
        found[f"fit/series/{name}"] = of_series(f"fit/series/{name}")
    return found
