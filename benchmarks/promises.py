#!/usr/bin/python3
"""Whether -accuracy keeps its promise: scenes at several accuracies, each against a run that is refined until it settles.
/usr/bin/python3 benchmarks/promises.py [BUILD_FOLDER] [OUT_FOLDER] [--quick] [--drawn FIRST LAST | --late] [--finest]
    [--smallest] [--low-passed]

Twenty-nine written scenes, or with --drawn those drawn at random with these numbers, or with --late ten that change their
nature late in the run; --finest adds an accuracy of 1e-5, --quick takes four scenes at 1e-2 and 1e-3, --smallest two scenes at 1e-2, --low-passed asks every scene for the
low-passed acceleration instead of the acceleration.
Prints, for every scene and accuracy, the largest true error of what is promised over the accuracy, what is not promised,
and the seconds of the trial runs, the time loop and the process (two scenes run at once). Writes promises.csv.

The reference is refined, step and mesh together, until what it says changes by less than a quarter of the accuracy; a
quantity whose reference does not get there is left out at that accuracy and counted as not judged.
"""

import csv
import os
import re
import tempfile
from concurrent.futures import ThreadPoolExecutor

import h5py
import runs
from scene_texts import beam, car, coaches, drawn, with_stop

# Their names in the summary, and of their expected errors.
QUANTITIES = {"deflection": ("deflection", "deflection"), "acceleration": ("acceleration", "acceleration"),
              "moment": ("moment", "moment"), "wheel force": ("greatest_wheel_force", "wheel_force"),
              "low-passed": ("acceleration_lowpass", "acceleration_lowpass")}
