"""The command traverse-check: question, need for a dynamic analysis, runs, verdicts, documents."""

import concurrent.futures
import contextlib
import functools
import io
import os
import pathlib
import signal
import sys
import textwrap
import threading
import time

import output_files
from output_files import write_text as write

from . import flow_chart, outcome, question, runs, scene, track_defects, units
from .rules import MARKS, CheckError, clause, printable, rule

MODES = 8    # natural modes for each span that are searched
WIDTH = 120  # of the terminal, for sentences
CLEARED = "\r\033[K"  # the line of a terminal
SILENT_START = 2.0  # s without progress, as in the program


def first_frequency(file):
    return float(file["norm"].attrs["n0"]), float(max(file["norm/determinant_length"][:]))


def stiffnesses_of(asked, traverse):
    """EI of the question, or that of the given frequencies: the square of n0 is proportional to EI."""
    if asked.EI:
        return asked.EI
    trial = scene.Case("", "", 1.0e10, asked.masses[0])
    n0, _ = runs.scratch_run(traverse, scene.bare_static_scene(asked, trial, asked.spans), first_frequency)
    return [trial.EI * (frequency / n0) ** 2 for frequency in asked.frequencies]


def parts_of(asked, case, traverse):
    """The parts that the flow chart judges: the bridge, or its simply supported spans of different lengths."""
    different = [[span] for span in sorted(set(asked.spans))] if asked.separate else [asked.spans]
    found = []
    for spans in different:
        n0, length = runs.scratch_run(traverse, scene.bare_static_scene(asked, case, spans), first_frequency)
        found.append(flow_chart.Part(length, n0, asked.separate))
    return found


def parts_of_a_bridge(asked, case, traverse):
    """The same; CheckError for a frequency of no bridge of this length: EI, mass and span do not belong together."""
    found, upper = parts_of(asked, case, traverse), rule("frequencies")["upper"]
    for part in found:
        usual = upper["c"] * part.length ** upper["e"]
        if not usual / 100.0 <= part.n0 <= 10.0 * usual:
            raise CheckError(f"the first frequency of {part.n0:.3g} Hz is that of no bridge with L = {part.length:g} m, whose "
                             f"upper limit is {usual:.3g} Hz (figure 6.10): check EI, mass and span with their units")
    return found


def print_steps(name, steps):
    """The steps of the flow chart for a case or a span."""
    if name:
        print(f"  {name}:")
    width = max(len(number) for number, _ in steps) + 2
    for number, said in steps:
        print(textwrap.fill(said, WIDTH, initial_indent=f"  {number:<{width}}", subsequent_indent=" " * (width + 2)))


def need(asked, cases, traverse):
    """Prints the steps of the flow chart for each case. Returns whether one of them needs a dynamic analysis, and the
    parts of the bridge in all cases."""
    print("Need for a dynamic analysis")
    needed, several, parts = False, asked.separate and len(set(asked.spans)) > 1, []
    for case in cases:
        for part in parts_of_a_bridge(asked, case, traverse):
            parts.append(part)
            found = flow_chart.answer(part, asked)
            needed |= found.needed
            span = f"span of {part.length:g} m" if several else ""
            print_steps(", ".join(filter(None, [case.words, span])), found.steps)
    print("  Result: " + ("dynamic analysis" if needed else
                          "dynamic analysis because of --always, although figure 6.9 requires none" if asked.always else
                          "no dynamic analysis is necessary; load models with Φ only"))
    return needed, parts


def modes_of(asked, case, traverse):
    """The number of natural modes up to 1.5 times the cut-off frequency, the largest of 30 Hz, 1.5 f1 and f3.

    The low-pass leaves less than 4 % of the accelerations above. On spans of 25 to 36 m, further modes changed the
    filtered accelerations by less than 0.2 %, and moments and deflections not at all.
    """
    text = scene.bare_static_scene(asked, case, asked.spans)
    wanted = str(MODES * len(asked.spans))
    found = runs.scratch_run(traverse, text, lambda file: sorted(file["modes/frequency"][:]), "-scene_analysis",
                             "modes", "-modes_count", wanted)
    distinct = [f for f, before in zip(found, [0.0, *found]) if f > before * (1.0 + 1e-3)]
    cut_off = max(30.0, 1.5 * distinct[0], distinct[min(2, len(distinct) - 1)])
    return sum(f <= 1.5 * cut_off for f in found)


