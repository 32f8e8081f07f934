"""The forms of the page: what an engineer fills in for each kind of computation."""

import functools
import math
from typing import NamedTuple

from . import inputs
from .fields import Field, chosen, flag, text

EI, MASS, SPEED = ("GN m2", "MN m2", "kN m2"), ("t/m", "kg/m"), ("km/h", "m/s")
KINDS = {"prestressed": "prestressed concrete", "composite": "composite", "steel": "steel", "reinforced": "reinforced concrete",
         "filler_beam": "filler beams"}
HSLM = "hslm_a"
# Ranges in SI units.
POSITIVE, OF_TRAINS, OF_EI = (0.0, math.inf, True), (0.0, 200.0, True), (0.0, 1e16, True)
OF_ALPHA, OF_VEHICLES, OF_TRACKS = (0.1, 10.0, False), (1.0, 2000.0, False), (1.0, 1e6, False)


class Form(NamedTuple):
    name: str      # in addresses
    title: str
    words: str     # what it computes, in one or two sentences
    groups: tuple  # (heading, fields)
    verb: str      # of the button

    @property
    def fields(self):
        return [field for _, group in self.groups for field in group]


@functools.cache
def vehicles():
    """{name: what it is} of vehicles of the library that may form a train."""
    found = {}
    for path in sorted((inputs.OPTIONS / "vehicles").glob("*.yml")):
        lines = path.read_text(encoding="utf-8").splitlines()
        if any(line.startswith("length:") for line in lines) and path.stem not in ("crane_trolley", "pedestrian"):
            found[path.stem] = lines[0].removeprefix("# What: ").split(",")[0].split(":")[0]
    return dict(sorted(found.items(), key=lambda one: one[0] != "velaro"))


@functools.cache
def examples():
    """{name: what it is} of the scenes of the library."""
    found = {}
    for path in sorted((inputs.OPTIONS / "scenes").glob("*.yml")):
        head = path.read_text(encoding="utf-8").splitlines()[0]
        found[path.stem] = head.removeprefix("# What: ").split(":")[0]
    return found


def bridge(spans="28", stiffness="260", mass="19", searched=False):
    stiff = [] if searched else [Field("beam_EI", "bending stiffness EI", stiffness, EI)]
    return ("bridge", (
        Field("beam_spans", "span lengths", spans, ("m",), many=True, hint="several spans are continuous"), *stiff,
        Field("beam_mass", "mass per length", mass, MASS, hint="with ballast and track"),
        chosen("model_damping_bound", "damping", KINDS, "prestressed", hint="lower bound of EN 1991-2, table 6.6"),
        flag("beam_continuity", "separate simple beams", more=True)))


def speeds(first, last, step, hint=""):
    return (Field("sweep_speed.from", "lowest speed", first, SPEED, range=OF_TRAINS),
            Field("sweep_speed.to", "highest speed", last, SPEED, range=OF_TRAINS),
            Field("sweep_speed.step", "step of the speeds", step, SPEED, hint=hint, range=POSITIVE))


def coaches(choices, preset, count="8"):
    return (chosen("train_vehicles", "train", choices, preset),
            Field("train_vehicles.count", "number of vehicles", count, hint="of a train of equal vehicles", range=OF_VEHICLES))


def check():
    return Form("check", "Check by EN 1991-2", "Decides whether a dynamic analysis is necessary, computes the trains HSLM and "
                "the load models, and evaluates the limits of EN 1990.", (
                    ("bridge", (
                        Field("span", "span lengths", "28", ("m",), many=True, hint="several spans are continuous"),
                        Field("EI", "bending stiffness EI", "260", EI, many=True, optional=True,
                              hint="two values: lower and upper bound"),
                        Field("mass", "mass per length", "19", MASS, many=True,
                              hint="with ballast and track; two values: lower and upper bound"),
                        chosen("type", "kind of bridge", {("filler" if kind == "filler_beam" else kind): words
                                                          for kind, words in KINDS.items()}, "prestressed",
                               hint="its damping by EN 1991-2, table 6.6"),
                        Field("frequency", "first natural frequency, instead of EI", "", ("Hz",), many=True, optional=True,
                              more=True),
                        flag("simply-supported", "separate simple beams", more=True))),
                    ("line", (
                        Field("line-speed", "line speed", "250", SPEED, hint="trains run at up to 1.2 times this speed"),
                        chosen("track", "track", {"ballast": "ballasted track", "direct": "direct fastening"}, "ballast"),
                        Field("alpha", "classification factor α", "1", more=True, range=OF_ALPHA),
                        Field("load-spread", "sleeper spacing", "", ("m",), optional=True, more=True,
                              hint="each axle force acts on three sleepers"),
                        flag("careful", "carefully maintained track", more=True))),
                    ("analysis", (
                        flag("always", "dynamic analysis in any case", more=True),
                        flag("additional-damping", "additional damping", more=True),
                        flag("complex", "no simple structure: skew, flexible supports, torsion", more=True),
                        Field("torsional-frequency", "first natural frequency of torsion", "", ("Hz",), optional=True,
                              more=True),
                        Field("GJ", "torsional stiffness GJ", "", EI, optional=True, more=True, hint="instead of this frequency"),
                        Field("polar-inertia", "polar moment of inertia per length", "", ("t m", "kg m"), optional=True,
                              more=True, hint="with GJ"),
                        Field("eccentricity", "track beside the axis", "", ("m",), optional=True, more=True,
                              hint="with GJ: the bridge twists"),
                        chosen("tracks", "tracks", {"1": "one", "2": "two"}, "1", more=True,
                               hint="two: load models stand on both"),
                        text("hslm-b", "N, d of HSLM-B", more=True, hint="simple spans below 7 m: from its chart"))),
                    ("title page of the report", tuple(
                        text(f"report-{name}", words, more=True) for name, words in (
                            ("project", "project"), ("structure", "structure"), ("author", "prepared by"),
                            ("checker", "checked by"))))), "Check")


