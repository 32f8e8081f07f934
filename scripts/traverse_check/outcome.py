"""The verdicts of the results files, for the terminal, in the units of engineering_units.csv."""

import math
import re
from typing import NamedTuple

import h5py
from traverse_report.quantities import over_span, unit_of, words_of

from . import scene
from .rules import marked, printable

EXCEEDED, NOT_JUDGED = 5, 6  # exit statuses
WORDS = {"kept": "complied with", "broken": "EXCEEDED", "not judged": "NOT EVALUATED"}  # as in the report


class Verdict(NamedTuple):
    word: str
    clause: str
    quantity: str
    value: float
    limit: float
    where: str


def verdicts(path):
    """The verdicts that a results file contains."""
    with h5py.File(path, "r", locking=False) as file:
        group = file["verdicts"]
        texts = [group[name].asstr()[:] for name in ("verdict", "clause", "quantity")]
        return [Verdict(verdict[0], clause[0], quantity[0], float(value), float(limit), verdict[1])
                for verdict, clause, quantity, value, limit in zip(*texts, group["value"][:], group["limit"][:])]


def shown(value, quantity):
    """A value of a limit in its usual unit; deflections over the span as L/600."""
    if math.isnan(value):
        return "-"
    unit, factor = unit_of(quantity)
    return over_span(quantity, value) or f"{value * factor:.4g} {unit}".strip()


def place(text):
    """The place of a value, with the speed in km/h only."""
    said = re.sub(r"[\d.]+ m/s \(([^)]*)\)", r"\1", text)
    said = re.sub(r" with alpha = ([\d.]+) and Phi(\d) =", r", α = \1, Φ\2 =", said)
    return printable(said)


def percent(ratio):
    return f"{100.0 * ratio:.0f} %"


def lines_of(found):
    """The verdicts as lines in columns."""
    cells = [[WORDS.get(v.word, v.word), marked(v.clause, scene.sources_of(v.quantity)), words_of(v.quantity),
              f"{shown(v.value, v.quantity)} of {shown(v.limit, v.quantity)}",
              "" if math.isnan(v.value) else percent(v.value / v.limit), place(v.where)] for v in found]
    widths = [max(len(row[i]) for row in cells) for i in range(5)]
    return ["  " + "  ".join(cell.ljust(width) for cell, width in zip(row, [*widths, 0])) for row in cells]


def trains_against_models(path):
    """The line of 6.4.6.5: the effect with the greatest ratio of trains to load models; empty without trains."""
    with h5py.File(path, "r", locking=False) as file:
        if "norm/train_over_model" not in file:
            return ""
        ratios = file["norm/train_over_model"][:]
        worst = int(ratios.argmax())
        effect, train = file["norm/effect"].asstr()[worst, 0], file["norm/train"].asstr()[worst, 0]
        model = file["norm/model"].asstr()[worst, 0]
    governs = ("the design must include the dynamic effects of the trains" if ratios[worst] > 1.0 else
               "the load models govern")
    return (f"trains with dynamic increment against load models with Φ, EN 1991-2 6.4.6.5: at most {ratios[worst]:.4g} "
            f"({effect}, {train} against {model}): {governs}")


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
        worst = max(judged, key=lambda verdict: verdict.value / verdict.limit)
        use = f"greatest utilisation {percent(worst.value / worst.limit)} ({words_of(worst.quantity)})"
    return "; ".join(["Result: " + (", ".join(counts) or f"all {len(found)} limits are {WORDS['kept']}"),
                      *([use] if judged else [])]) + "."
