"""The command traverse-report: pages of each results file in their order."""

import argparse
import datetime
import pathlib
import shutil
import sys
import tempfile
from typing import NamedTuple, Optional

import fatigue
import h5py

from . import comfort_sheet, fatigue_sheet, norm_sheet, rail_sheet, sheets, statistics, summary_sheet, workbook
from . import governing as again
from . import limits as judging
from .model_sheet import sheet as model_page
from .page import Report, table
from .source import ReportError, Source


class Governing(NamedTuple):
    words: str  # name of the run
    why: str
    source: Optional[Source]  # its results; None if it could not be repeated
    trouble: str


def positive(text):
    value = fatigue.number(text)
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text}: allowed: a number above 0")
    return value


def arguments_of(words):
    parser = argparse.ArgumentParser(
        prog="traverse-report", description="A report of results files: PDF on A4 and XLSX, to hand in.",
        epilog="A sweep's or study's governing run is computed again for its time histories and verdicts, by the "
               "program that stands beside this one.")
    parser.add_argument("results", nargs="+", metavar="RESULTS.h5", help="results files of traverse")
    parser.add_argument("-o", "--output", metavar="NAME", help="writes NAME.pdf and NAME.xlsx; left out: beside the first "
                        "results file, under its name")
    parser.add_argument("--limits", metavar="FILE", help="limits to judge by, as -limits of traverse takes them; left out: "
                        "those of the computation")
    parser.add_argument("--program", metavar="FILE", help="the program that repeats the governing run")
    parser.add_argument("--folder", metavar="FOLDER", help="where files that a scene names are looked for; left out: here")
    parser.add_argument("--if-limits", action="store_true", help="does nothing for results that are no sweep or study "
                        "with limits")
    parser.add_argument("--factor", type=fatigue.number, default=1.0, metavar="NUMBER", help="the stress that a unit of the "
                        "bridge's moment makes, e.g. 1/0.35")
    parser.add_argument("--line", type=fatigue.line_of, help="damage is counted by it: en1993:CATEGORY or "
                        "slope:M,RANGE,CYCLES, in the stress's unit")
    parser.add_argument("--passages", type=positive, default=1.0, metavar="A_DAY", help="of the run; left out: 1")
    parser.add_argument("--no-governing-run", action="store_true", help="does not repeat it")
    return parser.parse_args(words)


def program_beside(given):
    """The program that repeats a run; None if there is none."""
    if given:
        if not pathlib.Path(given).is_file():
            raise ReportError(f"--program {given}: there is no such file")
        return given
    here = pathlib.Path(sys.argv[0]).resolve().parent
    for place in (here / "traverse", here.parent / "build" / "traverse"):
        if place.is_file():
            return place
    return shutil.which("traverse")


def governing_of(source, limits, arguments, scratch):
    """Repeats the worst run of a table."""
    if source.runs is None or arguments.no_governing_run or not source.runs.finished.any():
        return None
    run, why = again.governing_run(source, limits)
    words = source.runs.run_in_words(run)
    program = program_beside(arguments.program)
    if program is None:
        return Governing(words, why, None, "the program traverse is not beside this script; --program names it")
    path, trouble = again.repeat(source, run, limits, program, arguments.folder or ".", scratch)
    return Governing(words, why, Source(path) if path is not None else None, trouble)


def add_pages(report, source, limits, verdicts, governing, asked):
    sheets.front(report, source, verdicts, governing)
    model_page(report, source)
    norm_sheet.sheet(report, source)
    rail_sheet.sheet(report, source)
    if source.runs is not None:
        sheets.line_sheet(report, source, limits)
        sheets.curve_sheets(report, source, limits)
        sheets.envelope_sheet(report, source)
        statistics.sheet(report, source)
    one = source if source.is_run else governing.source if governing is not None else None
    if one is not None:
        heading = source.title() if source.runs is None else f"governing run, {governing.words}"
        sheets.run_envelope_sheet(report, one, heading)
        sheets.history_sheets(report, one, heading, limits)
        comfort_sheet.sheet(report, one, heading)
        fatigue_sheet.sheet(report, one, heading, asked)
    rows = [(name, value) for name, value in sorted(source.options.items())
            if not name.startswith(("vehicle_", "output_file"))]
    page = report.page(f"What was asked for: {source.title()}")
    table(report, page, [("option", 2.4, "left"), ("value", 4.3, "left")], rows, size=7)


def has_limits(path):
    """Whether a file is that of a sweep or a study with limits."""
    with h5py.File(path, "r", locking=False) as file:
        many = "sweep/speed" in file or "study/finished" in file
        return many and "options" in file and "limits" in [name.lstrip("-") for name in file["options"].asstr()[:, 0]]


def run(words):
    arguments = arguments_of(words)
    if arguments.if_limits:
        arguments.results = [path for path in arguments.results if has_limits(path)]
        if not arguments.results:
            return
    sources = [Source(path) for path in arguments.results]
    out = pathlib.Path(arguments.output) if arguments.output else sources[0].path
    stem = out.with_suffix("") if out.suffix in (".pdf", ".xlsx", ".h5") else out
    version = sources[0].file.attrs.get("version", "")
    asked = fatigue_sheet.Asked(arguments.factor, arguments.line, arguments.passages)
    today = datetime.date.today().isoformat()
    report = Report(", ".join(source.title() for source in sources)[:60], f"traverse {version}, report of {today}")
    with tempfile.TemporaryDirectory() as scratch:
        entries, first_pages = [], []
        for number, source in enumerate(sources):
            folder = pathlib.Path(scratch) / str(number)
            folder.mkdir()
            limits = judging.limits_of(source, arguments.limits, arguments.folder)
            verdicts = judging.judge(source, limits)
            governing = governing_of(source, limits, arguments, folder)
            if governing is not None and governing.source is not None:
                alone = judging.stored(governing.source)
                verdicts = judging.with_governing(verdicts, [v._replace(run=f"{governing.words}, alone") for v in alone])
            if governing is not None and governing.trouble:
                print(f"the governing run, {governing.words}, could not be repeated: {governing.trouble}")
            first_pages.append(len(report.pages) + 1)
            add_pages(report, source, limits, verdicts, governing, asked)
            entries.append((source, limits, verdicts, governing))
        if len(sources) > 1:
            summary_sheet.sheet(report, [(source, verdicts, first) for (source, _, verdicts, _), first in
                                         zip(entries, first_pages)])
        paths = [f"{stem}.pdf", f"{stem}.xlsx"]
        try:
            report.save(paths[0])
            workbook.write(paths[1], entries, asked)
        except OSError as error:
            raise ReportError(f"{error.filename or stem}: {error.strerror}") from None
    print(f"report  {paths[0]} ({len(report.pages)} pages), {paths[1]}")


def main():
    try:
        run(sys.argv[1:])
    except ReportError as error:
        print(f"traverse-report: {error}", file=sys.stderr)
        return 1
    return 0
