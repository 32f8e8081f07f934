"""The runs of a sweep or a study: varied options, results of each run with its place, values with limits."""

import numpy as np
from traverse_report.quantities import QUANTITIES, unit_of, words_of
from traverse_report.source import Source

from .packing import Curve, kept_rows, number, packed
from .tables import unit_of_limit

MOST_VALUES = 120_000  # of all runs: about 0.65 MB
PROFILES = ("peak_deflection", "peak_acceleration", "peak_moment")


def quantities_of(results, runs):
    """(name, words, unit, factor) of each quantity with a value for some run."""
    units = dict(results.file["verdicts/quantity"].asstr()[:]) if "verdicts/quantity" in results.file else {}
    names = [name for name in dict.fromkeys([*QUANTITIES, *units]) if name in runs.values]
    return [(name, words_of(name), *unit_of_limit(name, units.get(name, "1"))) for name in names
            if np.isfinite(runs.of_run(name)).any()]


def places(runs, name):
    """The station of the value of each run, m; NaN if there is none."""
    if runs.values[name].ndim == 1 and name not in runs.places:
        return np.full(runs.count, np.nan)
    known = np.isfinite(runs.of_run(name))
    stations = [runs.place(name, run) if known[run] else None for run in range(runs.count)]
    return np.array([np.nan if x is None else x for x in stations])


def parameters_of(runs):
    found = []
    for name, column in runs.parameters.items():
        words, unit, factor = runs.words(name)
        words = "train of HSLM-A" if name.endswith("hslm_a") else words.replace("_", " ")
        found.append({"name": words, "unit": unit, "values": factor * column})
    return found


def judged(results, limits, count):
    """[runs, limits]: values in the units of the page, NaN without a value; empty without limits."""
    for name in ("sweep/judged", "study/judged"):
        if name in results.file and limits:
            return results.values(name).reshape(count, len(limits)) * [limit["factor"] for limit in limits]
    return np.zeros((count, 0))


def profiles(runs, kept):
    """Largest value of all runs at each station, and if they are few those of each run."""
    if runs.probes.ndim > 1 or len(runs.probes) < 3:
        return []
    order = np.argsort(runs.probes)
    found, few = [], len(kept) * len(runs.probes) * len(PROFILES) <= MOST_VALUES
    for name in PROFILES:
        values = np.abs(runs.values[name])
        if np.isfinite(values).any():
            unit, factor = unit_of(name)
            largest = np.where(np.isfinite(values), values, -np.inf).max(axis=0)
            of_runs = packed(factor * values[kept][:, order]) if few else None
            found.append({"title": f"Along the bridge: {words_of(name)}", "unit": unit, "x": packed(runs.probes[order]),
                          "largest": packed(factor * largest[order]), "runs": of_runs})
    return found


def packed_runs(results, limits):
    """All for the page; None for a file of a single run."""
    if "sweep/speed" not in results.file and "study/finished" not in results.file:
        return None
    runs = Source(results.file.filename).runs
    found, parameters = quantities_of(results, runs), parameters_of(runs)
    values_with_limits = judged(results, limits, runs.count)
    columns = {name: factor * runs.of_run(name) for name, _, _, factor in found}
    width = len(parameters) + 2 * len(found) + len(limits)
    kept = kept_rows([Curve(name, column) for name, column in columns.items()], MOST_VALUES // width) if found else \
        np.arange(runs.count)
    order = np.full(runs.count, -1)
    order[kept] = np.arange(len(kept))
    x, label = runs.x() if runs.x_name else (np.arange(1.0, runs.count + 1.0), "number of the run")
    lines = [{"name": name, "runs": [int(order[run]) for run in line if order[run] >= 0]}
             for name, line in runs.lines()]
    return {
        "count": runs.count, "finished": int(runs.finished.sum()), "kept": len(kept), "x": packed(x[kept]),
        "xLabel": label, "lines": lines, "lineNames": runs.lines_in_words(),
        "points": not runs.x_name or any(len(np.unique(x[line])) < len(line) for _, line in runs.lines()),
        "parameters": [{**one, "values": [number(value) for value in one["values"][kept]]} for one in parameters],
        "quantities": [{"name": name, "words": words, "unit": unit, "values": packed(columns[name][kept]),
                        "places": packed(places(runs, name)[kept])} for name, words, unit, _ in found],
        "judged": packed(values_with_limits[kept]), "profiles": profiles(runs, kept),
        "names": [runs.run_in_words(int(run)) for run in kept] if len(kept) <= 5000 else None}
