"""Whether a dynamic analysis is necessary: EN 1991-2 figure 6.9, as far as the input allows.

Where a step is not confirmed well enough to omit the analysis, or needs data that this program does not have, the
answer is the analysis: it is never wrong and takes seconds.
"""

from typing import NamedTuple

from . import units
from .rules import clause, rule


class Part(NamedTuple):
    """A bridge, or one of its simply supported spans."""
    length: float  # determinant length in m
    n0: float      # Hz
    separate: bool


class Answer(NamedTuple):
    steps: list    # (clause, sentence)
    needed: bool


def limits_of_n0(length):
    """(lower, upper) limit of figure 6.10 in Hz; None outside of its lengths."""
    bounds = rule("frequencies")
    for row in bounds["lower"]:
        if row["from"] <= length <= row["to"]:
            return row["c"] * length ** row["e"], bounds["upper"]["c"] * length ** bounds["upper"]["e"]
    return None


def frequency_step(part):
    """(whether n0 is within figure 6.10, step)"""
    limits = limits_of_n0(part.length)
    length = f"L = {units.in_words('span', part.length)}"
    if limits is None:
        return False, (clause("frequencies"), f"n0 = {part.n0:.4g} Hz; the figure has no limits for {length}")
    within = limits[0] <= part.n0 <= limits[1]
    interval = f"{'within' if within else 'outside'} {limits[0]:.3g} to {limits[1]:.3g} Hz"
    return within, (clause("frequencies"), f"n0 = {part.n0:.4g} Hz is {interval} for {length}")


def torsion_steps(part, torsional_frequency):
    """The last steps of the chart, which end in the dynamic analysis here."""
    factor = rule("torsion")["value"]
    if torsional_frequency is None:
        return [(clause("torsion"), f"nT > {factor:g} n0 cannot be decided without --torsional-frequency: dynamic "
                 "analysis; if it is not satisfied, torsion must be included, which this plane model cannot do")]
    compared = f"{factor:g} n0 = {factor * part.n0:.4g} Hz"
    if torsional_frequency <= factor * part.n0:
        return [(clause("torsion"), f"nT = {torsional_frequency:.4g} Hz is not above {compared}: dynamic analysis with "
                 "torsion, which this plane model cannot include")]
    return [(clause("torsion"), f"nT = {torsional_frequency:.4g} Hz is above {compared}: bending modes are sufficient"),
            (clause("tables"), "v/n0 within tables F.1 and F.2 cannot be decided, because they are not in this "
             "program: dynamic analysis")]


def answer(part, question):
    """The steps of the chart for a part of the bridge, and whether they end in a dynamic analysis."""
    limit, longest = rule("line_speed"), rule("long_span")
    slow = question.line_speed <= units.values("line-speed", f"{limit['value']} {limit['unit']}")[0]
    steps = [(clause("line_speed"), f"line speed {units.in_words('line-speed', question.line_speed)} is "
              f"{'not ' if slow else ''}above {limit['value']} {limit['unit']}")]
    within, frequencies = frequency_step(part)
    if question.complex:
        steps.append((clause("simple"), "no simple structure (--complex): dynamic analysis with bending and torsion"))
        return Answer(steps, True)
    if slow and not part.separate:
        steps += [frequencies, (clause("continuous"), "continuous bridge: no dynamic analysis, provided that the "
                                "limits of EN 1990 A2.4.4 are satisfied with very good passenger comfort")]
        return Answer(steps, False)
    if slow:
        steps.append(frequencies)
        if within:
            steps.append((clause("in_limits"), "no dynamic analysis up to this line speed"))
            return Answer(steps, False)
    if not part.separate:
        steps.append((clause("simple"), "continuous, therefore no simple structure: dynamic analysis with bending and "
                      "torsion"))
        return Answer(steps, True)
    steps.append((clause("simple"), "simply supported: a simple structure, if it has no skew and rigid supports"))
    if not slow and part.length >= longest["value"]:
        steps += [frequencies, (clause("long_span"), f"L >= {longest['value']} m: no public source confirms that the "
                                "analysis may be omitted at this line speed: dynamic analysis")]
        return Answer(steps, True)
    if not slow:
        steps += [(clause("long_span"), f"L is below {longest['value']} m"), frequencies]
    return Answer([*steps, *torsion_steps(part, question.torsional_frequency)], True)
