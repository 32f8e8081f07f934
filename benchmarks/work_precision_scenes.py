"""The ways and the scenes of work_precision.py: integrators, fixed and adaptive, by elements and by modes."""

import os
import re
from dataclasses import dataclass, field

import runs

FIXED = {
    "esdirk4": {},
    "genalpha": {"ts_type": "genalpha"},
    "arkimex 3": {"ts_type": "arkimex", "ts_arkimex_type": "3"},
    "arkimex 4": {"ts_type": "arkimex", "ts_arkimex_type": "4"},
    "bdf": {"ts_type": "bdf"},
}
ADAPTIVE = {  # by tolerances, from the scene's longest step on
    "esdirk4, ladder": {"ts_adapt_type": "ladder"},
    "arkimex 4, adaptive": {"ts_type": "arkimex", "ts_arkimex_type": "4", "ts_adapt_type": "basic"},
}
BY_MODES = {  # of the finest mesh, with linear vehicles
    "by modes, esdirk4": {"model_vehicles": "linear"},
    "by modes, genalpha": {"model_vehicles": "linear", "ts_type": "genalpha"},
}
WAYS = FIXED | ADAPTIVE | BY_MODES
MODES = [8, 16, 32, 64]
LOOSEST, TIGHTER = 1e-2, 4.0  # tolerance, and by how much each is tighter than the one before
WANTED = [1e-2, 1e-3, 1e-4, 1e-5]


@dataclass
class Scene:
    name: str
    file: str                  # in options/scenes, without what it says of mesh, step, samples and accuracy
    step: float                # s, the longest one tried
    halvings: int              # of it
    meshes: list
    mesh: str = "beam_elements_per_span"
    denser: int = 4            # the reference's elements over the finest of these
    wanted: list = field(default_factory=lambda: WANTED)
    options: dict = field(default_factory=dict)


MOVING_MASS = """beam: {spans: 25.0, EI: 8.323e9, mass: 2303.0, damping_ratios: 0.01}
support: {types: [pinned, roller]}
vehicle:
  moving_mass:
    bodies:  [body]
    wheels:  [contact]
    drivers: [level]
    body:    {mass: 14394.0, inertia: 1.0, position: [0.0, 0.1]}
    contact: {body: body, radius: 0.1, law: linear, stiffness: 1.0e9}
    level:   {body: body, coordinate: phi}
train: {vehicles: moving_mass, positions: 0.0, speed: 59.7}
"""
WRITTEN = {"r5_moving_mass": MOVING_MASS}
LINEAR = {f"vehicle_coach_wheel_{i}_{key}": value
          for i in range(1, 5) for key, value in (("law", "linear"), ("stiffness", 1.2e9))}
TWO_COACHES = {"train_vehicles": "coach*2", "scene_tail": 0.2}
COARSE, FINE, FINEST = [4, 8, 16, 32], [8, 16, 32, 64], [8, 16, 32, 64, 128]
SCENES = [
    Scene("R1, a force", "r1_moving_force", 0.0125, 8, FINEST),
    Scene("R2, a sprung mass, linear wheel", "r2_sprung_mass", 0.04, 8, FINE),
    Scene("R3, another one", "r3_sprung_mass", 0.04, 8, FINE),
    Scene("R4, a Hertz wheel", "r4_hertz_wheel", 0.04, 8, FINE),
    Scene("R5, a mass on a stiff linear wheel", "r5_moving_mass", 0.02, 8, FINEST),
    Scene("R6, a force on three spans", "r6_three_spans", 0.025, 8, FINE),
    Scene("R7, two masses", "r7_two_masses", 0.04, 8, FINEST),
    Scene("R8, a coach on a ballasted bridge", "r8_ballasted_bridge", 0.01, 4, [1, 2], "track_elements_per_bay",
          denser=2, wanted=WANTED[:2],
          options={"train_positions": -15.8, "track_approach": 28.8, "scene_tail": 0.0}),
    Scene("two coaches on three spans", "three_span_train", 0.02, 7, COARSE,
          options=TWO_COACHES),
    Scene("the same on linear wheels", "three_span_train", 0.02, 7, COARSE,
          options=TWO_COACHES | LINEAR),
    Scene("a wheel hops over a bump", "wheel_over_a_bump", 4e-3, 8, FINE, options={"beam_damping_ratios": 0.02}),
    Scene("a coach on a rail on 100 pads", "rail_on_pads", 4e-3, 5, [200, 400, 800], denser=2, wanted=WANTED[:2],
          options={"beam_spans": 60.0, "beam_rayleigh": "0,2e-5", "foundation_vertical_x": "0.3,59.7",
                   "train_positions": 18.0, "ts_max_time": 0.25, "output_probes": "30.0,30.3"}),
]
SMALLEST = Scene("R3, a sprung mass", "r3_sprung_mass", 0.04, 3, [4, 8], wanted=[1e-2])


def speed_of(file):
    """The option that names a scene's speed, and its value there, m/s."""
    with open(file) as scene:
        text = scene.read()
    speed = float(re.search(r"\bspeed: *([0-9.]+)", text)[1])
    return ("load_speed" if re.search(r"^load:", text, flags=re.M) else "train_speed"), speed


def opened(name, folder):
    """A copy of the scene's file that leaves mesh, step, samples and accuracy open."""
    if name in WRITTEN:
        text = WRITTEN[name]
    else:
        with open(runs.scene(name)) as file:
            text = file.read()
    text = text.replace("../", os.path.join(runs.ROOT, "options", ""))
    text = re.sub(r"^( +(interval|dt|elements_per_span)|accuracy):.*\n", "", text, flags=re.M)
    text = re.sub(r"^(output|ts):.*\n(?!\s)", "", text, flags=re.M)
    path = os.path.join(folder, name + ".yml")
    with open(path, "w") as file:
        file.write(text)
    return path
