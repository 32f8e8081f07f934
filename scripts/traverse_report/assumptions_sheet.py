"""The page of the assumptions of the calculation, each with its source: an input file, the norm or the program."""

import re
from typing import NamedTuple

import numpy as np
from engineering_units import shown

from . import structure
from .language import capital, digits, known, num, percent, t
from .model_sheet import KINDS, draw_bridge
from .page import table
from .quantities import words_of

FIRST_FREQUENCIES = 6


def origin(source, *names):
    """The input file and line of the first of these options that was given; otherwise a default."""
    group = source.file["input"] if "input" in source.file else {}
    if "options" in group:
        given = {name: place for name, place in zip(group["options"].asstr()[:, 0], group["sources"].asstr()[:])}
        for name in names:
            if name in given:
                path, line = given[name]
                path = path.replace("\\", "/").split("/")[-1]
                return t("{file}, line {line}", file=path, line=line) if line != "0" else \
                    t("command line") if path == "command line" else path
    found = next((name for name in names if name in source.options), None)
    return t("option {name}", name=found) if found else t("default of the program")


def noted(source, pattern):
    """The first group of a pattern in the notes of the program; empty if there is none."""
    found = next(filter(None, (re.search(pattern, note) for note in source.model.notes)), None)
    return found[1] if found else ""


def in_unit(value, kind):
    unit, factor = shown(kind)
    return f"{digits(factor * value)} {unit}"


def along(data, kind):
    low, high = data[:, 1].min(), data[:, 1].max()
    unit, factor = shown(kind)
    return in_unit(low, kind) if low == high else t("{low} to {high}, variable along the bridge",
                                                    low=digits(factor * low),
                                                    high=in_unit(high, kind))


# What a bridge that twists has, each of all spans or one for each.
TORSION = (("beam_GJ", "torsional stiffness GJ", "bending_stiffness"),
           ("beam_polar_inertia", "polar moment of inertia per length", "rotational_inertia_per_length"),
           ("track_eccentricity", "track beside the axis", "length"),
           ("norm_second_track", "second track of the load models beside the axis", "length"))


def of_structure(source):
    """What the title page's options say of the structure."""
    rows = [(words, structure.text_of(source, name), name) for words, name in
            ((t("material"), "report_material"), (t("drawings"), "report_drawings"))]
    return [(words, said, t("command line") if name in source.replaced else origin(source, name))
            for words, said, name in rows if said]


def of_bridge(source):
    model, options = source.model, source.options
    rows, spans = [], np.diff(model.span_ends)
    if len(spans):
        lengths = " + ".join(num(span) for span in spans[:12]) + (" + …" if len(spans) > 12 else "")
        rows.append((t("span lengths"), f"{lengths} m", origin(source, "beam_spans", "bridge_modes_file")))
    if model.supports:
        kinds = [t(KINDS[kind]) if kind in KINDS else kind for kind, _ in model.supports]
        rows.append((t("supports"), ", ".join(f"{kinds.count(kind)} × {kind}" for kind in dict.fromkeys(kinds)),
                     origin(source, "support_types")))
    for name, words, kind in (("EI", "bending stiffness EI", "bending_stiffness"),
                              ("GA", "shear stiffness GA", "axial_stiffness"),
                              ("mass", "mass per length", "mass_per_length")):
        if name in model.group:
            varied = source.runs is not None and f"beam_{name}" in source.runs.parameters
            rows.append((t(words), t("varied in the study") if varied else t("estimated by the fit")
                         if source.is_estimated(f"beam_{name}") else along(model.group[name][:], kind),
                         origin(source, f"beam_{name}", f"beam_{name}_file")))
    rows += [(t(words), t("; ").join(in_unit(float(part), kind) for part in options[name].split(",")), origin(source, name))
             for name, words, kind in TORSION if name in options]
    if "modes/frequency" in source.file:
        shown_ones = t("; ").join(num(f) for f in source.file["modes/frequency"][:FIRST_FREQUENCIES])
        rows.append((t("natural frequencies"), f"{shown_ones} Hz", t("computed")))
    elif "norm" in source.file:
        rows.append((t("first natural frequency n₀"), f"{num(source.file['norm'].attrs['n0'])} Hz", t("computed")))
    rows += [(t("foundation: {kind}", kind=t(KINDS[kind.replace("_bed", "")])), foundation(source, kind, data),
              origin(source, f"foundation_{kind}_k")) for kind, data in model.foundation.items()]
    if "beam_surface_height" in options:
        rows.append((t("height of the track above the neutral axis"), f"{num(float(options['beam_surface_height']))} m",
                     origin(source, "beam_surface_height")))
    return rows


