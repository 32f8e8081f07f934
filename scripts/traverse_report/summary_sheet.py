"""The first page of a report of several results files: the worst result, and each file with its result and page."""

import matplotlib.pyplot as plt

from .page import AMBER, GREEN, GREY, LEFT, RED, Report, table
from .sheets import outcome

SEVERITY = (GREEN, GREY, AMBER, RED)
COLUMNS = [("results file", 1.7, "left"), ("what it is", 1.9, "left"), ("outcome", 2.0, "left"),
           ("least margin", 0.75, "right"), ("page", 0.45, "right")]


def outcome_of(source, verdicts):
    """A sentence and its colour; red if the computation has not reached its end."""
    sentence, colour = outcome(verdicts)
    ended = source.summary.get("ended", "it was killed")
    if ended != "reached its end":
        return f"The computation did not reach its end: {ended}. {sentence}", RED
    return sentence, colour


def draw(report, entries, own, pages_before):
    """Adds the pages of the summary at the end of the report."""
    page = report.page("All results")
    worst = max((colour for _, colour in own), key=SEVERITY.index)
    sentence, _ = outcome([verdict for _, verdicts, _ in entries for verdict in verdicts])
    page.text(LEFT, f"Of {len(entries)} results files: {sentence}", size=12, colour=worst, weight="bold")
    judged = [(verdict.margin, verdict, source) for source, verdicts, _ in entries for verdict in verdicts
              if verdict.word in ("kept", "broken")]
    if judged:
        margin, verdict, source = min(judged, key=lambda found: found[0])
        page.text(LEFT, f"Least margin of all: {100.0 * margin:.1f} %, {source.title()} ({source.path.name}), "
                        f"{verdict.limit.quantity.replace('_', ' ')} ({verdict.limit.clause}), {verdict.word}.", size=9.5)
    page.y -= 0.1
    rows = []
    for (source, _, first), (words, colour) in zip(entries, own):
        margins = [margin for margin, _, which in judged if which is source]
        rows.append([f"{source.title()} ({source.path.name})", source.kind_in_words(), (words, colour),
                     f"{100.0 * min(margins):.1f} %" if margins else "", str(first + pages_before)])
    table(report, page, COLUMNS, rows, size=8)


def sheet(report, entries):
    """entries: (source, verdicts, number of its first page so far)."""
    own, trial = [outcome_of(source, verdicts) for source, verdicts, _ in entries], Report("", "")
    draw(trial, entries, own, 0)
    for page in trial.pages:
        plt.close(page.figure)
    before = len(report.pages)
    draw(report, entries, own, len(trial.pages))
    report.pages[:] = report.pages[before:] + report.pages[:before]
