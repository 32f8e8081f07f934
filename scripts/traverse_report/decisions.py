"""Requirements that the report decides from the results file without a limit: the need for a dynamic analysis, the
range of speeds, track defects and uplift at the bearings."""

from typing import NamedTuple

import numpy as np
from picture_words import weighs
from traverse_check import flow_chart, track_defects
from traverse_check.rules import rule

from .language import num, t
from .page import AMBER, GREEN, GREY, INK, RED
from .quantities import speed_in_words, words_of
from .uplift import Bearing, force_in_words, joints_are, least_over_time, permanent_forces


class Decision(NamedTuple):
    words: str
    colour: str
    anchor: str = ""  # of the page with its reasons


def has_equal_spans(source):
    """Whether all spans are equal and separate, or there is only one."""
    lengths = np.unique(np.round(np.diff(source.model.span_ends), 6))
    return len(lengths) == 1 and joints_are(source, "separate")


def need_for_analysis(source):
    """The answer of the flow chart of figure 6.9; None without line speed or first frequency, and for other bridges."""
    if source.line is None or "norm" not in source.file:
        return None
    separate = has_equal_spans(source)
    if not separate and not joints_are(source, "continuous"):
        return None
    group = source.file["norm"]
    part = flow_chart.Part(float(group["determinant_length"][:].max()), float(group.attrs["n0"]), separate)
    return flow_chart.answer(part, source.line)


def need(source):
    found = need_for_analysis(source)
    if found is None:
        why = t("not decided: the line speed is not part of the input (--line-speed)") if source.line is None else \
            t("not decided: the chart needs one span, equal simple spans or a continuous bridge, and its first "
              "frequency")
        return Decision(why, AMBER)
    if not found.needed:
        return Decision(t("no dynamic analysis is necessary"), INK, "need")
    if source.is_dynamic:
        return Decision(t("a dynamic analysis is necessary; this report contains it"), INK, "need")
    return Decision(t("a dynamic analysis is necessary; this report does not contain it"), RED, "need")


def speeds(source):
    """Whether the runs reach 1.2 times the line speed."""
    if source.runs is None or not source.runs.is_over_speed:
        return None
    computed = float(np.max(source.runs.parameters[source.runs.x_name]))
    if source.line is None:
        return Decision(t("computed up to {speed}; the line speed is not part of the input (--line-speed)",
                          speed=speed_in_words(computed)), INK, "assumptions")
    wanted = rule("speeds")["factor"] * source.line.line_speed
    enough = computed >= (1.0 - 1e-9) * wanted
    return Decision(t("computed up to {speed}; {factor} times the line speed: {wanted}", speed=speed_in_words(computed),
                      factor=num(rule("speeds")["factor"]), wanted=speed_in_words(wanted)),
                    GREEN if enough else RED, "assumptions")


def defects(source):
    """The factors of 6.4.6.4 that the values of the results file contain."""
    factors = dict(source.judged_factors())
    if not factors:
        return None
    known = {name: factors[name] for name in track_defects.QUANTITIES if factors.get(name, 1.0) != 1.0}
    if not known:
        return Decision(t("the judged values do not contain it (factor of the limits)"), AMBER)
    said = t("; ").join(t(": ").join((words_of(name), num(value, ".5g"))) for name, value in known.items())
    return Decision(t("factors of the judged values: {factors}", factors=said), INK, "verdicts")


def traffic_uplift(source):
    """The least static bearing force of all loads, with alpha and Phi or the dynamic factor of the trains at most."""
    group = source.file["static"]
    factors = factors_of_reactions(source)
    least = [Bearing(factor * float(values[:, 0].min()), load, float(group["reaction_x"][int(values[:, 0].argmin())]))
             for load, factor, values in zip(source.static_loads(), factors, group["reaction"][:])]
    return min(least, key=lambda one: one.value)


def dynamic_uplift(source):
    """[the least bearing force over time] of the run of the file, of all runs, or of the governing run alone; where the
    runs have the weight of the bridge, it contains it."""
    if source.is_run:
        least = least_over_time(source, t("the run"))
    elif source.least_bearing is not None:
        least = source.least_bearing
    else:
        least = None if source.governing is None else least_over_time(source.governing, t("governing run"))
    return [] if least is None else [least]


def has_least_bearing_of_runs(source):
    """Whether the runs of a table have bearing forces of the traffic alone, with a bound from their accelerations."""
    return source.runs is not None and "static/reaction" in source.file and "peak_acceleration" in source.runs.values \
        and not weighs(source.options) and permanent_forces(source) is not None


def factors_of_reactions(source):
    """The largest factor of each static load: alpha Phi of a load model, 1 + phi'dyn + phi''/2 of the worst train."""
    group = source.file["norm"] if "norm" in source.file else {}
    phi, alpha = float(group["phi"][:].max()) if "phi" in group else 1.0, source.load_models()
    of_train = float((group["train_dynamic"][:] / group["train_static"][:]).max()) if "train_dynamic" in group else 1.0
    return [phi * alpha[load] if load in alpha else of_train for load in source.static_loads()]


def uplift(source):
    """Whether the bearing forces of traffic exceed those of the permanent loads; characteristic values."""
    file, dynamic = source.file, dynamic_uplift(source)
    with_weight = dynamic if weighs(source.options) else []
    if with_weight and (source.is_run or with_weight[0].value <= 0.0):  # of a table only the governing run is known
        least = with_weight[0]
        words = "no uplift: least bearing force with the mass of the bridge {force}" if least.value > 0.0 else \
            "uplift: least bearing force with the mass of the bridge {force}"
        return Decision(t(words, force=least.words()), GREEN if least.value > 0.0 else RED)
    if source.is_run and not dynamic and "supports/reaction" in file:
        return Decision(t("not decided: each joint between two decks needs a station (output_probes)"), AMBER)
    if "static/reaction" not in file:
        return Decision(t("not decided: the static bearing forces are missing (norm_load_models)"), AMBER)
    traffic = min([traffic_uplift(source), *([] if with_weight else dynamic)], key=lambda one: one.value)
    if traffic.value > -1e-6 * float(np.abs(file["static/reaction"][:]).max()):
        return Decision(t("no uplift: no load lifts a bearing"), GREEN)
    if traffic.own is None:
        return Decision(t("not decided: least force of traffic {force}; the bearing force of the permanent loads is "
                          "missing (a run with beam_self_weight contains it)", force=traffic.words()), AMBER)
    words, colour = ("no uplift: least force of traffic {force}, of the mass of the bridge {own}", GREEN) \
        if not traffic.lifts() else \
        ("not decided: bound of the least force of traffic {force}, of the mass of the bridge {own}", AMBER) \
        if traffic.is_bound else ("uplift: least force of traffic {force}, of the mass of the bridge {own}", RED)
    return Decision(t(words, force=traffic.words(), own=force_in_words(traffic.own)), colour)


# The decisions by their names in clauses.yml. None: the file does not contain what they need.
DECISIONS = {"need": need, "speeds": speeds, "track_defects": defects, "uplift": uplift}
