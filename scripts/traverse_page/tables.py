"""Tables of the page: verdicts, EN 1991-2 6.4.6.5, rail and bridge, forces at rest, envelopes, searches, statistics,
sensitivity analyses, fits, screens, summary, options."""

import re

import numpy as np
from engineering_units import shown
from picture_vehicles import wheels_of
from traverse_report import find_sheet, fit_sheet, screen_sheet, sensitivity_sheet
from traverse_report import statistics as of_runs
from traverse_report.language import capital, known, num, percent, t
from traverse_report.language import number as in_digits
from traverse_report.limits import factors_of
from traverse_report.quantities import QUANTITIES, shown_value, unit_of, unit_of_si, with_factor
from traverse_report.rail_sheet import CASES, PEAKS
from traverse_report.source import Source, parameter_words

from .along import ENVELOPES, FEWEST_STATIONS
from .histories import named
from .packing import number

MOST_BRIDGES = 300  # rows of the table of a screen


def unit_of_limit(quantity, unit):
    """(unit for print, factor) of a quantity with a limit, whose values in the file have this SI unit."""
    return unit_of(quantity) if quantity in QUANTITIES else unit_of_si(unit)


def limits(results):
    """The limits of /verdicts: clause, text, quantity, unit of the page, factor to it, limit in this unit."""
    if "verdicts/limit" not in results.file:
        return []
    group, found = results.file["verdicts"], []
    rows = zip(group["clause"].asstr()[:], group["quantity"].asstr()[:], group["limit"][:], factors_of(results.file))
    for (clause, text), (quantity, unit), limit, contained in rows:
        shown_unit, factor = unit_of_limit(quantity, unit)
        found.append({"clause": clause, "text": text, "quantity": quantity, "words": with_factor(quantity, contained),
                      "unit": shown_unit, "factor": factor, "limit": number(factor * limit)})
    return found


def valued(limit, value):
    """A value in SI units of a quantity with a limit: a text as L/600, or number and unit."""
    if limit["quantity"].endswith("deflection_over_span"):
        return shown_value(value, limit["quantity"])
    return [number(limit["factor"] * value), limit["unit"]]


def with_options_in_words(results, text):
    """The text of a verdict on a study, where the varied options of the run have their names and SI values."""
    names = str(results.file["study"].attrs["dimensions"]).split(",") if "study/finished" in results.file else []
    for name in names:
        words, unit, factor = parameter_words(name, str(results.file["study"][name].attrs.get("unit", "1")))
        head = "A" if name.endswith("hslm_a") else "" if name.endswith("speed") else f"{words} "
        text = re.sub(rf"\b{re.escape(name)} (-?\d[\d.,]*(?:e[-+]?\d+)?)(?=,|$)", lambda found: head + in_digits(
            factor * float(found[1].replace(",", "."))) + (f" {unit}" if unit else ""), text)
    return text


def verdicts(results, limits_of_file, found):
    """The table of the verdicts `found`; None without limits."""
    if not limits_of_file:
        return None
    group, rows = results.file["verdicts"], []
    many = bool(np.any(group["runs"][:] > 1))
    for limit, verdict, runs, broken in zip(limits_of_file, found, group["runs"][:], group["broken_in"][:]):
        of_runs = [t("{count} of {all}", count=f"{broken:.0f}", all=f"{runs:.0f}") if runs > 1 else ""] if many else []
        rows.append([verdict.word, limit["clause"], ": ".join(filter(None, (limit["words"], known(limit["text"])))),
                     valued(limit, verdict.value), valued(limit, verdict.limit.value),
                     None if np.isnan(verdict.value) else percent(verdict.utilisation),
                     with_options_in_words(results, verdict.where), *of_runs])
    head = [t("result"), t("clause"), t("requirement"), t("value"), t("limit"), t("utilisation"),
            t("position and time, or reason of a missing value")]
    return {"title": capital(t("verdicts")), "first": True, "head": head + ([t("exceeded in")] if many else []),
            "rows": rows}


def norm(results):
    """Trains and load models, effect by effect; None if they were not compared."""
    if "norm/effect" not in results.file:
        return None
    group, rows = results.file["norm"], []
    texts = [group[name].asstr()[:] for name in ("effect", "train", "model", "governs")]
    values = [group[name][:] for name in ("phi_dyn", "train_static", "train_dynamic", "model_static", "model_with_phi",
                                          "train_over_model")]
    for (effect, unit), (train, _), (model, _), (_, governs), *of_row in zip(*texts, *values):
        shown_unit, factor = unit_of_si(unit)
        dynamic, *forces, ratio = of_row
        static, with_dynamic, of_model, with_phi = ([number(factor * value), shown_unit] for value in forces)
        rows.append([known(effect.replace("_", " ")), known(governs), train, number(dynamic), static, with_dynamic, model,
                     of_model, with_phi, number(ratio)])
    return {"title": t("Dynamic verdict by EN 1991-2, 6.4.6.5"), "rows": rows,
            "head": [t("effect"), t("governs"), t("train"), "φ′dyn", t("static"), "1 + φ′dyn + φ″/2", t("load model"),
                     t("static"), t("with α and Φ"), t("train over load model")],
            "note": str(group.attrs.get("words", ""))}