def trains_of(asked):
    """The models HSLM-A or HSLM-B that apply."""
    short = [span < rule("short_span")["value"] and asked.separate for span in asked.spans]
    return [train for train, applies in (("A", not all(short)), ("B", any(short))) if applies]


def limits_file_of(asked):
    return pathlib.Path(asked.limits) if asked.limits else runs.data_file("limits", "en1991_2.yml")


def check_outputs(asked, cases, words):
    """OutputError unless all files of the folder may be written, of whatever trains these will be. words: of the
    command line, which may be names of files that are read."""
    inputs = [limits_file_of(asked), *(word for word in words if pathlib.Path(word).is_file())]
    names = [case.name + train for case in cases for train in ("", "_hslm_a", "_hslm_b")]
    endings = ("yml", "txt", "h5", *(("png", "html") if asked.report else ()))
    files = [("limits", "yml"), ("summary", "txt"), *(("report", ending) for ending in ("pdf", "xlsx") if asked.report),
             *((name, ending) for name in names for ending in endings)]
    for name, ending in files:
        kind = "results" if ending == "h5" else ending
        output_files.check(asked.folder / f"{name}.{ending}", kind, inputs)


def tell(text):
    """Tells what the check is doing, which does not belong in its summary; in place of the progress on a terminal."""
    print(f"{CLEARED if sys.stderr.isatty() else ''}  {text}", file=sys.stderr, flush=True)


class Progress:
    """Tells the progress of several runs as the program does: on a terminal in a line that is rewritten, otherwise in a
    line for each tenth."""

    def __init__(self, names):
        self.percents, self.shown, self.lock = dict.fromkeys(names, 0), 0, threading.Lock()
        self.begin = time.monotonic()

    def update(self, name, percent):
        with self.lock:
            self.percents[name] = percent
            mean = sum(self.percents.values()) / len(self.percents)
            if mean == 100.0 or time.monotonic() - self.begin < SILENT_START:
                return
            if sys.stderr.isatty():
                print(f"{CLEARED}{mean:3.0f} %   of the runs", end="", file=sys.stderr, flush=True)
            elif mean // 10 > self.shown:
                self.shown = mean // 10
                print(f"{mean:3.0f} %   of the runs", file=sys.stderr, flush=True)


def run_all(asked, cases, factor, needed, traverse):
    """Writes and runs the scenes of all cases; the names of the results files, with the words of their cases. factor:
    of the limits of effects of trains; None without a dynamic analysis."""
    dynamic = factor is not None
    write(asked.folder / "limits.yml", scene.limits_text(asked, limits_file_of(asked), factor))
    trains = trains_of(asked) if dynamic else [""]
    names, done = [], []
    for case in cases:
        modes = modes_of(asked, case, traverse) if dynamic else 0
        for train in trains:
            names.append(case.name + (f"_hslm_{train.lower()}" if len(trains) > 1 else ""))
            text = scene.dynamic_scene(asked, case, modes, train, needed) if train else scene.static_scene(asked, case)
            write(asked.folder / f"{names[-1]}.yml", text)
            words = ", ".join(filter(None, [case.words, f"HSLM-{train}" if train else "load models with Φ"]))
            done.append((f"{names[-1]}.h5", words, case))
    progress = Progress(names)
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        def compute(name):
            tell(f"{name}.yml is being computed")
            printed = runs.compute(traverse, asked.folder, f"{name}.yml", f"{name}.h5",
                                   progress=functools.partial(progress.update, name))
            progress.update(name, 100)
            return printed

        printed = pool.map(compute, names)
        said = []
        for name, text in zip(names, printed):
            write(asked.folder / f"{name}.txt", text)
            said += runs.unusual_input(text)
            tell(f"{name}.yml is computed")
    for line in dict.fromkeys(said):
        print(textwrap.fill(f"Unusual input: {line}", WIDTH, subsequent_indent="  "))
    return done