OF_LOW_PASSED = "accuracy_of: [deflection, moment, wheel_force, acceleration_lowpass]\n"
SIMPLE, FIVE = "[pinned, roller]", "[pinned, roller, roller, roller, roller]"
VEHICLES = os.path.join(runs.ROOT, "options", "vehicles")
SCENES = {
    "coach, 32 m": beam(32.0, 2.5e11, 3e4, SIMPLE, 0.02) + coaches("velaro", 1, 70.0) + "scene: {tail: 0.5}\n",
    "two coaches, three spans": beam([40.0, 50.0, 40.0], 4e11, 2.5e4, "[pinned, roller, roller, roller]", 0.01)
    + coaches("s300", 2, 55.0),
    "coach, undamped": beam(20.0, 2e10, 1.2e4, SIMPLE) + coaches("manchester", 1, 40.0),
    "truck": beam(30.0, 1.2e10, 9e3, SIMPLE, 0.03) + car("linear", 4e6, 18e3, 1200.0, 1.8e6, 2e4, 25.0),
    "heavy, clamped": beam(15.0, 5e9, 4e3, "[clamped, roller]", [0.02, 0.03])
    + car("hertz", 5e10, 25e3, 2e3, 3e6, 5e4, 50.0, -3.0),
    "fast": beam(40.0, 6e10, 8e3, SIMPLE, 0.01) + car("hertz", 3.6e10, 12e3, 1500.0, 1.2e6, 2e4, 110.0, -5.0)
    + "scene: {tail: 1.0}\n",
    "two spans, undamped": beam([25.0, 25.0], 1e10, 3e3, "[pinned, roller, roller]")
    + car("linear", 1e8, 1e4, 1e3, 2e6, 1e4, 35.0),
    "eight forces": beam([30.0, 36.0, 30.0], 2e10, 1e4, "[pinned, roller, roller, roller]", 0.02)
    + "load:\n  forces: 2.0e5*8\n  positions: [0,-3,-11,-14,-22,-25,-33,-36]\n  speed: 60.0\nscene: {tail: 0.5}\n",
    "spans apart": beam("25.0*6", 1.5e11, 2e4, "roller*7", 0.025, "  continuity: simply_supported\n")
    + coaches("velaro", 3, 80.0),
    "bed": beam(60.0, 1.3e7, 120.0, "free", 0.02) + "foundation:\n  vertical_bed: {k: 4.0e7, c: 3.0e4}\n"
    + car("hertz", 9e10, 12e3, 900.0, 1.2e6, 2e4, 50.0, 10.0) + "ts: {max_time: 0.8}\n",
    "bump": beam(30.0, 1.2e10, 9e3, SIMPLE, 0.02) + car("linear", 4e6, 18e3, 1200.0, 1.8e6, 2e4, 20.0, -5.0)
    + "track:\n  profile: bump\n  bump: {start: 10.0, length: 1.5, height: 0.01}\n",
    "short and slow": beam(12.0, 1e9, 5e3, SIMPLE, 0.05) + car("hertz", 2e10, 8e3, 500.0, 1e6, 1e4, 15.0, -1.0),
    "rough road": beam(40.0, 4e10, 9e3, SIMPLE, 0.02) + car("linear", 5e6, 16e3, 1100.0, 1.5e6, 2e4, 22.0, -6.0)
    + "track: {profile: iso8608_B}\n",
    "very slow": beam(20.0, 8e9, 5e3, SIMPLE, 0.02) + car("hertz", 3e10, 12e3, 1e3, 1.5e6, 2e4, 2.0),
    "own weight": beam([30.0, 30.0], 2e10, 8e3, "[pinned, roller, roller]", 0.02, "  self_weight: true\n")
    + coaches("manchester", 2, 45.0) + "scene: {tail: 2.0}\n",
    "hinge": beam([25.0, 30.0, 25.0], 3e10, 9e3, "[pinned, roller, roller, roller]", 0.03, "  hinges: [32.0]\n")
    + car("linear", 6e6, 2e4, 1500.0, 2e6, 3e4, 30.0, -2.0),
    "starts on the bridge": beam(35.0, 3e10, 9e3, "[clamped, clamped]", [0.01, 0.02])
    + car("hertz", 3e10, 15e3, 1200.0, 1.5e6, 2e4, 40.0, 10.0),
    "springs below": beam(60.0, 2e10, 6e3, SIMPLE, 0.02)
    + "foundation:\n  vertical: {x: [20.0, 40.0], k: 2.0e7, c: 1.0e5}\n"
    + car("hertz", 3e10, 15e3, 1200.0, 1.5e6, 2e4, 35.0, -2.0),
    "light wheel": beam(25.0, 1e10, 6e3, SIMPLE, 0.02) + car("linear", 1e9, 9e3, 50.0, 1.5e6, 2e4, 25.0, -2.0),
    "HSLM-A3": beam(20.0, 1.5e10, 1e4, SIMPLE, 0.01) + "load: {hslm_a: 3, speed: 60.0}\n",
    "eight coaches": beam([30.0, 30.0], 2e11, 2.5e4, "[pinned, roller, roller]", 0.015) + coaches("velaro", 8, 90.0),
    "stiff contact": beam(25.0, 8.3e9, 2303.0, SIMPLE, 0.02) + car("linear", 1.6e9, 5750.0, 1e3, 1.6e6, 1e4, 27.8),
    # What comes late in the run and is unlike all before.
    "late bump": beam([30.0] * 4, 2e11, 2e4, FIVE, 0.01) + car("hertz", 3.6e10, 12e3, 1500.0, 1.2e6, 2e4, 60.0)
    + "track:\n  profile: bump\n  bump: {start: 100.0, length: 2.0, height: 0.012}\n",
    "late stiff coach": beam([30.0] * 4, 2e11, 2e4, FIVE, 0.01)
    + coaches("velaro", 5, 70.0).replace("train:", f"  other: {{file: {VEHICLES}/y25_wagon.yml}}\ntrain:").replace(
        "coach*5", "[coach, coach, coach, coach, other]"),
    "short span first": beam([12.0, 40.0, 40.0, 40.0], 2e11, 2e4, FIVE, 0.01) + coaches("velaro", 2, 70.0),
    "late prop": beam([30.0] * 4, 2e10, 1e4, FIVE, 0.02)
    + "foundation:\n  vertical: {x: 105.0, k: 2.0e8, c: 1.0e5, one_sided: true}\n"
    + car("hertz", 3e10, 15e3, 1200.0, 1.5e6, 2e4, 45.0, -2.0),
    # The acceleration that counts, instead of all of it.
    "low-passed, undamped": beam(25.0, 8.323e9, 2303.0, SIMPLE)
    + car("hertz", 3.643e10, 5750.0, 1e3, 1.595e6, 0.0, 27.8) + "scene: {tail: 0.5}\n" + OF_LOW_PASSED,
    "low-passed, coaches": beam([30.0, 36.0], 3e11, 2.5e4, "[pinned, roller, roller]", 0.02)
    + coaches("velaro", 3, 70.0) + "scene: {tail: 0.5}\n" + OF_LOW_PASSED,
    "low-passed, bump": beam(30.0, 1.2e10, 9e3, SIMPLE, 0.02)
    + car("linear", 4e6, 18e3, 1200.0, 1.8e6, 2e4, 20.0, -5.0)
    + "track:\n  profile: bump\n  bump: {start: 10.0, length: 1.5, height: 0.01}\nscene: {tail: 0.3}\n" + OF_LOW_PASSED,
}
RESONANT = beam(30.0, 8e10, 2e4, SIMPLE, 0.005)  # with coaches of 25.835 m at 90.2 m/s, forces 25 m apart at 87.3 m/s
SIX, SEVEN, TEN = [beam(f"30.0*{count}", 2e11, 2e4, f"roller*{count + 1}", 0.01, "  continuity: simply_supported\n")
                   for count in (6, 7, 10)]
