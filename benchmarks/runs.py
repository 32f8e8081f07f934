"""What the benchmark scripts share: their arguments, runs of the program, how large a run was, and its peaks.

Every script takes [BUILD_FOLDER] [OUT_FOLDER] --smallest: the folder with the program (build), the folder that tables
and pictures go to (results), and whether each kind of run is made once only, at the smallest size, which takes seconds
and shows that the script works; the figures then mean nothing.
"""

import argparse
import csv
import os
import re
import resource
import statistics
import subprocess
import sys
import time

import h5py
import numpy as np

PEAKS = {"deflection": "deflection", "acceleration": "acceleration", "moment": "moment",
         "wheel force": "greatest_wheel_force"}
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def two_way_traffic(spans, pairs, apart=5000.0, pitch=15000.0):
    """Options of trains of eight coaches each way, pairs of them that start so far apart and meet, m, on separate spans."""
    options = {
        "options_file": os.path.join(ROOT, "options", "bridges", "danyang_kunshan.yml"), "beam_spans": f"32.0*{spans}",
        "beam_elements_per_span": 10, "vehicle_coach_file": os.path.join(ROOT, "options", "vehicles", "s300.yml"),
        "model_vehicles": "linear", "step_kinks": "false", "ts_dt": 0.02,
        "trains": ",".join(f"{way}_{k}" for k in range(pairs) for way in ("up", "down"))}
    for k in range(pairs):
        for way, place, speed in (("up", 5000.0 + pitch * k, 83.333333), ("down", 5000.0 + pitch * k + apart, -83.333333)):
            options |= {f"{way}_{k}_vehicles": "coach*8", f"{way}_{k}_spacing": 25.0, f"{way}_{k}_positions": place,
                        f"{way}_{k}_speed": speed}
    return options


def scene(name):
    return os.path.join(ROOT, "options", "scenes", name + ".yml")


def parser(text):
    """Of the arguments that all scripts share, and --help; a script may add its own."""
    arguments = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("build", nargs="?", default=os.path.join(ROOT, "build"), metavar="BUILD_FOLDER",
                           help="where the program is; left out: build")
    arguments.add_argument("out", nargs="?", default=os.path.join(ROOT, "results"), metavar="OUT_FOLDER",
                           help="where tables and pictures go; left out: results")
    arguments.add_argument("--smallest", action="store_true",
                           help="each kind of run once, at its smallest size: shows in seconds that the script works")
    return arguments


def given(arguments, *benchmark_programs):
    """What the command line says. The programs have to be there, and the output folder is from here on."""
    found = arguments.parse_intermixed_args()
    option = " -DTRAVERSE_BENCHMARKS=ON" if benchmark_programs else ""
    for program in [benchmark_program(found.build, name) for name in benchmark_programs] or [traverse(found.build)]:
        if not os.access(program, os.X_OK):
            sys.exit(f"{arguments.prog}: {program} is missing; build it with: cmake -B build{option} && "
                     "cmake --build build")
    os.makedirs(found.out, exist_ok=True)
    return found


def traverse(build):
    return os.path.join(build, "traverse")


def benchmark_program(build, name):
    """A program that is built only where CMake is told TRAVERSE_BENCHMARKS=ON."""
    return os.path.join(build, "benchmarks", name)


def on_ranks(ranks):
    """What stands before a command that runs on so many ranks."""
    return ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []


def environment():
    """Ours, and what Open MPI needs on one machine; scripts/setup.sh says why."""
    needed = {"OMPI_MCA_pml": "ob1", "OMPI_MCA_btl": "self,vader", "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
              "HWLOC_COMPONENTS": "-gl,-opencl", "HWLOC_HIDE_ERRORS": "2"}
    if os.geteuid() == 0:
        needed |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    return needed | os.environ


def words(options):
    return [part for name, value in options.items() for part in ("-" + name, str(value))]


