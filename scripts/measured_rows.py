"""The measured values of doc/measured, what is assumed about each bridge, and how each value is computed.

A value is a function of a scene (measured_bridges.Scene) and of further options, "-name value". Ranges are pairs.
"""

from dataclasses import dataclass
from typing import Callable

import numpy as np


@dataclass
class Row:
    quantity: str
    measured: float | tuple[float, float]
    digits: int
    compute: Callable
    compared: bool = True  # False: fitted, or of another kind than the measured value


@dataclass
class Assumption:
    what: str
    used: str
    instead: list[tuple[str, list[str]]]  # (label, options)


@dataclass
class Bridge:
    rows: list[Row]
    watched: Row  # of which the assumptions are changed
    assumptions: list[Assumption]


def frequency(number):
    """The natural frequency of mode 1, 2, ..., Hz."""
    modes = ("-scene_analysis modes", "-modes_count 4")
    return lambda scene, *options: scene.results(*modes, *options)["modes/frequency"][number - 1]


def deepest(probe):
    """The greatest deflection at a probe, mm."""
    return lambda scene, *options: -1e3 * scene.results(*options)["envelope/deflection"][probe, 0]


def uplift(probe):
    """The greatest upward deflection at a probe, mm."""
    return lambda scene, *options: 1e3 * scene.results(*options)["envelope/deflection"][probe, 1]


def parked(probe, front):
    """The deflection, mm, under the lorry of bridge 705 with its front axle at `front`."""
    places = ",".join(f"{front - behind:g}" for behind in (0.0, 3.6, 4.92, 6.37))
    return lambda scene, *options: -1e3 * scene.results(
        "-scene_analysis static", f"-load_positions {places}", *options)["probes/deflection"][0, probe]


def given(compute, *mine):
    """The same value of the scene with options of its own."""
    return lambda scene, *options: compute(scene, *mine, *options)


def quotient(above, below):
    return lambda scene, *options: above(scene, *options) / below(scene, *options)


def moments(probe, choose, per=1.0):
    """A figure of the moment over time at a probe: choose(time, moment)."""
    def value(scene, *options):
        found = scene.results(*options)
        return choose(found["time"], found["probes/moment"][:, probe]) * per
    return value


def between(start, end, pick):
    return lambda time, moment: pick(moment[(time >= start) & (time <= end)])


def highest_at(start, end):
    """The time of the greatest moment from start to end."""
    return lambda time, moment: time[(time >= start) & (time <= end)][np.argmax(moment[(time >= start) & (time <= end)])]


def over_the_greatest(choose):
    return lambda time, moment: choose(time, moment) / moment.max()


def factors(wheels, static, first, last):
    """The greatest force of these wheels over their static one while all stand on the bridge of Vransko, least and
    greatest value of nine speeds; `first` and `last` are the places of the outer two, m from the lorry's origin."""
    speeds = (10.55, 11.31, 11.63, 11.97, 13.93, 14.84, 18.45, 19.14, 19.50)

    def value(scene, *options):
        found = []
        for speed in speeds:
            results = scene.results(f"-train_speed {speed}", *options)
            place = -60.0 + speed * results["time"]
            on = (place + last >= 0.0) & (place + first <= 24.8)
            found.append(sum(results[f"vehicles/0/{wheel}/normal_force"] for wheel in wheels)[on].max() / static)
        return min(found), max(found)
    return value


TO_STRAIN = 1e6 / (2 * 2.1e11 * 2.726e-3)  # microstrain of the stringers' lower edge for a moment of both
MOTOR, TRAILER = (1.15, 2.3), (0.0, 1.1)  # s, when the bogies of both cars of the railcar are in the first panel
ALWAYS = (0.0, np.inf)
TRUSS_SLOW, TRUSS_FAST = (given(deepest(0), f"-load_speed {speed}") for speed in (11.25, 20.16))


def strain(probe, times, pick=np.max):
    return moments(probe, between(*times, pick), TO_STRAIN)


def bounce(time, moment):
    """The frequency of the bouncing lorry from the first and the third peak at midspan."""
    return 2.0 / (highest_at(2.2, 2.6)(time, moment) - highest_at(1.5, 1.9)(time, moment))


CRACKED = "-beam_EI options/measured/belleville_cracked_EI.csv"
PARKED_SPANS = [Row("parked, middle of the second span (U13), mm", 0.705, 3, parked(1, 24.525)),
                Row("parked, middle of the third span (U19), mm", 0.655, 3, parked(2, 39.825)),
                Row("parked, middle of the fourth span (U26), mm", 0.660, 3, parked(3, 55.125)),
                Row("parked, last span (U29), mm", 0.748, 3, parked(4, 99.75)),
                Row("parked, axis of the first piers (U12), mm", 0.135, 3, parked(0, 16.875), compared=False)]
