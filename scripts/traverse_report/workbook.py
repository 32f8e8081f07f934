"""The workbook of the report (XLSX), in the SI units of the results file."""

import re

import numpy as np
import openpyxl
from openpyxl.styles import Alignment, Font, PatternFill
from openpyxl.utils import get_column_letter

from . import model_sheet, norm_sheet, rail_sheet
from .comfort_sheet import comfort_rows
from .fatigue_sheet import SLOPES, fatigue_rows
from .limits import judge_lines, stored
from .sheets import peak_rows
from .statistics import statistic_rows

HEAD = PatternFill("solid", fgColor="D9E2EA")
FILLS = {word: PatternFill("solid", fgColor=colour)
         for word, colour in (("kept alone", "EEEEEE"), ("kept", "DDF0E4"), ("broken", "F6D5D9"))}
MOST_ROWS = 1_000_000
MOST_HISTORY_ROWS = 20_000


def plain(value):
    """A value for a cell, without NaN, types of numpy and control characters."""
    if isinstance(value, (np.floating, float)):
        return float(value) if np.isfinite(value) else None
    if isinstance(value, np.integer):
        return int(value)
    return re.sub(r"[\x00-\x08\x0b\x0c\x0e-\x1f]", " ", value) if isinstance(value, str) else value


def write_as_text(book):
    """Stores all strings as text, also those from files that begin with =: no cell becomes a formula or an error."""
    for sheet in book:
        for row in sheet.iter_rows():
            for cell in row:
                if isinstance(cell.value, str):
                    cell.data_type = "s"
                    cell.quotePrefix = cell.value[:1] in "=+-@"  # it remains text when a user edits it


def add_sheet(book, name, head, rows):
    unique, i = name[:31], 2
    while unique in book.sheetnames:
        unique, i = f"{name[:28]} {i}", i + 1
    sheet = book.create_sheet(unique)
    sheet.append(head)
    for cell in sheet[1]:
        cell.font, cell.fill = Font(bold=True), HEAD
        cell.alignment = Alignment(wrap_text=True, vertical="top")
    for row in rows:
        sheet.append([plain(value) for value in row])
    sheet.freeze_panes = "A2"
    widths = [len(str(text)) for text in head]
    for row in sheet.iter_rows(min_row=2, max_row=min(sheet.max_row, 200), values_only=True):
        widths = [max(width, len(f"{value:.6g}" if isinstance(value, float) else str(value or "")))
                  for width, value in zip(widths, row)]
    for i, width in enumerate(widths, 1):
        sheet.column_dimensions[get_column_letter(i)].width = min(max(width, 8) + 2, 60)
    return sheet


def add_verdicts(book, name, verdicts):
    head = ["clause", "text", "quantity", "allowed", "unit", "found", "margin", "verdict", "run", "where"]
    sheet = add_sheet(book, name, head, [
        [v.limit.clause, v.limit.text, v.limit.quantity, v.limit.value, v.limit.unit or "1", v.value,
         v.margin if v.word != "not judged" else None, v.word, v.run, v.where] for v in verdicts])
    for row in sheet.iter_rows(min_row=2):
        row[6].number_format = "0.0%"
        if row[7].value in FILLS:
            row[7].fill = FILLS[row[7].value]


def add_runs(book, prefix, source):
    """Adds one row per run: varied options, then the largest value of its probes; heads contain the units."""
    runs = source.runs
    units = {**{name: "1" for name in runs.values},
             **{name: str(data.attrs.get("unit", "1")) for group in ("sweep", "study") if group in source.file
                for name, data in source.file[group].items() if hasattr(data, "shape")}}
    head = ["run"] + [f"{name} ({units.get(name, '1')})" for name in runs.parameters]
    if "verdicts/quantity" in source.file:
        units.update(source.file["verdicts/quantity"].asstr()[:].tolist())
    head += [f"{name} ({units[name]})" for name in runs.values]
    columns = [runs.of_run(name) for name in runs.values]
    rows = ([run] + [column[run] for column in runs.parameters.values()] + [column[run] for column in columns]
            for run in range(min(runs.count, MOST_ROWS)))
    add_sheet(book, f"{prefix}runs", head, rows)


def add_lines(book, prefix, source, limits):
    rows = [[row.line, row.limit.clause, row.limit.quantity, row.limit.value, row.value, row.x,
             row.margin, row.word,
             "; ".join(f"{a:g} to {b:g}" for a, b in row.broken)] for row in judge_lines(source, limits)]
    if rows:
        _, label = source.runs.x()
        add_sheet(book, f"{prefix}cases", ["case", "clause", "quantity", "allowed", "greatest", f"at {label}", "margin",
                                           "verdict", f"broken at {label}"], rows)


def add_statistics(book, prefix, source):
    rows = statistic_rows(source)
    if not rows:
        return
    levels = [quantile[0] for quantile in rows[0][6]]
    head = ["case", "quantity", "unit", "runs", "mean", "deviation"]
    for level in levels:
        head += [f"{100 * level:g} %", "not below", "not above"]
    add_sheet(book, f"{prefix}statistics", head,
              [[words, said, unit, samples, mean, deviation] + [v for quantile in quantiles for v in quantile[1:]]
               for words, said, unit, samples, mean, deviation, quantiles in rows])


