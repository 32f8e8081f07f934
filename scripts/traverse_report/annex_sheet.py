"""The annex: convergence with error estimates, the notes of the program and the options of the computation."""

import re
import subprocess

from .assumptions_sheet import discretisation, noted, origin, uncertainty_of
from .language import capital, num, t
from .page import BEGINNING, GREY, LEFT, table

# Quantities with an error estimate: their names in words, and in the notes of the program.
ESTIMATED = {"deflection": ("deflection", "deflection"),
             "acceleration": ("deck acceleration, unfiltered", "acceleration"),
             "acceleration_lowpass": ("deck acceleration, low-pass filtered", "low-passed acceleration"),
             "moment": ("bending moment", "moment"), "shear": ("shear force", "shear"),
             "wheel_force": ("wheel force", "wheel force"),
             "axial_displacement": ("longitudinal displacement", "axial displacement"),
             "axial_force": ("axial force", "axial force"), "frequency": ("natural frequency", "frequency")}
USUAL = ("deflection", "acceleration", "acceleration_lowpass", "moment")  # listed without an estimate, too
SECONDS_FOR_HELP = 10.0


def estimates(source, governing):
    """Rows (quantity, estimated relative error, where it comes from). governing: the repeated run, or None."""
    rows, of_finer = [], errors_of_governing(governing)
    for name, (words, in_notes) in ESTIMATED.items():
        error = source.summary.get(f"expected_error_{name}")
        if error is not None:
            rows.append((t(words), percent_of_error(error), t("trial runs with finer mesh, step or more modes")))
        elif name in of_finer:
            rows.append((t(words), percent_of_error(of_finer[name]),
                         t("governing run with twice the elements and natural modes")))
        elif name in USUAL or (name == "wheel_force" and len(source.model.train)):
            rows.append((t(words), t("not estimated"), reason(source, in_notes)))
    return rows


def errors_of_governing(governing):
    """{quantity: relative difference of the peak of the governing run from the finer one}"""
    if governing is None or governing.finer is None:
        return {}
    run, finer = governing.source.summary, governing.finer.summary
    return {name: abs(float(run[name]) / float(finer[name]) - 1.0) for name in USUAL
            if name in run and finer.get(name, 0.0) != 0.0}


def percent_of_error(error):
    return f"{num(100.0 * error, '.1g')} %"


def reason(source, quantity):
    """Why the program estimates no error of a quantity, as it says."""
    of_all = noted(source, r"^errors are not estimated: (.*)") or t("no accuracy requested")
    return noted(source, rf"^error not estimated: {quantity}: (.*)") or of_all


def model_rows(source):
    """Rows (part of the discretisation, value, where it comes from)."""
    found, rows = discretisation(source), []
    if found.elements:
        rows.append((t("beam elements"), found.elements, origin(source, "beam_elements_per_span", "accuracy")))
    if found.modes:
        highest = noted(source, r"modes up to ([\d.e+]+) Hz")
        value = t("{count}, up to {frequency} Hz", count=found.modes, frequency=num(float(highest))) if highest else \
            str(found.modes)
        rows.append((t("natural modes"), value, origin(source, "model_modes", "accuracy")))
    exact = any("exact in time" in note for note in source.model.notes)
    step = found.step or (t("exact in time") if exact else "")
    if step:
        rows.append((t("time step"), step, origin(source, "ts_dt", "accuracy") if found.step else t("method")))
    rows.append((t("stations of evaluation"), str(len(source.results.probes)),
                 origin(source, "output_probes", "output_probes_spacing")))
    if source.runs is not None:
        rows += [(t("peaks over the speed, possible excess"), said,
                  t("curvature of the peaks between the computed speeds") if known else t("no accuracy requested"))
                 for said, known in uncertainty_of(source)]
    return rows


def notes_of(source, governing):
    """Rows (run, note): those of the file, then those that only its governing run has."""
    run = t("first run") if source.runs is not None else ""
    rows = [(run, note) for note in source.model.notes]
    if governing is not None and governing.source is not None:
        rows += [(t("governing run"), note) for note in governing.source.model.notes if note not in source.model.notes]
    return rows


def notes_of_all(entries):
    """Rows (file and run, note) of files; notes of all files are there once. entries: (source, ..., governing)."""
    several = [(source.path.name, notes_of(source, governing)) for source, *_, governing in entries]
    found = [{note for _, note in rows} for _, rows in several]
    common = set.intersection(*found) if len(found) > 1 else set()
    rows = [(t("all files"), note) for _, note in several[0][1] if note in common]
    for name, own in several:
        rows += [(", ".join(filter(None, (name if len(found) > 1 else "", run))), note) for run, note in own
                 if note not in common]
    return rows


def notes_sheet(report, entries):
    """The notes of the program on the runs of all files, with the annex of the only file or behind all files."""
    rows = notes_of_all(entries)
    if not rows:
        return
    page = report.page(t("Notes of the program (in English)"), least=BEGINNING)
    if any(source.runs is not None for source, *_ in entries):
        page.text(LEFT, t("The runs of a sweep or study share their model; in notes, numbers that depend on the load "
                          "or the speed are those of the first run."), size=8, colour=GREY)
        page.y -= 0.05
    table(report, page, [("", 0.3, "left"), (t("run"), 1.3, "left"), (t("note"), 5.2, "left")],
          [(str(i), run, note) for i, (run, note) in enumerate(rows, 1)], size=7)


def units_of_options(program):
    """{option: unit} from the help text of the program; empty without it."""
    if program is None:
        return {}
    try:
        said = subprocess.run([program, "-help"], capture_output=True, text=True, timeout=SECONDS_FOR_HELP).stdout
    except (OSError, subprocess.TimeoutExpired):
        return {}
    return dict(re.findall(r"^  -(\w+) .*\n +[^\n\[]*\[([^\]\n]+)\]", said, re.MULTILINE))


def option_rows(source, program):
    """Rows (option, value, unit, the line of a file or the command line)."""
    units = units_of_options(program)
    return [(name, value, units.get(name, ""), origin(source, name)) for name, value in sorted(source.options.items())
            if not name.startswith(("vehicle_", "output_file", "report_"))]


def sheet(report, source, governing, program):
    report.annex()
    if source.is_dynamic:
        page = report.page(t("Mesh, time step and error estimates"))
        columns = [(t("part of the model"), 2.2, "left"), (t("value"), 2.0, "left"), (t("source"), 2.6, "left")]
        page = table(report, page, columns, [(capital(words), *rest) for words, *rest in model_rows(source)])
        page.text(LEFT, t("The estimated errors are those of mesh, modes and time step only. They do not include the "
                          "error of the model, the material values and the loads."), size=8, colour=GREY)
        page.y -= 0.05
        columns = [(t("peak values of"), 2.2, "left"), (t("estimated relative error"), 1.5, "left"),
                   (t("source of the estimate, or why there is none"), 3.1, "left")]
        table(report, page, columns, [(capital(words), *rest) for words, *rest in estimates(source, governing)])
    page = report.page(t("Options of the computation"), least=BEGINNING)
    page.text(LEFT, t("Numbers are in the unit of the option; the run of the file has these options and defaults of "
                      "the program for all others."), size=8, colour=GREY)
    page.y -= 0.05
    table(report, page, [(t("option"), 1.8, "left"), (t("value"), 2.9, "left"), (t("unit"), 0.7, "left"),
                         (t("source"), 1.4, "left")], option_rows(source, program), size=7)
