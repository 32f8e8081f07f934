"""The scope of verification: every requirement of clauses.yml with its result, so that nobody takes a part for the
whole."""

import functools
import pathlib

import yaml

from . import hslm
from .comfort_sheet import comfort_rows
from .decisions import DECISIONS, need_for_analysis
from .front_sheet import COLOURS, WORDS
from .language import capital, t
from .page import AMBER, BEGINNING, GREEN, GREY, INK, LEFT, RED, Reference, table
from .quantities import shown_value, speed_in_words

PAGES = {"rail": {"rail_tension", "rail_compression", "deck_displacement", "deck_end_displacement"}}  # others: verdicts
MARKS = ("⁰", "¹")  # clauses that no or one public source confirms


@functools.cache
def clauses():
    return yaml.safe_load(pathlib.Path(__file__).with_name("clauses.yml").read_text(encoding="utf-8"))


def varied(source, name):
    """Whether an option has several values: in the runs of the file, or in the files of the report."""
    return source.runs is not None and (name in source.runs.parameters
                                        or len({one.options.get(name) for one in source.compared}) > 1)


def has_all_trains(source):
    return set(map(hslm.name_of, hslm.TRAINS)) <= set(source.hslm_trains)


def has_resonance_of_real_trains(source):
    """Whether vehicles, or axle forces that are no load model HSLM, pass at several speeds."""
    own_forces = "load" in source.model.forces and "load_hslm_b" not in source.options and not source.hslm_trains
    return source.runs is not None and source.runs.is_over_speed and (own_forces or len(source.model.train) > 0)


# What a requirement without a limit needs in the results: a condition, and the anchor of its page.
COMPUTED = {
    "norm": (lambda source: "norm" in source.file, "norm"),
    "trains_and_models": (lambda source: "norm/effect" in source.file, "norm"),
    "comfort": (lambda source: bool(comfort_rows(source)[0]), "comfort"),
    "hslm": (has_all_trains, "loads"),
    "real_trains": (has_resonance_of_real_trains, "loads"),
    "damping": (lambda source: "model_damping_bound" in source.options, "assumptions"),
    "mass": (lambda source: varied(source, "beam_mass"), "assumptions"),
    "stiffness": (lambda source: varied(source, "beam_EI"), "assumptions"),
    "rail": (lambda source: source.is_rail, "rail"),
}


def has_joints(source):
    return any(joint in ("hinge", "separate") for _, joint in source.model.supports)


def is_unnecessary(source):
    """Whether the flow chart requires no dynamic analysis."""
    found = need_for_analysis(source)
    return found is not None and not found.needed


def of_file(name):
    return f" ({name})" if name else ""


def results_of(source, row, verdicts):
    """(result in words, its colour, limit, value, anchor of its page) of a requirement, one for each verdict."""
    quantities = row.get("quantities", [])
    found = [verdict for verdict in verdicts if verdict.limit.quantity in quantities and verdict.word != "not judged"]
    if found:
        return [(t(": ").join([t(WORDS[v.word]), *([v.limit.words] if len(found) > 1 else [])]) + of_file(v.file),
                 COLOURS[v.word], shown_value(v.limit.value, v.limit.quantity),
                 shown_value(v.value, v.limit.quantity),
                 ("", v.file) if v.file else "rail" if v.limit.quantity in PAGES["rail"] else "verdicts")
                for v in found]
    if row.get("needs") == "joints" and not has_joints(source):
        return [(t("not applicable: no joint between two decks"), GREY, "", "", "")]
    if row.get("needs") == "torsion" and "beam_GJ" not in source.options:
        return [(t("not verified: the beam does not twist"), AMBER, "", "", "")]
    if row.get("needs") == "dynamic" and not source.is_dynamic and is_unnecessary(source):
        return [(t("not applicable: no dynamic analysis is necessary"), GREY, "", "", "need")]
    decision = DECISIONS[row["decided"]](source) if "decided" in row else None
    if decision is not None:
        return [(decision.words, decision.colour, "", "", decision.anchor)]
    condition, anchor = COMPUTED.get(row.get("computed"), (None, ""))
    remark = t(row["remark"]) if "remark" in row else ""
    if condition is not None and condition(source):
        return [(t("; ").join(filter(None, (t("computed, without a limit"), remark))), INK, "", "", anchor)]
    if condition is None and not quantities and "decided" not in row:
        return [(t("; ").join(filter(None, (t("not in this program"), remark))), GREY, "", "", "")]
    return [(t("not verified: no limit given") if quantities else t("not verified"), AMBER, "", "", "")]


