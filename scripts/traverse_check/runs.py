"""Runs of the program and of the scripts that draw and report, each in a separate process."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import checked_results

from .rules import CheckError

SCRIPTS = pathlib.Path(__file__).resolve().parents[1]  # also the folder of the installed scripts
PERCENT = re.compile(r"^\s*(\d{1,3}) %   ")  # how a line of the program on its progress begins


def program(given):
    """The program traverse: the given one, or that of the environment or beside this command."""
    beside = pathlib.Path(sys.argv[0]).resolve().parent
    usual = [os.environ.get("TRAVERSE_BINARY"), beside / "traverse", beside.parent / "build" / "traverse",
             shutil.which("traverse")]
    for place in [given] if given else usual:
        if place is not None and pathlib.Path(place).is_file():
            return str(pathlib.Path(place).resolve())
    raise CheckError(f"--program {given}: there is no such file" if given else
                     "the program traverse is not beside this command: --program names it", 4)


def data_file(*names):
    """A file of options/, in the sources or beside the installed scripts."""
    return SCRIPTS.parent.joinpath("options", *names)


def last_line(printed):
    """The message of a failed process."""
    lines = [line for line in printed.splitlines() if line.strip()]
    return lines[-1].removeprefix("traverse: ") if lines else "it ended without a message"


def unusual_input(printed):
    """The lines on unusual input that the program has printed."""
    found, inside = [], False
    for line in printed.splitlines():
        if inside and line.startswith("  "):
            found.append(line.strip())
        else:
            inside = line == "unusual input"
    return found


def compute(traverse, folder, scene, results, *words, progress=lambda percent: None):
    """Runs a scene file of a folder; all names are relative to it. Returns what the program prints, without the lines on
    its progress, which `progress` takes."""
    asked = [traverse, "-options_file", scene, "-output_file", results, "-skip_petscrc", *words]
    own = {name: value for name, value in os.environ.items() if not name.startswith("PETSC_OPTIONS")}
    printed = ""
    with tempfile.TemporaryFile("w+", errors="replace") as errors, \
            subprocess.Popen(asked, cwd=folder, stdout=subprocess.PIPE, stderr=errors, text=True, errors="replace", env=own,
                             stdin=subprocess.DEVNULL) as process:
        try:
            for line in process.stdout:
                if found := PERCENT.match(line):
                    progress(int(found[1]))
                else:
                    printed += line
            status = process.wait()
        except KeyboardInterrupt:
            process.kill()
            raise
        errors.seek(0)
        complaint = errors.read()
    if status != 0:
        raise CheckError(f"the run of {scene} failed: {last_line(complaint or printed)}", status if status in (2, 3, 4) else 3)
    return printed + complaint


def scratch_run(traverse, text, read, *words):
    """Runs the text of a scene in a folder of its own and returns read(results file)."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "scene.yml").write_text(text, encoding="utf-8")
        compute(traverse, folder, "scene.yml", "results.h5", *words)
        with checked_results.opened(pathlib.Path(folder, "results.h5")) as file:
            return read(file)


def start(folder, *words):
    """Starts a Python script of this folder; `finish` waits for it."""
    return subprocess.Popen([sys.executable, *map(str, words)], cwd=folder, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, errors="replace", stdin=subprocess.DEVNULL)


def finish(process, what):
    out, error = process.communicate()
    if process.returncode != 0:
        lines = (error or out).strip().splitlines() or ["no message"]
        raise CheckError(f"{what} could not be written: {lines[-1]}", 4)


def command(name):
    """A command such as traverse-report, beside this command or in the sources."""
    for place in (pathlib.Path(sys.argv[0]).resolve().parent, SCRIPTS):
        if (place / name).is_file():
            return place / name
    raise CheckError(f"{name} is not beside this command", 4)


def report_words(traverse, asked, files):
    """The words of the command that makes the report of results files of a check."""
    more = []
    if asked.torsional_frequency is not None:
        more = ["--torsional-frequency", f"{asked.torsional_frequency!r} Hz"]
    if asked.GJ is not None:
        more = ["--GJ", f"{asked.GJ!r} N.m2", "--polar-inertia", f"{asked.polar_inertia!r} kg.m"]
    if asked.complex:
        more.append("--complex")
    return [command("traverse-report"), *files, "-o", "report", "--program", traverse, "--folder", ".", "--line-speed",
            f"{asked.line_speed!r} m/s", *more]


def documents(traverse, asked, files):
    """A report of all results files, and a picture and a page of each. Returns the names of the files."""
    folder = asked.folder
    report = start(folder, *report_words(traverse, asked, files))
    made = ["report.pdf", "report.xlsx"]
    for name in files:
        for script, ending in (("picture.py", ".png"), ("page.py", ".html")):
            made.append(str(pathlib.Path(name).with_suffix(ending)))
            finish(start(folder, SCRIPTS / script, name, made[-1]), made[-1])
    finish(report, "the report")
    return made
