#!/usr/bin/python3
"""How near the times come that -describe estimates, over the processor time that runs have taken beyond their start.
/usr/bin/python3 benchmarks/check_estimates.py [BUILD_FOLDER] [OUT_FOLDER] [SCENE...] [--smallest]

SCENE is the name of a file of options/scenes, such as r3_sprung_mass; left out: all but the longest one. Writes
check_estimates.csv to OUT_FOLDER.
"""

import glob
import os
import re
import resource
import subprocess
import tempfile

import runs

LEFT_OUT = {"danyang_kunshan"}
UNITS = {"ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0}


def seconds_in(text):
    """Of "2 min 05 s" and the like at the start of a text."""
    total = 0.0
    for number, unit in re.findall(r"([\d.]+) (ms|s|min|h)\b", re.match(r"about ((?:[\d.]+ (?:ms|s|min|h) ?)+)", text)[1]):
        total += float(number) * UNITS[unit]
    return total


def run(build, scene, folder, *words):
    """What a run says, and its processor time in s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    command = [os.path.abspath(runs.traverse(build)), "-options_file", runs.scene(scene), *words]
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder, check=True, env=runs.environment())
    return done.stdout, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def all_scenes():
    names = (os.path.splitext(os.path.basename(path))[0] for path in sorted(glob.glob(runs.scene("*"))))
    return [name for name in names if name not in LEFT_OUT]


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("scenes", nargs="*", metavar="SCENE")
    given = runs.given(arguments)
    scenes = ["r3_sprung_mass"] if given.smallest else given.scenes or all_scenes()
    near, table = {3: 0, 10: 0}, []
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            said, start = run(given.build, scene, folder, "-describe")
            estimates = re.findall(r"^  (?:trial runs|time) +(about .*)$", said, re.MULTILINE)
            if not estimates:
                continue
            estimate = sum(map(seconds_in, estimates))
            taken = max(run(given.build, scene, folder)[1] - start, 0.01)
            table.append([scene, estimate, taken])
            for factor in near:
                near[factor] += 1 / factor <= estimate / taken <= factor
            print(f"{scene:32}{estimate:10.3g} s{taken:10.3g} s{estimate / taken:10.2g}", flush=True)
    for factor, count in near.items():
        print(f"within a factor of {factor}: {count} of {len(table)}")
    runs.write_table(os.path.join(given.out, "check_estimates.csv"), ["scene", "estimate, s", "taken, s"], table)


if __name__ == "__main__":
    main()