def add_run(book, prefix, source):
    """Adds envelopes and time histories of a single run."""
    file, results = source.file, source.results
    x = results.probes
    if "envelope/deflection" in file:
        kinds = [("deflection", "deflection", "m"), ("acceleration", "acceleration", "m/s2"), ("moment", "moment", "N m"),
                 ("shear", "shear", "N"), ("moment_shear", "moment, its shear", "N"),
                 ("shear_moment", "shear, its moment", "N m")]
        kinds = [kind for kind in kinds if f"envelope/{kind[0]}" in file]
        columns = [file[f"envelope/{name}"][:] for name, _, _ in kinds]
        static = file["envelope/static_deflection"][:] if "envelope/static_deflection" in file else np.full(len(x), np.nan)
        head = ["x (m)"] + [f"{end} {words} ({unit})" for _, words, unit in kinds for end in ("least", "greatest")]
        head.append("static deflection (m)")
        add_sheet(book, f"{prefix}envelope", head, [[x[p]] + [v for column in columns for v in column[p]] + [static[p]]
                                                    for p in range(len(x))])
    if not results.rows:
        return
    worst = int(np.argmax(np.abs(results.over_time(file["probes/deflection"])).max(axis=0)))
    head, columns = ["time (s)"], [results.time]
    for name, unit in (("deflection", "m"), ("velocity", "m/s"), ("acceleration", "m/s2"), ("moment", "N m"),
                       ("shear", "N")):
        if f"probes/{name}" not in file:
            continue
        head.append(f"{name} at {x[worst]:g} m ({unit})")
        columns.append(results.over_time(file[f"probes/{name}"])[:, worst])
    if "supports/reaction" in file:
        for i, place in enumerate(results.supports):
            head.append(f"bearing force at {place:g} m (N)")
            columns.append(results.over_time(file["supports/reaction"])[:, i, 1])
    for k, vehicle in enumerate(results.vehicles):
        for name in vehicle:
            if "normal_force" in vehicle[name] and len(columns) < 60:
                head.append(f"vehicle {k}, {name} (N)")
                columns.append(results.over_time(vehicle[name]["normal_force"]))
    every = -(-results.rows // MOST_HISTORY_ROWS)
    add_sheet(book, f"{prefix}history", head, np.stack(columns, axis=1)[::every].tolist())


def add_comfort(book, prefix, source):
    rows, _ = comfort_rows(source)
    if rows:
        add_sheet(book, f"{prefix}comfort", ["vehicle", "body", "from its centre (m)", "rms (m/s2)", "Wb (m/s2)", "windows",
                                             "N_MV, vertical", "Sperling"],
                  [[i, body, x, *felt] for i, body, x, felt in rows])


def add_cycles(book, prefix, source, asked):
    rows = fatigue_rows(source, asked)
    if not rows:
        return
    head = ["probe (m)", "cycles", "largest range (N m)"] + [f"equivalent range, slope {slope:g} (N m)" for slope in SLOPES]
    add_sheet(book, f"{prefix}cycles", head + ["damage of a passage"],
              [[row.x, sum(c.count for c in row.cycles), max(c.range for c in row.cycles),
                *(row.equivalent(slope) for slope in SLOPES), None if np.isnan(row.damage) else row.damage] for row in rows])


def write(path, entries, asked):
    """entries: (source, limits, verdicts, governing or None) of each file; asked: of fatigue."""
    book = openpyxl.Workbook()
    book.remove(book.active)
    for number, (source, limits, verdicts, governing) in enumerate(entries, 1):
        prefix = "" if len(entries) == 1 else f"{number} "
        add_verdicts(book, f"{prefix}verdicts", verdicts)
        add_sheet(book, f"{prefix}peaks", ["quantity", "value", "where"], peak_rows(source))
        rows = [*model_sheet.properties(source), *model_sheet.promises(source)]
        rows += [("Modelled", note) for note in source.model.notes] + sorted(source.options.items())
        add_sheet(book, f"{prefix}model", ["what", "value"], [("Results file", str(source.path.name)), *rows])
        for name, (head, rows) in (("EN 1991-2", norm_sheet.workbook_rows(source)),
                                   ("static effects", norm_sheet.static_rows(source)),
                                   ("rail and bridge", rail_sheet.rows(source)),
                                   ("stress of the rails", rail_sheet.envelope_rows(source))):
            if rows:
                add_sheet(book, f"{prefix}{name}", head, rows)
        if source.runs is not None:
            add_lines(book, prefix, source, limits)
            add_runs(book, prefix, source)
            add_statistics(book, prefix, source)
        elif source.is_run:
            add_run(book, prefix, source)
            add_comfort(book, prefix, source)
            add_cycles(book, prefix, source, asked)
        if governing is not None and governing.source is not None:
            add_verdicts(book, f"{prefix}governing verdicts", stored(governing.source))
            add_run(book, f"{prefix}governing ", governing.source)
            add_comfort(book, f"{prefix}governing ", governing.source)
            add_cycles(book, f"{prefix}governing ", governing.source, asked)
    write_as_text(book)
    book.save(path)