LAST_SPAN = Row("20 km/h, last span (U29), mm", 0.717, 3, deepest(4))
TRUSS = Row("deflection at midspan, 40.5 km/h, mm", 24.55, 2, TRUSS_SLOW)
MIDDLE_GAUGE = Row("motor bogies, 2.085 m (s1), microstrain", 171.0, 0, strain(1, MOTOR))
LEFT_OVER = Row("free vibration, first trough over greatest moment", -0.12, 2,
                moments(0, over_the_greatest(between(3.13, 3.6, np.min))))
FRONT_AXLE = factors(["front_wheel"], 74.5e3, 4.25, 4.25)
TANDEM = factors(["middle_wheel", "rear_wheel"], 200e3, 0.69, -0.69)
QUARTER = Row("greatest strain at the quarter point over that at midspan", 0.70, 2,
              quotient(moments(0, between(*ALWAYS, np.max)), moments(1, between(*ALWAYS, np.max))))
LEAST_OVER_GREATEST = moments(0, over_the_greatest(between(*ALWAYS, np.min)))
HOGGING = Row("least over greatest strain at the middle of the first span", -0.20, 2, LEAST_OVER_GREATEST)


def yielding(stiffness, lines, ends):
    return "-support_stiffness " + ",".join([ends] + [stiffness] * lines + [ends])


