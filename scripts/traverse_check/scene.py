"""The scene files of a check: text that an engineer can change and run again."""

import json
import math
from typing import NamedTuple

from input_files import InputError, yaml_of
from traverse_report import language
from traverse_report.language import t
from traverse_report.quantities import speed_in_words

from . import track_defects, units
from .rules import MARKS, CheckError, clause, data, requirements, rule

SECTIONS = 20             # stations in each span
MANY_SPANS = 4            # from this number of spans on, half of them: the time grows with their total number
SPEED_STEP = 5.0 / 3.6    # m/s, before the program refines the speeds
REFINE = 0.01             # relative accuracy of the peaks over the speed
NAMES = {"stiffness": "bending stiffness EI", "mass": "mass per length"}
WORDS = {"filler_beam": "filler beams", "prestressed": "prestressed concrete", "reinforced": "reinforced concrete"}


class Case(NamedTuple):
    """One combination of the bounds."""
    name: str             # of its files
    words: str            # "lower EI, upper mass", empty without bounds
    EI: float
    mass: float


def cases(question, stiffnesses):
    """All combinations of the bounds. `stiffnesses`: EI in N m2, or those that belong to the frequencies."""
    found = []
    kind = "frequency" if question.frequencies else "EI"
    for i, EI in enumerate(stiffnesses):
        for j, mass in enumerate(question.masses):
            parts = [(("lower", "upper")[number], what) for number, what, count in
                     ((i, kind, len(stiffnesses)), (j, "mass", len(question.masses))) if count > 1]
            name = "_".join(f"{bound}_{what}" for bound, what in parts) or "check"
            found.append(Case(name, ", ".join(f"{bound} {what}" for bound, what in parts), EI, mass))
    return found


def spans_in_words(question):
    count, lengths = len(question.spans), ", ".join(f"{span:g}" for span in question.spans)
    if count == 1:
        return f"a simply supported span of {lengths} m"
    if len(set(question.spans)) == 1:
        lengths = f"{question.spans[0]:g}"
    return f"{count} {'simply supported' if question.separate else 'continuous'} spans of {lengths} m"


def bridge_in_words(question):
    material = WORDS.get(question.type, question.type)
    track = "ballasted track" if question.track == "ballast" else "direct fastening"
    speed = units.in_words("line-speed", question.line_speed)
    return f"{spans_in_words(question)}, {material}, {track}, line speed {speed}"


def quoted(text):
    """A text as YAML: JSON is a part of it. Bytes that are no text become question marks."""
    return json.dumps(text, ensure_ascii=False).encode("utf-8", "replace").decode("utf-8")


def rows(*lines):
    """Lines (key: value, comment) in columns."""
    width = max(len(line) for line, _ in lines)
    return "".join((f"  {line:<{width}}  # {comment}" if comment else f"  {line}") + "\n" for line, comment in lines)


def beam_text(spans, case, question):
    """The bridge of a scene."""
    bounds_of_EI = len(question.EI or question.frequencies) > 1
    text = "beam:\n" + rows(
        (f"spans: [{', '.join(repr(span) for span in spans)}]", "m"),
        (f"EI: {case.EI!r}", "N m2" + (f"; bounds: {clause('stiffness')}" if bounds_of_EI else "")),
        (f"mass: {case.mass!r}", "kg/m, with ballast and track"
         + (f"; bounds: {clause('mass')}" if len(question.masses) > 1 else "")))
    if question.simply_supported and len(spans) > 1:
        text += "  continuity: simply_supported\n"
    if question.eccentricity is None:
        return text
    return (text + rows((f"GJ: {question.GJ!r}", "N m2"), (f"polar_inertia: {question.polar_inertia!r}", "kg m"))
            + "track:\n" + rows((f"eccentricity: {question.eccentricity!r}", "m from the axis: the track of the trains")))


def norm_text(question):
    models = "lm71" if question.separate else "lm71, sw0"
    return "norm:\n" + rows(
        (f"load_models: [{models}]", "EN 1991-2 6.3"),
        (f"alpha: {question.alpha!r}", "EN 1991-2 6.3.2"),
        *([(f"second_track: {-question.eccentricity!r}", "m: load models stand on both tracks")]
          if question.tracks == 2 else []),
        (f"track: {'careful' if question.careful else 'standard'}", "EN 1991-2 6.4.5.2: careful: Phi2; standard: Phi3"))


def report_text(question, needed):
    texts = title_page(question, needed)
    return "report:\n" + rows(*((f"{name}: {quoted(text)}", "") for name, text in texts.items()))


