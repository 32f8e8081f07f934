"""Limits and verdicts of the runs: those of the file, otherwise computed from its values."""

import pathlib
from typing import NamedTuple

import numpy as np
from input_files import InputError, yaml_of

from .language import num, t
from .larger_effect import larger, place_of, spans_at
from .quantities import with_factor
from .source import ReportError

# Static effects by EN 1991-2: they are independent of the runs and checked once.
STATIC = {"lm71_deflection_over_span", "lm71_end_rotation", "lm71_joint_rotation", "lm71_track_twist", "train_over_lm71"}
# Quantities of limits with another name in a table of runs.
STORED = {"unfiltered_deck_acceleration": "peak_acceleration", "contact_loss": "longest_loss"}
LIST = "list of limits, each with quantity, value and clause"


class Limit(NamedTuple):
    clause: str
    quantity: str
    value: float
    text: str
    factor: float = 1.0  # of effects that the computation neglects; values of verdicts contain it

    @property
    def words(self):
        """The quantity in words, with the factor."""
        return with_factor(self.quantity, self.factor)


class Verdict(NamedTuple):
    limit: Limit
    word: str      # kept, broken, not judged, kept alone: in the governing run
    value: float   # NaN without a verdict
    run: str       # name of the run
    where: str     # place and time, or the reason of a missing verdict
    file: str = ""  # in a table of several files

    @property
    def margin(self):
        return 1.0 - self.value / self.limit.value

    @property
    def utilisation(self):
        return self.value / self.limit.value


def key_of(limit):
    """What the same limit in several files has in common: its factor may differ."""
    return limit.clause, limit.quantity, limit.value


def as_number(text):
    parts = [float(part) for part in str(text).split("/")]
    return parts[0] / parts[1] if len(parts) == 2 else parts[0]


def read_limits(path):
    try:
        rows = yaml_of(path, LIST)
        return [Limit(str(row.get("clause", "")), str(row["quantity"]), as_number(row["value"]),
                      str(row.get("text", "")), as_number(row.get("factor", 1.0))) for row in rows]
    except InputError as error:
        raise ReportError(str(error)) from None
    except (KeyError, TypeError, ValueError, ZeroDivisionError, AttributeError):
        raise ReportError(f"{path} is no {LIST}") from None


def factors_of(file):
    """The factor of each limit of /verdicts; their values contain it."""
    group = file["verdicts"]
    return group["factor"][:] if "factor" in group else np.ones(len(group["limit"]))


def limits_of(source, given, folder):
    """The given limits, those of the stored verdicts, or those of the file in the options."""
    if given:
        return read_limits(given)
    if "verdicts/limit" in source.file:
        return [verdict.limit for verdict in stored(source)]
    name = source.options.get("limits")
    for place in (folder, source.path.parent, pathlib.Path()) if name else ():
        if place is not None and (pathlib.Path(place) / name).is_file():
            return read_limits(pathlib.Path(place) / name)
    return []


def stored(source):
    """The verdicts of /verdicts; limits of load models judge the larger of them and the trains."""
    file = source.file
    group = file["verdicts"] if "verdicts" in file else {}
    if "limit" not in group:
        return []
    verdicts = []
    texts = [group[name].asstr()[:] for name in ("clause", "quantity", "verdict")]
    columns = zip(*texts, group["value"][:], group["limit"][:], factors_of(file), group["time"][:])
    for clause, quantity, verdict, value, limit, factor, time in columns:
        when = "" if np.isnan(time) else f", t = {num(time)} s"
        own = Limit(clause[0], quantity[0], float(limit), clause[1], float(factor))
        value, place = larger(file, own.quantity, float(value), own.factor, place_of(verdict[1]) + when)
        word = verdict[0] if verdict[0] == "not judged" else word_of(value, own)
        verdicts.append(Verdict(own, word, value, "", place))
    return verdicts


def values_of(source, limit):
    """One value per run with the factor of the limit, in its unit, or None and the reason."""
    runs, quantity = source.runs, limit.quantity
    for name in (quantity, STORED.get(quantity)):
        if name in runs.values:
            return limit.factor / runs.factors.get(name, 1.0) * runs.of_run(name), ""
    if quantity == "deflection_over_span":
        if not len(source.model.span_ends):
            return None, t("the file contains no spans")
        spans = spans_at(source.model.span_ends, runs.probes)
        return limit.factor * (np.abs(runs.values["peak_deflection"]) / spans).max(axis=1), ""
    if quantity == "deck_acceleration":
        return None, t("the runs were stored without low-pass filter")
    return None, t("the file does not contain it for every run")


