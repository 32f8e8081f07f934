"""Panels of a search (find_option): the greatest ratio to the bound over the searched values, and the intervals within
the bound with what governs beyond their ends."""

import numpy as np
from matplotlib.ticker import LogLocator
from option_words import option_in_words
from picture_axes import GREY, PALE, Panel
from picture_rows import draw_beside, height_of, wrapped_rows
from picture_runs import Axis, Limit, Runs, digits, engineering, engineering_of_si, grouped, in_words
from picture_speeds import draw_lines, is_logarithmic, looks_of
from picture_table import keep
from search_answers import Search
from traverse_report.quantities import QUANTITIES, words_of

GREEN = "#007A59"
MOST_ROWS = 16  # answers with a row of their own
BOUND = Limit(1.0, "bound", "the bound")


def unit_of(option, unit):
    return engineering("speed") if option.endswith("speed") else engineering_of_si(unit)


def within_sentence(name):
    """A quantity within a sentence: 'deck acceleration, low-pass filtered'."""
    return words_of(name).removeprefix("greatest ").removeprefix("longest ")


class Words:
    """The answers of a search in words."""

    def __init__(self, results):
        self.search, self.results = Search(results), results
        self.runs = Runs(results)
        self.unit, self.factor = unit_of(self.search.option, self.search.unit)
        named = [self.search.option, *self.search.also]
        self.option = " with ".join(map(option_in_words, named))

    def value(self, value):
        """A searched value with as many digits as the accuracy of the search has."""
        return grouped(float(f"{self.factor * value:.{self.search.digits()}g}"), ",.12g")

    def name(self, answer):
        words = []
        for option, value in answer.parts:
            if option.endswith("hslm_a"):
                words.append(f"A{value:.0f}")
                continue
            unit, factor = unit_of(option, str(self.results.file["study"][option].attrs["unit"]))
            number = f"{digits(factor * value)} {unit}".strip()
            words.append(number if option.endswith("speed") else f"{option_in_words(option)} {number}")
        return ", ".join(words) or "all runs"

    def governing(self, answer, governing):
        """The quantity and the run that exceed the bound; options that all runs of the answer share are left out."""
        if np.isnan(governing.ratio):
            return "not every run determines the quantities"
        shared = {"train" if option.endswith("hslm_a") else option for option, _ in answer.parts}
        run = self.runs.run_in_words(governing.run, {self.search.option, *shared})
        return within_sentence(governing.quantity) + (f" ({run})" if run else "")

    def interval(self, interval):
        """'100 to 237.4', 'up to 237.4', 'from 100'; without unit"""
        (first, last), (at_first, at_last) = map(self.value, interval.ends), interval.at_end
        if at_first and at_last:
            return f"all from {first} to {last}"
        return f"up to {last}" if at_first else f"from {first}" if at_last else f"{first} to {last}"

    def intervals(self, answer):
        """'A9: up to 237.4; from 260.1 km/h'"""
        found = "; ".join(map(self.interval, answer.intervals))
        return f"{self.name(answer)}: {found or 'none'} {self.unit if found else ''}".rstrip()

    def beyond(self, answer):
        """What exceeds the bound beyond the ends of the intervals, a text for each end or gap."""
        said, before = [], None  # before: the end of the interval before, with the words of what governs above it
        for one in answer.intervals:
            first, last = map(self.value, one.ends)
            below, above = (self.governing(answer, side) if side else "" for side in one.beyond)
            if before and below == before[1]:
                said[-1] = f"between {before[0]} and {first}: {below}"
            elif below:
                said.append(f"below {first}: {below}")
            if above:
                said.append(f"above {last}: {above}")
            before = (last, above)
        if answer.closest:
            value, governing = answer.closest
            said.append(f"closest at {self.value(value)} {self.unit}, {governing.ratio:.4g} times the bound: "
                        f"{self.governing(answer, governing)}")
        return said

    def lines(self, answer):
        """(text, colour) of each line about an answer."""
        return [(self.intervals(answer), GREEN if answer.intervals else "black"),
                *((text, GREY) for text in self.beyond(answer))]

    def title(self):
        """What the search asks: 'bending stiffness EI that keeps all limits'."""
        search = self.search
        if not search.asked:
            of_one = "" if search.kept == "limits" else f" ({within_sentence(search.kept)})"
            return f"{self.option} that keeps {'the limit' if of_one else 'all limits'}{of_one}"
        unit, factor = engineering(QUANTITIES[search.asked].kind) if search.asked in QUANTITIES else ("", 1.0)
        return f"{self.option} with {within_sentence(search.asked)} up to {in_words(factor * search.equals, unit)}"


def panels_of(results):
    words = Words(results)
    answers = words.search.answers
    answers = answers if len(answers) <= MOST_ROWS else [*answers[:MOST_ROWS - 1], answers[-1]]
    rows = wrapped_rows([words.lines(answer) for answer in answers])
    return [Panel(lambda ax, worst: draw_ratios(ax, words), 2.6),
            Panel(lambda ax, worst: draw_intervals(ax, words, answers, rows), height_of(rows))]


def draw_ratios(ax, words):
    """Draws a curve for each answer; that of all runs is the greatest of the others."""
    search = words.search
    answers = search.answers[:-1] if len(search.answers) > 1 else search.answers
    axis = Axis(words.option, words.unit, words.factor * search.value)
    names = [words.name(answer) for answer in answers] if len(answers) > 1 else [""]
    ratios = np.array([answer.ratio for answer in answers])
    draw_lines(ax, axis, names, ratios, "", [BOUND], 1.0, looks_of(names, ratios))
    for interval in search.answers[-1].intervals:
        ax.axvspan(*(words.factor * end for end in interval.ends), color=GREEN, alpha=0.10, lw=0, zorder=0.5)
    if is_logarithmic(axis.values):
        scale_by_factors(ax)
    ax.set(ylabel="ratio to the bound", title="Greatest ratio of a run to the bound; green: within the bound")


def scale_by_factors(ax):
    ax.set_xscale("log")
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ax.xaxis.set_major_formatter(lambda value, place: digits(value))
    ax.xaxis.set_minor_locator(LogLocator(subs=()))


def draw_intervals(ax, words, answers, rows):
    """Draws the intervals within the bound, one row for each answer."""
    search = words.search
    values = words.factor * search.value
    for answer, (middle, half) in zip(answers, draw_beside(ax, rows)):
        ax.plot(values[[0, -1]], [middle, middle], color=PALE, lw=1.0, zorder=1)
        for number, interval in enumerate(answer.intervals, 1):
            first, last = (words.factor * end for end in interval.ends)
            places = np.searchsorted(search.value, interval.ends)
            keep(ax, f"{words.name(answer)}: ratio at the ends of interval {number}", [first, last],
                 answer.ratio[places])
            ax.barh(middle, last - first, min(2.0 * half, 1.0), left=first, color=GREEN, ec=GREEN, zorder=2)
    left_out = len(search.answers) - len(answers)
    first, last = words.value(search.value[0]), words.value(search.value[-1])
    ax.set(xlabel=f"{words.option} ({words.unit})" if words.unit else words.option,
           title=f"Values within the bound, searched from {first} to {last} {words.unit}".rstrip() +
           (f" ({left_out} answers are not drawn)" if left_out else ""))
    ax.grid(False, axis="y")
    if is_logarithmic(values):
        scale_by_factors(ax)
    ax.set_xlim(values[0], values[-1])
