"""The command traverse-report: pages of each results file in their order."""

import argparse
import pathlib
import shutil
import sys
import tempfile
from typing import NamedTuple, Optional

import fatigue
import output_files
from checked_results import in_one_line
from traverse_check import flow_chart, units
from traverse_check.rules import CheckError

from . import (
    annex_sheet, assumptions_sheet, bound_sheet, bounds, checks_sheet, comfort_sheet, comparison_sheet, curve_sheet,
    decisions, fatigue_sheet, find_sheet, fit_sheet, front_sheet, loads_sheet, norm_sheet, rail_sheet, run_sheet,
    screen_sheet, sensitivity_sheet, static_sheet, statistics, structure, title_sheet, uplift, workbook_sheets)
from . import governing as again
from . import limits as judging
from .language import LANGUAGES, choose, t
from .page import Report
from .source import ReportError, Source, opened

# Texts of the title page. --line is the S-N curve, as in fatigue.py.
TITLE = {"project": "name of the project", "structure": "name of the structure",
         "railway-line": "line and kilometre of the structure", "author": "who has made the calculation",
         "checker": "who has checked it", "revision": "revision of the report", "date": "date of the report",
         "note": "a remark on the title page", "logo": "a picture for the title page, PNG or JPEG",
         "material": "materials of the structure, such as C50/60, St 1570/1770",
         "cross-section": "a picture of the cross-section, PNG or JPEG", "drawings": "numbers of the drawings",
         "norm-edition": "edition of the norm, such as EN 1991-2:2003",
         "national-annex": "national annex, such as DIN EN 1991-2/NA:2012-08"}

PICTURES = ("logo", "cross-section")


class Governing(NamedTuple):
    run: int
    words: str  # name of the run
    why: str
    source: Optional[Source]  # its results; None if it could not be repeated
    trouble: str
    finer: Optional[Source] = None  # its results with twice the elements and natural modes


def positive(text):
    value = fatigue.number(text)
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text}: allowed: a number above 0")
    return value


def arguments_of(given):
    parser = argparse.ArgumentParser(
        prog="traverse-report", description="A report of results files: PDF on A4 and XLSX, to hand in.",
        epilog="A sweep's or study's governing run is computed again for its time histories and verdicts, by the "
               "program that stands beside this one.")
    parser.add_argument("results", nargs="+", metavar="RESULTS.h5", help="results files of traverse")
    parser.add_argument("-o", "--output", metavar="NAME",
                        help="writes NAME.pdf and NAME.xlsx; left out: beside the first results file, under its name")
    parser.add_argument("--limits", metavar="FILE",
                        help="limits to check, as -limits of traverse takes them; left out: those of the computation")
    parser.add_argument("--program", metavar="FILE", help="the program that repeats the governing run")
    parser.add_argument("--folder", metavar="FOLDER",
                        help="where files that a scene names are looked for; left out: here")
    parser.add_argument("--if-limits", action="store_true", help="does nothing for results that are no sweep or study "
                        "with limits")
    parser.add_argument("--factor", type=fatigue.number, default=1.0, metavar="NUMBER",
                        help="the stress that a unit of the bridge's moment makes, e.g. 1/0.35")
    parser.add_argument("--line", type=fatigue.line_of, help="damage is counted by it: en1993:CATEGORY or "
                        "slope:M,RANGE,CYCLES, in the stress's unit")
    parser.add_argument("--passages", type=positive, default=1.0, metavar="A_DAY", help="of the run; left out: 1")
    parser.add_argument("--no-governing-run", action="store_true", help="does not repeat it")
    parser.add_argument("--no-pdf", action="store_true", help="writes the workbook only")
    parser.add_argument("--all-bounds", action="store_true", help="all pages of each file; left out: of files of one "
                        "structure, such as bounds of its stiffness, only of the one with the greatest utilisation")
    group = parser.add_argument_group("need for a dynamic analysis", "The flow chart of EN 1991-2 figure 6.9.")
    group.add_argument("--line-speed", metavar="SPEED", help="maximum line speed at the site, such as 250 km/h")
    group.add_argument("--torsional-frequency", metavar="HZ", help="first natural frequency of torsion")
    group.add_argument("--GJ", metavar="STIFFNESS", help="torsional stiffness between forks instead, such as 90 GN.m2")
    group.add_argument("--polar-inertia", metavar="INERTIA", help="with --GJ: polar moment of inertia of the mass per "
                       "length, such as 160 t.m")
    group.add_argument("--complex", action="store_true", help="no simple structure: skew, flexible supports, torsion")
    group = parser.add_argument_group("title page", "These replace the options report_... of the scene. Material, "
                                      "cross-section and drawings are in the basis of calculation.")
    for name, words in TITLE.items():
        group.add_argument(f"--{name}", metavar="FILE" if name in PICTURES else "TEXT", help=words)
    group.add_argument("--language", choices=LANGUAGES, help="language of the report")
    return parser.parse_args(given)