def sweep():
    trains = {HSLM: "trains A1 to A10 of HSLM", **vehicles()}
    return Form("sweep", "Speeds", "Computes a train at many speeds: the curves over the speed show resonance, and are "
                "compared with the limits of EN 1990. Deflections, rotations and deck accelerations are judged with the "
                "factor 1 + φ″ for track defects, EN 1991-2 6.4.6.4, at the highest speed.", (
                    bridge(), ("train", (*coaches(trains, HSLM), *speeds("150", "300", "5")))), "Compute")


def find():
    return Form("find", "Least stiffness", "Finds the least bending stiffness with which the bridge keeps a limit under the "
                "trains HSLM. Deflections, rotations and deck accelerations are judged with the factor 1 + φ″ for track "
                "defects, EN 1991-2 6.4.6.4, at the highest speed and the EI that was found.", (
                    bridge(searched=True),
                    ("search", (
                        Field("find_between.from", "least EI of the search", "100", EI, range=OF_EI),
                        Field("find_between.to", "greatest EI of the search", "500", EI, range=OF_EI),
                        chosen("find_keep", "limit", {"deck_acceleration": "vertical acceleration of the deck",
                                                      "deflection_over_span": "deflection over span length",
                                                      "end_rotation": "end rotation", "": "all limits"}, "deck_acceleration"))),
                    ("train", speeds("100", "300", "2", "halved if a peak between two speeds exceeds the limit"))), "Find")


def rough():
    spectra = {"german_low": "German railways, low disturbance", "german_high": "German railways, high disturbance",
               "fra_6": "FRA, class 6", "fra_4": "FRA, class 4", "iso8608_A": "road, ISO 8608 class A",
               "iso8608_C": "road, ISO 8608 class C"}
    return Form("rough", "Rough track", "Computes a train on many random tracks: mean and quantiles of deflections, "
                "accelerations and wheel forces.", (
                    bridge("25", "30", "15"),
                    ("train", (*coaches(vehicles(), "velaro", "2"), Field("train_speed", "speed", "250", SPEED, range=OF_TRAINS))),
                    ("track", (
                        chosen("track_profile", "roughness", spectra, "german_low"),
                        Field("study_vary_track_seed", "number of random tracks", "20", range=OF_TRACKS),
                        Field("track_wavelengths.from", "shortest wave", "", ("m",), optional=True, more=True),
                        Field("track_wavelengths.to", "longest wave", "", ("m",), optional=True, more=True)))), "Compute")


def crane():
    return Form("crane", "Crane", "The trolley of an overhead crane hoists a load, travels along its girder and stops: "
                "deflection of the girder, wheel forces, force and sway of the ropes.", (
                    ("girder", (
                        Field("beam_spans", "span", "22", ("m",)),
                        Field("beam_EI", "bending stiffness EI", "1600", ("MN m2", "GN m2", "kN m2")),
                        Field("beam_mass", "mass per length", "700", ("kg/m", "t/m")),
                        Field("beam_damping_ratios", "damping ratio", "1", ("%",)))),
                    ("trolley", (
                        Field("vehicle_trolley_load_mass", "mass of the load", "10", ("t", "kg"), range=POSITIVE),
                        Field("vehicle_trolley_trolley_mass", "mass of the trolley", "3", ("t", "kg")),
                        Field("vehicle_trolley_front_fall", "length of the ropes", "8", ("m",), range=POSITIVE),
                        Field("vehicle_trolley_front_fall_winding_table", "height of hoisting", "2", ("m",),
                              hint="0: the load hangs"))),
                    ("travel", (
                        Field("train_positions", "place of the trolley at the start", "5", ("m",),
                              hint="from the left end of the girder"),
                        Field("train_speed_file.way", "way", "11.9", ("m",)),
                        Field("train_speed_file.speed", "speed", "72", ("m/min", "m/s"), range=POSITIVE),
                        Field("train_speed_file.time", "time of accelerating and of braking", "4.9", ("s",), range=POSITIVE),
                        Field("ts_max_time", "time after the stop", "5", ("s",), more=True, range=POSITIVE)))), "Compute")


def own():
    return Form("scene", "Own scene", "Any scene in YAML, with its tables; the guide describes all options.", (), "Compute")


@functools.cache
def forms():
    return {form.name: form for form in (check(), sweep(), find(), rough(), crane(), own())}