def head(question, case, what):
    words = f"; {case.words}" if case.words else ""
    return (f"# What: check by EN 1991-2 and EN 1990: {bridge_in_words(question)}{words}; {what}.\n"
            f"# Source: input of traverse check; {MARKS[0]} no public source confirms the clause, {MARKS[1]} one: "
            "check it with the norm.\n"
            "# Expected: the verdicts of limits.yml. To change it and run it again: traverse -options_file with this "
            "file.\n")


def speeds(question):
    """First speed, last speed and step in m/s."""
    last = rule("speeds")["factor"] * question.line_speed
    usual = float(rule("speeds")["first"])
    first = usual if last > 1.1 * usual else 0.5 * last  # slow lines have no speed above the usual first one
    return first, last, (last - first) / math.ceil((last - first) / SPEED_STEP)


def dynamic_scene(question, case, modes, train, needed=True):
    """The sweep of the trains HSLM-A or HSLM-B over the speeds. needed: whether figure 6.9 requires it."""
    first, last, step = speeds(question)
    sweep = [(f"speed: [{first!r}, {last!r}, {step!r}]",
              f"m/s: from, to, step; to {rule('speeds')['factor']} times the line speed, {clause('speeds')}"),
             (f"refine: {REFINE!r}", "further speeds, until the peaks have this relative accuracy")]
    loads = []
    if train == "A":
        sweep.append(("hslm_a: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]", clause("short_span")))
    else:
        loads.append((f"hslm_b: [{question.hslm_b[0]}, {question.hslm_b[1]!r}]", f"{clause('short_span')}: N, d in m"))
        loads.append((f"speed: {first!r}", "m/s; the sweep replaces it"))
    if question.load_spread is not None:
        loads.append((f"spread: {question.load_spread!r}", "m: sleeper spacing, EN 1991-2 6.3.6"))
    damping = [(f"modes: {modes}", "all natural modes up to 1.5 times the cut-off frequency of EN 1990 A2.4.4.2.1"),
               (f"damping_bound: {question.type}", clause("damping"))]
    if question.additional_damping:
        damping.append(("additional_damping: true", "EN 1991-2 6.4.6.4"))
    spacing = min(question.spans) / (SECTIONS if len(question.spans) < MANY_SPANS else SECTIONS // 2)
    return (head(question, case, f"trains HSLM-{train}") + beam_text(question.spans, case, question)
            + "model:\n" + rows(*damping) + ("load:\n" + rows(*loads) if loads else "") + "sweep:\n" + rows(*sweep)
            + "scene:\n" + rows(("tail: 1.0", "s of free vibration"))
            + "output:\n" + rows((f"probes: {{spacing: {spacing!r}}}", "m: stations along the bridge"))
            + norm_text(question) + report_text(question, needed) + "limits: limits.yml\n")


def bare_static_scene(question, case, spans):
    """The static effects of the load models, without limits and title page."""
    return (beam_text(spans, case, question) + "scene:\n"
            + rows(("analysis: envelope", "largest static effects over all positions")) + norm_text(question))


def static_scene(question, case):
    """The static effects of the load models with Phi."""
    return (head(question, case, "load models with Phi, static") + bare_static_scene(question, case, question.spans)
            + report_text(question, False) + "limits: limits.yml\n")


def read_limits(limits_file):
    """The rows of a file of limits."""
    try:
        found = yaml_of(limits_file, "list of limits, each with quantity, value and clause")
        return [{name: str(row[name]) for name in ("clause", "quantity", "value", "text", "factor")
                 if name in row or name == "quantity"} for row in found]
    except InputError as error:
        raise CheckError(str(error), 4) from None
    except (TypeError, KeyError):
        raise CheckError(f"{limits_file} is no list of limits, each with quantity, value and clause") from None


def limit_rows(question, limits_file, factor):
    """The limits of the file that apply, and that of EN 1991-2 6.4.6.5. Direct fastening replaces values of
    options/limits/en1991_2.yml. factor: of 6.4.6.4 for the effects of trains; None without a dynamic analysis."""
    found, dynamic = read_limits(limits_file), factor is not None
    joints = question.simply_supported and len(question.spans) > 1
    others = data()["direct_fastening"] if question.track == "direct" and not question.limits else {}
    kept = []
    for row in found:
        quantity = row["quantity"]
        row |= {name: str(value) for name, value in others.get(quantity, {}).items() if name != "sources"}
        if ("joint" not in quantity or joints) and (dynamic or quantity.startswith("lm71")):
            kept.append(row)
    if question.eccentricity is not None and all(row["quantity"] != "lm71_track_twist" for row in kept):
        kept.append(twist_row(question.line_speed))
    if not kept:
        raise CheckError(f"{limits_file}: none of its limits applies to this check")
    return with_rules_for_trains(kept, factor) if dynamic else kept


def twist_row(line_speed):
    """The limit of the twist of a track at a line speed in m/s, as a row of the file of limits."""
    own = rule("twist")
    value = next(row["value"] for row in own["limits"] if 3.6 * line_speed <= row["to"] * (1.0 + 1e-9))
    return {"clause": own["clause"], "quantity": "lm71_track_twist", "value": str(value), "text": own["text"]}


def with_rules_for_trains(found, factor):
    """Limits with those of the trains: of deflection and rotation as under LM71, and of 6.4.6.5, which holds for the
    twist too, each unless there is one; and with the factor of 6.4.6.4 for the effects of trains."""
    own = rule("limit_states")
    added = [row | {"quantity": row["quantity"].removeprefix("lm71_"), "text": "under the trains"} for row in found
             if row["quantity"].startswith("lm71_") and row["quantity"] != "lm71_track_twist"]
    added.append({"clause": own["clause"], "quantity": "train_over_lm71", "value": str(own["value"]),
                  "text": own["text"]})
    given = {row["quantity"] for row in found}
    return track_defects.with_factor(found + [row for row in added if row["quantity"] not in given], factor)


def limits_text(question, limits_file, factor):
    return text_of_limits("this check", limits_file, limit_rows(question, limits_file, factor))


def text_of_limits(what, limits_file, found):
    """Rows of limits as a file, which an engineer can change."""
    lines = ["- {" + ", ".join(f"{name}: {quoted(text)}" for name, text in row.items()) + "}\n" for row in found]
    return (f"# What: limits of {what}; values are numbers in SI units, or fractions. To change and to run again.\n"
            f"# Source: {quoted(limits_file.name)}; national annexes may change recommended values.\n"
            f"# factor: 1 + phi'', or 1 + phi''/2 on carefully maintained track, by {clause('track_defects')}.\n"
            "# Expected: no figure.\n" + "".join(lines))


def sources_of(quantity):
    """The public sources that confirm the clause of the limit of a quantity."""
    return next((row["sources"] for row in requirements() if quantity in row.get("quantities", ())), [])


def single_bounds(question):
    """The quantities of which one value was given, so that their bounds are not examined."""
    return [name for name, values in (("stiffness", question.EI or question.frequencies), ("mass", question.masses))
            if len(values) == 1]


def not_covered(question, judged, dynamic):
    """Requirements of EN 1990 A2.4.4 and EN 1991-2 6.4 without a verdict, which the check does not compute either; those
    of a dynamic analysis only if there is one."""
    covered = {"norm", "hslm", "damping", "mass", "stiffness", "need", "speeds", "track_defects"} - \
        set(single_bounds(question))
    left_out = {"joints"} if dynamic else {"joints", "dynamic"}
    return [row for row in requirements() if not set(row.get("quantities", ())) & set(judged)
            and row.get("needs") not in left_out and row.get("computed", row.get("decided")) not in covered]


def title_page(question, needed):
    """The texts of the title page in the language of the report: those given, the bridge, and the conditions of the
    result. needed: whether figure 6.9 requires a dynamic analysis."""
    wanted = question.title.get("language", "en")
    language.choose(wanted if wanted in language.LANGUAGES else "en")
    try:
        words = "need for a dynamic analysis by EN 1991-2 figure 6.9: yes, at a line speed of {speed}" if needed else \
            "need for a dynamic analysis by EN 1991-2 figure 6.9: no, at a line speed of {speed}"
        note = [t(words, speed=speed_in_words(question.line_speed))]
        single = [f"{t(NAMES[name])} ({rule(name)['clause']})" for name in single_bounds(question)]
        if single:
            note.append(t("not examined, as one value was given: the bounds of {names}", names=", ".join(single)))
        structure = f"{spans_on_title(question)}, {t(WORDS.get(question.type, question.type))}"
        return {"structure": structure[0].upper() + structure[1:],
                "note": " ".join(f"{said[0].upper()}{said[1:]}." for said in note)} | question.title
    finally:
        language.choose("en")


def spans_on_title(question):
    count, spans = len(question.spans), question.spans
    lengths = " + ".join(language.num(span, ".6g") for span in (spans if len(set(spans)) > 1 else spans[:1]))
    if count == 1:
        return t("a simply supported span of {lengths} m", lengths=lengths)
    if question.separate:
        return t("{count} simply supported spans of {lengths} m", count=count, lengths=lengths)
    return t("{count} continuous spans of {lengths} m", count=count, lengths=lengths)


def conditions(question, dynamic):
    """What the result depends on, beside the limits."""
    single = single_bounds(question)
    if not dynamic or not single:
        return ""
    words = " and ".join("--EI" if name == "stiffness" else "--mass" for name in single)
    return (f"Condition: no scatter of the given {' and '.join(single)}; the lower and upper bounds, two values of "
            f"{words}, were not examined.")
