"""The pages of a sweep or a study: each train with each limit, curves over the speed, envelopes along the bridge."""

import numpy as np

from . import curves
from .front_sheet import is_known, word_cell
from .language import capital, number, percent, t
from .limits import judge_lines
from .page import GREY, LEFT, table
from .quantities import QUANTITIES, shown_value, unit_of, words_of


def line_sheet(report, source, limits):
    """Every train with each limit: greatest value, its speed and utilisation, and the speeds at which it is
    exceeded."""
    rows = judge_lines(source, limits)
    if not rows:
        return
    _, label = source.runs.x()
    unit = label.split("(")[-1].rstrip(")") if "(" in label else ""
    page = report.page(t("Limits for each train") if "hslm_a" in source.runs.line_names else t("Limits for each case"))
    if any(row.word in ("above", "below") for row in rows):
        page.text(LEFT, t("Above and below: the unfiltered peak, compared with a limit of filtered values. It does not "
                          "replace the verification with filtered values."), size=8, colour=GREY)
        page.y -= 0.08
    columns = [(source.runs.lines_in_words() or t("case"), 1.7, "left"), (t("greatest"), 0.9, "right"),
               (f"{t('at')} ({unit})" if unit else t("at"), 0.8, "right"), (t("utilisation"), 0.9, "right"),
               (t("result"), 1.0, "left"), (f"{t('exceeded at')} ({unit})" if unit else t("exceeded at"), 1.5, "left")]
    short = dict(zip((name for name, _ in source.runs.lines()), curves.names_of(source.runs)))
    for limit in dict.fromkeys(row.limit for row in rows):
        cells = []
        for row in (row for row in rows if row.limit == limit):
            broken = t("; ").join(number(a) if a == b else f"{number(a)} – {number(b)}" for a, b in row.broken)
            cells.append([short[row.line], shown_value(row.value, limit.quantity), number(row.x),
                          percent(1.0 - row.margin),
                          word_cell(row.word), broken])
        if page.room() < 1.5:
            page = report.page(page.heading)
        page.text(LEFT, t("Limit {value} ({clause}): {quantity}", value=shown_value(limit.value, limit.quantity),
                          clause=limit.clause, quantity=limit.words), size=9, weight="bold")
        page.y -= 0.03
        page = table(report, page, columns, cells, size=7)


def curve_sheets(report, source, limits):
    """Every quantity over the speed, two per page. Returns the number of lines of each."""
    runs, drawn = source.runs, {}
    if runs is None or runs.x_name is None:
        return drawn
    page, names = None, curves.names_of(runs)
    for name in QUANTITIES:
        if not is_known(runs, name):
            continue
        unit, factor = unit_of(name)
        if page is None or page.room() < 4.6 + curves.key_room(names):
            page = report.page(t("Results over the speed") if runs.is_over_speed
                               else t("Results over the parameter"))
            for note in notes_on_curves(source):
                page.text(LEFT, note, size=8, colour=GREY)
        report.anchor(name)
        ax = page.axes(3.7, right=curves.room_for(names))
        ax.set_title(capital(runs.quantity_in_words(name)))
        drawn[name] = curves.over_x(ax, source, name, factor * runs.of_run(name), unit,
                                    curves.limit_lines(source, limits, name))
        page.fit(ax)
    return drawn


def notes_on_curves(source):
    runs, file, said = source.runs, source.file, []
    if runs.line_names and runs.line_names != ["hslm_a"]:
        said.append(t("One line for each {names}.", names=runs.lines_in_words()))
    if len(runs.lines()) > curves.MOST_LINES:
        said.append(t("Only some of the lines are drawn; the workbook contains all of them."))
    if runs.over:
        said.append(t("Over all values of {names}: thick: greatest (of least values the least); dotted: median; "
                      "shaded: range.",
                      names=", ".join(runs.words(name)[0] for name in runs.over)))
    if "resonances/speed" in file:
        said.append(t("Light lines: resonance speeds v = f₁ · d; dashed: v = f₁ · d / 2.") if len(runs.lines()) > 3 else
                    t("Light lines: resonance speeds {formula}.", formula="v = f₁ · d / i"))
    if "cancellations/speed" in file:
        said.append(t("Dotted lines: cancellation speeds {formula}.", formula="v = 2 f₁ · L / (2k + 1)"))
    return said


def envelope_sheet(report, source, limits):
    """The largest deflection, acceleration and moment of each train at every probe, for a table of runs."""
    runs = source.runs
    stations = runs.probes[0] if runs.probes.ndim == 2 else runs.probes
    if len(stations) < 3 or (runs.probes.ndim == 2 and np.ptp(runs.probes, axis=0).max() > 0.0):
        return
    page, what = None, t("all speeds") if runs.is_over_speed and not runs.over else t("all runs")
    for name in ("peak_deflection", "peak_acceleration", "peak_moment"):
        unit, factor = unit_of(name)
        known = np.abs(runs.values[name])
        if np.isnan(known).all():
            continue
        if page is None or page.room() < 3.1:
            page = report.page(t("Envelopes along the bridge"))
            page.text(LEFT, t("Marks: stations of evaluation."), size=8, colour=GREY)
            if runs.line_names and runs.line_names != ["hslm_a"]:
                page.text(LEFT, t("One line for each {names}.", names=runs.lines_in_words()), size=8, colour=GREY)
        ax = page.axes(2.3, right=max(0.5 + curves.room_for(curves.names_of(runs)), 1.0))
        ax.set_title(f"{capital(words_of(name))} ({what})")
        series = [(line, factor * np.nanmax(known[indices], axis=0), None)
                  for line, indices in curves.chosen_lines(ax, runs, known.max(axis=1), curves.MOST_LISTED)
                  if not np.isnan(known[indices]).all()]
        static = factor * np.nan_to_num(runs.static).max(axis=0) if name == "peak_deflection" else None
        curves.along_bridge(ax, source.model.span_ends, stations, series, unit, static=static)
        ax.set_ylim(0.0, ax.get_ylim()[1] * 1.1)
        page.fit(ax)
    if page is not None:
        judged_places(report, page, source, limits)


def judged_places(report, page, source, limits):
    """The judged deck acceleration of each run at its place, because a sweep stores no other filtered values."""
    runs, name = source.runs, "deck_acceleration"
    if name not in runs.places:
        return
    page = report.page(page.heading) if page.room() < 3.1 else page
    unit, factor = unit_of(name)
    ax = page.axes(2.3, right=max(0.5 + curves.room_for(curves.names_of(runs)), 1.0))
    for i, (line, indices) in enumerate(curves.chosen_lines(ax, runs, runs.of_run(name), curves.MOST_LISTED)):
        colour, _, mark = curves.look(i)
        ax.plot(runs.places[name][indices], factor * runs.of_run(name)[indices], ls="none", marker=mark, ms=3.2,
                mew=0.0, color=colour, label=line)
    ends = source.model.span_ends
    ax.set(title=t("{quantity}: each run at its place", quantity=capital(runs.quantity_in_words(name))), ylabel=unit,
           xlabel=t("position along the bridge (m)"), xlim=(ends[0], ends[-1]))
    ax.set_ylim(0.0, ax.get_ylim()[1] * 1.1)
    curves.draw_limits(ax, curves.limit_lines(source, limits, name))
    ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.04), frameon=False, fontsize=8, labelspacing=0.35)
    page.fit(ax)
