"""The quantities of results and limits: the words for them and their row of engineering_units.csv, also for pictures."""

from typing import NamedTuple

import numpy as np
from engineering_units import shown

from .language import digits, num, t


class Quantity(NamedTuple):
    words: str
    kind: str = ""  # row of engineering_units.csv; empty for a ratio


QUANTITIES = {
    "peak_deflection": Quantity("greatest deflection", "deflection"),
    "peak_acceleration": Quantity("greatest deck acceleration, unfiltered", "acceleration"),
    "deck_acceleration": Quantity("greatest deck acceleration, low-pass filtered", "acceleration"),
    "unfiltered_deck_acceleration": Quantity("greatest deck acceleration, unfiltered", "acceleration"),
    "deflection_over_span": Quantity("deflection over span length"),
    "peak_moment": Quantity("greatest bending moment", "moment"),
    "amplification": Quantity("dynamic amplification of the greatest deflection"),
    "least_wheel_force": Quantity("least wheel force", "force"),
    "greatest_wheel_force": Quantity("greatest wheel force", "force"),
    "longest_loss": Quantity("longest loss of wheel-rail contact", "loss_time"),
    "contact_loss": Quantity("longest loss of wheel-rail contact", "loss_time"),
    "end_rotation": Quantity("greatest rotation of the deck ends", "rotation"),
    "joint_rotation": Quantity("greatest relative rotation of adjacent decks", "rotation"),
    "car_acceleration": Quantity("greatest vertical acceleration of car bodies", "acceleration"),
    "wheel_unloading": Quantity("greatest wheel unloading, unfiltered"),
    "filtered_wheel_unloading": Quantity("greatest wheel unloading, low-pass filtered"),
    "unloading_time": Quantity("longest time of wheel unloading, low-pass filtered", "loss_time"),
    "lm71_deflection_over_span": Quantity("deflection over span length under LM71 or the trains"),
    "lm71_end_rotation": Quantity("rotation of the deck ends under LM71 or the trains", "rotation"),
    "lm71_joint_rotation": Quantity("relative rotation of adjacent decks under LM71 or the trains", "rotation"),
    "lm71_track_twist": Quantity("twist of a track over 3 m under LM71 or the trains", "deflection"),
    "track_twist": Quantity("greatest twist of a track over 3 m", "deflection"),
    "bearing_uplift": Quantity("greatest uplift of a bearing", "force"),
    "train_over_lm71": Quantity("effect of the trains over that of LM71"),
    "rail_tension": Quantity("additional tensile stress of the rails", "stress"),
    "rail_compression": Quantity("additional compressive stress of the rails", "stress"),
    "rail_slip": Quantity("relative displacement between rail and deck", "displacement"),
    "deck_displacement": Quantity("longitudinal displacement of the deck end under braking", "displacement"),
    "deck_end_displacement": Quantity("longitudinal displacement of the deck end due to bending", "displacement"),
    "rail_device_opening": Quantity("movement of the rail expansion device", "displacement"),
}
OF_SI = {"m": "deflection", "N m": "moment", "N": "force", "rad": "rotation", "m/s2": "acceleration", "m/s": "speed",
         "Pa": "stress"}


def words_of(name):
    """A quantity in words; of an unknown one its name in the results file."""
    return t(QUANTITIES[name].words) if name in QUANTITIES else name.replace("_", " ")


def unit_of(name):
    """(unit for print, factor from SI)"""
    kind = QUANTITIES[name].kind if name in QUANTITIES else ""
    return shown(kind) if kind else ("", 1.0)


def with_factor(name, factor):
    """A quantity in words, with a factor that its values contain."""
    return words_of(name) + ("" if factor == 1.0 else f" × {num(factor, '.5g')}")


def shown_value(value, name):
    """A value of a quantity as text with its usual unit, a deflection over the span as L/600; empty for NaN."""
    if np.isnan(value):
        return ""
    if name.endswith("deflection_over_span"):
        return f"L/{digits(1.0 / value)}" if value > 0.0 else "0"
    unit, factor = unit_of(name)
    return f"{digits(factor * value)} {unit}".strip()


def speed_in_words(speed):
    """A speed in m/s as text with the usual unit."""
    unit, factor = shown("speed")
    return f"{num(factor * speed)} {unit}"


def unit_of_si(si):
    """(unit for print, factor from SI) of an effect stored in this SI unit; other units remain."""
    return shown(OF_SI[si]) if si in OF_SI else (si.replace("2", "²").replace("1", ""), 1.0)
