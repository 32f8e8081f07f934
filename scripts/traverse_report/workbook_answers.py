"""The sheets of searches, sensitivity analyses, fits and screens in the workbook, with their charts."""

import itertools

from openpyxl.utils import get_column_letter

from . import find_sheet, fit_sheet, screen_sheet, sensitivity_sheet
from .curves import MOST_LINES
from .language import capital, t
from .workbook import add_bars, add_chart

MOST_BARS = 40  # of one chart


def beside(sheet, number=0):
    """The cell of a chart right of the table; number: of the chart from above."""
    return f"{get_column_letter(sheet.max_column + 2)}{2 + 24 * number}"


def add_find(book, prefix, source):
    heads, rows = find_sheet.interval_rows(source)
    if rows:
        book.add(f"{prefix}{t('Search for values')}", heads, rows)
    heads, rows = find_sheet.ratio_rows(source)
    sheet = book.add(f"{prefix}{t('Ratio to the bound')}", [*heads, t("bound")], [[*row, 1.0] for row in rows])
    answers = range(2, min(len(heads), MOST_LINES + 1) + 1)
    add_chart(sheet, t("Ratio to the bound"), heads[0], t("ratio"), [*answers, len(heads) + 1], beside(sheet),
              limits=[len(heads) + 1])


def add_sensitivity(book, prefix, source):
    heads, rows = sensitivity_sheet.workbook_rows(source)
    sheet = book.add(f"{prefix}{t('Sensitivity analysis')}", heads, rows)
    first = 2
    for number, (quantity, some) in enumerate(itertools.groupby(rows, lambda row: row[0])):
        last = first + len(list(some)) - 1
        add_bars(sheet, capital(quantity), capital(heads[3]), 2, 4, (first, min(last, first + MOST_BARS - 1)),
                 beside(sheet, number))
        first = last + 1


def add_fit(book, prefix, source):
    for name, (heads, rows) in ((t("Fit to measurements"), fit_sheet.workbook_rows(source)),
                                (t("correlations"), fit_sheet.workbook_correlations(source)),
                                (t("starts of the fit"), fit_sheet.workbook_starts(source)),
                                (t("measured frequencies"), fit_sheet.workbook_frequencies(source))):
        if rows:
            book.add(f"{prefix}{name}", heads, rows)
    for number, (series, heads, rows) in enumerate(fit_sheet.workbook_series(source), 1):
        title = t(": ").join((series.name, series.place))
        sheet = book.add(f"{prefix}{t('series')} {number}", heads, rows, about=title)
        add_chart(sheet, title, heads[0], series.unit or "1", range(2, 5), beside(sheet))


def add_screen(book, prefix, source):
    for name, (heads, rows), column in ((t("bridges"), screen_sheet.workbook_bridges(source), 5),
                                        (t("formations"), screen_sheet.workbook_formations(source), 3)):
        sheet = book.add(f"{prefix}{name}", heads, rows)
        add_bars(sheet, t("Largest response over its limit"), t("ratio"), 1, column,
                 (2, 1 + min(len(rows), MOST_BARS)), beside(sheet))
    heads, rows = screen_sheet.workbook_pairs(source)
    if rows:
        book.add(f"{prefix}{t('pairs')}", heads, rows)


def add_answers(book, prefix, source):
    """All sheets of the answers of one results file."""
    for kind, add in ((source.is_search, add_find), (source.is_sensitivity, add_sensitivity), (source.is_fit, add_fit),
                      (source.is_screen, add_screen)):
        if kind:
            add(book, prefix, source)
