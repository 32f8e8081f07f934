"""The page of the cycles of the bridge's moments by scripts/fatigue.py, for runs with moments over time."""

from typing import NamedTuple

import fatigue
import numpy as np
from picture_data import choose

from .curves import look
from .language import num, place_in_words, t
from .page import GREY, LEFT, table
from .quantities import unit_of_si

SLOPES = (3.0, 5.0)
MOST_PLACES = 12
YEARS = fatigue.DAYS_A_YEAR


class Asked(NamedTuple):
    """Parameters from moments to stresses and damage; there is no damage if line is None."""
    factor: float = 1.0
    line: object = None
    passages: float = 1.0  # a day


class Row(NamedTuple):
    x: float
    cycles: list
    damage: float  # of a passage; NaN without an S-N curve

    def equivalent(self, slope):
        return fatigue.equivalent_range(self.cycles, slope, 1.0) if self.cycles else 0.0


def fatigue_rows(source, asked):
    """The cycles of the moment, N m, and the damage of one passage, for every probe or for a selection with the
    worst."""
    file, results = source.file, source.results
    if "probes/moment" not in file or results.rows < 3:
        return []
    moments = results.over_time(file["probes/moment"])
    chosen = choose(moments.shape[1], MOST_PLACES, np.ptp(moments, axis=0))
    rows = []
    for p in sorted(chosen, key=lambda p: results.probes[p]):
        cycles = fatigue.rainflow(moments[:, p])
        stresses = [c._replace(range=c.range * abs(asked.factor)) for c in cycles]
        damage = asked.line.damage(stresses) if asked.line else np.nan
        if cycles and cycles_matter(cycles, moments):
            rows.append(Row(float(results.probes[p]), cycles, damage))
    return rows


def cycles_matter(cycles, moments):
    """Whether the largest range is more than the rounding of a moment that is zero, as at the ends of a simple span."""
    return max(cycle.range for cycle in cycles) > 1e-4 * np.ptp(moments, axis=0).max()


def draw_spectrum(ax, rows, supports):
    """Draws the number of cycles of a passage over their range."""
    unit, factor = unit_of_si("N m")
    worst = sorted(rows, key=lambda row: -row.equivalent(SLOPES[-1]))[:3]
    for i, row in enumerate(worst):
        cycles = sorted(row.cycles, key=lambda c: -c.range)
        count = np.cumsum([c.count for c in cycles])
        colour, style, _ = look(i)
        ax.step(np.concatenate([[0.0], count]), factor * np.array([cycles[0].range] + [c.range for c in cycles]),
                where="pre", color=colour, ls=style, label=place_in_words(row.x, supports))
    ax.set(title=t("Ranges of the bending moment in one passage, the greatest first"),
           xlabel=t("number of cycles with at least this range"), ylabel=unit)
    ax.set_xlim(0.0, None)
    ax.set_ylim(0.0, None)
    ax.legend(frameon=False, fontsize=8)


def sheet(report, source, run, asked):
    rows = fatigue_rows(source, asked)
    if not rows or max(row.cycles[0].range if row.cycles else 0.0 for row in rows) == 0.0:
        return
    page = report.page(t("Cycles of the bending moment"))
    report.anchor("cycles")
    page.text(LEFT, run, colour=GREY)
    stored = source.results.time
    page.text(LEFT, t("Cycles of the bending moments, counted by the rainflow method (ASTM E1049-85) between the "
                      "stored instants, {step} s apart. Equivalent range: the single cycle that causes the same damage "
                      "as the whole passage, for an S-N curve of slope m.", step=num(stored[1] - stored[0])), size=8,
              colour=GREY)
    if asked.line:
        page.text(LEFT, t("Stress: {factor} times the moment. Damage by {line}, for {passages} passages a day, without "
                          "partial factors.", factor=num(asked.factor), line=asked.line.name,
                          passages=num(asked.passages)),
                  size=8,
                  colour=GREY)
    else:
        page.text(LEFT, t("Stress, damage and life require the options --factor and --line of traverse-report."),
                  size=8, colour=GREY)
    ax = page.axes(2.2, right=0.1, below=0.6)
    draw_spectrum(ax, rows, source.results.supports)
    unit, factor = unit_of_si("N m")
    columns = [("x (m)", 0.8, "right"), (t("cycles"), 0.7, "right"), (f"{t('largest range')} ({unit})", 1.25, "right")]
    columns += [(f"{t('equivalent range')}, m = {slope:g} ({unit})", 1.25, "right") for slope in SLOPES]
    if asked.line:
        columns += [(t("damage a day"), 0.9, "right"), (t("life (years)"), 0.65, "right")]
    cells = []
    for row in rows:
        own = [num(row.x, ".6g"), num(sum(c.count for c in row.cycles), "g"),
               num(factor * max(c.range for c in row.cycles), ".5g")]
        own += [num(factor * row.equivalent(slope), ".5g") for slope in SLOPES]
        if asked.line:
            a_day = asked.passages * row.damage
            own += [num(a_day, ".3e"), num(1.0 / (a_day * YEARS)) if a_day > 0.0 else t("unlimited")]
        cells.append(own)
    table(report, page, columns, cells)
