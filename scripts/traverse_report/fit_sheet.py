"""The page of a fit: the estimates with their standard errors, the measurements, and each series with its computed
counterpart."""

from typing import NamedTuple

import numpy as np
import picture_fit

from . import curves
from .language import capital, digits, known, num, t
from .page import AMBER, GREY, LEFT, table
from .source import parameter_words

STRONG = 0.9  # a correlation that is said
MOST_IN_OUTCOME = 4  # estimates
SERIES_HEIGHT = 1.9  # inches
EXACT = 7  # digits of values in the workbook's texts and of estimates without a standard error


class Unknown(NamedTuple):
    """An estimated option, or the shift or offset of a series; numbers in the unit for print."""
    words: str
    unit: str
    estimate: float  # NaN before the first minimisation has ended
    error: float     # infinite: not determined; NaN: at a bound
    low: float
    high: float
    start: float
    at_bound: bool

    def name(self):
        return f"{self.words} ({self.unit})" if self.unit else self.words

    def value(self, value):
        """A value with its unit and with two digits of the standard error; infinite bounds and NaN are empty."""
        if not np.isfinite(value):
            return ""
        count = EXACT
        if np.isfinite(self.error) and self.error > 0.0 and value != 0.0:
            count = max(int(np.floor(np.log10(abs(value)))) - int(np.floor(np.log10(self.error))) + 2, 2)
        rounded = float(f"{value:.{min(count, 12)}g}")
        return num(rounded, ",.12g" if abs(rounded) < 1e7 else ".12g")

    def error_in_words(self):
        if np.isinf(self.error):
            return t("not determined")
        return "" if np.isnan(self.error) else num(self.error, ".2g")

    def sentence(self):
        """The estimate with its standard error in words."""
        plus = f" ± {self.error_in_words()}" if np.isfinite(self.error) else ""
        at = f" ({t('at a bound')})" if self.at_bound else ""
        return f"{self.words} {self.value(self.estimate)}{plus} {self.unit}".rstrip() + at


class Series(NamedTuple):
    """A measured series; values in the unit for print."""
    name: str
    place: str
    unit: str
    time: np.ndarray      # s, by the clock of the measurement
    measured: np.ndarray
    computed: np.ndarray  # NaN before the first minimisation has ended
    sd: float

    def rms(self):
        """Root mean square of the residuals."""
        return float(np.sqrt(np.mean((self.computed - self.measured) ** 2)))


def unknowns_of(file):
    """The unknowns of a fit in their order."""
    group, groups = file["fit"], file.get("fit/series", {})
    units = str(group["estimate"].attrs["unit"]).split(", ")
    columns = [group[name][:] for name in ("estimate", "standard_error", "low", "high", "start")]
    found = []
    for i, (name, unit) in enumerate(zip(file["unknown"].asstr()[:], units)):
        words, shown, factor = unknown_in_words(str(name), unit, groups)
        found.append(Unknown(words, shown, *(factor * float(column[i]) for column in columns),
                             bool(group["at_bound"][i] == 1.0)))
    return found


def unknown_in_words(name, unit, groups):
    """(name, unit for print, factor) of an option, or of the shift or offset of a series."""
    owner, _, kind = name.rpartition("_")
    if owner in groups and kind == "shift":
        return t("shift of the clock of {series}", series=owner), unit, 1.0
    if owner in groups and kind == "offset":
        return t("offset of {series}", series=owner), *picture_fit.unit_of(groups[owner])
    return parameter_words(name, unit)


def series_of(file):
    """The measured series in their order."""
    if "measured_series" not in file:
        return []
    found, deviations = [], file["fit/series_sd"][:] if "fit/series_sd" in file else []
    for name, sd in zip(file["measured_series"].asstr()[:], deviations):
        group = file[f"fit/series/{name}"]
        unit, factor = picture_fit.unit_of(group)
        found.append(Series(str(name), place_of(group), unit, group["time"][:], factor * group["measured"][:],
                            factor * group["computed"][:], factor * float(sd)))
    return found


