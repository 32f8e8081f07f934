"""Charts along the bridge or the track: envelopes, static effects, rail stresses, natural modes; and the ratios of a
search over its values; and the measured series of a fit."""

import numpy as np
from engineering_units import shown
from picture_axes import legible
from picture_data import MOST_CURVES
from traverse_report import find_sheet, fit_sheet
from traverse_report.language import Chosen, known, num, t
from traverse_report.rail_sheet import CASES
from traverse_report.source import Source

from .packing import Chart, Curve

ENVELOPES = {"deflection": ("Deflection of the bridge, upward positive", "deflection"),
             "acceleration": ("Vertical acceleration of the bridge, unfiltered", "acceleration"),
             "moment": ("Bending moment of the bridge, positive in sagging", "moment"),
             "shear": ("Shear force of the bridge", "force")}
FEWEST_STATIONS = 4  # of a chart; tables.envelope has the values at fewer stations
# Limits that are lines in a chart of the rails: quantity, sign.
OF_STRESS, OF_SLIP = {"rail_tension": 1.0, "rail_compression": -1.0}, {"rail_slip": 1.0}


def along(title, quantity, x, curves, where="", limits=()):
    """A chart over the position of values in SI units."""
    unit, factor = shown(quantity)
    unit, smaller = legible(unit, [factor * values for _, values in curves])
    order = np.argsort(x, kind="stable")
    scaled = [Curve(name, smaller * factor * values[order]) for name, values in curves]
    lines = tuple((name, smaller * factor * value) for name, value in limits)
    return Chart(title, unit, scaled, x[order], where or t("position along the bridge"), "m", lines)


def inside(title):
    """A title within another one; German nouns keep their capital letters."""
    said = known(title)
    return said if Chosen.language == "de" else f"{said[0].lower()}{said[1:]}"


def envelope_charts(results):
    group = results.file["envelope"] if "envelope" in results.file else {}
    for name, (title, quantity) in ENVELOPES.items():
        if name in group and len(results.probes) >= FEWEST_STATIONS:
            curves = [("least to greatest of the run", group[name][:])]
            if name == "deflection" and "static_deflection" in group:
                curves.append(("largest static deflection, drawn downward", -group["static_deflection"][:]))
            yield along(t("Envelope: {effect}", effect=inside(title)), quantity, results.probes, curves)


def rest_charts(results):
    """The deflected bridge of a static analysis."""
    if results.rows == 1 and "shape/x" in results.file:
        yield along(t("Deflection of the bridge at rest, upward positive"), "deflection", results.values("shape/x"),
                    [("at rest", results.values("shape/deflection"))])


def static_charts(results):
    if "static/load" not in results.file:
        return
    loads, x = results.file["static/load"].asstr()[:, 0], results.values("static/x")
    for name, (title, quantity) in ENVELOPES.items():
        if f"static/{name}" in results.file:
            values = results.values(f"static/{name}")
            yield along(t("Static effects of each load over all its positions: {effect}", effect=inside(title)),
                        quantity, x, [(load, values[i]) for i, load in enumerate(loads)])


def rail_limits(results, signs):
    if "verdicts/limit" not in results.file:
        return []
    rows = zip(results.file["verdicts/quantity"].asstr()[:, 0], results.file["verdicts/clause"].asstr()[:, 0],
               results.values("verdicts/limit"))
    return [(f"limit, {clause}", signs[quantity] * limit) for quantity, clause, limit in rows if quantity in signs]


def rail_charts(results):
    for kind, quantity, at, title, signs in (
            ("stress", "stress", "x", "Additional stress of the rails, least and greatest of all train positions",
             OF_STRESS),
            ("slip", "displacement", "sleeper_x",
             "Displacement of the rail relative to deck or ground, least and greatest", OF_SLIP)):
        sides = [f"{side}_{kind}" for side in ("least", "greatest")]
        curves = [(t(words), np.column_stack([results.values(f"rail_forces/{case}/{side}") for side in sides]))
                  for case, words in CASES.items() if f"rail_forces/{case}/{sides[0]}" in results.file]
        if curves:
            yield along(known(title), quantity, results.values(f"rail_forces/{at}"), curves,
                        t("position along the track"), rail_limits(results, signs))


def mode_charts(results):
    shapes = results.values("modes/shape")
    if shapes is None or "modes/x" not in results.file:
        return
    frequencies = results.values("modes/frequency")
    kept = range(min(len(shapes), MOST_CURVES))
    note = "" if len(kept) == len(shapes) else f" ({t('{count} of {all}', count=len(kept), all=len(shapes))})"
    yield Chart(t("Natural modes of the bridge, each with the largest value 1") + note, "",
                [Curve(f"{num(frequencies[i], '.5g')} Hz", shapes[i]) for i in kept], results.values("modes/x"),
                t("position along the bridge"), "m")


def search_charts(results):
    """The ratio to the bound over the searched values; the page calls its section by what it contains."""
    if "find/ratio" not in results.file:
        return
    words = find_sheet.Words(Source(results.file.filename))
    curves = [Curve(name, ratio) for name, ratio in words.curves(find_sheet.MOST_DRAWN)]
    yield Chart(t("Ratio to the bound"), "", curves, words.factor * words.search.value, words.option, words.unit,
                ((t("bound"), 1.0),))


def fit_charts(results):
    """Each measured series of a fit with its computed counterpart."""
    if "fit/estimate" not in results.file:
        return
    for one in fit_sheet.series_of(results.file):
        curves = [Curve(t("measured"), one.measured)]
        curves += [Curve(t("computed"), one.computed)] if np.isfinite(one.computed).all() else []
        yield Chart(f"{one.name}: {one.place}", one.unit, curves, one.time, t("time"), "s")


def heading(results):
    """The heading of these charts."""
    if "fit/estimate" in results.file:
        return t("Measured and computed")
    return t("Search for values") if "find/ratio" in results.file else t("Along the bridge")


def charts(results):
    kinds = (search_charts, fit_charts, rail_charts, rest_charts, envelope_charts, static_charts, mode_charts)
    return [chart for kind in kinds for chart in kind(results)]