def given_title(arguments):
    return {name.replace("railway-line", "line").replace("-", "_"): getattr(arguments, name.replace("-", "_"))
            for name in TITLE}


def line_of(arguments):
    """What the flow chart asks, or None without a line speed."""
    def value(name):
        text = getattr(arguments, name.replace("-", "_"))
        found = [None] if text is None else units.values(name, text)
        if len(found) != 1:
            raise ReportError(f"--{name} {text}: allowed: one value")
        return found[0]

    if arguments.line_speed is None:
        return None
    try:
        frequency = value("torsional-frequency")
        speed = flow_chart.torsional_wave_speed(value("GJ"), value("polar-inertia"), frequency)
        return flow_chart.Line(value("line-speed"), arguments.complex, frequency, speed)
    except CheckError as error:
        raise ReportError(f"--{error}") from None


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
        return Governing(run, words, why, None, "the program traverse is not beside this script; --program names it")
    path, trouble = again.repeat(source, run, limits, program, arguments.folder or ".", scratch)
    if path is None:
        return Governing(run, words, why, None, trouble)
    finer = again.repeat(source, run, limits, program, arguments.folder or ".", scratch, finer=2)[0] \
        if again.modes_of(source) else None
    return Governing(run, words, why, Source(path), "", Source(finer) if finer is not None else None)


def least_bearing_of_runs(source, governing, arguments, scratch):
    """The least bearing force over time of all runs; those that may have it are repeated."""
    program, folder = program_beside(arguments.program), arguments.folder or "."

    def repeat(run):
        if run == governing.run:
            return governing.source
        path, _ = again.repeat(source, run, [], program, folder, scratch, name=f"bearing_{run}")
        return None if path is None else Source(path)

    return uplift.least_of_runs(source, repeat)


def add_pages(report, entry, asked, program, group):
    """All pages of a file. group: the entries of its structure in this report, this one first."""
    source, limits, verdicts, governing = entry
    front_sheet.sheet(report, source, verdicts, governing)
    if not source.is_screen:  # its bridges and formations are in its tables
        assumptions_sheet.sheet(report, source)
        loads_sheet.sheet(report, source)
    if source.is_verification:
        checks_sheet.sheet(report, source, bounds.worst_of(group), [other for other, *_ in group[1:]])
    norm_sheet.sheet(report, source)
    static_sheet.sheet(report, source)
    rail_sheet.sheet(report, source)
    find_sheet.sheet(report, source)
    sensitivity_sheet.sheet(report, source)
    fit_sheet.sheet(report, source)
    screen_sheet.sheet(report, source)
    if source.runs is not None:
        curve_sheet.line_sheet(report, source, limits)
        curve_sheet.curve_sheets(report, source, limits)
        curve_sheet.envelope_sheet(report, source, limits)
        statistics.sheet(report, source)
    one = source if source.is_run else governing.source if governing is not None else None
    if one is not None:
        words = source.kind_in_words() if source.is_run else t("Governing run: {run}", run=governing.words)
        run_sheet.envelope_sheet(report, one, t("Results along the bridge"), words, limits)
        run_sheet.history_sheets(report, one, t("Time histories"), words, limits)
        comfort_sheet.sheet(report, one, words)
        fatigue_sheet.sheet(report, one, words, asked)
    annex_sheet.sheet(report, source, governing, program)


def has_limits(path):
    """Whether a file is that of a sweep or a study with limits."""
    with opened(path) as file:
        many = "sweep/speed" in file or "study/finished" in file
        return many and "options" in file and "limits" in [name.lstrip("-") for name in file["options"].asstr()[:, 0]]


def entry_of(source, arguments, scratch):
    """(source, limits, verdicts, governing run or None)"""
    limits = judging.limits_of(source, arguments.limits, arguments.folder)
    verdicts = judging.judge(source, limits)
    governing = governing_of(source, limits, arguments, scratch)
    if governing is not None and governing.source is not None:
        source.governing = governing.source
        if decisions.has_least_bearing_of_runs(source):
            source.least_bearing = least_bearing_of_runs(source, governing, arguments, scratch)
        alone = judging.stored(governing.source)
        name = t("{run}, governing run only", run=governing.words)
        verdicts = judging.with_governing(verdicts, [verdict._replace(run=name) for verdict in alone])
    if governing is not None and governing.trouble:
        print(f"the governing run, {governing.words}, could not be repeated: {governing.trouble}")
    return source, limits, verdicts, governing