def place_of(group):
    """The dataset and the place of a series in words."""
    dataset = str(group.attrs["dataset"]).strip("/")
    if "x" in group.attrs:
        return f"{known(picture_fit.quantity_of(group))}, x = {num(float(group.attrs['x']), '.6g')} m"
    return t("{dataset}, number {number}", dataset=dataset, number=int(group.attrs["component"]))


def frequencies_of(file):
    """(name, measured, computed, standard deviation) of each measured frequency, Hz."""
    if "fit/frequencies" not in file:
        return []
    columns = [file[f"fit/frequencies/{name}"][:] for name in ("measured", "computed", "sd")]
    return list(zip(map(str, file["measured_frequency"].asstr()[:]), *columns))


def findings_of(source):
    """The sentences of the program on what the data do not determine."""
    return [line for line in str(source.summary.get("findings", "")).split("\n") if line]


def correlations(file, unknowns):
    """The pairs with a strong correlation in a sentence."""
    found = file["fit/correlation"][:]
    pairs = [t("{first} and {second}: {value}", first=unknowns[i].words, second=unknowns[j].words,
               value=num(found[i, j], ".3f"))
             for j in range(len(unknowns)) for i in range(j) if abs(found[i, j]) > STRONG]
    limit = num(STRONG)
    return t("Correlations of estimates above {limit}: {pairs}.", limit=limit, pairs=t("; ").join(pairs)) if pairs else \
        t("No correlation of two estimates is above {limit}.", limit=limit)


def outcome(source):
    """The main result of a fit in one line."""
    unknowns = unknowns_of(source.file)
    if not any(np.isfinite(one.estimate) for one in unknowns):
        return t("Fit, no verification: no minimisation has ended.")
    said = t("; ").join(one.sentence() for one in unknowns[:MOST_IN_OUTCOME])
    if len(unknowns) <= MOST_IN_OUTCOME:
        return t("Fit, no verification. Estimates: {estimates}.", estimates=said)
    return t("Fit, no verification. Estimates: {estimates}, and {count} more.", estimates=said,
             count=len(unknowns) - MOST_IN_OUTCOME)


def peak_rows(source):
    """Rows of the summary: the estimates."""
    return [(one.words, one.estimate, one.unit, t("at a bound") if one.at_bound else
             t("standard error {error}", error=f"{one.error_in_words()} {one.unit}".rstrip())
             if np.isfinite(one.error) else one.error_in_words()) for one in unknowns_of(source.file)]


def head():
    return [t("unknown"), t("unit"), t("estimate"), t("standard error"), t("lower bound"), t("upper bound"),
            t("start of the fit"), t("remark")]


def rows(source):
    """The texts of the table of unknowns."""
    return [[capital(one.words), one.unit or "1", one.value(one.estimate), one.error_in_words(),
             *(digits(value) if np.isfinite(value) else "" for value in (one.low, one.high, one.start)),
             t("at a bound") if one.at_bound else ""] for one in unknowns_of(source.file)]


def frequency_head():
    return [t("frequency"), f"{t('measured')} (Hz)", f"{t('computed')} (Hz)", f"{t('standard deviation')} (Hz)"]


def frequency_rows(source):
    return [[name, *(num(value, ".5g") if np.isfinite(value) else "" for value in values)]
            for name, *values in frequencies_of(source.file)]


def series_head():
    return [t("series"), t("dataset and place"), t("values"), t("rms of the residuals"), t("standard deviation")]


def series_rows(source):
    return [[one.name, one.place, num(len(one.time), ",.0f"),
             *(f"{num(value, '.3g')} {one.unit}".rstrip() if np.isfinite(value) else ""
               for value in (one.rms(), one.sd))] for one in series_of(source.file)]


def workbook_rows(source):
    """Head and rows of the unknowns."""
    return head(), [[one.words, one.unit or "1", one.estimate, one.error, one.low, one.high, one.start,
                     t("at a bound") if one.at_bound else ""] for one in unknowns_of(source.file)]