def foundation(source, kind, data):
    """The stiffness of a kind of foundation in words."""
    rotational, bed = kind.startswith("rotational"), kind.endswith("_bed")
    row = "rotational_stiffness" if rotational else "bed_stiffness" if bed else "spring_stiffness"
    values = np.unique(data[:, 1])
    said = " – ".join(in_unit(value, row) for value in (values if len(values) < 2 else values[[0, -1]]))
    if source.runs is not None and f"foundation_{kind}_k" in source.runs.parameters:
        said = t("varied in the study")
    parts = [said, t("along the whole bridge") if bed else t("{count} stations", count=len(data))]
    if data.shape[1] > 3:
        gap = in_unit(data[:, 3].max(), "rotation" if rotational else "displacement")
        parts += [t("compression only")] if data[:, 4].any() else []
        parts += [f"{t('gap')} {gap}"] if data[:, 3].any() else []
        parts += [t("with a cubic term")] if data[:, 5].any() else []
        parts += [f"{t('sliding force')} {in_unit(data[:, 6].max(), 'force')}"] if data[:, 6:].any() else []
    return t("; ").join(parts)


def of_damping(source):
    options = source.options
    stated = noted(source, r"^damping ([\d.e-]+) %")
    words = "ζ = {value} % of each natural mode" if discretisation(source).modes else \
        "ζ = {value} % of the first two natural modes, Rayleigh damping of all others"
    value = t(words, value=num(float(stated))) if stated else ""
    for name, words in (("model_damping_bound", "lower bound of EN 1991-2, Table 6.6: {value}"),
                        ("beam_damping_ratios", "ratios of the first natural modes: {value}"),
                        ("model_damping_ratios", "ratio of each natural mode: {value}"),
                        ("beam_rayleigh", "Rayleigh a, b: {value}")):
        if source.is_estimated(name):
            return [(t("damping"), t("estimated by the fit"), origin(source, name))]
        if name in options:
            said = options[name] if name in ("model_damping_bound", "beam_rayleigh") else \
                t("; ").join(percent(float(part)) for part in options[name].split(","))
            said = t(words, value=known(said))
            return [(t("damping"), t("; ").join(filter(None, (value, said))), origin(source, name)), *ratios_of(source),
                    *([(t("additional damping"), t("by EN 1991-2 6.4.6.4"), origin(source, "model_additional_damping"))]
                      if options.get("model_additional_damping") == "true" else [])]
    return [(t("damping"), t("none"), t("default of the program")), *ratios_of(source)]


def ratios_of(source):
    """The damping ratios that the first natural modes have, by the bridge itself and by dampers of its foundation."""
    rows = []
    for name, words in (("beam", "damping ratios of the first natural modes"),
                        ("dampers", "damping ratios that dampers of the foundation add")):
        values = source.file[f"modes/ratio_by_{name}"][:FIRST_FREQUENCIES] if f"modes/ratio_by_{name}" in source.file else []
        if np.any(values):
            rows.append((t(words), t("; ").join(f"{num(100.0 * value, '.3g')} %" for value in values), t("computed")))
    return rows


