"""The larger of the effects of load models and of trains, for limits of deflection and rotation: EN 1991-2 6.4.6.5."""

import re
from typing import NamedTuple

import numpy as np
from engineering_units import shown

from .language import decimal, known, num, t
from .quantities import shown_value, speed_in_words

EFFECTS = {"lm71_deflection_over_span": "deflection", "lm71_end_rotation": "end_rotation",
           "lm71_joint_rotation": "joint_rotation", "lm71_track_twist": "track_twist"}


class OfTrains(NamedTuple):
    value: float  # with 1 + phi'dyn + phi''/2, in the unit of the limit
    words: str    # train and speed
    x: float      # m


def spans_at(ends, stations):
    """The length of the span of each station, m; at a support the shorter one. ends: positions of the span ends."""
    lengths = np.full(np.shape(stations), np.inf)
    for left, right in zip(ends[:-1], ends[1:]):
        inside = (stations >= left - 1e-9) & (stations <= right + 1e-9)
        lengths = np.where(inside, np.minimum(lengths, right - left), lengths)
    return lengths


def of_trains(file, quantity):
    """The largest effect of the trains of a results file for a limit of load models; None without such an effect."""
    if quantity not in EFFECTS or "norm/effect" not in file:
        return None
    group = file["norm"]
    effects = list(group["effect"].asstr()[:, 0])
    if EFFECTS[quantity] not in effects:
        return None
    row = effects.index(EFFECTS[quantity])
    x, value = float(group["train_x"][row]), float(group["train_dynamic"][row])
    if quantity == "lm71_deflection_over_span":
        ends = np.concatenate([[0.0], np.cumsum(file["model/spans"][:])])
        value /= float(spans_at(ends, np.array(x)))
    train = t("{train} at {speed}", train=group["train"].asstr()[row, 0],
              speed=speed_in_words(group["phi_dyn_speed"][row]))
    return OfTrains(value, train, x)


def larger(file, quantity, value, factor, place):
    """(value, place) of a limit of load models: those of the file, or those of the trains if they are larger. Both name
    the other one. factor: that of the limit; place: of the load models, in words."""
    trains = of_trains(file, quantity)
    if trains is None or np.isnan(value):
        return value, place
    own = factor * trains.value
    if own > value:
        said = t("{train} governs, with 1 + φ′dyn + φ″/2; load models: {value}", train=trains.words,
                 value=shown_value(value, quantity))
        return own, f"{said}, x = {num(round(trains.x, 3))} m"
    said = t("load models govern; trains: {value} ({train}, with 1 + φ′dyn + φ″/2)", train=trains.words,
             value=shown_value(own, quantity))
    return value, t("; ").join((place, said))


def place_of(text):
    """The place of a value, or the reason why it is missing: words of the program in the language of the report."""
    said = known(re.sub(r" with alpha = ([\d.]+) and Phi(\d) = ([\d.]+)", factors_in_words, text))
    said = re.sub(r"\bat [\d.e+]+ m/s \(([\d.]+) km/h\)", lambda found: speed_at(found[1]), said)
    effect = re.match(r"([a-z ]+) of (\w+) at ([\d.]+) km/h", said)
    if effect:
        said = t("{effect} of {train} at {speed}", effect=known(effect[1]), train=effect[2],
                 speed=f"{effect[3]} {shown('speed')[0]}") + said[effect.end():]
    return re.sub(r"(?<![\d.])\d+\.\d+(?![\d.])", lambda found: decimal(found[0]), said)


def factors_in_words(found):
    """The match of alpha, the number of Phi and its value as symbols."""
    return f", α = {found[1]}, Φ{found[2].translate(str.maketrans('23', '₂₃'))} = {found[3]}"


def speed_at(kmh):
    return t("at {speed}", speed=f"{kmh} {shown('speed')[0]}")
