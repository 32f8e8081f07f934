"""The workbook of the report: the overview, and verdicts, assumptions, loads and results of each file."""

from openpyxl.styles import Font, PatternFill

from . import (
    annex_sheet, assumptions_sheet, checks_sheet, loads_sheet, norm_sheet, rail_sheet, workbook_answers, workbook_results)
from .front_sheet import WORDS, peak_rows
from .language import known, t
from .limits import stored
from .quantities import unit_of, unit_of_si
from .workbook import FILLS, Workbook
from .workbook_results import with_unit


def add_verdicts(book, name, verdicts):
    rows = []
    for v in verdicts:
        unit, factor = unit_of(v.limit.quantity)
        judged = v.word != "not judged"
        rows.append([v.limit.clause, known(v.limit.text), v.limit.words, factor * v.limit.value,
                     factor * v.value if judged else None, unit or "1", v.utilisation if judged else None,
                     v.margin if judged else None, t(WORDS[v.word]), v.run, v.where, v.limit.quantity])
    sheet = book.add(name, [t("clause"), t("requirement"), t("quantity"), t("limit"), t("value"), t("unit"),
                            with_unit(t("utilisation"), "%"), with_unit(t("margin"), "%"), t("result"), t("run"),
                            t("position, time"), t("name in the results file")], rows)
    for row, v in zip(sheet.iter_rows(min_row=2), verdicts):
        if v.word in FILLS:
            row[8].fill = PatternFill("solid", fgColor=FILLS[v.word])


def add_scope(book, name, source, verdicts):
    rows = []
    for requirement, clause, results in checks_sheet.rows_of(source, verdicts):
        rows += [[requirement, clause, said, limit, value] for said, _, limit, value, _ in results]
    book.add(name, [t("requirement"), t("clause"), t("result"), t("limit"), t("value")], rows)


def add_source(book, prefix, entry, asked, program):
    """All sheets of one results file."""
    source, limits, verdicts, governing = entry
    if verdicts:
        add_verdicts(book, f"{prefix}{t('verdicts')}", verdicts)
    if source.is_verification:
        add_scope(book, f"{prefix}{t('scope')}", source, verdicts)
    book.add(f"{prefix}{t('greatest values')}", [t("quantity"), t("value"), t("unit"), t("run, position, time")],
             [[words, value, unit or "1", where] for words, value, unit, where in peak_rows(source)])
    if not source.is_screen:
        book.add(f"{prefix}{t('basis')}", [t("assumption"), t("value"), t("source")], assumptions_sheet.rows_of(source))
    trains = loads_sheet.hslm_rows(source)
    unit, factor = unit_of_si("N")
    if trains:
        book.add(f"{prefix}HSLM", [t("train"), t("coaches N"), t("coach length D (m)"), t("axle spacing d (m)"),
                                   with_unit(t("axle force P"), unit), t("axles"), with_unit(t("total weight"), unit),
                                   t("length (m)")],
                 [[name, count, length, spacing, factor * force, axles, factor * weight, whole]
                  for name, count, length, spacing, force, axles, weight, whole in trains])
    for name, (head, rows) in (("EN 1991-2 6.4.6.5", norm_sheet.workbook_rows(source)),
                               (t("static effects"), norm_sheet.static_rows(source)),
                               (t("track and bridge"), rail_sheet.rows(source)),
                               (t("rail stresses"), rail_sheet.envelope_rows(source))):
        if rows:
            book.add(f"{prefix}{name}", head, rows)
    workbook_answers.add_answers(book, prefix, source)
    if source.runs is not None:
        workbook_results.add_lines(book, f"{prefix}{t('cases')}", source, limits)
        workbook_results.add_runs(book, f"{prefix}{t('runs')}", source)
        workbook_results.add_curves(book, f"{prefix}{t('curves')} ", source, limits)
        workbook_results.add_envelopes_of_runs(book, f"{prefix}{t('envelopes')}", source)
        workbook_results.add_statistics(book, f"{prefix}{t('statistics')}", source)
    elif source.is_run:
        workbook_results.add_run(book, prefix, source, asked)
    if governing is not None and governing.source is not None:
        if alone := stored(governing.source):
            add_verdicts(book, f"{prefix}{t('governing run')} {t('verdicts')}", alone)
        workbook_results.add_run(book, f"{prefix}{t('governing run')} ", governing.source, asked)
    add_annex(book, f"{prefix}{t('annex')}", source, governing, program)


def add_annex(book, name, source, governing, program):
    notes = [[t("note"), run, note, "", ""] for run, note in annex_sheet.notes_of(source, governing)]
    rows = []
    if source.is_dynamic:
        rows += [[t("model"), words, value, "", why] for words, value, why in annex_sheet.model_rows(source)]
        rows += [[t("estimated relative error"), words, value, "", why]
                 for words, value, why in annex_sheet.estimates(source, governing)]
    options = [[t("option"), *row] for row in annex_sheet.option_rows(source, program)]
    book.add(name, [t("kind"), t("name"), t("value"), t("unit"), t("source")], rows + notes + options)


def write(path, title, lines, entries, asked, program=None):
    """title: of the title page; lines: the result; entries: (source, limits, verdicts, governing or None) of each
    file."""
    book = Workbook()
    texts = ((t("project"), title.project), (t("structure"), title.structure), (t("line and position"), title.line),
             (t("revision"), title.revision), (t("date"), title.date), (t("prepared by"), title.author),
             (t("checked by"), title.checker), (t("norm"), title.norm_edition),
             (t("national annex"), title.national_annex), (t("remark"), title.note))
    rows = [[t("result"), line] for line in lines] + [[words, text] for words, text in texts if text]
    front = book.add(t("overview"), [t("report"), ""], rows)
    for number, entry in enumerate(entries, 1):
        add_source(book, "" if len(entries) == 1 else f"{number} ", entry, asked, program)
    front.auto_filter.ref, front.freeze_panes = None, "A2"
    start = front.max_row + 2
    front.cell(start, 1, t("sheets")).font = Font(bold=True)
    for i, name in enumerate(book.book.sheetnames[1:], 1):
        cell = front.cell(start + i, 1, name)
        cell.data_type = "s"
        cell.hyperlink, cell.style = f"#'{name}'!A1", "Hyperlink"
        front.cell(start + i, 2, book.about[name])
    book.save(path)