def judge(source, limits):
    """The verdict of the worst run for each limit."""
    if source.runs is None:
        return judge_run(source, limits)
    verdicts, known = [], {verdict.limit.quantity: verdict for verdict in stored(source)}
    whys = {quantity: verdict.where for quantity, verdict in known.items()}
    for limit in limits:
        if limit.quantity in STATIC and limit.quantity in known:
            verdicts.append(judged_again(known[limit.quantity], limit))
            continue
        values, why = values_of(source, limit)
        if values is None or np.isnan(values).all():
            verdicts.append(Verdict(limit, "not judged", np.nan, "", why
                                    or whys.get(limit.quantity, t("no run contains it"))))
            continue
        run = int(np.nanargmax(values))
        name = limit.quantity if limit.quantity in source.runs.values else STORED.get(limit.quantity, "peak_deflection")
        place = source.runs.place(name, run) if name in source.runs.values else None
        broken = np.count_nonzero(values > limit.value)
        where = [] if place is None else [f"x = {num(place, '.6g')} m"]
        where += [t("exceeded in {count} of {all} runs", count=broken,
                    all=np.count_nonzero(~np.isnan(values)))] if broken else []
        verdicts.append(Verdict(limit, word_of(values[run], limit), float(values[run]), source.runs.run_in_words(run),
                                ", ".join(where)))
    return verdicts


def word_of(value, limit):
    return "kept" if value <= limit.value else "broken"


def judged_again(verdict, limit):
    """A stored verdict for a limit of the same quantity with another value or factor."""
    value = limit.factor / verdict.limit.factor * verdict.value
    word = verdict.word if verdict.word == "not judged" else word_of(value, limit)
    return verdict._replace(limit=limit, word=word, value=value)


def judge_run(source, limits):
    """The verdicts of a single run: the stored ones, otherwise by its peaks."""
    known, verdicts, summary = {verdict.limit.quantity: verdict for verdict in stored(source)}, [], source.summary
    peaks = {"unfiltered_deck_acceleration": "acceleration", "deck_acceleration": "acceleration_lowpass",
             "amplification": "amplification", "contact_loss": "longest_loss"}
    for limit in limits:
        name = peaks.get(limit.quantity)
        if limit.quantity in known:
            verdicts.append(judged_again(known[limit.quantity], limit))
        elif name in summary:
            value = limit.factor * abs(float(summary[name]))
            where = f"x = {num(summary[f'{name}_place'], '.6g')} m" if f"{name}_place" in summary else ""
            verdicts.append(Verdict(limit, word_of(value, limit), value, "", where))
        else:
            verdicts.append(Verdict(limit, "not judged", np.nan, "",
                                    t("the run did not evaluate it; the option -limits of traverse evaluates it")))
    return verdicts


def with_governing(verdicts, alone):
    """Adds the verdicts of the governing run for limits that the table of runs does not contain: broken remains broken,
    kept is valid for this run only."""
    found = {verdict.limit[:3]: verdict._replace(word="kept alone" if verdict.word == "kept" else verdict.word)
             for verdict in alone if verdict.word != "not judged"}
    return [found.get(verdict.limit[:3], verdict) if verdict.word == "not judged" else verdict for verdict in verdicts]


class LineVerdict(NamedTuple):
    line: str
    limit: Limit
    value: float
    x: float
    broken: list  # intervals of x, (from, to)
    filtered: bool  # False: unfiltered values for a limit of low-passed ones

    @property
    def word(self):
        return ("broken" if self.broken else "kept") if self.filtered else "above" if self.broken else "below"

    @property
    def margin(self):
        return 1.0 - self.value / self.limit.value


def judge_lines(source, limits):
    """The greatest value of every line (train) for each limit, its x, and the intervals in which it is broken."""
    runs, rows = source.runs, []
    if runs is None or runs.x_name is None:
        return rows
    x, _ = runs.x()
    for limit in limits:
        values, _ = values_of(source, limit)
        filtered = values is not None or limit.quantity != "deck_acceleration"
        if not filtered:
            values, _ = values_of(source, limit._replace(quantity="unfiltered_deck_acceleration"))
        for name, indices in runs.lines() if values is not None else ():
            stations = np.unique(x[indices])
            greatest = np.array([np.nanmax(np.append(values[indices][x[indices] == at], -np.inf)) for at in stations])
            worst = int(np.argmax(greatest))
            if np.isfinite(greatest[worst]):
                rows.append(LineVerdict(name, limit, float(greatest[worst]), float(stations[worst]),
                                        ranges(stations, greatest > limit.value), filtered))
    return rows


def ranges(x, where):
    """The intervals [(from, to)] of neighbouring x for which `where` is true."""
    found = []
    for i in np.flatnonzero(where):
        if found and i > 0 and where[i - 1]:
            found[-1][1] = float(x[i])
        else:
            found.append([float(x[i]), float(x[i])])
    return [tuple(pair) for pair in found]
