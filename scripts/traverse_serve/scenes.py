"""The scenes that the forms describe: texts that an engineer can download, change and run again."""

import math

from traverse_check import main as checking
from traverse_check import track_defects
from traverse_check.question import Question
from traverse_check.scene import Case, quoted, read_limits, rows, text_of_limits
from traverse_report.language import num, number, t

from . import inputs
from .forms import HSLM, forms

TRAINS = "hslm_a: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]"
MODEL = ("beam", "model", "vehicle", "train", "load")  # blocks of what is drawn
HEAD = "# What: {what}.\n# Source: values of the page of traverse serve.\n# Expected: no figure.\n"
MOST_SPEEDS = 10_000
STEP = 0.025  # s between rows of tables of a crane
TROLLEY = """    length: 2.8                    # m
    bodies:  [trolley, front_axle, rear_axle, load]
    joints:  [front_bearing, rear_bearing]
    springs: [front_fall, rear_fall]
    wheels:  [front_wheel, rear_wheel]
    trolley:    {{mass: {frame!r}, inertia: {inertia!r}, position: [0.0, 0.4]}}
    front_axle: {{mass: 200.0, inertia: 2.5, position: [1.0, 0.1575]}}
    rear_axle:  {{mass: 200.0, inertia: 2.5, position: [-1.0, 0.1575]}}
    load:       {{mass: {load!r}, inertia: {load_inertia!r}, position: [0.0, {low!r}]}}    # its centre is at the lower ends of the falls
    front_bearing: {{type: weld, bodies: [trolley, front_axle], point: [1.0, 0.1575]}}
    rear_bearing:  {{type: weld, bodies: [trolley, rear_axle], point: [-1.0, 0.1575]}}
    front_fall: {{bodies: [trolley, load], from: [0.6, 0.4], to: [0.6, {low!r}], {fall}}}
    rear_fall:  {{bodies: [trolley, load], from: [-0.6, 0.4], to: [-0.6, {low!r}], {fall}}}
    front_wheel: {{body: front_axle, radius: 0.1575, law: hertz, stiffness: 1.35e11}}
    rear_wheel:  {{body: rear_axle, radius: 0.1575, law: hertz, stiffness: 1.35e11}}
"""
AXLE = 1.0  # m from the middle of the trolley to its axles
STEEL = 1.75e6 * 8.0  # N, EA of a fall of overhead_crane.yml


def whole(given, name):
    """A count."""
    if given[name] != int(given[name]):
        raise inputs.InputError(t("allowed: a whole number"), name)
    return int(given[name])


def listed(values):
    return f"[{', '.join(repr(value) for value in values)}]"


def bridge(given, stiffness):
    """Blocks of a railway bridge. stiffness: N m2."""
    lines = [(f"spans: {listed(given['beam_spans'])}", "m"), (f"EI: {stiffness!r}", "N m2"),
             (f"mass: {given['beam_mass']!r}", "kg/m, with ballast and track")]
    if given["beam_continuity"] and len(given["beam_spans"]) > 1:
        lines.append(("continuity: simply_supported", ""))
    return {"beam": lines, "model": [(f"damping_bound: {given['model_damping_bound']}", "EN 1991-2, table 6.6")]}


def speeds(given):
    """The speeds at equal steps that are at most the given one, so that the highest speed is one of them."""
    first, last, step = (given[f"sweep_speed.{part}"] for part in ("from", "to", "step"))
    if first > last:
        raise inputs.InputError(t("allowed: at most the highest speed"), "sweep_speed.from")
    if last - first > MOST_SPEEDS * step:
        raise inputs.InputError(t("allowed: a step with at most {count} speeds", count=number(MOST_SPEEDS)), "sweep_speed.step")
    if first < last:
        step = (last - first) / max(1, math.ceil((last - first) / step - 1e-6))
    return f"speed: {listed((first, last, step))}", "m/s: from, to, step"


def factor_for_track(given, traverse):
    """1 + phi'' at the highest speed; of a search at its greatest EI, where the frequency and phi'' are greatest."""
    stiffness, speed = given.get("beam_EI") or given["find_between.to"], given["sweep_speed.to"]
    asked = Question(given["beam_spans"], [stiffness], [given["beam_mass"]], given["model_damping_bound"], speed,
                     simply_supported=given["beam_continuity"])
    parts = checking.parts_of(asked, Case("", "", stiffness, given["beam_mass"]), traverse)
    return track_defects.factor(parts, speed, asked.careful)


