"""Whether a dynamic analysis is necessary: EN 1991-2 figure 6.9, as far as the input allows.

Where a step is not confirmed well enough to omit the analysis, or needs data that this program does not have, the
answer is the analysis: it is never wrong and takes seconds.
"""

import math
from typing import NamedTuple, Optional

from traverse_report.language import num, t
from traverse_report.quantities import speed_in_words

from . import rules, units
from .rules import CheckError, rule


class Part(NamedTuple):
    """A bridge, or one of its simply supported spans."""
    length: float  # determinant length in m
    n0: float      # Hz
    separate: bool


class Line(NamedTuple):
    """What the chart asks beside the frequency and the length of a bridge."""
    line_speed: float                      # m/s
    complex: bool = False                  # no simple structure
    torsional_frequency: Optional[float] = None  # Hz
    torsional_wave_speed: Optional[float] = None  # m/s, sqrt(GJ/I): of spans between forks, instead of their frequency


def torsional_wave_speed(GJ, polar_inertia, torsional_frequency):
    """sqrt(GJ/I) in m/s, or None without a torsional stiffness, which stands in place of a frequency."""
    if (GJ is None) != (polar_inertia is None):
        raise CheckError("GJ and polar-inertia belong together: give both, or neither")
    if GJ is None:
        return None
    if torsional_frequency is not None:
        raise CheckError("torsional-frequency and GJ: allowed: one of them")
    return math.sqrt(GJ / polar_inertia)


def clause(name):
    """The clause of a rule in the language of the output."""
    return rules.clause(name).replace("figure", t("figure")).replace("annex F", t("annex F"))


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
    frequency, length = num(part.n0), num(part.length, ".6g")
    if limits is None:
        said = t("n0 = {frequency} Hz; the figure has no limits for L = {length} m", frequency=frequency, length=length)
        return False, (clause("frequencies"), said)
    within = limits[0] <= part.n0 <= limits[1]
    low, high = (num(limit, ".3g") for limit in limits)
    words = "n0 = {frequency} Hz is within {low} to {high} Hz for L = {length} m" if within else \
        "n0 = {frequency} Hz is outside {low} to {high} Hz for L = {length} m"
    return within, (clause("frequencies"), t(words, frequency=frequency, low=low, high=high, length=length))


def torsion_steps(part, line):
    """The last steps of the chart, which end in the dynamic analysis here."""
    value = rule("torsion")["value"]
    factor, bound = num(value), num(value * part.n0)
    of_torsion = line.torsional_frequency
    if line.torsional_wave_speed is not None:
        of_torsion = line.torsional_wave_speed / (2.0 * part.length)
    if of_torsion is None:
        return [(clause("torsion"), t("nT > {factor} n0 cannot be decided without a torsional frequency, or GJ and a "
                                      "polar inertia: dynamic analysis; if it is not satisfied, with torsion, which runs "
                                      "with an eccentricity of the track include", factor=factor))]
    frequency = num(of_torsion)
    if of_torsion <= value * part.n0:
        return [(clause("torsion"), t("nT = {frequency} Hz is not above {factor} n0 = {bound} Hz: dynamic analysis "
                                      "with torsion, which runs with an eccentricity of the track include",
                                      frequency=frequency, factor=factor, bound=bound))]
    return [(clause("torsion"), t("nT = {frequency} Hz is above {factor} n0 = {bound} Hz: bending modes are sufficient",
                                  frequency=frequency, factor=factor, bound=bound)),
            (clause("tables"), t("v/n0 within tables F.1 and F.2 cannot be decided, because they are not in this "
                                 "program: dynamic analysis"))]


def speed_step(line):
    """(whether the line speed is low, step)"""
    limit = rule("line_speed")
    least = units.values("line-speed", f"{limit['value']} {limit['unit']}")[0]
    slow = line.line_speed <= least
    words = "line speed {speed} is not above {limit}" if slow else "line speed {speed} is above {limit}"
    return slow, (clause("line_speed"), t(words, speed=speed_in_words(line.line_speed), limit=speed_in_words(least)))


def answer(part, line):
    """The steps of the chart for a part of the bridge, and whether they end in a dynamic analysis."""
    longest = rule("long_span")
    slow, first = speed_step(line)
    within, frequencies = frequency_step(part)
    steps = [first]
    if line.complex:
        steps.append((clause("simple"), t("no simple structure: dynamic analysis with bending and torsion")))
        return Answer(steps, True)
    if slow and not part.separate:
        steps += [frequencies, (clause("continuous"), t("continuous bridge: no dynamic analysis, provided that the "
                                                        "limits of EN 1990 A2.4.4 are satisfied with very good "
                                                        "passenger comfort"))]
        return Answer(steps, False)
    if slow:
        steps.append(frequencies)
        if within:
            steps.append((clause("in_limits"), t("no dynamic analysis up to this line speed")))
            return Answer(steps, False)
    if not part.separate:
        steps.append((clause("simple"), t("continuous, therefore no simple structure: dynamic analysis with bending "
                                          "and torsion")))
        return Answer(steps, True)
    steps.append((clause("simple"), t("simply supported: a simple structure, if it has no skew and rigid supports")))
    if not slow and part.length >= longest["value"]:
        steps += [frequencies, (clause("long_span"), t("L >= {limit} m: no public source confirms that the analysis "
                                                       "may be omitted at this line speed: dynamic analysis",
                                                       limit=num(longest["value"])))]
        return Answer(steps, True)
    if not slow:
        steps += [(clause("long_span"), t("L is below {limit} m", limit=num(longest["value"]))), frequencies]
    return Answer([*steps, *torsion_steps(part, line)], True)