BRIDGES = {
    "indian_truss": Bridge(
        [Row("first frequency, vertical, Hz", 5.37, 2, frequency(1)), TRUSS,
         Row("deflection at midspan, 72.6 km/h, mm", 24.81, 2, TRUSS_FAST),
         Row("72.6 over 40.5 km/h", 24.81 / 24.55, 3, quotient(TRUSS_FAST, TRUSS_SLOW))],
        TRUSS,
        [Assumption("stiffness of the chords", "by panels", [("least everywhere", ["-beam_EI 1.735e11"]),
                                                             ("greatest everywhere", ["-beam_EI 2.437e11"])]),
         Assumption("shear stiffness", "diagonals, by panels", [("as of the first diagonals", ["-beam_GA 1.941e9"]),
                                                                ("no shear deformation", ["-beam_GA 1e14"])]),
         Assumption("mass", "2,641 kg/m", [("3,100 kg/m", ["-beam_mass 3100"])]),
         Assumption("damping", "2 %", [("1 %", ["-beam_damping_ratios 0.01"]), ("5 %", ["-beam_damping_ratios 0.05"])])]),
    "amsterdam_slab": Bridge(
        [Row("20 km/h, middle of the second span (U13), mm", 0.684, 3, deepest(1), compared=False),
         Row("20 km/h, middle of the fourth span (U26), mm", 0.633, 3, deepest(3), compared=False), LAST_SPAN,
         Row("20 km/h, uplift in the second span, mm", 0.074, 3, uplift(1)),
         Row("20 km/h, uplift in the fourth span, mm", 0.044, 3, uplift(3)),
         Row("20 km/h, uplift in the last span, mm", 0.110, 3, uplift(4)), *PARKED_SPANS,
         Row("20 km/h over parked, fourth span", 0.633 / 0.660, 2, quotient(deepest(3), parked(3, 55.125)))],
        LAST_SPAN,
        [Assumption("width of the strip", "11.7 m", [("10 m", ["-beam_EI 7.93e9"]), ("14 m", ["-beam_EI 1.110e10"])]),
         Assumption("stiffness of each line of a pier", "1.76e9 N/m", [("1.06e9 N/m", [yielding("1.06e9", 12, "0")]),
                                                                       ("rigid", [yielding("0", 12, "0")])]),
         Assumption("damping", "2 %", [("5 %", ["-beam_damping_ratios 0.05"])])]),
    "leirelva_stringer": Bridge(
        [Row("motor bogies, 1.085 m (s2), microstrain", 120.0, 0, strain(0, MOTOR)), MIDDLE_GAUGE,
         Row("motor bogies, 3.085 m (s3), microstrain", 90.0, 0, strain(2, MOTOR)),
         Row("trailer bogies, 1.085 m (s2), microstrain", 82.0, 0, strain(0, TRAILER)),
         Row("trailer bogies, 2.085 m (s1), microstrain", 125.0, 0, strain(1, TRAILER)),
         Row("trailer bogies, 3.085 m (s3), microstrain", 60.0, 0, strain(2, TRAILER)),
         Row("least, 1.085 m (s2), microstrain", -23.0, 0, strain(0, ALWAYS, np.min)),
         Row("least, 2.085 m (s1), microstrain", -22.0, 0, strain(1, ALWAYS, np.min)),
         Row("least, 3.085 m (s3), microstrain", -30.0, 0, strain(2, ALWAYS, np.min))],
        MIDDLE_GAUGE,
        [Assumption("cross girders", "3.8e8 N/m", [(label, [yielding(stiffness, 5, stiffness)]) for label, stiffness in (
            ("rigid", "0"), ("2e8 N/m", "2e8"), ("1e8 N/m", "1e8"))]),
         Assumption("mass", "550 kg/m", [("400 kg/m", ["-beam_mass 400"]), ("800 kg/m", ["-beam_mass 800"])]),
         Assumption("damping", "2 %", [("0.5 %", ["-beam_damping_ratios 0.005"]), ("5 %", ["-beam_damping_ratios 0.05"])])]),
    "slovenian_beams": Bridge(
        [Row("first frequency, Hz", 3.54, 2, frequency(1), compared=False),
         Row("frequency from the first to the third peak, Hz", 3.0, 1, moments(0, bounce)),
         Row("first peak over greatest moment at midspan", 0.56, 2, moments(0, over_the_greatest(between(1.5, 1.9, np.max)))),
         Row("trough after it", 0.51, 2, moments(0, over_the_greatest(between(1.8, 2.0, np.min)))),
         Row("trough after the greatest", 0.48, 2, moments(0, over_the_greatest(between(2.1, 2.4, np.min)))),
         Row("third peak", 0.73, 2, moments(0, over_the_greatest(between(2.3, 2.6, np.max)))), LEFT_OVER,
         Row("free vibration, crest after it", 0.10, 2, moments(0, over_the_greatest(between(3.3, 3.75, np.max))))],
        LEFT_OVER,
        [Assumption("dip at the joint", "6 mm", [("none", ["-track_profile none"])]),
         Assumption("mass, with the same frequency", "12 t/m", [("8 t/m", ["-beam_mass 8e3", "-beam_EI 4.261e10"]),
                                                                ("16 t/m", ["-beam_mass 1.6e4", "-beam_EI 8.521e10"])]),
         Assumption("tyres of the rear axle", "3.99e6 N/m", [
             (f"{stiffness} N/m", [f"-vehicle_lorry_rear_wheel_stiffness {stiffness}"]) for stiffness in ("3.6e6", "4.4e6")]),
         Assumption("damping of the rear tyres", "13.6 kNs/m", [("45 kNs/m", ["-vehicle_lorry_rear_wheel_damping 4.5e4"])])]),
    "vransko": Bridge(
        [Row("first frequency, Hz", 5.11, 2, frequency(1), compared=False), QUARTER,
         Row("front axle over its static load, nine speeds", (1.03, 1.34), 2, FRONT_AXLE),
         Row("tandem over its static load, nine speeds", (1.08, 1.28), 2, TANDEM),
         Row("all axles over their static load, nine speeds", (1.07, 1.27), 2,
             factors(["front_wheel", "middle_wheel", "rear_wheel"], 274.5e3, 4.25, -0.69)),
         Row("front axle, another profile (seed 2)", (1.03, 1.34), 2, given(FRONT_AXLE, "-track_seed 2")),
         Row("tandem, another profile (seed 2)", (1.08, 1.28), 2, given(TANDEM, "-track_seed 2")),
         Row("front axle, damped by 10 % in place of 3 %", (1.03, 1.34), 2,
             given(FRONT_AXLE, "-vehicle_lorry_front_wheel_damping 2.97e4"))],
        QUARTER,
        [Assumption("road", "ISO 8608, class A", [
            ("smooth", ["-track_profile none"]), ("class B", ["-track_profile iso8608_B"])]),
         Assumption("random profile", "seed 1", [(f"seed {seed}", [f"-track_seed {seed}"]) for seed in (2, 3)]),
         Assumption("mass, with the same frequency", "15 t/m", [("10 t/m", ["-beam_mass 1e4", "-beam_EI 4.003e10"]),
                                                                ("20 t/m", ["-beam_mass 2e4", "-beam_EI 8.007e10"])])]),
    "belleville": Bridge(
        [Row("first frequency, Hz", 1.33, 2, frequency(1), compared=False), Row("second frequency, Hz", 2.00, 2, frequency(2)),
         Row("second over first frequency", 2.00 / 1.33, 2, quotient(frequency(2), frequency(1))), HOGGING,
         Row("the same without the vibration", -8.0 / 60.0, 2, LEAST_OVER_GREATEST),
         Row("second over first frequency, slab cracked at the pier", 2.00 / 1.33, 2,
             given(quotient(frequency(2), frequency(1)), CRACKED))],
        HOGGING,
        [Assumption("stiffness beside the pier", "as elsewhere", [("half over 15 % of both spans", [CRACKED])]),
         Assumption("damping", "1 %", [("0.5 %", ["-beam_damping_ratios 0.005"]), ("2 %", ["-beam_damping_ratios 0.02"])])]),
}
