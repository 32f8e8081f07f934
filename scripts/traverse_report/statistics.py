"""Statistics of a study over its seeds or samples: a table of quantiles, and distributions of the peaks."""

import numpy as np

from . import curves
from .language import capital, num, number, percent, t
from .page import GREY, LEFT, table
from .quantities import QUANTITIES, unit_of, words_of


def groups_in_words(source):
    group = source.file["study/statistics"]
    names = [name for name in source.runs.parameters if name in group]
    count = next((group[name].shape[0] for name in group if name.endswith("_mean")), 0)
    words = []
    for g in range(count):
        parts = []
        for name in names:
            said, unit, factor = source.runs.words(name)
            parts.append(f"{said} {number(factor * group[name][g])} {unit}".strip())
        words.append(", ".join(parts) or t("all runs"))
    return words


def judged_quantities(source):
    """The quantities of the limits in their order."""
    return [row[0] for row in source.file["verdicts/quantity"].asstr()[:]] if "verdicts/quantity" in source.file else []


def statistic_rows(source):
    """Rows (group, quantity, unit, samples, mean, deviation, [(quantile, value, low, high)]) at the probe with the
    largest mean."""
    if "study/statistics" not in source.file:
        return []
    group, rows = source.file["study/statistics"], []
    judged = judged_quantities(source) if "judged_mean" in group else []
    levels = group["quantiles"][:]
    for g, words in enumerate(groups_in_words(source)):
        for name in QUANTITIES:
            unit, factor = unit_of(name)
            column = name if f"{name}_mean" in group else "judged" if name in judged else None
            if column is None:
                continue
            mean = group[f"{column}_mean"][g]
            if column == "judged":
                at = (g, judged.index(name))
            else:
                at = (g,) if mean.ndim == 0 else (g, int(np.nan_to_num(mean).argmax()))
            if np.isnan(group[f"{column}_mean"][at]):
                continue
            quantiles = [(level, *(factor * group[f"{column}_quantile{end}"][at][k] for end in ("", "_low", "_high")))
                         for k, level in enumerate(levels)]
            samples = group[f"{column}_samples"][g]
            rows.append((words, words_of(name), unit, int(np.max(samples)), factor * float(group[f"{column}_mean"][at]),
                         factor * float(group[f"{column}_deviation"][at]), quantiles))
    return rows


def bound(value):
    return "?" if np.isnan(value) else num(value)


def explanation(source):
    over = ", ".join(source.runs.words(name)[0] for name in source.runs.over) or t("all runs")
    return t("Over {names}; each value at the station where the mean is largest. Brackets: distribution-free "
             "confidence interval of the quantile, {level}; ?: too few runs for a bound on this side.", names=over,
             level=percent(source.file["study/statistics"].attrs.get("confidence", 0.95)))


def head(rows):
    return [t("case"), t("quantity"), t("runs"), t("mean"), t("standard deviation"),
            *(percent(level) for level, *_ in rows[0][6])]


def cells(rows):
    """The table of statistic_rows as texts."""
    made, before = [], None
    for words, said, unit, samples, mean, deviation, quantiles in rows:
        made.append([words if words != before else "", f"{said} ({unit})" if unit else said, str(samples), num(mean),
                     num(deviation, ".3g")]
                    + [f"{num(value)} [{bound(low)}; {bound(high)}]" for _, value, low, high in quantiles])
        before = words
    return made


def sheet(report, source):
    rows = statistic_rows(source)
    if not rows:
        return
    page = report.page(t("Statistics"))
    page.text(LEFT, explanation(source), size=8, colour=GREY)
    page.y -= 0.08
    if len(np.unique([row[0] for row in rows])) == 1:
        distributions(page, source)
    names = head(rows)
    widths = [0.7, 1.35, 0.5, 0.65, 1.1] + [2.5 / max(len(names) - 5, 1)] * (len(names) - 5)
    sides = ["left"] * 2 + ["right"] * (len(names) - 2)
    table(report, page, list(zip(names, widths, sides)), cells(rows), size=7)


def distributions(page, source):
    """Draws the cumulative distributions of the peaks of one group."""
    shown = [name for name in ("peak_deflection", "peak_acceleration", "least_wheel_force", "greatest_wheel_force")
             if name in source.runs.values][:4]
    for name in shown:
        unit, factor = unit_of(name)
        values = np.sort(factor * source.runs.of_run(name))
        values = values[~np.isnan(values)]
        if not len(values):
            continue
        ax = page.axes(1.1, right=0.1)
        ax.step(values, np.arange(1, len(values) + 1) / len(values), where="post", color=curves.COLOURS[0])
        ax.set(title=t("{quantity}: share of the runs below", quantity=capital(words_of(name))), xlabel=unit,
               ylim=(0, 1.02))
