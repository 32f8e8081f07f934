#!/usr/bin/python3
"""Spoils files that the program reads at random: each has to end in a result or in one clear line.
/usr/bin/python3 benchmarks/mutations.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest] [--mutants N] [--seed SEED]
[--processes N]

One mutant in three is a copy of options/ in which one or two places of one file are changed: lines lost, doubled,
exchanged or moved, numbers replaced, names misspelt, bytes garbled, the end cut off. Small scenes are computed for a
moment, the others read and shown by -describe. The others are small files of mutated_files.py (scenes that run to their
end, studies, limits, modes, results, checkpoints), in whose binary ones bits are flipped. Wrong are signals, more than
CPU_SECONDS of the processor, a failure without exactly one line that says why, numbers that are none (nan, inf, words)
where the run takes them without a word, and other numbers at status 0 where a results file or a checkpoint was damaged.
Writes mutations.csv to OUT_FOLDER, a line for each wrong one, and keeps its files in OUT_FOLDER/mutants.
"""

import concurrent.futures
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

import mutated_files
import runs

OPTIONS = pathlib.Path(runs.ROOT) / "options"
COMPUTED = {"r1_moving_force", "r2_sprung_mass", "r4_hertz_wheel", "r6_three_spans", "r7_two_masses", "pendulum",
            "slider_crank", "bouncing_ball", "tapered_jib", "prop_with_gap", "three_span_half_car"}
A_MOMENT = ["-ts_dt", "1e-3", "-ts_max_steps", "20", "-beam_elements_per_span", "4", "-output_interval", "1e-2"]
GIVEN_AGAIN = re.compile(r"\b(?:dt|max_steps|elements_per_span|interval)\b")  # by A_MOMENT, which wins
CPU_SECONDS = 60
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?(?![\w.])")
NO_NUMBERS = ["nan", "inf", "-inf", "many", "1e999"]
NUMBERS = ["0", "-1", "1e308", "1e-308", "-1e9", "1e9", "3.5", "", "1,2,3", "1.0*1000000000", "0x10", "1e", "'1'", "[1]", "{}"]


def code_end(line):
    return line.index("#") if "#" in line else len(line)


def replace_number(generator, lines, values):
    """Whether a number outside of comments, and of what counts, was there to be replaced."""
    places = [(i, m) for i, line in enumerate(lines) if not GIVEN_AGAIN.search(line)
              for m in NUMBER.finditer(line, 0, code_end(line))]
    if not places:
        return False
    i, match = generator.choice(places)
    lines[i] = lines[i][:match.start()] + generator.choice(values) + lines[i][match.end():]
    return True


def garble(generator, text):
    at, byte = generator.randrange(len(text) + 1), bytes([generator.randrange(256)])
    return text[:at] + byte + text[at + generator.randrange(2):]


def misspell(generator, lines):
    i = generator.randrange(len(lines))
    words = list(re.finditer(r"[A-Za-z_]{3,}", lines[i][:code_end(lines[i])]))
    if words:
        word = generator.choice(words)
        at = generator.randrange(word.start(), word.end())
        lines[i] = lines[i][:at] + generator.choice("axz_") + lines[i][at + generator.randrange(2):]


def move_lines(generator, lines):
    i, j = generator.randrange(len(lines)), generator.randrange(len(lines))
    kind = generator.randrange(5)
    if kind == 0:
        del lines[i]
    elif kind == 1:
        lines.insert(j, lines[i])
    elif kind == 2:
        lines[i], lines[j] = lines[j], lines[i]
    elif kind == 3:
        lines[i] = generator.choice(["  ", "\t", "- ", ""]) + lines[i].lstrip()
    else:
        lines[i] = lines[i][:generator.randrange(len(lines[i]) + 1)]


def spoil(generator, text):
    """The changed bytes, and whether some number is now none."""
    lines, kind = text.decode().split("\n"), generator.randrange(10)
    if kind == 0:
        return garble(generator, text), False
    if kind == 1:
        return text[:generator.randrange(len(text))], False
    if kind <= 3 and replace_number(generator, lines, NO_NUMBERS):
        return "\n".join(lines).encode(), True
    if kind <= 6:
        replace_number(generator, lines, NUMBERS)
    elif kind == 7:
        misspell(generator, lines)
    else:
        move_lines(generator, lines)
    return "\n".join(lines).encode(), False


