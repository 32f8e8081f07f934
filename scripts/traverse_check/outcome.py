"""The verdicts of the results files, for the terminal, in the units of engineering_units.csv."""

from traverse_report.limits import stored
from traverse_report.quantities import shown_value
from traverse_report.source import Source

from . import scene
from .rules import marked, printable, rule

EXCEEDED, NOT_JUDGED = 5, 6  # exit statuses
WORDS = {"kept": "complied with", "broken": "EXCEEDED", "not judged": "NOT EVALUATED"}  # as in the report


def verdicts(path):
    """The verdicts that a results file contains, as in the report."""
    return stored(Source(path))


def percent(ratio):
    return f"{100.0 * ratio:.0f} %"


def lines_of(found):
    """The verdicts as lines in columns."""
    cells = [[WORDS[v.word], marked(v.limit.clause, scene.sources_of(v.limit.quantity)), v.limit.words,
              f"{shown_value(v.value, v.limit.quantity) or '-'} of {shown_value(v.limit.value, v.limit.quantity)}",
              "" if v.word == "not judged" else percent(v.utilisation), printable(v.where)] for v in found]
    widths = [max(len(row[i]) for row in cells) for i in range(5)]
    return ["  " + "  ".join(cell.ljust(width) for cell, width in zip(row, [*widths, 0])) for row in cells]


def consequence(found):
    """What follows if the trains exceed the load models; empty if they do not."""
    if any(verdict.word == "broken" and verdict.limit.quantity == "train_over_lm71" for verdict in found):
        return (f"{rule('limit_states')['clause']}: the effects of the load models with Φ do not cover those of the "
                "trains: the design must include the dynamic effects of the trains.")
    return ""


def status(found):
    """The exit status of all verdicts."""
    words = {verdict.word for verdict in found}
    return EXCEEDED if "broken" in words else NOT_JUDGED if words != {"kept"} else 0


def conclusion(found):
    """The last line: the result and the greatest utilisation."""
    judged = [verdict for verdict in found if verdict.word in ("kept", "broken")]
    broken, missing = sum(verdict.word == "broken" for verdict in judged), len(found) - len(judged)
    counts = [f"{count} of {len(found)} limits {'is' if count == 1 else 'are'} {WORDS[word]}"
              for count, word in ((broken, "broken"), (missing, "not judged")) if count]
    if judged:
        worst = max(judged, key=lambda verdict: verdict.utilisation)
        use = f"greatest utilisation {percent(worst.utilisation)} ({worst.limit.words})"
    return "; ".join(["Result: " + (", ".join(counts) or f"all {len(found)} limits are {WORDS['kept']}"),
                      *([use] if judged else [])]) + "."
