"""The runs of a sweep or a study: varied options, results of each run with its place, values with limits."""

import numpy as np
from picture_model import Model
from picture_runs import sign_of
from search_answers import Search
from traverse_report.language import t
from traverse_report.quantities import QUANTITIES, unit_of, words_of
from traverse_report.source import Source

from .packing import Curve, kept_rows, number, packed
from .tables import unit_of_limit

MOST_VALUES = 120_000  # of all runs: about 0.65 MB
MOST_LINES, CHOSEN = 18, 10  # lines that colours and dashes tell apart; those that are drawn if there are more
# Options that change what moves or where it moves; the file has the loads and the bridge of the first run only.
OF_PLACES = ("beam_spans", "load_", "train_", "vehicle_")
PROFILES = ("peak_deflection", "peak_acceleration", "peak_moment")


def quantities_of(results, runs):
    """(name, words, unit, factor) of each quantity with a value for some run."""
    units = dict(results.file["verdicts/quantity"].asstr()[:]) if "verdicts/quantity" in results.file else {}
    names = [name for name in dict.fromkeys([*QUANTITIES, *units]) if name in runs.values]
    return [(name, runs.quantity_in_words(name), *unit_of_limit(name, units.get(name, "1"))) for name in names
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
        train = name.endswith("hslm_a")
        found.append({"name": t("train of HSLM-A") if train else words.replace("_", " "), "unit": unit, "train": train,
                      "values": factor * column})
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
            found.append({"title": t("Along the bridge: {effect}", effect=words_of(name)), "unit": unit,
                          "x": packed(runs.probes[order]),
                          "largest": packed(factor * largest[order]), "runs": of_runs})
    return found


def speeds_of(results, runs):
    """The constant speed of the train of each run, m/s; None if runs move in another way than the model in the file."""
    model, varied = Model(results), [name for name, column in runs.parameters.items() if len(np.unique(column)) > 1]
    groups = len(np.unique(model.trains[:, 0])) + len(np.unique(model.loads[:, 0]))
    tabled = any(name.endswith("_speed_file") for name in results.options)
    names = [name for name in runs.parameters if name.endswith("speed")]
    others = [name for name in varied if name not in names and name.startswith(OF_PLACES)]
    trains = {f"A{number:.0f}" for number in np.unique(runs.parameters.get("hslm_a", ()))}
    both = len(model.train) > 0 and len(model.forces) > 0
    unknown = not len(model.train) and not trains <= set(model.forces)
    if tabled or others or both or unknown or groups > 1 or len(names) > 1:
        return None
    speed = runs.parameters[names[0]] if names else np.full(runs.count, results.speed() or 0.0)
    return speed if np.all(speed != 0.0) else None


def chosen_lines(lines, runs, columns, search):
    """(indices of the drawn lines, a note): all lines, or of more than MOST_LINES those that matter."""
    if len(lines) <= MOST_LINES:
        return list(range(len(lines))), ""
    line_of = np.empty(runs.count, dtype=int)
    for i, (_, own) in enumerate(lines):
        line_of[own] = i
    greatest = line_of[[int(np.nanargmax(sign_of(name) * column)) for name, column in columns.items()]]
    if not search or not columns:
        wanted = [*greatest, *np.linspace(0, len(lines) - 1, CHOSEN).round().astype(int)]
        chosen = sorted(list(dict.fromkeys(wanted))[:CHOSEN])
        return chosen, t("Drawn: {count} of {all} curves, those with the greatest values and others at even distances.",
                         count=len(chosen), all=len(lines))
    at_bound, beyond = search.run_at_bound(), search.beyond()
    searched = runs.parameters[search.option if search.option in runs.parameters else "hslm_a"]
    judged = next((columns[one.quantity] for one in beyond if one.quantity in columns), next(iter(columns.values())))
    there = np.flatnonzero(searched == searched[at_bound])
    wanted = [line_of[at_bound], *(line_of[one.run] for one in beyond), *greatest, *line_of[there[np.argsort(-judged[there])]]]
    chosen = sorted(list(dict.fromkeys(wanted))[:CHOSEN])
    return chosen, t("Drawn: {count} of {all} curves, those that govern at the answer and beyond it, those with the greatest "
                     "values and others at the answer.", count=len(chosen), all=len(lines))


def packed_runs(results, limits):
    """All for the page; None for a file of a single run."""
    if "sweep/speed" not in results.file and "study/finished" not in results.file:
        return None
    runs = Source(results.file.filename).runs
    found, parameters = quantities_of(results, runs), parameters_of(runs)
    values_with_limits = judged(results, limits, runs.count)
    columns = {name: factor * runs.of_run(name) for name, _, _, factor in found}
    width = len(parameters) + 2 * len(found) + len(limits)
    search = Search(results) if "find/ratio" in results.file else None
    all_lines = runs.lines()
    chosen, note = chosen_lines(all_lines, runs, columns, search)
    drawn = np.sort(np.concatenate([all_lines[i][1] for i in chosen]))
    kept = drawn[kept_rows([Curve(name, column[drawn]) for name, column in columns.items()], MOST_VALUES // width)] if found \
        else drawn
    order = np.full(runs.count, -1)
    order[kept] = np.arange(len(kept))
    speeds = speeds_of(results, runs)
    x, label = runs.x() if runs.x_name else (np.arange(1.0, runs.count + 1.0), "number of the run")
    lines = [{"name": name, "runs": [int(order[run]) for run in line if order[run] >= 0]}
             for name, line in (all_lines[i] for i in chosen)]
    return {
        "count": runs.count, "finished": int(runs.finished.sum()), "kept": len(kept), "drawn": len(drawn), "x": packed(x[kept]),
        "xLabel": label, "lines": lines, "lineNames": runs.lines_in_words(), "lineNote": note,
        "first": -1 if search is None else int(order[search.run_at_bound()]),
        "points": not runs.x_name or any(len(np.unique(x[line])) < len(line) for _, line in all_lines),
        "parameters": [{**one, "values": [number(value) for value in one["values"][kept]]} for one in parameters],
        "quantities": [{"name": name, "words": words, "unit": unit, "values": packed(columns[name][kept]),
                        "places": packed(places(runs, name)[kept])} for name, words, unit, _ in found],
        "speeds": None if speeds is None else packed(speeds[kept]),
        "judged": packed(values_with_limits[kept]), "profiles": profiles(runs, kept),
        "names": [runs.run_in_words(int(run)) for run in kept] if len(kept) <= 5000 else None}