def rows_of(source, verdicts, others=()):
    """(requirement, clause, results) of all requirements. others: further files of the structure; their decisions are
    results, too, where they differ and are not satisfied."""
    rows = []
    for row in clauses()["requirements"] if source.is_verification else ():
        said = t(row["requirement"]) + (f" ({t(row['value'])})" if "value" in row else "")
        mark = MARKS[len(row["sources"])] if row["clause"] and len(row["sources"]) < len(MARKS) else ""
        results = results_of(source, row, verdicts)
        for other in others if "decided" in row else ():
            results += [(words + of_file(other.path.name), colour, limit, value, ("", other.path.name))
                        for words, colour, limit, value, _ in results_of(other, row, [])
                        if words != results[0][0] and colour != GREEN]
        rows.append((said, row["clause"] + mark, results))
    return rows


def alarms(source):
    """The requirements that are decided without a limit and are not satisfied, in words."""
    found = [(row, DECISIONS[row["decided"]](source)) for row in clauses()["requirements"] if "decided" in row]
    return [t(": ").join((f"{capital(t(row['requirement']))}, {row['clause']}", decision.words)) for row, decision in found
            if decision is not None and decision.colour == RED]


def sheet(report, source, verdicts, others=()):
    report.foot_note = t("{one}: one public source confirms the number of the clause; {none}: no public source "
                         "confirms it. Such numbers must be checked with the norm.", one=MARKS[1], none=MARKS[0])
    scope(report, source, verdicts, others)
    steps(report, source)
    report.foot_note = ""


def steps(report, source):
    """The steps of the flow chart of figure 6.9 for the bridge of the file."""
    found = need_for_analysis(source)
    if found is None:
        return
    page = report.page(t("Need for a dynamic analysis"), least=BEGINNING)
    report.anchor("need")
    page.text(LEFT, t("Flow chart of EN 1991-2 figure 6.9 for a line speed of {speed}",
                      speed=speed_in_words(source.line.line_speed)))
    page.y -= 0.05
    table(report, page, [(t("clause"), 1.7, "left"), (t("step"), 5.1, "left")], found.steps)


def scope(report, source, verdicts, others):
    page = report.page(t("Scope of verification"))
    page.text(LEFT, t("All requirements of EN 1990 A2.4.4 and EN 1991-2 6.4 and 6.5.4 for railway bridges. A result "
                      "covers only the requirements with a verdict; the others need a separate verification. Values in "
                      "brackets are the recommended ones; the national annex may change them."))
    if others:
        page.text(LEFT, t("Each result is the worst of all files of the structure; one of another file has its name."))
    page.y -= 0.08
    cells = []
    for requirement, clause, results in rows_of(source, verdicts, others):
        for i, (said, colour, limit, value, anchor) in enumerate(results):
            first = [capital(requirement), clause] if i == 0 else ["", ""]
            cells.append([*first, (said, colour), limit, value, Reference(anchor) if anchor else ""])
    columns = [(t("requirement"), 2.3, "left"), (t("clause"), 1.25, "left"), (t("result"), 1.55, "left"),
               (t("limit"), 0.62, "right"), (t("value"), 0.72, "right"), (t("page"), 0.36, "right")]
    table(report, page, columns, cells, size=6.5)