def workbook_frequencies(source):
    """Head and rows of the measured frequencies."""
    return frequency_head(), frequencies_of(source.file)


def workbook_correlations(source):
    """Head and rows: a row and a column for each unknown."""
    names = [one.words for one in unknowns_of(source.file)]
    return [t("correlation"), *names], [[name, *map(float, row)] for name, row in
                                        zip(names, source.file["fit/correlation"][:])]


def workbook_starts(source):
    """Head and rows of the minimisations: misfit and estimates."""
    starts, unknowns = source.file["fit/starts"], unknowns_of(source.file)
    units = str(starts["estimate"].attrs["unit"]).split(", ")
    factors = [unknown_in_words(str(name), unit, source.file.get("fit/series", {}))[2]
               for name, unit in zip(source.file["unknown"].asstr()[:], units)]
    return [t("start of the fit"), t("misfit"), *(one.name() for one in unknowns)], [
        [number, float(misfit), *(factor * float(value) for factor, value in zip(factors, values))]
        for number, (misfit, values) in enumerate(zip(starts["misfit"][:], starts["estimate"][:]), 1)]


def workbook_series(source):
    """(series, head, rows) of each series."""
    def column(words, unit):
        return f"{words} ({unit})" if unit else words

    return [(one, [t("time of the measurement (s)"),
                   *(column(words, one.unit) for words in (t("measured"), t("computed"), t("residual")))],
             np.stack([one.time, one.measured, one.computed, one.computed - one.measured], axis=1).tolist())
            for one in series_of(source.file)]


def sheet(report, source):
    if not source.is_fit:
        return
    page = report.page(t("Fit to measurements"))
    report.anchor("fit")
    page.text(LEFT, t("The estimates minimise the sum of the squares of all residuals, each over its standard "
                      "deviation. Numbers are in the unit of their row."), size=8, colour=GREY)
    page.y -= 0.05
    widths = (1.6, 0.55, 0.9, 0.95, 0.7, 0.7, 0.7, 0.7)
    aligned = ["left", "left", *["right"] * 5, "left"]
    page = table(report, page, list(zip(head(), widths, aligned)), rows(source), size=7)
    page.text(LEFT, correlations(source.file, unknowns_of(source.file)), size=8)
    for words in findings_of(source):
        page = page if page.room() > 0.6 else report.page(page.heading)
        page.text(LEFT, t("Finding of the program: {words}", words=words), size=8, colour=AMBER)
    page.y -= 0.12
    for names, cells, widths in ((frequency_head(), frequency_rows(source), (2.0, 1.6, 1.6, 1.6)),
                                 (series_head(), series_rows(source), (1.4, 2.4, 0.8, 1.1, 1.1))):
        if cells:
            page = page if page.room() > 0.8 else report.page(page.heading)
            left = 1 if names[0] == frequency_head()[0] else 2
            sides = ["left"] * left + ["right"] * (len(names) - left)
            page = table(report, page, list(zip(names, widths, sides)), cells, size=7)
    draw_all(report, page, source)


def draw_all(report, page, source):
    """Draws each series, and the residuals of the frequencies."""
    words = picture_fit.Words(t("measured"), t("computed"), t("residual"), t("time of the measurement (s)"),
                              t("Frequencies: computed less measured"), t("standard deviations"),
                              t("frequency of the list"), t("grey: one standard deviation"))
    right = curves.room_for([words.measured, words.computed, words.residual])
    for one in series_of(source.file):
        page = page if page.room() > SERIES_HEIGHT + 0.9 else report.page(page.heading)
        ax = page.axes(SERIES_HEIGHT, right=right)
        picture_fit.draw_series(ax, source.file[f"fit/series/{one.name}"], t(": ").join((one.name, one.place)), words)
        page.fit(ax)
    if "fit/frequencies" in source.file:
        page = page if page.room() > SERIES_HEIGHT + 0.9 else report.page(page.heading)
        ax = page.axes(SERIES_HEIGHT, right=1.8)
        picture_fit.draw_frequencies(ax, source.file["fit/frequencies"], words)
        page.fit(ax)