def of_loads(source):
    options, rows = source.options, [(t("traffic load"), source.train_in_words(), origin(
        source, "sweep_hslm_a", "load_hslm_a", "train_vehicles", "load_forces", "load_file", "uic774_train_length"))]
    varied = source.runs.parameters if source.runs is not None else {}
    speeds = varied.get("speed", varied.get("train_speed", varied.get("load_speed")))
    unit, factor = shown("speed")
    if speeds is not None:
        each = np.unique(speeds)
        rows.append((t("speeds"), t("{count} speeds from {low} to {high}", count=len(each), low=num(factor * each[0]),
                                    high=f"{num(factor * each[-1])} {unit}"),
                     origin(source, "sweep_speed", "study_vary_train_speed")))
    elif source.is_estimated("train_speed", "load_speed"):
        rows.append((t("speed"), t("estimated by the fit"), origin(source, "train_speed", "load_speed")))
    elif source.results.speed():
        rows.append((t("speed"), f"{num(factor * source.results.speed())} {unit}",
                     origin(source, "train_speed", "load_speed")))
    if "track_rail_EI" in options:
        rows.append((t("track"), t("rail, pads, sleepers and ballast in layers"), origin(source, "track_rail_EI")))
    else:
        rows.append((t("track"), t("not modelled: the loads act on the deck"), t("default of the program")))
    if options.get("track_profile", "none") != "none":
        rows.append((t("track irregularities"), options["track_profile"], origin(source, "track_profile")))
    if source.is_dynamic:
        rows.append(spread_of(source))
    if "norm" in source.file:
        group = source.file["norm"]
        rows.append((t("classification factor α"), num(group.attrs["alpha"]), origin(source, "norm_alpha")))
        lengths, phi = (np.unique(group[name][:]) for name in ("determinant_length", "phi"))
        track = "Φ₂" if options.get("norm_track") == "careful" else "Φ₃"
        rows.append((t("dynamic factor {name}, determinant length L_Φ", name=track),
                     f"{t('; ').join(num(value) for value in (*phi, *lengths))} m",
                     "EN 1991-2 6.4.5.2, 6.4.5.3"))
    return rows


def spread_of(source):
    options = source.options
    if "load_spread" not in options:
        return (t("load distribution by rail and sleepers"), t("none: axle loads act as single forces"),
                t("default of the program"))
    return (t("load distribution by rail and sleepers"), t("over three sleepers, 25, 50 and 25 %, spacing {value}",
                                                           value=f"{num(float(options['load_spread']))} m"),
            origin(source, "load_spread"))


def method_of(source):
    """The method of the analysis in words, with its mesh, modes and step."""
    if source.is_fit:
        return t("nonlinear least squares; starts: {count}",
                 count=len(source.file["fit/starts/misfit"]))
    if not source.is_dynamic:
        return t("static analysis with non-linear track resistance") if source.is_rail else \
            t("static analysis by influence lines")
    found = discretisation(source)
    parts = [t("modal superposition, {count} natural modes", count=found.modes) if found.modes else
             t("direct integration of the finite element model"),
             t("{count} beam elements", count=found.elements) if found.elements else "",
             f"{t('time step')} {found.step}" if found.step else ""]
    return t("; ").join(filter(None, parts))


class Discretisation(NamedTuple):
    """Modes (0: none), elements of all spans together and time step as text; empty: unknown."""
    modes: int
    elements: str
    step: str


def discretisation(source):
    """That of the runs, from the attributes of the sweep or study, the options and the notes of the program."""
    file = source.file
    group = file["sweep"] if "sweep" in file else file["study"] if "study" in file else None
    attrs = {} if group is None else dict(group.attrs)
    modes = int(attrs.get("modes", noted(source, r"^the bridge by (\d+) modes")) or 0)
    elements = noted(source, r"^beam of .* (\d+) elements,") or noted(source, r"(\d+) elements a span") or \
        noted(source, r"(\d+) elements") or attrs.get("elements_per_span", "")
    step = attrs.get("time_step", noted(source, r"steps of (?:at most )?([\d.e-]+) s"))
    unit, factor = shown("loss_time")
    return Discretisation(modes, str(elements), f"{num(factor * float(step))} {unit}" if step else "")


