"""The page of a screen: what was decided, the heat map of all pairs, the bridges and the worst pairs."""

from typing import NamedTuple

import numpy as np
import picture_screen
from engineering_units import shown

from .language import Ticks, digits, num, t
from .page import GREY, LEFT, RED, table
from .quantities import speed_in_words

MOST_BRIDGES, MOST_PAIRS = 60, 30  # rows of the tables
MOST_IN_WORKBOOK = 100_000  # pairs
MAP_HEIGHT = 3.6  # inches
DECIDED = {0.0: "no common speed", 1.0: "bound", 2.0: "passages"}


class Screen:
    """The results of a screen, and texts of them in the language of the report."""

    def __init__(self, file):
        group = file["screen"]
        self.bridges, self.formations = (list(map(str, file[name].asstr()[:])) for name in ("bridge", "formation"))
        self.ratio, self.permitted, self.worst_speed, self.exceeding, self.decided = (
            group[name][:] for name in ("ratio", "permitted_speed", "governing_speed", "exceeding_speeds",
                                        "decided_by"))
        self.length, self.frequency = group["bridge_length"][:], group["bridge_frequency"][:]
        self.governing, self.bridge_ratio = group["governing_formation"][:], group["bridge_ratio"][:]
        self.worst_bridges, self.worst_formations = picture_screen.order_of(self.ratio)

    def pairs(self, most=None):
        """(bridge, formation) of the pairs with a ratio, those with the largest one first."""
        order = np.argsort(-np.nan_to_num(self.ratio, nan=-np.inf), axis=None, kind="stable")
        order = order[:int(np.isfinite(self.ratio).sum())][:most]
        return list(zip(*np.unravel_index(order, self.ratio.shape)))

    def restricted(self):
        """The number of pairs that exceed a limit at some speed."""
        return int(np.count_nonzero(self.exceeding > 0.0))

    def decided_by(self, value):
        return int(np.count_nonzero(self.decided == value))

    def permitted_to_all(self, bridge):
        """The greatest speed in m/s up to which no formation exceeds a limit; NaN if none exceeds one at any speed."""
        exceeded = self.exceeding[bridge] > 0.0
        return float(self.permitted[bridge][exceeded].min()) if exceeded.any() else np.nan

    def formation(self, bridge):
        """The name of the formation that governs a bridge."""
        number = self.governing[bridge]
        return self.formations[int(number)] if np.isfinite(number) else ""


class Row(NamedTuple):
    """A bridge in the table; speed in m/s, NaN without a restriction."""
    name: str
    length: float
    frequency: float
    formation: str
    ratio: float
    speed: float


def bridge_rows(screen, most=None):
    """The bridges, those with the largest ratio first."""
    order = np.argsort(-np.nan_to_num(screen.bridge_ratio, nan=-np.inf), kind="stable")[:most]
    return [Row(screen.bridges[i], screen.length[i], screen.frequency[i], screen.formation(i), screen.bridge_ratio[i],
                screen.permitted_to_all(i)) for i in order]


def permitted_in_words(speed):
    if np.isnan(speed):
        return t("no restriction")
    return speed_in_words(speed) if speed > 0.0 else t("none of the speeds")


def coloured(ratio):
    """A ratio as a cell: red above 1."""
    if np.isnan(ratio):
        return ""
    return (num(ratio, ".3f"), RED) if ratio > 1.0 else num(ratio, ".3f")


def outcome(source):
    """The main result of a screen in one line."""
    screen = Screen(source.file)
    return t("Screen, no verification of one structure. {count} of {all} pairs of bridge and formation exceed a limit "
             "at some speed.", count=num(screen.restricted(), ",.0f"), all=num(screen.ratio.size, ",.0f"))


def peak_rows(source):
    """Rows of the summary: the governing pair."""
    screen = Screen(source.file)
    found = screen.pairs(1)
    return [(t("greatest response over its limit"), float(screen.ratio[pair]), "",
             f"{screen.bridges[pair[0]]}, {screen.formations[pair[1]]}, {speed_in_words(screen.worst_speed[pair])}")
            for pair in found]


def said_of(screen, source):
    """What was decided in which way, in sentences."""
    said = [t("Pairs decided by the bound: {bound}; by passages: {passages}; without a speed that bridge and formation "
              "both permit: {none}.", bound=num(screen.decided_by(1.0), ",.0f"),
              passages=num(screen.decided_by(2.0), ",.0f"), none=num(screen.decided_by(0.0), ",.0f"))]
    missing = len(screen.bridges) - int(source.summary.get("bridges_finished", len(screen.bridges)))
    if missing:
        said.append(t("Bridges without a result: {count}.", count=missing))
    said.append(t("A ratio is the largest response over its limit; of pairs decided by the bound it is the bound, "
                  "which is not below the response."))
    said.append(t("The map has the worst pairs above and on the left; blue: limits kept, red: a limit exceeded."))
    return " ".join(said)