def limits(given, factor):
    """The limits of EN 1990 for what the scene has, with a factor for the effects of trains."""
    path = inputs.OPTIONS / "limits/en1990.yml"
    without = set() if given["beam_continuity"] and len(given["beam_spans"]) > 1 else {"joint_rotation"}
    if given.get("train_vehicles", HSLM) == HSLM:
        without.add("car_acceleration")
    rows = [row for row in read_limits(path) if row["quantity"] not in without]
    return text_of_limits("this page", path, track_defects.with_factor(rows, factor))


def coaches(given, speed, files, start=None):
    """Blocks of a train of vehicles of the library. start: where it begins, m."""
    name = given["train_vehicles"]
    source = (inputs.OPTIONS / "vehicles" / f"{name}.yml")
    files[source.name] = inputs.with_library(source.read_text(encoding="utf-8"), source.name, files, source.parent)
    count = whole(given, "train_vehicles.count")
    return {"vehicle": [(f"{name}: {{file: {source.name}}}", "")],
            "train": [(f"vehicles: {name}*{count}", "all equal"), (f"speed: {speed!r}", "m/s"),
                      *([(f"positions: {start!r}", "m: the roughness has its full height at the bridge")] if start else [])]}


def stations(given):
    """Probes at the quarters of each span, with the middle, m."""
    start, found = 0.0, []
    for span in given["beam_spans"]:
        found += [float(f"{start + part * span:.6g}") for part in (0.25, 0.5, 0.75)]
        start += span
    return [(f"probes: {listed(found)}", "m")]


def sweep(given, files):
    sweeping = [speeds(given)]
    if given["train_vehicles"] == HSLM:
        sweeping.append((TRAINS, "EN 1991-2, load model HSLM-A"))
        moving = {}
    else:
        moving = coaches(given, given["sweep_speed.from"], files)
    return bridge(given, given["beam_EI"]) | moving | {
        "sweep": sweeping, "scene": [("tail: 1.0", "s of free vibration")], "output": stations(given), "limits": "limits.yml"}


def find(given, files):
    between = [given["find_between.from"], given["find_between.to"]]
    if between[0] >= between[1]:
        raise inputs.InputError(t("allowed: below the greatest EI of the search"), "find_between.from")
    keep = [(f"keep: {given['find_keep']}", "")] if given["find_keep"] else []
    start = float(f"{math.sqrt(between[0] * between[1]):.6g}")
    return bridge(given, start) | {
        "sweep": [speeds(given), (TRAINS, "EN 1991-2, load model HSLM-A")], "scene": [("tail: 1.0", "s of free vibration")],
        "output": stations(given), "limits": "limits.yml",
        "find": [("option: beam_EI", "the search replaces it"), (f"between: {listed(between)}", "N m2"), *keep]}


def rough(given, files):
    waves = [given[f"track_wavelengths.{end}"] for end in ("from", "to")]
    track = [(f"profile: {given['track_profile']}", "")]
    if any(wave is not None for wave in waves):
        if None in waves:
            raise inputs.InputError(t("allowed: both lengths of waves, or none"), "track_wavelengths.from")
        if waves[0] >= waves[1]:
            raise inputs.InputError(t("allowed: below the longest wave"), "track_wavelengths.from")
        track.append((f"wavelengths: {listed(waves)}", "m"))
    return bridge(given, given["beam_EI"]) | coaches(given, given["train_speed"], files, -120.0) | {
        "track": track, "output": stations(given),
        "study": [(f"vary: {{track_seed: 1:{whole(given, 'study_vary_track_seed')}}}", "first and last seed"),
                  ("statistics: {over: track_seed, quantiles: [0.1, 0.5, 0.9]}", "0.1 for the least wheel force")],
        "accuracy": "1.0e-2"}


