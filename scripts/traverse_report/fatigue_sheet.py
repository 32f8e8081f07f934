"""The page of the cycles of the bridge's moments by scripts/fatigue.py, for runs with moments over time."""

from typing import NamedTuple

import fatigue
import numpy as np
from picture_data import choose, place_in_words

from .curves import look
from .page import GREY, LEFT, table

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
    """The cycles of the moment, N m, and the damage of one passage, for every probe or for a selection with the worst."""
    file, results = source.file, source.results
    if "probes/moment" not in file or results.rows < 3:
        return []
    moments = results.over_time(file["probes/moment"])
    chosen = choose(moments.shape[1], MOST_PLACES, np.ptp(moments, axis=0))
    rows = []
    for p in chosen:
        cycles = fatigue.rainflow(moments[:, p])
        stresses = [c._replace(range=c.range * abs(asked.factor)) for c in cycles]
        damage = asked.line.damage(stresses) if asked.line else np.nan
        if cycles:
            rows.append(Row(float(results.probes[p]), cycles, damage))
    return rows


def draw_spectrum(ax, rows, supports):
    """Draws the number of cycles of a passage over their range."""
    worst = sorted(rows, key=lambda row: -row.equivalent(SLOPES[-1]))[:3]
    for i, row in enumerate(worst):
        cycles = sorted(row.cycles, key=lambda c: -c.range)
        count = np.cumsum([c.count for c in cycles])
        colour, style, _ = look(i)
        ax.step(np.concatenate([[0.0], count]), 1e-3 * np.array([cycles[0].range] + [c.range for c in cycles]),
                where="pre", color=colour, ls=style, label=place_in_words(row.x, supports))
    ax.set(title="Ranges of the moment in one passage, the greatest first", xlabel="cycles with at least that range",
           ylabel="kN m")
    ax.set_xlim(0.0, None)
    ax.set_ylim(0.0, None)
    ax.legend(frameon=False, fontsize=8)


def sheet(report, source, heading, asked):
    rows = fatigue_rows(source, asked)
    if not rows or max(row.cycles[0].range if row.cycles else 0.0 for row in rows) == 0.0:
        return
    page = report.page(f"Cycles of the moments: {heading}")
    stored = source.results.time
    page.text(LEFT, "Counted by rainflow (ASTM E1049-85) between the stored instants, "
                    f"{stored[1] - stored[0]:.4g} s apart. Equivalent range: the single cycle that causes the same damage "
                    "as the whole passage, for an S-N curve of slope m.", size=8, colour=GREY)
    if asked.line:
        page.text(LEFT, f"Stress: {asked.factor:g} times the moment. Damage by {asked.line.name}, for {asked.passages:g} "
                        "passages a day, without partial factors.", size=8, colour=GREY)
    else:
        page.text(LEFT, "Stress, damage and life require the options --factor and --line of traverse-report.", size=8,
                  colour=GREY)
    ax = page.axes(2.2, right=0.1, below=0.6)
    draw_spectrum(ax, rows, source.results.supports)
    columns = [("probe (m)", 0.8, "right"), ("cycles", 0.7, "right"), ("largest range kN m", 1.25, "right")]
    columns += [(f"equivalent, slope {slope:g}", 1.25, "right") for slope in SLOPES]
    if asked.line:
        columns += [("damage a day", 0.9, "right"), ("life (years)", 0.65, "right")]
    cells = []
    for row in rows:
        own = [f"{row.x:.6g}", f"{sum(c.count for c in row.cycles):g}", f"{1e-3 * max(c.range for c in row.cycles):.5g}"]
        own += [f"{1e-3 * row.equivalent(slope):.5g}" for slope in SLOPES]
        if asked.line:
            a_day = asked.passages * row.damage
            own += [f"{a_day:.3e}", f"{1.0 / (a_day * YEARS):.4g}" if a_day > 0.0 else "no end"]
        cells.append(own)
    table(report, page, columns, cells)
