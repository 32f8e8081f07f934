"""Files that mutations.py spoils besides those of options/: small ones, which are run to their end.

Each kind has the files it begins with, the command that reads them, and what tells whether the numbers that came out at
status 0 are still those of the files as they were, where they have to be.
"""

import pathlib
import shutil
import subprocess
from typing import Callable, NamedTuple

import h5py
import numpy as np

BEAM = """beam:
  spans: [20.0, 15.0]
  EI: 5.0e9
  mass: 8.0e3
  elements_per_span: 4
  damping_ratios: 0.01
support: {types: [pinned, roller, roller]}
"""
FORCES = BEAM + """load:
  forces: [1.0e5, 8.0e4]
  positions: [0.0, -3.0]
  speed: 40.0
output: {interval: 0.01, probes: [10.0, 27.5]}
ts: {dt: 5.0e-3}
"""
TRAIN = BEAM + """vehicle:
  wagon:
    bodies: [body, axle]
    joints: [guide]
    springs: [suspension]
    wheels: [wheel]
    drivers: [level]
    body: {mass: 5000.0, inertia: 100.0, position: [0.0, 2.0]}
    axle: {mass: 1000.0, inertia: 10.0, position: [0.0, 0.5]}
    guide: {type: prismatic, bodies: [body, axle], point: [0.0, 0.5], axis: [0.0, 1.0]}
    suspension: {bodies: [body, axle], from: [0.0, 2.0], to: [0.0, 0.5], stiffness: 1.6e6, damping: 1.0e4}
    wheel: {body: axle, radius: 0.5, stiffness: 1.0e9}
    level: {body: body, coordinate: phi}
train: {vehicles: [wagon, wagon], speed: 40.0, positions: [0.0, -6.0]}
track: {profile: profile.csv}
output: {interval: 0.01}
ts: {dt: 2.0e-3}
"""
PROFILE = "# x, height\n-20, 0\n-10, 2e-4\n0, 5e-4\n10, 2e-4\n20, 0\n30, 2e-4\n40, 5e-4\n50, 2e-4\n60, 0\n"
STUDY = FORCES + """study:
  vary:
    beam_mass: [8.0e3, 9.0e3]
    load_speed: {from: 30.0, to: 50.0, count: 3}
"""
LIMITS = """- {clause: "A2.4.4.2", quantity: deck_acceleration, value: 3.5, text: ballast}
- {clause: "A2.4.4.3", quantity: deflection_over_span, value: 1/600}
- clause: "dynamic"
  quantity: amplification
  value: 2.0
"""
MODES = """# frequencies in Hz, modal masses in kg
frequency, 5.0, 20.0
modal_mass, 8.0e4, 8.0e4
damping_ratio, 0.01, 0.02
0, 0, 0
5, 0.7071, 1
10, 1, 0
15, 0.7071, -1
20, 0, 0
"""
BY_MODES = """bridge: {modes_file: modes.csv}
load: {forces: [1.0e5], speed: 40.0}
output: {probes: [10.0]}
"""
SCENE = ["-options_file", "scene.yml", "-output_file", "out.h5"]


class Kind(NamedTuple):
    files: dict            # text files by name, to begin with
    before: list           # commands that make the others
    spoiled: list          # names of those that are spoiled, one of them each time
    command: list
    numbers: str = ""      # dataset of out.h5 that must not change at status 0; empty: what was spoiled may change it


KINDS = {
    "train": Kind({"scene.yml": TRAIN, "profile.csv": PROFILE}, [], ["scene.yml", "profile.csv"], SCENE),
    "forces": Kind({"scene.yml": FORCES}, [], ["scene.yml"], SCENE),
    "study": Kind({"scene.yml": STUDY}, [], ["scene.yml"], SCENE),
    "limits": Kind({"scene.yml": FORCES, "limits.yml": LIMITS}, [], ["limits.yml"], [*SCENE, "-limits", "limits.yml"]),
    "modes": Kind({"scene.yml": BY_MODES, "modes.csv": MODES}, [], ["modes.csv"], SCENE),
    "modes in HDF5": Kind({"scene.yml": BY_MODES.replace("csv", "h5"), "made.yml": FORCES},
                          [["-options_file", "made.yml", "-output_file", "modes.h5", "-scene_analysis", "modes",
                            "-modes_count", "3"]], ["modes.h5"], SCENE),
    "results": Kind({"scene.yml": FORCES}, [["-options_file", "scene.yml", "-output_file", "r.h5"]], ["r.h5"],
                    ["r.h5", "-output_file", "out.h5"], "probes/deflection"),
    "resumed study": Kind({"scene.yml": STUDY}, [SCENE], ["out.h5"], [*SCENE, "-study_resume"], "study/peak_deflection"),
    "checkpoint": Kind({"scene.yml": FORCES},
                       [["-options_file", "scene.yml", "-output_file", "r.h5", "-ts_max_steps", "60"]],
                       ["r.h5", "r.h5.checkpoint"], [*SCENE, "-restart", "r.h5.checkpoint"], "probes/deflection"),
}


def start(program, folder, words, **how):
    return subprocess.run([program, *words], cwd=folder, capture_output=True, **how)


class Prepared(NamedTuple):
    folder: pathlib.Path   # with the files as they are before they are spoiled
    numbers: object        # of the command that reads them then; None: they may change


def numbers_of(kind, folder):
    if not kind.numbers:
        return None
    with h5py.File(folder / "out.h5") as file:
        return file[kind.numbers][()]


def prepare(program, folder, how):
    """Makes the files of every kind, and runs each as it is. Name -> Prepared."""
    prepared = {}
    for name, kind in KINDS.items():
        place, tried = pathlib.Path(folder) / name, pathlib.Path(folder) / f"{name} tried"
        place.mkdir()
        for file, text in kind.files.items():
            (place / file).write_text(text, encoding="utf-8")
        for words in kind.before:
            start(program, place, words, check=True, **how)
        shutil.copytree(place, tried)
        start(program, tried, kind.command, check=True, **how)
        prepared[name] = Prepared(place, numbers_of(kind, tried))
    return prepared


def spoil_bytes(generator, content):
    """One bit flipped, or a few bytes of another value, or the end cut off."""
    content, kind = bytearray(content), generator.randrange(8)
    at = generator.randrange(len(content))
    if kind == 0:
        return bytes(content[:at])
    if kind == 1:
        content[at:at + 8] = generator.randbytes(8)
    elif kind == 2:
        content[at] = generator.choice([0, 0xff, 0x7f, 0x80])
    else:
        content[at] ^= 1 << generator.randrange(8)
    return bytes(content)


def mutant(program, prepared, name, generator, spoil_text: Callable, folder, how):
    """The run of a spoiled copy, whether some number is now none, the spoiled file, and "" or what it was silent of."""
    kind, place = KINDS[name], pathlib.Path(folder) / "mutant"
    shutil.copytree(prepared[name].folder, place)
    file = place / generator.choice(kind.spoiled)
    content, no_number = file.read_bytes(), False
    if file.suffix in (".yml", ".csv"):
        content, no_number = spoil_text(generator, content)
    else:
        content = spoil_bytes(generator, content)
    file.write_bytes(content)
    run, silence = start(program, place, kind.command, **how), ""
    if run.returncode == 0 and kind.numbers:
        try:
            same = np.array_equal(numbers_of(kind, place), prepared[name].numbers, equal_nan=True)
        except (OSError, KeyError):
            same = False
        silence = "" if same else "other numbers without a word"
    return run, no_number, file, silence