def rail(results):
    """The largest effects of each case of UIC 774-3; None for another analysis."""
    if "rail_forces/x" not in results.file:
        return None
    group, rows = results.file["rail_forces"], []
    stress, length = shown("stress"), shown("displacement")
    for case, words in CASES.items():
        if case in group:
            row = [t(words)]
            for name, (_, factor) in (("tension", stress), ("compression", stress), ("slip", length), ("end", length)):
                value, place, _ = group[case][name][:]
                row += [number(factor * value), number(round(place, 6))]
            rows.append(row)
    head = [t("case")]
    for (words, _), (unit, _) in zip(PEAKS.values(), (stress, stress, length, length)):
        head += [f"{t(words)} ({unit})", t("at x (m)")]
    fronts = group["front"][:]
    return {"title": t("Track-bridge interaction by UIC 774-3"), "head": head, "rows": rows,
            "note": t("Of {count} positions of the train, its front {low} to {high} m behind the end of the bridge "
                      "from which it comes.",
                      count=len(fronts), low=num(fronts.min(), ".6g"), high=num(fronts.max(), ".6g"))}


def envelope(results):
    """Least and greatest values at a few stations; None if there are none, or many, which charts show."""
    if "envelope" not in results.file or len(results.probes) >= FEWEST_STATIONS:
        return None
    group, rows = results.file["envelope"], []
    for name, (title, quantity) in ENVELOPES.items():
        unit, factor = shown(quantity)
        for i, x in enumerate(results.probes) if name in group else ():
            least, greatest = (number(factor * value) for value in group[name][i])
            first, second = (number(time) for time in group[f"{name}_time"][i])
            rows.append([known(title), number(x), [least, unit], first, [greatest, unit], second])
    return {"title": t("Least and greatest values of the run"), "rows": rows,
            "head": [t("quantity"), t("at x (m)"), t("least"), t("at t (s)"), t("greatest"), t("at t (s)")]}


def rest(results):
    """Wheel forces and support reactions of a static analysis; None for another one."""
    if results.rows != 1:
        return None
    unit, factor = shown("force")
    rows = [[named(results, k, name), [number(factor * force[0]), unit]] for k, name, force in wheels_of(results)]
    if "supports/reaction" in results.file:
        rows += [[t("support at x = {x} m", x=num(x, ".6g")), [number(factor * force), unit]]
                 for x, force in zip(results.supports, results.file["supports/reaction"][0, :, 1])]
    return {"title": t("Forces at rest"), "head": [t("wheel or support"), t("force")], "rows": rows} if rows else None


def search(results):
    """The values within the bound, for each answer of a search; None for another file."""
    if "find/ratio" not in results.file:
        return None
    words = find_sheet.Words(Source(results.file.filename))
    return {"title": t("Search for values"), "first": True, "head": [capital(name) for name in find_sheet.head()],
            "rows": words.rows(), "note": capital(words.question())}


def statistics(results):
    """Mean, deviation and quantiles of a study; None for another file."""
    source = Source(results.file.filename) if "study/statistics" in results.file else None
    rows = of_runs.statistic_rows(source) if source else []
    return {"title": t("Statistics"), "first": True, "head": [capital(name) for name in of_runs.head(rows)],
            "rows": of_runs.cells(rows), "note": of_runs.explanation(source)} if rows else None


def sensitivity(results):
    """The measures of a sensitivity analysis; None for another file."""
    if "sensitivity/units" not in results.file:
        return None
    words = sensitivity_sheet.Words(Source(results.file.filename))
    return {"title": t("Sensitivity analysis"), "first": True, "head": [capital(name) for name in words.head()],
            "rows": words.rows(), "note": words.explanation()}


def fit(results):
    """The unknowns of a fit; None for another file."""
    if "fit/estimate" not in results.file:
        return None
    source = Source(results.file.filename)
    said = [fit_sheet.correlations(source.file, fit_sheet.unknowns_of(source.file)), *fit_sheet.findings_of(source)]
    return {"title": t("Fit to measurements"), "first": True, "head": [capital(name) for name in fit_sheet.head()],
            "rows": fit_sheet.rows(source), "note": " ".join(said)}


def screen(results):
    """The bridges of a screen; None for another file."""
    if "screen/ratio" not in results.file:
        return None
    found = screen_sheet.Screen(results.file)
    rows = [[cell[0] if isinstance(cell, tuple) else cell for cell in row]
            for row in screen_sheet.cells_of_bridges(found, MOST_BRIDGES)]
    return {"title": t("Bridges"), "first": True, "head": [capital(name) for name in screen_sheet.head()], "rows": rows,
            "note": screen_sheet.shortened(len(found.bridges), MOST_BRIDGES)}


def plain(value):
    """An attribute as a number or a text."""
    value = value.item() if hasattr(value, "item") and np.size(value) == 1 else value
    return number(value) if isinstance(value, float) else value if isinstance(value, int) else str(value)


def pairs(results):
    """Tables of two columns, closed at first: summary, options."""
    found = [{"title": t("Summary of the run, in SI units"), "rows": [[name, plain(value)] for name, value in
                                                                   sorted(results.summary.items())]},
             {"title": t("Options of the scene"), "rows": [list(row) for row in results.options.items()]}]
    return [{**one, "head": [t("name"), t("value")], "closed": True} for one in found if one["rows"]]
