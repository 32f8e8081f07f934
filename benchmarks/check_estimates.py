#!/usr/bin/python3
"""How near the times come that -check estimates: check_estimates.py [SCENE...] runs scenes of options/scenes (all but the longest
one) with and without -check and prints the estimate over the processor time that the run has taken beyond its start."""

import pathlib
import re
import resource
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parents[1]
PROGRAM = HERE / "build/traverse"
LEFT_OUT = {"danyang_kunshan"}
UNITS = {"ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0}


def seconds_in(text):
    """Of "2 min 05 s" and the like at the start of a text."""
    total = 0.0
    for number, unit in re.findall(r"([\d.]+) (ms|s|min|h)\b", re.match(r"about ((?:[\d.]+ (?:ms|s|min|h) ?)+)", text)[1]):
        total += float(number) * UNITS[unit]
    return total


def run(scene, folder, *words):
    """What a run says, and its processor time in s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([PROGRAM, "-options_file", scene, *words], capture_output=True, text=True, cwd=folder, check=True)
    return done.stdout, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def main():
    scenes = [pathlib.Path(name).resolve() for name in sys.argv[1:]] or [
        path for path in sorted((HERE / "options/scenes").glob("*.yml")) if path.stem not in LEFT_OUT]
    near, counted = {3: 0, 10: 0}, 0
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            said, start = run(scene, folder, "-check")
            estimates = re.findall(r"^  (?:trial runs|time) +(about .*)$", said, re.MULTILINE)
            if not estimates:
                continue
            estimate = sum(map(seconds_in, estimates))
            taken = max(run(scene, folder)[1] - start, 0.01)
            counted += 1
            for factor in near:
                near[factor] += 1 / factor <= estimate / taken <= factor
            print(f"{scene.stem:32}{estimate:10.3g} s{taken:10.3g} s{estimate / taken:10.2g}", flush=True)
    for factor, count in near.items():
        print(f"within a factor of {factor}: {count} of {counted}")


if __name__ == "__main__":
    main()