FORCES = "load:\n  forces: 3.0e5*12\n  positions: [" + ", ".join(str(-25.0 * i) for i in range(12)) + "]\n  speed: 87.3\n"
# What the beginning of a run does not show: supports and stops that are touched late, resonance, wheels that go on
# striking.
LATE = {
    "gap at resonance": RESONANT
    + "foundation:\n  vertical: {x: 15.0, k: 2.0e8, c: 1.0e5, gap: 5.0e-3, one_sided: true}\n" + coaches("velaro", 8, 90.2),
    "gap at resonance, forces": RESONANT
    + "foundation:\n  vertical: {x: 7.5, k: 2.0e10, gap: 4.0e-3, one_sided: true}\n" + FORCES,
    "bed with a gap": RESONANT + "foundation:\n  vertical_bed: {k: 2.0e9, gap: 5.0e-3, one_sided: true}\n" + FORCES,
    "cubic spring": RESONANT + "foundation:\n  vertical: {x: 15.0, k: 1.0e6, cubic: 1.0e13}\n" + coaches("velaro", 8, 90.2),
    "stop on a rough track": SIX
    + with_stop(car("hertz", 3e10, 15e3, 1200.0, 1.5e6, 2e4, 50.0), 2e8, 0.107)
    + "track: {profile: german_low, seed: 1}\n",
    "stop that strikes": TEN + with_stop(car("hertz", 3.6e10, 12e3, 1500.0, 6e5, 1e4, 60.0), 2e7, 0.012)
    + "track: {profile: german_high, seed: 4}\n",
    "wheels that go on striking": SEVEN + car("hertz", 3e10, 15e3, 1200.0, 1.5e6, 2e4, 80.0)
    + "track: {profile: german_high, seed: 4}\n",
    "wagon on a rough track": SIX + coaches("y25_wagon", 1, 33.0) + "track: {profile: german_high, seed: 2}\n",
    "heavy axle last": beam([30.0] * 3, 2e11, 2e4, "[pinned, roller, roller, roller]", 0.01)
    + "load:\n  forces: [1e5, 1e5, 1e5, 1e5, 1e5, 1e5, 1e5, 1e6]\n  positions: [0, -18, -36, -54, -72, -90, -108, -111]\n"
      "  speed: 80\nscene: {tail: 1}\n",
    "uplift": beam([30.0] * 3, 2e10, 2e3, "free*4", 0.005)
    + "foundation:\n  vertical: {x: [0.0, 30.0, 60.0, 90.0], k: 2.0e8, c: 1.0e5, one_sided: true}\n"
      "load:\n  forces: 1.0e5*6\n  positions: [0, -20, -40, -60, -80, -100]\n  speed: 50\nscene: {tail: 2.0}\n",
}
REFERENCE = (50, 4e-4)  # elements in the longest span and s, halved
ON_BED, WITH_HINGE = 300, 25
MOST_HALVINGS, LONGEST = 6, 30.0  # s of a reference's time loop
JUDGED = 0.25                     # of the accuracy may be in doubt


def peaks(run):
    with h5py.File(run.file) as results:
        values = results["summary"].attrs
        promised = {q: f"expected_error_{error}" in values for q, (_, error) in QUANTITIES.items()}
        wanted = [q for q in QUANTITIES if q != "acceleration" or QUANTITIES["low-passed"][0] not in values]
        return {q: abs(float(values[QUANTITIES[q][0]])) for q in wanted if QUANTITIES[q][0] in values}, promised


def frequency(run):
    """The option that names the frequency of the run's low pass: of a fine mesh it is not computed."""
    with h5py.File(run.file) as results:
        found = results["summary"].attrs.get("acceleration_lowpass_frequency")
        return {} if found is None else {"output_lowpass": float(found)}


def reference(build, name, scene, results, doubt, longest):
    """Peaks, and how far off each may be: what halving step and elements once more has changed."""
    elements, step = REFERENCE
    elements = {"bed": ON_BED, "hinge": WITH_HINGE}.get(name, elements)
    before, counting = None, {}
    for _ in range(MOST_HALVINGS):
        run = runs.Run(build, {"options_file": scene, "ts_dt": step, "beam_elements_per_span": elements,
                               "step_probes": "true"} | counting, results)
        found, _ = peaks(run)
        counting = frequency(run)
        off = {q: abs(before[q] / p - 1.0) if before and p > 0.0 else 1.0 for q, p in found.items()}
        if max(off.values()) < doubt or 4.0 * run.seconds > longest:
            break
        before, elements, step = found, 2 * elements, 0.5 * step
    return found, off