def crane(given, files):
    """The crane of options/scenes/overhead_crane.yml with other values."""
    start, stop = given["train_positions"], given["train_positions"] + given["train_speed_file.way"]
    for place, name in ((start, "train_positions"), (stop, "train_speed_file.way")):
        if not AXLE <= place <= given["beam_spans"] - AXLE:
            raise inputs.InputError(t("the middle of the trolley would be at {place} m; allowed: from {low} m to {high} m, with "
                                      "all wheels on the girder", place=num(place), low=num(AXLE),
                                      high=num(given["beam_spans"] - AXLE, ".6g")), name)
    load, rope, height = (given[f"vehicle_trolley_{name}"] for name in ("load_mass", "front_fall", "front_fall_winding_table"))
    if height >= rope:
        raise inputs.InputError(t("allowed: longer than the height of hoisting"), "vehicle_trolley_front_fall")
    stiffness = STEEL / rope
    free = rope - 0.5 * load * 9.81 / stiffness  # so that the load is at rest where it is drawn
    fall = f"stiffness: {stiffness!r}, damping: 3750.0, free_length: {free!r}, side: tension"
    if height != 0.0:
        files["hoist.csv"] = hoist_table(height)
        fall += ", winding_table: hoist.csv"
    frame = given["vehicle_trolley_trolley_mass"] - 400.0  # without both axles
    if frame <= 0.0:
        raise inputs.InputError(t("allowed: above 0.4 t, the mass of both axles"), "vehicle_trolley_trolley_mass")
    trolley = TROLLEY.format(frame=frame, inertia=frame * 1200.0 / 2600.0, load=load, load_inertia=load * 0.6667,
                             low=0.4 - rope, fall=fall)
    files["trolley_speed.csv"], end = speed_table(given)
    damping = given["beam_damping_ratios"]
    return {"beam": [(f"spans: {given['beam_spans']!r}", "m"), (f"EI: {given['beam_EI']!r}", "N m2"),
                     (f"mass: {given['beam_mass']!r}", "kg/m"), (f"damping_ratios: {listed([damping, damping])}", ""),
                     ("self_weight: true", "")],
            "vehicle": "\n  trolley:\n" + trolley.rstrip("\n"),
            "train": [("vehicles: trolley", ""), (f"positions: {given['train_positions']!r}", "m: the middle of the trolley"),
                      ("speed_file: trolley_speed.csv", "")],
            "ts": [(f"max_time: {end + given['ts_max_time']!r}", "s")],
            "output": [("interval: 0.02", "s"), (f"probes: [{0.5 * given['beam_spans']!r}]", "m")]}


def hoist_table(height):
    """Hoists from 0.5 s to 4 s, with the speed of a cosine."""
    lines = ["# t (s), change of the free length of the ropes (m)"]
    for step in range(int(5.0 / STEP) + 1):
        part = min(max((step * STEP - 0.5) / 3.5, 0.0), 1.0)
        lines.append(f"{step * STEP:.3f}, {-0.5 * height * (1.0 - math.cos(math.pi * part)):.8f}")
    return "\n".join(lines) + "\n"


def speed_table(given):
    """(text, end): the trolley starts after 5 s, s."""
    way, speed, time = (given[f"train_speed_file.{name}"] for name in ("way", "speed", "time"))
    if way < speed * time:
        raise inputs.InputError(t("allowed: at least {way} m, which accelerating and braking need", way=num(speed * time)),
                                "train_speed_file.way")
    start, at_speed = 5.0, way / speed - time
    times = [0.0, start, start + time, start + time + at_speed, start + 2.0 * time + at_speed]
    if at_speed < 1e-9:
        del times[3]
    speeds_at = [0.0, 0.0, *([speed] * (len(times) - 3)), 0.0]
    lines = [f"{t:.6f},{v!r}" for t, v in zip(times, speeds_at)]
    return "\n".join(["# t (s), speed of the trolley (m/s)", *lines]) + "\n", times[-1]


BLOCKS = {"sweep": sweep, "find": find, "rough": rough, "crane": crane}
WHAT = {"sweep": "a train on a bridge at many speeds", "find": "the least stiffness of a bridge that keeps a limit",
        "rough": "a train on a bridge with random tracks", "crane": "a crane hoists a load, travels and stops"}


def text_of(blocks):
    return "".join(f"{name}: {block}\n" if isinstance(block, str) else f"{name}:\n" + rows(*block)
                   for name, block in blocks.items())


def scene_files(name, given, language, factor):
    """{file: text} of a form, with scene.yml. factor: of the limits of effects of trains."""
    files = {}
    blocks = BLOCKS[name](given, files)
    if "limits" in blocks:
        files["limits.yml"] = limits(given, factor)
    named = [(f"name: {quoted(t(forms()[name].title))}", ""), *blocks.get("scene", ())]
    text = HEAD.format(what=WHAT[name]) + text_of(blocks | {"scene": named, "report": [(f"language: {language}", "")]})
    return {"scene.yml": text} | files


def drawn_files(name, given):
    """{file: text} of the model alone, at rest: for the drawing."""
    files = {}
    blocks = {block: rows for block, rows in BLOCKS[name](given, files).items() if block in MODEL}
    if not {"load", "train"} & set(blocks):
        blocks["load"] = [("hslm_a: 1", ""), ("speed: 50.0", "m/s")]
    return {"scene.yml": text_of(blocks)} | files


def check_file(given, language):
    """bridge.yml of traverse check: its words and the values of the form, with their units."""
    words = {name: "true" if value is True else value for name, value in given.items() if value}
    lines = [f"{name}: {quoted(value)}\n" for name, value in words.items()]
    return ("# What: the words of a check by EN 1991-2: traverse check bridge.yml\n# Source: values of the page of traverse "
            f"serve.\n# Expected: no figure.\n{''.join(lines)}report-language: {language}\n")
