"""Numbers for a page: arrays as base64 texts of 4-byte floats; charts; curves with fewer samples but all extremes."""

import base64
import math
from typing import NamedTuple

import numpy as np
from traverse_report.language import t

MOST_POINTS = 4000     # of one curve
MOST_VALUES = 160_000  # of all curves over time: about 0.9 MB


class Curve(NamedTuple):
    """values: [n], or [n, 2] with the least and the greatest value of a band."""
    name: str
    values: np.ndarray


class Chart(NamedTuple):
    """Curves over the same x, all in the units of the page."""
    title: str
    unit: str
    curves: list
    x: np.ndarray = None    # over time if it is left out
    x_name: str = ""
    x_unit: str = "s"
    limits: tuple = ()      # (name, value)


def packed(values):
    """The values as a text that the page decodes to an array of 4-byte floats."""
    return {"f32": base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode("ascii")}


def number(value):
    """A number with nine digits, or None if it is unknown."""
    return float(f"{value:.9g}") if math.isfinite(value) else None


def kept_rows(curves, most):
    """Rows of at most `most` samples: those with the least and the greatest value of every curve in each interval."""
    values = np.column_stack([curve.values for curve in curves])
    rows = len(values)
    if rows <= most:
        return np.arange(rows)
    per_interval = 2 * values.shape[1]
    edges = np.linspace(0, rows, max(most // per_interval, 2) + 1).round().astype(int)
    known = np.isfinite(values)
    low, high = np.where(known, values, np.inf), np.where(known, values, -np.inf)
    kept = {0, rows - 1}
    for start, end in zip(edges, edges[1:]):
        kept.update(start + low[start:end].argmin(axis=0), start + high[start:end].argmax(axis=0))
    return np.array(sorted(kept))


def packed_chart(chart, time, most=MOST_POINTS):
    """The chart for the page. `samples`: how many of the file's samples it contains, and how many there are."""
    x = time if chart.x is None else chart.x
    rows = kept_rows(chart.curves, most)
    return {"title": chart.title, "unit": chart.unit, "xName": chart.x_name or t("time"), "xUnit": chart.x_unit,
            "time": chart.x is None, "x": packed(np.asarray(x)[rows]), "samples": [len(rows), len(x)],
            "limits": [[name, number(value)] for name, value in chart.limits],
            "curves": [{"name": curve.name, "columns": [packed(column) for column in
                                                        np.atleast_2d(np.asarray(curve.values)[rows].T)]}
                       for curve in chart.curves]}


def packed_charts(charts, time):
    """All charts, with so many points that they stay below MOST_VALUES."""
    columns = sum(1 + sum(np.ndim(curve.values) for curve in chart.curves) for chart in charts)
    most = min(MOST_POINTS, MOST_VALUES // max(columns, 1))
    return [packed_chart(chart, time, most) for chart in charts]
