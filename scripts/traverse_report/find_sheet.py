"""The page of a search (find_option): the ratio to the bound over the searched values, and the intervals within it."""

import numpy as np
from picture_data import choose
from search_answers import Search

from . import curves
from .language import capital, num, t
from .page import GREY, LEFT, RED, table
from .quantities import shown_value, with_factor, words_of

MOST_DRAWN = 10


class Words:
    """The answers of a search in the language of the report."""

    def __init__(self, source):
        self.search, self.runs = Search(source.results), source.runs
        self.option = " + ".join(self.runs.words(name)[0] for name in (self.search.option, *self.search.also))
        _, self.unit, self.factor = self.runs.words(self.search.option)

    def value(self, value):
        """A searched value with its unit, and with as many digits as the accuracy of the search has."""
        number = float(f"{self.factor * value:.{self.search.digits()}g}")
        return f"{num(number, ',.12g')} {self.unit}".rstrip()

    def name(self, answer):
        """The values that the runs of an answer share."""
        parts = []
        for option, value in answer.parts:
            name = "hslm_a" if option.endswith("hslm_a") else option
            run = int(np.argmin(np.abs(self.runs.parameters[name] - value)))
            parts.append(self.runs.named_value(name, run))
        return ", ".join(parts) or t("all runs")

    def question(self):
        search = self.search
        if search.asked:
            return t("{option} with {quantity} up to {value}", option=self.option, quantity=words_of(search.asked),
                     value=shown_value(search.equals, search.asked))
        if search.kept == "limits":
            return t("{option} that keeps all limits", option=self.option)
        return t("{option} that keeps the limit: {quantity}", option=self.option, quantity=self.judged(search.kept))

    def judged(self, quantity):
        """A quantity with the factor of its limit that its judged values contain."""
        return with_factor(quantity, self.search.factors.get(quantity, 1.0))

    def interval(self, interval):
        (first, last), (at_first, at_last) = map(self.value, interval.ends), interval.at_end
        if at_first and at_last:
            return t("all from {first} to {last}", first=first, last=last)
        if at_first or at_last:
            return t("up to {value}", value=last) if at_first else t("from {value}", value=first)
        return t("{first} to {last}", first=first, last=last)

    def intervals(self, answer):
        return t("; ").join(map(self.interval, answer.intervals)) or t("no value")

    def governing(self, governing):
        """The quantity and the run that exceed the bound."""
        if np.isnan(governing.ratio):
            return t("not every run determines the quantities")
        names = [name for name, column in self.runs.parameters.items()
                 if name != self.search.option and len(np.unique(column)) > 1]
        run = ", ".join(self.runs.named_value(name, governing.run) for name in names)
        return self.judged(governing.quantity) + (f" ({run})" if run else "")

    def beyond(self, answer):
        """What governs beyond the ends of the intervals."""
        said = []
        for one in answer.intervals:
            for text, end, beyond in zip(("below {value}: {words}", "above {value}: {words}"), one.ends, one.beyond):
                if beyond is not None:
                    said.append(t(text, value=self.value(end), words=self.governing(beyond)))
        if answer.closest:
            value, governing = answer.closest
            said.append(t("closest at {value}, {ratio} times the bound: {words}", value=self.value(value),
                          ratio=num(governing.ratio), words=self.governing(governing)))
        return t("; ").join(said)

    def label(self):
        return f"{self.option} ({self.unit})" if self.unit else self.option

    def curves(self, most):
        """(name, ratio at each searched value) of at most `most` answers, among them the one with the greatest ratio;
        that of all runs, if there are others, is not among them."""
        answers = self.search.answers[:-1] if len(self.search.answers) > 1 else self.search.answers
        greatest = np.array([np.nanmax(np.nan_to_num(answer.ratio)) for answer in answers])
        return [(self.name(answers[i]), answers[i].ratio) for i in choose(len(answers), most, greatest)]

    def rows(self):
        """(answer, values within the bound, what governs beyond them) of each answer."""
        return [[self.name(answer), self.intervals(answer), self.beyond(answer)] for answer in self.search.answers]


def ratio_rows(source):
    """Head and rows: the searched values, and the ratio of each answer to the bound."""
    words = Words(source)
    heads = [words.label(), *(words.name(answer) for answer in words.search.answers)]
    columns = [words.factor * words.search.value, *(answer.ratio for answer in words.search.answers)]
    return heads, [[None if np.isnan(value) else float(value) for value in row] for row in zip(*columns)]


def interval_rows(source):
    """Head and rows: first and last value of each interval within the bound, and what governs beyond them."""
    words = Words(source)
    unit = f" ({words.unit})" if words.unit else ""
    rows = [[words.name(answer), *(words.factor * end for end in interval.ends), words.beyond(answer)]
            for answer in words.search.answers for interval in answer.intervals]
    return [t("runs"), t("least") + unit, t("greatest") + unit, t("beyond them")], rows


def head():
    return [t("runs"), t("values within the bound"), t("beyond them")]


def outcome(source):
    """The main result of a search in one line."""
    words = Words(source)
    return t("Search, no verification of one structure. {question}: {values}.", question=capital(words.question()),
             values=words.intervals(words.search.answers[-1]))


def sheet(report, source):
    if not source.is_search:
        return
    words, page = Words(source), report.page(t("Search for values"))
    report.anchor("find")
    page.text(LEFT, capital(words.question()), size=10, weight="bold")
    page.text(LEFT, t("Searched from {first} to {last}. The bound is the limit, or the given value of the quantity.",
                      first=words.value(words.search.value[0]), last=words.value(words.search.value[-1])), size=8,
              colour=GREY)
    drawn = words.curves(MOST_DRAWN)
    ax = page.axes(3.0, right=curves.room_for([name for name, _ in drawn]))
    draw(ax, words, drawn)
    page.fit(ax)
    table(report, page, [(head()[0], 1.4, "left"), (head()[1], 2.2, "left"), (head()[2], 3.2, "left")], words.rows(),
          size=7)


def draw(ax, words, drawn):
    """Draws the ratio of each answer, the bound, and the intervals of all runs."""
    x, ends = words.factor * words.search.value, []
    for i, (name, ratio) in enumerate(drawn):
        colour, style, _ = curves.look(i)
        ax.plot(x, ratio, color=colour, ls=style if len(drawn) > 1 else "-")
        ends.append(curves.End(ratio[-1], name, colour, style))
    for interval in words.search.answers[-1].intervals:
        ax.axvspan(*(words.factor * end for end in interval.ends), color="#00693E", alpha=0.10, lw=0)
    ax.axhline(1.0, color=RED, lw=1.2, ls=(0, (6, 2)))
    ax.set(xlim=(x[0], x[-1]), xlabel=words.label(), ylabel=t("ratio"),
           title=t("Greatest ratio of a run to its bound; shaded: within the bound for all runs"))
    ax.set_ylim(0.0, None)
    if len(drawn) > 1:
        curves.label_at_ends(ax, [end for end in ends if np.isfinite(end.value)])
