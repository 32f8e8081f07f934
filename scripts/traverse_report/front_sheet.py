"""The summary of one results file: its verdicts, its greatest values and its governing run."""

import numpy as np
from engineering_units import shown
from picture_hanging import hanging_of

from . import find_sheet, fit_sheet, model_sheet, norm_sheet, rail_sheet, screen_sheet, static_sheet
from .language import capital, digits, known, num, percent, place_in_words, t
from .limits import STATIC
from .page import AMBER, GREEN, GREY, LEFT, RED, table
from .quantities import QUANTITIES, shown_value, unit_of, words_of

WORDS = {"kept": "complied with", "kept alone": "complied with in the governing run", "broken": "exceeded",
         "not judged": "not evaluated", "below": "below", "above": "above"}
COLOURS = {"kept": GREEN, "kept alone": GREY, "broken": RED, "not judged": GREY, "below": GREEN, "above": AMBER}


def word_cell(word):
    return t(WORDS[word]), COLOURS[word]


def outcome(verdicts):
    """The main result in one line, and its colour."""
    judged = [verdict for verdict in verdicts if verdict.word in ("kept", "broken")]
    broken = sum(verdict.word == "broken" for verdict in judged)
    alone = sum(verdict.word == "kept alone" for verdict in verdicts)
    left = len(verdicts) - len(judged) - alone
    if not verdicts:
        return t("No limits were given: the results are not verified."), GREY
    said, colour = t("None of the {count} limits could be evaluated.", count=len(verdicts)), GREY
    if broken:
        said, colour = t("Limits exceeded: {count} of {all} evaluated.", count=broken, all=len(judged)), RED
    elif judged:
        said = t("All evaluated limits are complied with: {count} of {all}.", count=len(judged), all=len(verdicts))
        colour = AMBER if alone else GREEN
    rest = [t("Known for the governing run only: {count}.", count=alone)] if alone else []
    rest += [t("Not evaluated: {count}.", count=left)] if left and judged else []
    return " ".join([said, *rest]), colour


def outcome_of(source, verdicts):
    """The same of a results file; red if its computation has not reached its end."""
    answer = next((one for kind, one in ((source.is_search, find_sheet), (source.is_fit, fit_sheet),
                                         (source.is_screen, screen_sheet)) if kind), None)
    said, colour = (answer.outcome(source), GREY) if answer is not None else outcome(verdicts)
    ended = source.summary.get("ended", t("it was killed"))
    if ended == "reached its end":
        return said, colour
    return f"{t('The computation did not reach its end: {reason}.', reason=ended)} {said}", RED


def verdict_table(report, page, verdicts):
    columns = [(t("requirement"), 1.4, "left"), (t("quantity"), 1.2, "left"), (t("limit"), 0.55, "right"),
               (t("value"), 0.72, "right"), (t("utilisation"), 0.7, "right"), (t("result"), 0.7, "left"),
               (t("run, position, time"), 1.53, "left")]
    rows = []
    for v in verdicts:
        judged = v.word != "not judged"
        rows.append([t("; ").join(filter(None, (v.limit.clause, known(v.limit.text)))), capital(v.limit.words),
                     shown_value(v.limit.value, v.limit.quantity), shown_value(v.value, v.limit.quantity),
                     percent(v.utilisation) if judged else "", word_cell(v.word),
                     t("; ").join(filter(None, (v.run, v.where)))])
    return table(report, page, columns, rows, size=7)


def is_known(runs, name):
    """Whether a quantity is listed and drawn: it has values, of losses of contact at least one, and no other quantity
    contains it, as the deflection that over the span."""
    if name in (*STATIC, "deflection_over_span") or name not in runs.values or np.isnan(runs.of_run(name)).all():
        return False
    return name != "longest_loss" or np.nanmax(runs.of_run(name)) > 0.0


def peak_rows(source):
    """Rows (quantity, value, unit, run and place) of the greatest values, in the unit."""
    if source.is_rail:
        return rail_sheet.peak_rows(source)
    if source.is_static:
        return static_sheet.peak_rows(source)
    if source.is_fit:
        return fit_sheet.peak_rows(source)
    if source.is_screen:
        return screen_sheet.peak_rows(source)
    return peaks_of_run(source) if source.runs is None else peaks_of_runs(source)


