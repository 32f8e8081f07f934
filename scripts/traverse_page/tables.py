"""Tables of the page: verdicts, EN 1991-2 6.4.6.5, rail and bridge, forces at rest, envelopes, summary, options."""

import numpy as np
from engineering_units import shown
from picture_rail import CASES
from picture_vehicles import wheels_of
from traverse_report.quantities import QUANTITIES, over_span, unit_of, unit_of_si, words_of

from .along import ENVELOPES, FEWEST_STATIONS
from .histories import named
from .packing import number


def unit_of_limit(quantity, unit):
    """(unit for print, factor) of a quantity with a limit, whose values in the file have this SI unit."""
    return unit_of(quantity) if quantity in QUANTITIES else unit_of_si(unit)


def limits(results):
    """The limits of /verdicts: clause, text, quantity, unit of the page, factor to it, limit in this unit."""
    if "verdicts/limit" not in results.file:
        return []
    group, found = results.file["verdicts"], []
    for (clause, text), (quantity, unit), limit in zip(group["clause"].asstr()[:], group["quantity"].asstr()[:],
                                                       group["limit"][:]):
        shown_unit, factor = unit_of_limit(quantity, unit)
        found.append({"clause": clause, "text": text, "quantity": quantity, "words": words_of(quantity),
                      "unit": shown_unit, "factor": factor, "limit": number(factor * limit)})
    return found


def verdicts(results, limits_of_file):
    """The table of verdicts; None without limits."""
    if not limits_of_file:
        return None
    group, rows = results.file["verdicts"], []
    columns = (group["verdict"].asstr()[:], group["value"][:], group["margin"][:], group["time"][:], group["runs"][:],
               group["broken_in"][:])
    many = bool(np.any(group["runs"][:] > 1))
    for limit, (word, where), value, margin, time, runs, broken in zip(limits_of_file, *columns):
        when = f", t = {time:.5g} s" if np.isfinite(time) else ""
        runs_in_words = [f"{broken:.0f} of {runs:.0f}" if runs > 1 else ""] if many else []
        shown_value, shown_limit = ([number(one), limit["unit"]] for one in (limit["factor"] * value, limit["limit"]))
        rows.append([word, limit["clause"], ": ".join(filter(None, (limit["words"], limit["text"]))),
                     over_span(limit["quantity"], value) or shown_value,
                     over_span(limit["quantity"], limit["limit"]) or shown_limit,
                     None if np.isnan(margin) else f"{100.0 * margin:.1f} %", where + when, *runs_in_words])
    head = ["verdict", "clause", "limit of", "value", "limit", "margin", "place, or reason of a missing value"]
    return {"title": "Verdicts", "first": True, "head": head + (["runs that break it"] if many else []), "rows": rows}


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
        rows.append([effect.replace("_", " "), governs, train, number(dynamic), static, with_dynamic, model, of_model,
                     with_phi, number(ratio)])
    return {"title": "Trains and load models, EN 1991-2 6.4.6.5", "rows": rows,
            "head": ["effect", "governs", "train", "φ'dyn", "static", "with 1 + φ'dyn + φ''/2", "load model",
                     "static", "with α and Φ", "train over model"], "note": str(group.attrs.get("words", ""))}


def rail(results):
    """The largest effects of each case of UIC 774-3; None for another analysis."""
    if "rail_forces/x" not in results.file:
        return None
    group, rows = results.file["rail_forces"], []
    stress, length = shown("stress"), shown("displacement")
    for case, words in [*CASES.items(), ("separate", "the cases alone, added")]:
        if case in group:
            row = [words]
            for name, (_, factor) in (("tension", stress), ("compression", stress), ("slip", length), ("end", length)):
                value, place, _ = group[case][name][:]
                row += [number(factor * value), number(round(place, 6))]
            rows.append(row)
    head = ["case"]
    for words, (unit, _) in (("tension", stress), ("compression", stress), ("relative displacement", length),
                             ("displacement of a deck end", length)):
        head += [f"{words} ({unit})", "at x (m)"]
    fronts = group["front"][:]
    return {"title": "Largest effects on rails and bridge, UIC 774-3", "head": head, "rows": rows,
            "note": f"Of {len(fronts)} positions of the train, its front {fronts.min():.6g} to {fronts.max():.6g} m "
                    "behind the end of the bridge from which it comes."}


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
            rows.append([title, number(x), [least, unit], first, [greatest, unit], second])
    return {"title": "Least and greatest values of the run", "rows": rows,
            "head": ["quantity", "at x (m)", "least", "at t (s)", "greatest", "at t (s)"]}


def rest(results):
    """Wheel forces and support reactions of a static analysis; None for another one."""
    if results.rows != 1:
        return None
    unit, factor = shown("force")
    rows = [[named(results, k, name), [number(factor * force[0]), unit]] for k, name, force in wheels_of(results)]
    if "supports/reaction" in results.file:
        rows += [[f"support at {x:.6g} m, upward positive", [number(factor * force), unit]]
                 for x, force in zip(results.supports, results.file["supports/reaction"][0, :, 1])]
    return {"title": "Forces at rest", "head": ["wheel or support", "force"], "rows": rows} if rows else None


def plain(value):
    """An attribute as a number or a text."""
    value = value.item() if hasattr(value, "item") and np.size(value) == 1 else value
    return number(value) if isinstance(value, float) else value if isinstance(value, int) else str(value)


def pairs(results):
    """Tables of two columns, closed at first: summary, options."""
    found = [{"title": "Summary of the run, in SI units", "rows": [[name, plain(value)] for name, value in
                                                                   sorted(results.summary.items())]},
             {"title": "Options of the scene", "rows": [list(row) for row in results.options.items()]}]
    return [{**one, "head": ["name", "value"], "closed": True} for one in found if one["rows"]]