def judge(build, name, text, accuracies, longest=LONGEST):
    """Lines of the table; longest: s of a reference's time loop."""
    with tempfile.TemporaryDirectory() as folder:
        scene, results = os.path.join(folder, "scene.yml"), os.path.join(folder, "run.h5")
        with open(scene, "w") as file:
            file.write(text)
        truth, doubt = reference(build, name, scene, results, JUDGED * accuracies[-1], longest)
        rows = []
        for accuracy in accuracies:
            run = runs.Run(build, {"options_file": scene, "accuracy": accuracy}, results)
            found, promised = peaks(run)
            errors = {q: abs(found[q] / p - 1.0) for q, p in truth.items() if p > 0.0 and q in found}
            certain = [q for q in errors if doubt[q] <= JUDGED * accuracy]
            judged = [q for q in certain if promised[q]]
            small = [q for q in certain if errors[q] < 0.5 * accuracy]
            trials = re.search(r"accuracy \S+: (.*?);.*trial runs took (\S+) s", run.text)
            rows.append({
                "scene": name, "accuracy": accuracy, "worst": max((errors[q] / accuracy for q in judged), default=0.0),
                "of": max(judged, key=lambda q: errors[q], default=""), "judged": len(judged),
                "not promised": [q for q in errors if not promised[q]],
                "in doubt": [q for q in errors if promised[q] and q not in judged],
                "small": len(small), "small but refused": [q for q in small if not promised[q]],
                "trials": float(trials[2]) if trials else 0.0, "loop": run.seconds, "process": run.process_seconds,
                "chosen": trials[1] if trials else ""} | errors)
        return rows


def show(row):
    notes = [f"error not estimated: {', '.join(row['not promised'])}"] if row["not promised"] else []
    notes += [f"in doubt: {', '.join(row['in doubt'])}"] if row["in doubt"] else []
    print(f"{row['scene']:42}{row['accuracy']:7.0e}{row['worst']:8.2f} {row['of']:13}{row['trials']:8.2f}{row['loop']:8.2f}"
          f"{row['process']:8.2f}  {row['chosen']}; {'; '.join(notes)}", flush=True)


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("--quick", action="store_true", help="four scenes, accuracies of 1e-2 and 1e-3")
    arguments.add_argument("--finest", action="store_true", help="also an accuracy of 1e-5")
    arguments.add_argument("--drawn", nargs=2, type=int, metavar=("FIRST", "LAST"), help="scenes drawn at random")
    arguments.add_argument("--late", action="store_true", help="scenes that change their nature late in the run")
    arguments.add_argument("--low-passed", action="store_true", help="accelerations low-passed, in every scene")
    given = runs.given(arguments)
    accuracies = [1e-2, 1e-3] + ([] if given.quick else [1e-4]) + ([1e-5] if given.finest else [])
    scenes = [drawn(i) for i in range(given.drawn[0], given.drawn[1] + 1)] if given.drawn else list((LATE if given.late else SCENES).items())
    if given.quick:
        scenes = scenes[:4]
    longest = LONGEST
    if given.smallest:  # judged alike however slow the machine is
        accuracies, longest = [1e-2], float("inf")
        few = ["heavy axle last"] if given.late else ["truck", "low-passed, undamped"]
        scenes = [scene for scene in scenes if scene[0] in few]
    if given.low_passed:
        scenes = [(name, text if OF_LOW_PASSED in text else text + OF_LOW_PASSED) for name, text in scenes]
    print(f"{'':42}  asked  true error over it  trials    loop process  s")
    rows = []
    with ThreadPoolExecutor(2) as pool:
        for some in pool.map(lambda s: judge(given.build, *s, accuracies, longest), scenes):
            rows += some
            for row in some:
                show(row)
    judged = sorted(row["worst"] for row in rows if row["judged"])
    print(f"kept in {sum(worst <= 1.0 for worst in judged)} of {len(judged)} runs that could be judged; the median of true "
          f"errors over what was asked is {judged[len(judged) // 2]:.2g}, {sum(worst < 0.01 for worst in judged)} are more "
          f"than 100 times smaller" if judged else "no run could be judged")
    print(f"of {sum(row['small'] for row in rows)} peaks whose true error is below half of what was asked "
          f"{sum(len(row['small but refused']) for row in rows)} were not promised")
    ratios = sorted(row["trials"] / row["loop"] for row in rows if row["trials"] and row["loop"])
    if ratios:
        print(f"trial runs over the run: median {ratios[len(ratios) // 2]:.2g}, nine of ten at most "
              f"{ratios[9 * len(ratios) // 10]:.2g}")
    path = os.path.join(given.out, "promises.csv")
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]) + [q for q in QUANTITIES if q not in rows[0]], restval="")
        table.writeheader()
        table.writerows(rows)
    print(path)


if __name__ == "__main__":
    main()
