"""The page of a results file beside the governing one of its structure: differences, utilisations and curves."""

import functools

import numpy as np

from . import assumptions_sheet, checks_sheet, curves, loads_sheet, norm_sheet, static_sheet
from .front_sheet import is_known, outcome_of, word_cell
from .language import capital, known, percent, t
from .limits import key_of
from .page import GREY, LEFT, RED, RIGHT, table, wrapped
from .quantities import QUANTITIES, shown_value, unit_of, unit_of_si

# The quantities that are drawn, the most important ones first.
DRAWN = ("deck_acceleration", "peak_acceleration", "peak_deflection", "end_rotation", "peak_moment", "least_wheel_force",
         *QUANTITIES)
MOST_DRAWN = 4
SMALLEST, TALLEST = 0.65, 1.5  # inches, of a curve
ABOVE, BELOW, LEFT_OF, BETWEEN = 0.5, 0.4, 0.5, 0.25  # inches around it


def sheet(report, entry, before, number):
    """before: the entries of the structure before this one, the governing one first; number: of the section of that one.
    An entry: (source, limits, verdicts, governing run)."""
    (source, limits, verdicts, again), governing = entry, before[0]
    page = report.page(t("Results of {file}", file=source.path.name), numbered=False)
    report.anchors.setdefault(("", source.path.name), page)
    page.text(LEFT, source.kind_in_words(), size=9)
    said, colour = outcome_of(source, verdicts)
    page.text(LEFT, said, size=10, colour=colour, weight="bold")
    for words in filter(None, (norm_sheet.sentence(source), *checks_sheet.alarms(source))):
        page.text(LEFT, words)
    if again is not None and again.trouble:
        page.text(LEFT, t("The governing run could not be repeated: {reason}", reason=known(again.trouble)), colour=RED)
    page.text(LEFT, t("Everything else is as in section {number}, {file}, which has the greatest utilisation. The workbook "
                      "has all numbers of both.", number=number, file=governing[0].path.name), size=8, colour=GREY)
    page.y -= 0.08
    page = table(report, page, [(t("difference"), 1.9, "left"), (t("here"), 2.45, "left"),
                                (t("section {number}", number=number), 2.45, "left")],
                 differences(source, governing[0]), size=7)
    page = table(report, page, [(t("requirement"), 1.65, "left"), (t("limit"), 0.55, "right"), (t("value"), 0.7, "right"),
                                (t("utilisation"), 0.68, "right"), (t("section {number}", number=number), 0.65, "right"),
                                (t("result"), 0.67, "left"), (t("run, position, time"), 1.9, "left")],
                 utilisations(verdicts, governing[2]), size=7)
    draw(page, source, limits, governing[0], number)
    if not any(has_same_loads(source, other) for other, *_ in before):
        loads_sheet.sheet(report, source)


def has_same_loads(source, other):
    forces, others = source.model.forces, other.model.forces
    return source.train_in_words() == other.train_in_words() and list(forces) == list(others) and all(
        np.array_equal(data, others[name]) for name, data in forces.items())


def differences(source, governing):
    """Rows (assumption or requirement, here, of the governing file) where the two differ."""
    own, others = ({words: said for words, said, _ in assumptions_sheet.rows_of(one)} for one in (source, governing))
    rows = [(words, own.get(words, ""), others.get(words, "")) for words in dict.fromkeys([*own, *others])]
    decided, of_governing = ({requirement: results[0][0] for requirement, _, results in checks_sheet.rows_of(one, [])}
                             for one in (source, governing))
    rows += [(requirement, said, of_governing[requirement]) for requirement, said in decided.items()]
    return [(capital(words), *both) for words, *both in rows if both[0] != both[1]]


def utilisations(verdicts, of_governing):
    """Rows of the limits, with the utilisation in the governing file."""
    known_ones = {key_of(verdict.limit): verdict for verdict in of_governing if verdict.word != "not judged"}
    rows = []
    for one in verdicts:
        judged, other = one.word != "not judged", known_ones.get(key_of(one.limit))
        rows.append([f"{capital(one.limit.words)} ({one.limit.clause})", shown_value(one.limit.value, one.limit.quantity),
                     shown_value(one.value, one.limit.quantity), percent(one.utilisation) if judged else "",
                     percent(other.utilisation) if other else "", word_cell(one.word),
                     t("; ").join(filter(None, (one.run, one.where)))])
    return rows


