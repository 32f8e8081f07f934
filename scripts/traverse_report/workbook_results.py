"""The results in the workbook: tables of runs, curves over the speed, envelopes, time histories, comfort and cycles."""

import numpy as np
from openpyxl.utils import get_column_letter

from .comfort_sheet import comfort_rows
from .curves import MOST_LINES, limit_lines, names_of
from .fatigue_sheet import SLOPES, fatigue_rows
from .front_sheet import WORDS, is_known
from .language import capital, num, t
from .limits import judge_lines
from .quantities import QUANTITIES, unit_of, unit_of_si, words_of
from .statistics import statistic_rows
from .workbook import add_chart

MOST_ROWS = 1_000_000
MOST_HISTORY_ROWS = 20_000
MOST_HISTORY_COLUMNS = 60


def with_unit(words, unit):
    return f"{words} ({unit})" if unit else words


def add_runs(book, name, source):
    """One row per run: varied options, then the greatest value of its probes."""
    runs = source.runs
    options = [(column, *runs.words(option)) for option, column in runs.parameters.items()]
    quantities = [(runs.of_run(quantity), runs.quantity_in_words(quantity), *unit_of(quantity))
                  for quantity in runs.values]
    head = [t("run")] + [with_unit(words, unit) for _, words, unit, _ in options + quantities]
    columns = [factor * values for values, _, _, factor in options + quantities]
    book.add(name, head, ([run, *(column[run] for column in columns)] for run in range(min(runs.count, MOST_ROWS))))


def add_curves(book, name, source, limits):
    """One sheet for each quantity: a column for each line over the speed with its limits, and their chart."""
    runs = source.runs
    if runs.x_name is None or len(runs.lines()) > MOST_LINES:
        return
    x, label = runs.x()
    stations, names = np.unique(x), names_of(runs)
    for i, quantity in enumerate((one for one in QUANTITIES if is_known(runs, one)), 1):
        unit, factor = unit_of(quantity)
        values, columns = factor * runs.of_run(quantity), []
        for _, indices in runs.lines():
            least = quantity.startswith("least")
            of_x = [values[indices][x[indices] == at] for at in stations]
            columns.append([np.nan if not len(v) else v.min() if least else v.max() for v in of_x])
        lines = limit_lines(source, limits, quantity)
        heads = [label] + [with_unit(one, unit) for one in names] + [with_unit(words, unit) for _, words in lines]
        columns += [[value] * len(stations) for value, _ in lines]
        words = capital(runs.quantity_in_words(quantity))
        sheet = book.add(f"{name}{i}", heads, zip(stations, *columns), about=words)
        numbers = range(2, len(heads) + 1)
        add_chart(sheet, words, label, unit or t("ratio"), numbers, f"{get_column_letter(len(heads) + 2)}2",
                  limits=numbers[len(names):])


def add_lines(book, name, source, limits):
    rows = []
    for row in judge_lines(source, limits):
        unit, factor = unit_of(row.limit.quantity)
        rows.append([row.line, row.limit.clause, row.limit.words, factor * row.limit.value,
                     factor * row.value,
                     unit or "1", row.x, 1.0 - row.margin, row.margin, t(WORDS[row.word]),
                     t("; ").join(f"{num(a, 'g')} – {num(b, 'g')}" for a, b in row.broken)])
    if rows:
        _, label = source.runs.x()
        book.add(name, [t("case"), t("clause"), t("quantity"), t("limit"), t("greatest"), t("unit"), label,
                        with_unit(t("utilisation"), "%"), with_unit(t("margin"), "%"), t("result"),
                        t(": ").join((t("exceeded at"), label))], rows)


def add_envelopes_of_runs(book, name, source):
    """The greatest deflection, acceleration and moment of each line at every station, with charts."""
    runs = source.runs
    stations = runs.probes[0] if runs.probes.ndim == 2 else runs.probes
    if len(stations) < 3 or (runs.probes.ndim == 2
                             and np.ptp(runs.probes, axis=0).max() > 0.0) or len(runs.lines()) > MOST_LINES:
        return
    order, names, heads, columns, charts = np.argsort(stations), names_of(runs), ["x (m)"], [], []
    for quantity in ("peak_deflection", "peak_acceleration", "peak_moment"):
        unit, factor = unit_of(quantity)
        values = factor * np.abs(runs.values[quantity])
        if np.isnan(values).all():
            continue
        charts.append((capital(words_of(quantity)), unit, range(len(heads) + 1, len(heads) + 1 + len(names))))
        heads += [with_unit(f"{words_of(quantity)}, {one}", unit) for one in names]
        columns += [np.where(np.isnan(values[indices]), -np.inf, values[indices]).max(axis=0)[order]
                    for _, indices in runs.lines()]
    sheet = book.add(name, heads, zip(stations[order], *columns))
    for i, (words, unit, numbers) in enumerate(charts):
        add_chart(sheet, words, heads[0], unit, numbers, f"{get_column_letter(len(heads) + 2)}{2 + 24 * i}")