def peaks_of_run(source):
    rows, summary = [], source.summary
    for name, quantity in (("deflection", "peak_deflection"), ("acceleration", "peak_acceleration"),
                           ("acceleration_lowpass", "deck_acceleration"), ("moment", "peak_moment")):
        if name in summary:
            unit, factor = unit_of(quantity)
            where = place_in_words(summary[f"{name}_place"], source.results.supports)
            if f"{name}_relative_to" in summary:
                where = f"{t('relative to the supports')}, {where}"
            rows.append((words_of(quantity), factor * abs(summary[name]), unit,
                         f"{where}, t = {num(summary[f'{name}_time'])} s"))
    if "amplification" in summary:
        rows.append((words_of("amplification"), summary["amplification"], "",
                     t("relative to the greatest static deflection")))
    if "least_wheel" in summary:
        unit, factor = unit_of("least_wheel_force")
        rows.append((words_of("least_wheel_force"), factor * summary["least_wheel_force"], unit,
                     known(str(summary["least_wheel"]))))
    return rows + (peaks_on_ropes(source) if source.is_crane else [])


def peaks_on_ropes(source):
    """Rows of the greatest sway of each load on ropes, and of the greatest force of its ropes."""
    rows, time = [], source.results.time
    for one in (one for one in hanging_of(source.results) if one.ropes):
        where = known(f"vehicle {one.vehicle}, {one.body}")
        for words, values, kind in ((t("greatest sway of a load on its ropes"), np.abs(one.swing), "deflection"),
                                    (t("greatest force of all ropes of a load"), one.force, "force")):
            (unit, factor), row = shown(kind), int(np.argmax(values))
            rows.append((words, factor * values[row], unit, f"{where}, t = {num(time[row])} s"))
    return rows


def peaks_of_runs(source):
    rows, runs = [], source.runs
    for name in QUANTITIES:
        if not is_known(runs, name):
            continue
        unit, factor = unit_of(name)
        values = runs.of_run(name)
        run = int(np.nanargmin(values) if name.startswith("least") else np.nanargmax(values))
        place = runs.place(name, run)
        where = "" if place is None else ", " + place_in_words(place, source.results.supports)
        rows.append((runs.quantity_in_words(name), factor * values[run], unit, runs.run_in_words(run) + where))
    return rows


def sheet(report, source, verdicts, governing):
    """The first page of a file: the scene, the verdicts and their utilisation."""
    page = report.page(t("Summary of results"))
    page.text(LEFT, source.title(), size=11, weight="bold")
    several = source.is_screen or source.runs is not None and "hslm_a" in source.runs.parameters
    train = "" if several else source.train_in_words() + t("; ")
    page.text(LEFT, train + source.kind_in_words(), size=9)
    page.text(LEFT, t("Results file {name}", name=source.path.name), size=8, colour=GREY)
    if len(source.model.span_ends) > 1:
        model_sheet.draw_bridge(page, source)
    page.y -= 0.05
    said, colour = outcome_of(source, verdicts)
    page.text(LEFT, said, size=11, colour=colour, weight="bold")
    if source.is_verification:
        page.text(LEFT, t("The result covers only the requirements that the section Scope of verification marks as "
                          "verified."), size=8,
                  colour=GREY)
    page.y -= 0.1
    if verdicts:
        page = verdict_table(report, page, verdicts)
        report.anchor("verdicts")
    if said := norm_sheet.sentence(source):
        page.text(LEFT, said)
        page.y -= 0.1
    head = t("greatest values of all runs") if source.runs is not None else t("greatest values of the run") \
        if source.is_run else t("estimate") if source.is_fit else t("greatest values")
    last = t("remark") if source.is_fit else t("bridge, formation, speed") if source.is_screen else \
        t("run, position, time")
    rows = [(capital(words), f"{digits(value)} {unit}".strip(), where)
            for words, value, unit, where in peak_rows(source)]
    page = table(report, page,
                 [(head, 2.5, "left"), (t("value"), 1.0, "right"), (last, 3.3, "left")], rows)
    if governing is not None:
        page = page if page.room() > 0.8 else report.page(page.heading)
        page.text(LEFT, t("The governing run, {run}, was repeated with closer stations and stored time histories, "
                          "because {reason}.",
                          run=governing.words, reason=governing.why))
        if governing.trouble:
            page.text(LEFT, t("The governing run could not be repeated: {reason}", reason=known(governing.trouble)),
                      colour=RED)