def of_method(source):
    rows = [(t("method"), method_of(source), origin(source, "scene_analysis", "model_modes", "beam_elements_per_span",
                                                    "accuracy"))]
    if not source.is_dynamic:
        return rows
    stations = source.results.probes
    rows.append((t("stations of evaluation"),
                 t("one station at x = {value} m", value=num(stations[0])) if len(stations) == 1 else
                 t("{count} stations from x = {low} m to {high} m", count=len(stations),
                   low=num(stations.min()), high=num(stations.max())),
                 origin(source, "output_probes", "output_probes_spacing")))
    limit = source.summary.get("acceleration_lowpass_frequency") or noted(source, r"low-passed at ([\d.e+]+) Hz")
    rows.append((t("filter of deck accelerations"), t("low-pass, cut-off frequency {value} Hz, without phase shift",
                                                      value=num(float(limit))) if limit else t("none"),
                 "EN 1990 A2.4.4.2.1" if limit and "output_lowpass" not in source.options
                 else origin(source, "output_lowpass")))
    given = source.options.get("scene_start") == "given"
    rows.append((t("start"), t("given positions and velocities") if given
                 else t("bridge and vehicles in static equilibrium"), origin(source, "scene_start")))
    return rows + of_accuracy(source)


def of_accuracy(source):
    """The relative errors that were requested: of the peaks of a run, and of their maxima over the speed."""
    options = source.options
    wanted = percent(float(options["accuracy"])) if "accuracy" in options else t("none requested")
    rows = [(t("relative error of the peaks of a run, requested"), wanted, origin(source, "accuracy"))]
    if source.runs is not None:
        over_speed = refinement(options)
        rows.append((t("relative error of the peaks over the speed, requested"),
                     percent(over_speed) if over_speed else t("none requested"),
                     origin(source, "sweep_refine", "study_refine")))
        rows += [(t("relative error of the peaks over the speed, achieved"), said,
                  t("computed") if known else t("no accuracy requested")) for said, known in uncertainty_of(source)]
    return rows


def refinement(options):
    """The relative error of the peaks over the speed that was requested; 0: none."""
    return next((float(options[name]) for name in ("sweep_refine", "study_refine") if name in options), 0.0)


def curve_in_words(name):
    """The name that the program gives a curve over the speed, such as 'end rotation of A8'."""
    quantity, of, train = name.partition(" of A")
    words = words_of(quantity.replace(" ", "_"))
    return t("{quantity} of {train}", quantity=words, train=f"A{train}") if of else words


def uncertainty_of(source):
    """[(by how much a peak over the speed may exceed the computed one in words, whether the program has determined it)];
    empty without several speeds. With limits alone the program adds speeds near them, without an error of the peaks."""
    if not str(source.runs.x_name).endswith("speed"):
        return []
    summary = source.summary
    share, added = float(summary.get("peak_uncertainty", 0.0)), int(summary.get("speeds_added", 0))
    known = refinement(source.options) > 0.0 and share > 0.0
    if not known:
        return [(t("not determined; {count} speeds added near limits", count=added) if added else
                 t("not determined between the speeds, which are as given"), known)]
    said = t("{share} ({curve})", share=percent(share), curve=curve_in_words(str(summary["peak_uncertainty_of"])))
    return [(t("; ").join((said, t("{count} speeds added", count=added))), known)]


def rows_of(source):
    """Rows (assumption, value, source)."""
    damping = of_damping(source) if source.is_dynamic or source.is_fit else []
    return [*of_structure(source), *of_bridge(source), *damping, *of_loads(source), *of_method(source)]


def sheet(report, source):
    page = report.page(t("Basis of calculation"))
    report.anchor("assumptions")
    if len(source.model.span_ends) > 1:
        draw_bridge(page, source)
    if source.cross_section is not None:
        structure.draw_cross_section(page, source.cross_section)
    table(report, page, [(t("assumption"), 1.9, "left"), (t("value"), 3.1, "left"), (t("source"), 1.8, "left")],
          [(capital(words), *rest) for words, *rest in rows_of(source)],
          size=8)