def add_envelope(book, name, source):
    """Envelopes of a single run at its stations, with charts."""
    file, x = source.file, source.results.probes
    kinds = [kind for kind in (("deflection", "m", "deflection"), ("acceleration", "m/s2", "acceleration"),
                               ("moment", "N m", "moment"),
                               ("shear", "N", "shear"), ("moment_shear", "N", "shear force at the extreme moment"),
                               ("shear_moment", "N m", "moment at the extreme shear force"))
             if f"envelope/{kind[0]}" in file]
    if not kinds:
        return
    order, heads, columns, charts = np.argsort(x), ["x (m)"], [x], []
    for quantity, si, words in kinds:
        unit, factor = unit_of_si(si)
        charts.append((capital(t(words)), unit, [len(heads) + 1, len(heads) + 2]))
        heads += [with_unit(f"{t(words)}, {t(side)}", unit) for side in ("least", "greatest")]
        columns += list(factor * file[f"envelope/{quantity}"][:].T)
    if "envelope/static_deflection" in file:
        unit, factor = unit_of_si("m")
        heads.append(with_unit(t("greatest static deflection"), unit))
        columns.append(factor * file["envelope/static_deflection"][:])
    sheet = book.add(name, heads, np.stack(columns, axis=1)[order].tolist())
    for i, (words, unit, numbers) in enumerate(charts[:4]):
        add_chart(sheet, words, heads[0], unit, numbers, f"{get_column_letter(len(heads) + 2)}{2 + 24 * i}")


def add_history(book, name, source):
    """Time histories of a single run: the station of the greatest deflection, bearings and wheels."""
    file, results = source.file, source.results
    if not results.rows:
        return
    worst = int(np.argmax(np.abs(results.over_time(file["probes/deflection"])).max(axis=0)))
    heads, columns = [t("time (s)")], [results.time]
    for quantity, si in (("deflection", "m"), ("velocity", "m/s"), ("acceleration", "m/s2"), ("moment", "N m"),
                         ("shear", "N")):
        if f"probes/{quantity}" in file:
            unit, factor = ("m/s", 1.0) if quantity == "velocity" else unit_of_si(si)
            heads.append(with_unit(f"{t(quantity)}, x = {num(results.probes[worst], '.6g')} m", unit))
            columns.append(factor * results.over_time(file[f"probes/{quantity}"])[:, worst])
    unit, factor = unit_of_si("N")
    if "supports/reaction" in file:
        for i, place in enumerate(results.supports):
            heads.append(with_unit(t("bearing force, x = {x} m", x=num(place, ".6g")), unit))
            columns.append(factor * results.over_time(file["supports/reaction"])[:, i, 1])
    for k, vehicle in enumerate(results.vehicles):
        for part in vehicle:
            if "normal_force" in vehicle[part] and len(columns) < MOST_HISTORY_COLUMNS:
                heads.append(with_unit(t("vehicle {number}, {part}", number=k, part=part), unit))
                columns.append(factor * results.over_time(vehicle[part]["normal_force"]))
    every = -(-results.rows // MOST_HISTORY_ROWS)
    book.add(name, heads, np.stack(columns, axis=1)[::every].tolist())


def add_statistics(book, name, source):
    rows = statistic_rows(source)
    if rows:
        head = [t("case"), t("quantity"), t("unit"), t("runs"), t("mean"), t("standard deviation")]
        for level in (quantile[0] for quantile in rows[0][6]):
            head += [t("{level} % quantile", level=num(100 * level)), t("not below"), t("not above")]
        book.add(name, head, [[words, said, unit or "1", samples, mean, deviation,
                               *(v for quantile in quantiles for v in quantile[1:])]
                              for words, said, unit, samples, mean, deviation, quantiles in rows])


def add_run(book, prefix, source, asked):
    """Everything of a single run."""
    add_envelope(book, f"{prefix}{t('envelopes')}", source)
    add_history(book, f"{prefix}{t('time history')}", source)
    rows, _ = comfort_rows(source)
    if rows:
        book.add(f"{prefix}{t('comfort')}",
                 [t("vehicle"), t("body"), f"{t('from its centre')} (m)", f"{t('rms')} (m/s²)",
                  "Wb (m/s²)", t("windows"), "N_MV", "Sperling Wz"],
                 [[i, body, x, *felt] for i, body, x, felt in rows])
    rows, (unit, factor) = fatigue_rows(source, asked), unit_of_si("N m")
    if rows:
        head = ["x (m)", t("cycles"), with_unit(t("largest range"), unit)]
        head += [with_unit(f"{t('equivalent range')}, m = {slope:g}", unit)
                 for slope in SLOPES] + [t("damage of a passage")]
        book.add(f"{prefix}{t('cycles')}", head,
                 [[row.x, sum(c.count for c in row.cycles), factor * max(c.range for c in row.cycles),
                   *(factor * row.equivalent(slope) for slope in SLOPES), row.damage] for row in rows])
