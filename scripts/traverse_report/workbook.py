"""The workbook of the report (XLSX): its sheets with heads, number formats, widths and native charts. Cells contain the
unrounded values in the unit of their head."""

import re

import numpy as np
import openpyxl
import output_files
from openpyxl.chart import BarChart, Reference, ScatterChart, Series
from openpyxl.styles import Alignment, Font, PatternFill
from openpyxl.utils import get_column_letter

from .language import capital, t

HEAD = PatternFill("solid", fgColor="D9E2EA")
FILLS = {"kept alone": "EEEEEE", "kept": "DDF0E4", "broken": "F6D5D9"}
FORMATS = {"mm": "0.000", "m/s²": "0.000", "kN m": "#,##0.0", "kN": "#,##0.0", "km/h": "0.0", "mrad": "0.000",
           "MPa": "0.00",
           "ms": "0.0", "s": "0.000", "m": "0.000", "%": "0.0%"}
RATIO = "0.0000"
WIDEST = 60
LIMIT_COLOUR = "B00020"


def plain(value):
    """A value for a cell, without NaN, types of numpy and control characters."""
    if isinstance(value, (np.floating, float)):
        return float(value) if np.isfinite(value) else None
    if isinstance(value, np.integer):
        return int(value)
    return re.sub(r"[\x00-\x08\x0b\x0c\x0e-\x1f]", " ", value) if isinstance(value, str) else value


def format_of(head):
    """The number format of a column, from the unit in brackets at the end of its head."""
    unit = re.search(r"\(([^()]*)\)$", head)
    return FORMATS.get(unit[1], "General") if unit else RATIO


class Workbook:
    """A workbook whose strings are all text, also those from files that begin with =: no cell becomes a formula."""

    def __init__(self):
        self.about = {}  # a description of some sheets by their names
        self.book = openpyxl.Workbook()
        self.book.remove(self.book.active)

    def add(self, name, heads, rows, about=""):
        """Adds a sheet with one row of heads. Excel permits 31 characters in its name, and some characters nowhere."""
        name = capital(re.sub(r"[\[\]:*?/\\]", " ", name)).strip("'")
        unique, i = name[:31], 2
        while unique.lower() in (known.lower() for known in self.book.sheetnames):
            unique, i = f"{name[:28]} {i}", i + 1
        sheet = self.book.create_sheet(unique)
        self.about[unique] = about
        sheet.append([capital(plain(head)) for head in heads])
        for cell in sheet[1]:
            cell.font, cell.fill = Font(bold=True), HEAD
            cell.alignment = Alignment(wrap_text=True, vertical="top")
        formats = [format_of(head) for head in heads]
        units = heads.index(t("unit")) if t("unit") in heads else None  # the column with the unit of each row
        for row in rows:
            sheet.append([plain(value) for value in row])
        widths = [min(len(head), 24) for head in heads]
        for number, row in enumerate(sheet.iter_rows(), 1):
            for i, cell in enumerate(row):
                if isinstance(cell.value, str):
                    cell.data_type = "s"
                    cell.quotePrefix = cell.value[:1] in "=+-@"  # it remains text when a user edits it
                    widths[i] = max(widths[i], len(cell.value)) if 1 < number < 300 else widths[i]
                elif isinstance(cell.value, float):
                    own = FORMATS.get(row[units].value, "General") if units is not None else RATIO
                    cell.number_format = own if formats[i] == RATIO else formats[i]
        for i, width in enumerate(widths, 1):
            sheet.column_dimensions[get_column_letter(i)].width = min(max(width, 9) + 2, WIDEST)
        sheet.freeze_panes = "B2"
        sheet.auto_filter.ref = sheet.dimensions
        return sheet

    def save(self, path):
        self.book.properties.creator = output_files.WRITER
        with output_files.written(path, "xlsx") as temporary:
            self.book.save(temporary)


def add_chart(sheet, title, x_title, y_title, columns, place, limits=()):
    """Adds a chart of columns (numbers from 1) over the first column; columns of limits are red and dashed."""
    chart = ScatterChart()
    chart.title, chart.style, chart.height, chart.width = title, 13, 11.0, 20.0
    chart.x_axis.title, chart.y_axis.title = x_title, y_title
    chart.x_axis.delete = chart.y_axis.delete = False  # otherwise the newest versions of Excel hide the axes
    chart.x_axis.number_format = chart.y_axis.number_format = "General"
    x = Reference(sheet, min_col=1, min_row=2, max_row=sheet.max_row)
    for column in columns:
        series = Series(Reference(sheet, min_col=column, min_row=1, max_row=sheet.max_row), x, title_from_data=True)
        series.marker.symbol, series.smooth = "none", False
        series.graphicalProperties.line.width = 15_000  # 1.2 points
        if column in limits:
            series.graphicalProperties.line.solidFill = LIMIT_COLOUR
            series.graphicalProperties.line.dashStyle = "dash"
        chart.series.append(series)
    chart.x_axis.scaling.min, chart.x_axis.scaling.max = bounds(sheet)
    sheet.add_chart(chart, place)


def add_bars(sheet, title, y_title, names, column, rows, place):
    """Adds a chart of bars of a column (numbers from 1) in these rows (first, last), with the names in another column."""
    chart = BarChart()
    chart.type, chart.title, chart.style, chart.legend = "bar", title, 13, None
    chart.height, chart.width, chart.gapWidth = 11.0, 20.0, 40
    chart.y_axis.title = y_title
    chart.x_axis.delete = chart.y_axis.delete = False
    chart.x_axis.scaling.orientation = "maxMin"  # the first row is on top
    chart.y_axis.number_format = "General"
    first, last = rows
    chart.series.append(Series(Reference(sheet, min_col=column, min_row=first, max_row=last), title=y_title))
    chart.set_categories(Reference(sheet, min_col=names, min_row=first, max_row=last))
    sheet.add_chart(chart, place)


def bounds(sheet):
    """The least and the greatest value of the first column."""
    values = [value for (value,) in sheet.iter_rows(min_row=2, max_col=1, values_only=True)
              if isinstance(value, (int, float))]
    return (min(values), max(values)) if values else (None, None)