def head():
    return [t("bridge"), t("length (m)"), f"{t('first frequency')} (Hz)", t("governing formation"), t("ratio"),
            t("greatest speed permitted to all formations")]


def cells_of_bridges(screen, most=None):
    return [[row.name, num(row.length, ".5g"), digits(row.frequency), row.formation, coloured(row.ratio),
             permitted_in_words(row.speed) if row.formation else t("no result")] for row in bridge_rows(screen, most)]


def shortened(count, most):
    """Says which rows a shortened table has; empty for a whole one."""
    return t("The {count} of {all} with the largest ratio.", count=most, all=num(count, ",.0f")) if count > most else ""


def workbook_bridges(source):
    """Head and rows of all bridges."""
    unit, factor = shown("speed")
    return [*head()[:-1], f"{head()[-1]} ({unit})", t("remark")], [
        [*row[:-1], factor * row.speed, permitted_in_words(row.speed) if not row.speed > 0.0 else ""]
        for row in bridge_rows(Screen(source.file))]


def workbook_formations(source):
    """Head and rows of all formations, those with the largest ratio first, with the bridge that governs each."""
    (unit, factor), group = shown("speed"), source.file["screen"]
    screen, speed, ratio, bridge = Screen(source.file), *(group[name][:] for name in (
        "formation_speed", "formation_ratio", "governing_bridge"))
    order = np.argsort(-np.nan_to_num(ratio, nan=-np.inf), kind="stable")
    return [t("formation"), f"{t('greatest speed')} ({unit})", t("ratio"), t("governing bridge")], [
        [screen.formations[i], factor * speed[i], ratio[i],
         screen.bridges[int(bridge[i])] if np.isfinite(bridge[i]) else ""] for i in order]


def workbook_pairs(source):
    """Head and rows of the pairs with a ratio, those with the largest one first."""
    screen, (unit, factor) = Screen(source.file), shown("speed")
    names = [t("bridge"), t("formation"), t("ratio"), f"{t('permitted speed')} ({unit})",
             f"{t('speed of the ratio')} ({unit})", t("decided by")]
    return names, [[screen.bridges[pair[0]], screen.formations[pair[1]], screen.ratio[pair],
                    factor * screen.permitted[pair], factor * screen.worst_speed[pair],
                    t(DECIDED[screen.decided[pair]])] for pair in screen.pairs(MOST_IN_WORKBOOK)]


def sheet(report, source):
    if not source.is_screen:
        return
    screen, page = Screen(source.file), report.page(t("Screen of bridges and formations"))
    report.anchor("screen")
    page.text(LEFT, said_of(screen, source), size=8)
    draw(page, source, screen)
    page = table_of_bridges(report, page, screen)
    table_of_pairs(report, page, screen)


def draw(page, source, screen):
    """Draws the heat map, with room for the names that it has."""
    left, below = (1.3 if len(screen.bridges) <= picture_screen.MOST_NAMES else 0.3,
                   1.25 if len(screen.formations) <= picture_screen.MOST_NAMES else 0.4)
    ax = page.axes(MAP_HEIGHT, left=left, right=0.8, below=below)
    picture_screen.draw(ax, source.results, t("Largest response over its limit"), t("response / limit"))
    ax.child_axes[0].yaxis.set_major_formatter(Ticks())
    page.fit(ax)


def heading(report, page, words, note):
    """The heading of a table, with what it contains; on the next page without room for some rows."""
    page = page if page.room() > 1.2 else report.page(page.heading)
    page.text(LEFT, words, size=10, weight="bold")
    if note:
        page.text(LEFT, note, size=8, colour=GREY)
    page.y -= 0.05
    return page


def table_of_bridges(report, page, screen):
    page = heading(report, page, t("Bridges"), " ".join(filter(None, (
        shortened(len(screen.bridges), MOST_BRIDGES),
        t("A formation with a lower speed of its own keeps this speed.")))))
    columns = list(zip(head(), (1.7, 0.8, 1.0, 1.4, 0.6, 1.3), ("left", "right", "right", "left", "right", "right")))
    return table(report, page, columns, cells_of_bridges(screen, MOST_BRIDGES), size=7)


def table_of_pairs(report, page, screen):
    pairs = screen.pairs(MOST_PAIRS)
    if not pairs:
        return
    page = heading(report, page, t("Worst pairs"), shortened(int(np.isfinite(screen.ratio).sum()), MOST_PAIRS))
    rows = [[screen.bridges[pair[0]], screen.formations[pair[1]], coloured(screen.ratio[pair]),
             permitted_in_words(screen.permitted[pair] if screen.exceeding[pair] > 0.0 else np.nan),
             speed_in_words(screen.worst_speed[pair]), t(DECIDED[screen.decided[pair]])] for pair in pairs]
    names = [t("bridge"), t("formation"), t("ratio"), t("permitted speed"), t("speed of the ratio"), t("decided by")]
    columns = list(zip(names, (1.7, 1.5, 0.7, 1.1, 1.0, 0.8), ("left", "left", "right", "right", "right", "left")))
    table(report, page, columns, rows, size=7)