def draw(page, source, limits, governing, number):
    """Draws small curves two by two, as many as the page has room for."""
    panels = static_panels(source, governing) if source.runs is None else panels_over_x(source, limits, governing)
    rows = min((len(panels) + 1) // 2, int((page.room() - 0.3) / (SMALLEST + ABOVE + BELOW)))
    if rows < 1:
        return
    page.text(LEFT, t("Lines as in section {number}; grey: greatest values of that section.", number=number), size=7.5,
              colour=GREY)
    height = min(TALLEST, page.room() / rows - ABOVE - BELOW)
    width = 0.5 * (RIGHT - LEFT - BETWEEN) - LEFT_OF
    top = page.y
    for i, (title, words, unit, label, panel) in enumerate(panels[:2 * rows]):
        left = LEFT + LEFT_OF + (i % 2) * (width + LEFT_OF + BETWEEN)
        bottom = top - ABOVE - height - (i // 2) * (height + ABOVE + BELOW)
        ax = page.framed(left, bottom, width, height)
        panel(ax)
        lines = wrapped(title, width + BETWEEN, 7.5, "bold")
        ax.set_title("\n".join([*lines, ""]), fontsize=7.5, loc="left")
        ax.annotate(words, (0.0, 1.0), (0.0, 5.0), "axes fraction", textcoords="offset points", fontsize=7)
        ax.set_xlabel(label, fontsize=7)
        ax.set_ylabel(unit, fontsize=7)
        ax.tick_params(labelsize=6.5)
    page.y = top - rows * (height + ABOVE + BELOW)


def panels_over_x(source, limits, governing):
    """(title, its second line, unit, label of x, function that draws) of the quantities of a sweep or study."""
    runs, found = source.runs, []
    names = [name for name in dict.fromkeys(DRAWN) if is_known(runs, name)] if runs.x_name else []
    if "deck_acceleration" in names and "peak_acceleration" in names:
        names.remove("peak_acceleration")
    for name in names[:MOST_DRAWN]:
        unit, values = unit_of(name)[0], runs.of_run(name)
        worst = int(np.nanargmin(values) if name.startswith("least") else np.nanargmax(values))
        at_worst = f"{shown_value(values[worst], name)}, {runs.run_in_words(worst)}"
        found.append((capital(runs.quantity_in_words(name)), at_worst, unit or t("ratio"), runs.x()[1],
                      functools.partial(draw_over_x, source, name, limits, governing.runs)))
    return found


def draw_over_x(source, name, limits, of_governing, ax):
    """Draws a line for each train, and below them the worst of the governing file."""
    runs, factor, least = source.runs, unit_of(name)[1], name.startswith("least")
    x, values = runs.x()[0], factor * runs.of_run(name)
    if of_governing.x_name == runs.x_name and name in of_governing.values:
        at, worst, _ = curves.by_x(of_governing.x()[0], factor * of_governing.of_run(name), slice(None), least)
        ax.plot(at, worst, color=curves.PALE, lw=3.0, zorder=0.8)
    for i, (_, indices) in enumerate(curves.chosen_lines(ax, runs, values)):
        colour, style, _ = curves.look(i)
        at, worst, _ = curves.by_x(x, values, indices, least)
        ax.plot(at, worst, color=colour, ls=style if len(runs.lines()) > 1 else "-", lw=0.8)
    ax.set_xlim(x.min(), x.max())
    if not least:
        ax.set_ylim(0.0, None)
    curves.draw_limits(ax, curves.limit_lines(source, limits, name), size=6)


def static_panels(source, governing):
    """The same of static effects along the bridge."""
    found = []
    for name, words in static_sheet.DRAWN:
        if all(f"static/{name}" in one.file for one in (source, governing)):
            unit = unit_of_si(str(source.file[f"static/{name}"].attrs["unit"]))[0]
            found.append((t(words), t("without α and Φ"), unit, t("position along the bridge (m)"),
                          functools.partial(draw_static, source, name, governing)))
    return found


def draw_static(source, name, governing, ax):
    """Draws least and greatest values of each load, and below them those of the governing file."""
    for one, look in ((governing, lambda _: (curves.PALE, "-", 3.0)), (source, lambda i: (*curves.look(i)[:2], 0.8))):
        group, factor = one.file["static"], unit_of_si(str(one.file[f"static/{name}"].attrs["unit"]))[1]
        for i, sides in enumerate(group[name][:]):
            colour, style, width = look(i)
            ax.plot(group["x"][:], factor * sides, color=colour, ls=style, lw=width)
    ax.set_xlim(source.model.span_ends[0], source.model.span_ends[-1])