def print_verdicts(asked, done):
    """The verdicts of each results file; all of them."""
    everything = []
    for name, words, case in done:
        found = outcome.verdicts(asked.folder / name)
        print(f"Verdicts: {words}; EI = {units.in_words('EI', case.EI)}, mass {units.in_words('mass', case.mass)}")
        print(*outcome.lines_of(found), sep="\n")
        everything += found
    return everything


def print_remarks(asked, judged, dynamic):
    """What the check does not contain, and what its result depends on."""
    left = [row["requirement"] for row in scene.not_covered(asked, [verdict.limit.quantity for verdict in judged],
                                                             dynamic)]
    for said in filter(None, (
                 outcome.consequence(judged), scene.conditions(asked, dynamic),
                 f"Not part of this check: {'; '.join(left)}.",
                 f"{MARKS[0]} no public source confirms the rule or its clause, {MARKS[1]} one public source confirms "
                 "it: check it with the norm. National annexes may change values.")):
        print(textwrap.fill(said, WIDTH, subsequent_indent="  "))


class Both:
    """Writes to the terminal and to a text."""

    def __init__(self, *streams):
        self.streams = streams

    def write(self, text):
        for stream in self.streams:
            stream.write(text)

    def flush(self):
        for stream in self.streams:
            stream.flush()


def check(words):
    """The exit status of the check, whose text is also in summary.txt."""
    asked = question.ask(words)
    traverse = runs.program(asked.program)
    asked.folder.mkdir(parents=True, exist_ok=True)
    summary = io.StringIO()
    try:
        with contextlib.redirect_stdout(Both(sys.stdout, summary)):
            return status_of(asked, traverse, words)
    finally:
        if summary.getvalue():
            write(asked.folder / "summary.txt", summary.getvalue())


def status_of(asked, traverse, words):
    """Runs the check, step by step."""
    cases = scene.cases(asked, stiffnesses_of(asked, traverse))
    scene.read_limits(limits_file_of(asked))
    check_outputs(asked, cases, words)
    print(f"Bridge: {scene.bridge_in_words(asked)}")
    needed, parts = need(asked, cases, traverse)
    dynamic = needed or asked.always
    first, last, _ = scene.speeds(asked)
    factor = track_defects.factor(parts, last, asked.careful) if dynamic else None
    if dynamic:
        print(f"Dynamic analysis: {', '.join(f'HSLM-{train}' for train in trains_of(asked))}, "
              f"{units.in_words('line-speed', first)} to {units.in_words('line-speed', last)}, "
              f"damping by {clause('damping')}")
        print(f"Effects of trains are judged with the factor {factor:.4g} for track defects, {clause('track_defects')}",
              flush=True)
    done = run_all(asked, cases, factor, needed, traverse)
    judged = print_verdicts(asked, done)
    print_remarks(asked, judged, dynamic)
    print(outcome.conclusion(judged), flush=True)
    names = [name for name, *_ in done]
    if asked.report:
        tell("the report, the pictures and the pages of results are being made")
    made = runs.documents(traverse, asked, names) if asked.report else []
    scenes = [pathlib.Path(name).with_suffix(".yml").name for name in names]
    print(f"Files in {printable(asked.folder)}: {', '.join([*made, *names, *scenes, 'limits.yml', 'summary.txt'])}")
    return outcome.status(judged)


def main():
    try:
        return check(sys.argv[1:])
    except CheckError as error:
        print(f"traverse check: {error}", file=sys.stderr)
        return error.status
    except output_files.OutputError as error:
        print(f"traverse check: {printable(error)}", file=sys.stderr)
        return 4
    except OSError as error:
        print(f"traverse check: {printable(error.filename or 'output')}: {error.strerror}", file=sys.stderr)
        return 4
    except KeyboardInterrupt:
        return 128 + signal.SIGINT