def report_of(groups, title, lines, colour, asked, program=None):
    """The pages: title, contents, comparison of several files, and the pages of the first file of each group; each other
    one has one page. groups: lists of entries."""
    entries = [entry for group in groups for entry in group]
    sources = [source for source, *_ in entries]
    report, first_pages, number = Report(f"traverse {sources[0].file.attrs.get('version', '')}"), [], 0
    for group in groups:
        of_governing = number + 1
        for number, entry in enumerate(group, of_governing):
            report.part("" if len(entries) == 1 else f"{entry[0].title()} ({entry[0].path.name})", number)
            before = len(report.pages)
            if number == of_governing:
                add_pages(report, entry, asked, program, group)
            else:
                bound_sheet.sheet(report, entry, group[:number - of_governing], of_governing)
            first_pages.append(report.pages[before])
    if len(entries) > 1:
        report.part("", 0)
        report.annex()
    annex_sheet.notes_sheet(report, entries)
    report.part("", 0)
    own, report.pages = report.pages, []
    if len(entries) > 1:
        comparison_sheet.sheet(report, [(source, verdicts) for source, _, verdicts, _ in entries], first_pages,
                               len(groups) < len(entries))
    compared, report.pages = report.pages, []
    title_sheet.title_page(report, title, sources, lines, colour)
    title_sheet.contents_page(report, compared)
    report.pages += compared + own
    return report


def checked_outputs(arguments):
    """{kind: name} of the files that may be written: the PDF, unless it is not wanted, and the XLSX file."""
    out = pathlib.Path(arguments.output or arguments.results[0])
    stem = out.with_suffix("") if out.suffix in (".pdf", ".xlsx", ".h5") else out
    inputs = [path for path in (*arguments.results, arguments.limits, arguments.logo,
                              arguments.cross_section) if path]
    paths = {kind: f"{stem}.{kind}" for kind in (("xlsx",) if arguments.no_pdf else ("pdf", "xlsx"))}
    for kind, path in paths.items():
        output_files.check(path, kind, inputs)
    return paths


def run(words):
    arguments = arguments_of(words)
    if arguments.if_limits:
        arguments.results = [path for path in arguments.results if has_limits(path)]
        if not arguments.results:
            return
    line, paths = line_of(arguments), checked_outputs(arguments)
    sources = [Source(path, line) for path in arguments.results]
    for source in sources:
        source.compared = sources
    wanted = arguments.language or sources[0].options.get("report_language", "en")
    choose(wanted if wanted in LANGUAGES else "en")
    title = title_sheet.title_of(sources, given_title(arguments), arguments.folder)
    structure.read(sources, given_title(arguments), arguments.folder)
    asked = fatigue_sheet.Asked(arguments.factor, arguments.line, arguments.passages)
    with tempfile.TemporaryDirectory() as scratch:
        entries = []
        for number, source in enumerate(sources):
            folder = pathlib.Path(scratch) / str(number)
            folder.mkdir()
            entries.append(entry_of(source, arguments, folder))
        groups = [[entry] for entry in entries] if arguments.all_bounds else bounds.groups_of(entries)
        entries = [entry for group in groups for entry in group]
        lines, colour = comparison_sheet.headline([(source, verdicts) for source, _, verdicts, _ in entries])
        program, made = program_beside(arguments.program), paths["xlsx"]
        try:
            if "pdf" in paths:
                report = report_of(groups, title, lines, colour, asked, program)
                title_sheet.save(report, paths["pdf"], title)
                made = f"{paths['pdf']} ({len(report.pages)} pages), {made}"
            workbook_sheets.write(paths["xlsx"], title, lines, entries, asked, program)
        except OSError as error:
            raise ReportError(f"{error.filename or paths['xlsx']}: {error.strerror}") from None
    print(f"report  {made}")


def main():
    try:
        run(sys.argv[1:])
    except (ReportError, output_files.OutputError) as error:
        print(f"traverse-report: {error}", file=sys.stderr)
        return 1
    except Exception as error:
        print(f"traverse-report: a file {in_one_line(error)}", file=sys.stderr)
        return 1
    return 0