def processor_seconds():
    """Of all programs that have been run and have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Failed(RuntimeError):
    """A run that the program refused or could not end: the command and what was said."""

    def __init__(self, command, text):
        super().__init__(f"{' '.join(command)}\n{text}")
        said = [line for line in text.splitlines() if line.startswith("traverse: ")]
        self.complaint = said[-1] if said else text.strip()
        self.step_is_too_long = "ts_dt" in self.complaint


class Run:
    """One run: seconds of its time loop and of the whole process, by the clock and of the processor, unknowns, the results
    file, and steps unless it sweeps."""

    def __init__(self, build, options, file, ranks=1):
        command = on_ranks(ranks) + [traverse(build)]
        command += words(options | {"output_file": file, "output_quiet": "true", "accuracy_cache": "false"})
        begin, used = time.monotonic(), processor_seconds()
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment())
        self.process_seconds = time.monotonic() - begin
        self.processor_seconds = processor_seconds() - used
        if done.returncode != 0:
            raise Failed(command, done.stdout)
        self.text = done.stdout
        self.file = file
        with h5py.File(file) as results:
            notes = results["model/notes"].asstr()[:, 1] if "model/notes" in results else []
            self.unknowns = unknowns("\n".join([done.stdout, *notes]))
            self.seconds = float(results.attrs.get("wall_seconds", np.nan))  # modes have no time loop
            self.steps = int(results.attrs.get("steps", 0))


def unknowns(text):
    """Of all nodes, held ones included, or modes, of sleepers, ballast and vehicles, as the program says it modelled."""

    def number(pattern):
        found = re.search(pattern, text)
        return int(found.group(1)) if found else 0

    modes = number(r"the bridge by (\d+) modes")
    if modes:
        return modes + number(r"degrees of freedom (\d+)")
    spans = number(r"(\d+) spans? \(each of its own\)") or 1
    per_node = number(r"elements, (\d+) unknowns a node") or 2
    total = per_node * (number(r"spans?[^,]*, (\d+) elements") + spans) + number(r"degrees of freedom (\d+)")
    track = re.search(r"track from (\S+) to (\S+) m: rail with (\d+) elements, sleepers every (\S+) m", text)
    if track:
        length, elements, spacing = float(track[2]) - float(track[1]), int(track[3]), float(track[4])
        bridge = float(re.search(r"beam of (\S+) m", text)[1])
        sleepers = round(length / spacing) + 1
        total += 2 * (elements + 1) + sleepers + round((length - bridge) / spacing)  # ballast moves on the ground only
    return total


def peak(file, probe=None):
    """The largest deflection at a probe (or the first): between samples the cubic through deflections and velocities."""
    with h5py.File(file) as results:
        t = results["time"][:]
        v = results["probes/deflection"][: len(t), probe or 0]
        w = results["probes/velocity"][: len(t), probe or 0]
    at = np.linspace(0.0, 1.0, 21)[1:-1, None]
    h = np.diff(t)
    between = ((1 + 2 * at) * (1 - at) ** 2 * v[:-1] + at**2 * (3 - 2 * at) * v[1:]
               + at * (1 - at) * h * ((1 - at) * w[:-1] - at * w[1:]))
    values = np.concatenate([v, between.ravel()])
    return float(values[np.abs(values).argmax()])


def peaks(file):
    """What the run says were its greatest deflection, acceleration, moment and wheel force, without signs."""
    with h5py.File(file) as results:
        summary = results["summary"].attrs
        found = {name: abs(float(summary.get(key, 0.0))) for name, key in PEAKS.items()}
    return {name: value for name, value in found.items() if value > 0.0}


def in_turn(build, cases, rounds, folder):
    """Runs every case once a round, so that what else the machine does meets all alike: medians of seconds, by name.

    cases: {name: options}; results files go to the folder. Returns {name: (median seconds, last Run)}.
    """
    taken, last = {name: [] for name in cases}, {}
    for _ in range(rounds):
        for i, (name, options) in enumerate(cases.items()):
            last[name] = Run(build, options, os.path.join(folder, f"in_turn_{i}.h5"))
            taken[name].append(last[name].seconds)
    return {name: (statistics.median(taken[name]), last[name]) for name in cases}


def write_table(file, header, rows):
    with open(file, "w", newline="") as table:
        writer = csv.writer(table)
        writer.writerow(header)
        writer.writerows(rows)
    print(file)
