"""The heat map of a screen for the page: the ratios of all pairs of bridge and formation, the worst ones first."""

import numpy as np
from traverse_report.language import t
from traverse_report.screen_sheet import Screen, said_of
from traverse_report.source import Source

from .packing import packed

MOST = 300  # bridges, and formations


def heat(results):
    """Names and ratios in the order of the map; None for a file without a screen."""
    if "screen/ratio" not in results.file:
        return None
    source = Source(results.file.filename)
    screen = Screen(source.file)
    rows, columns = screen.worst_bridges[:MOST], screen.worst_formations[:MOST]
    fewer = t("Drawn: the {bridges} bridges and {formations} formations with the largest ratio.", bridges=len(rows),
              formations=len(columns)) if screen.ratio.shape != (len(rows), len(columns)) else ""
    return {"title": t("Largest response over its limit"), "label": t("response / limit"),
            "note": " ".join(filter(None, (said_of(screen, source), fewer))),
            "rows": [screen.bridges[i] for i in rows], "columns": [screen.formations[i] for i in columns],
            "values": packed(screen.ratio[np.ix_(rows, columns)].ravel())}