def files_of(scene):
    """The scene and what it names, and what those name: files of options/."""
    found, ahead = [], [scene]
    while ahead:
        file = ahead.pop()
        if file in found or not file.is_file():
            continue
        found.append(file)
        if file.suffix == ".yml":
            text = re.sub(r"#.*", "", file.read_text(encoding="utf-8"))
            names = re.findall(r"[\w./-]+\.(?:yml|csv)", text)
            ahead += [(file.parent / name).resolve() for name in names]
    return [file for file in found if file.is_relative_to(OPTIONS)]


def limit():
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS + 1))


def wrong(run, no_number):
    """What is wrong with it; empty where nothing is."""
    said = [line for line in run.stderr.decode(errors="replace").splitlines() if line.strip()]
    if run.returncode < 0 or run.returncode > 127:
        return f"signal, status {run.returncode}"
    if run.returncode == 0:
        return "a number that is none was taken" if no_number else ""
    return "" if len(said) == 1 and said[0].startswith("traverse: ") else f"{len(said)} lines: {' / '.join(said)[:300]}"


def keep(kept, file, name):
    kept.mkdir(parents=True, exist_ok=True)
    shutil.copy(file, kept / name)


def small_mutant(program, prepared, name, seed, kept):
    """Of one of mutated_files.KINDS. What is wrong, or nothing."""
    with tempfile.TemporaryDirectory() as folder:
        how = {"env": runs.environment(), "preexec_fn": limit}
        run, no_number, file, silence = mutated_files.mutant(program, prepared, name, random.Random(seed), spoil, folder, how)
        found = wrong(run, no_number) or silence
        if found:
            keep(kept, file, f"{seed}_{name.replace(' ', '_')}_{file.name}")
        return found


def mutant(build, scene, file, seed, kept):
    """Makes it, runs it, and keeps it where it ends wrongly. What is wrong, or nothing."""
    generator = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        options = pathlib.Path(folder) / "options"
        shutil.copytree(OPTIONS, options)
        place = options / file.relative_to(OPTIONS)
        changed, no_number = spoil(generator, place.read_bytes())
        place.write_bytes(changed)
        words = A_MOMENT if scene.stem in COMPUTED else ["-describe"]
        run = subprocess.run([os.path.abspath(runs.traverse(build)), "-options_file", options / scene.relative_to(OPTIONS), "-output_file",
                              "none", *words], cwd=folder, env=runs.environment(), capture_output=True, preexec_fn=limit)
        found = wrong(run, no_number)
        if found:
            keep(kept, place, f"{seed}_{scene.stem}_{place.name}")
        return found


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("--mutants", type=int, default=4000, metavar="N", help="how many; left out: 4,000")
    arguments.add_argument("--seed", type=int, default=1, metavar="SEED", help="of the first mutant; left out: 1")
    arguments.add_argument("--processes", type=int, default=os.cpu_count(), metavar="N",
                           help="at a time; left out: one for each processor")
    given = runs.given(arguments)
    count = 24 if given.smallest else given.mutants
    scenes = {scene: files_of(scene) for scene in sorted((OPTIONS / "scenes").glob("*.yml"))}
    kept, rows, program = pathlib.Path(given.out) / "mutants", [], os.path.abspath(runs.traverse(given.build))
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(given.processes) as pool:
        prepared, jobs = mutated_files.prepare(program, folder, {"env": runs.environment()}), {}
        for seed in range(given.seed, given.seed + count):
            generator = random.Random(-seed)
            if seed % 3 != 0:
                name = generator.choice(list(mutated_files.KINDS))
                jobs[pool.submit(small_mutant, program, prepared, name, seed, kept)] = (seed, name, "")
                continue
            scene = generator.choice(list(scenes))
            file = generator.choice(scenes[scene])
            jobs[pool.submit(mutant, given.build, scene, file, seed, kept)] = (seed, scene.stem, file.name)
        for done, job in enumerate(concurrent.futures.as_completed(jobs), 1):
            if done % 500 == 0:
                print(f"{done} of {count}", flush=True)
            if job.result():
                rows.append([*jobs[job], job.result()])
                print(": ".join(map(str, rows[-1])), flush=True)
    runs.write_table(os.path.join(given.out, "mutations.csv"), ["seed", "scene", "file", "what is wrong"], sorted(rows))
    print(f"{count - len(rows)} of {count} mutants ended in a result or in one clear line")
    sys.exit(1 if rows else 0)


if __name__ == "__main__":
    main()
