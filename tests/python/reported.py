"""What tests of scripts/traverse-report share: small computations, and the command itself."""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest.mock

import openpyxl

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import BINARY, BRIDGE, CROSSING, SOURCE, Computed  # noqa: E402

SCRIPTS = SOURCE / "scripts"
sys.path.insert(0, str(SCRIPTS))
from traverse_report import fatigue_sheet, language, main, source, title_sheet, workbook_sheets  # noqa: E402

SIMPLE = """
beam: {spans: [20.0], EI: 6.0e10, mass: 1.8e4}
model: {modes: 3, damping_ratios: 0.01}
scene: {tail: 0.2}
"""
TRAINS = """
sweep: {speed: [40.0, 80.0, 5.0], hslm_a: [1, 2]}
norm: {load_models: [lm71]}
limits: factor.yml
"""
FACTOR = '- {clause: "rule 7", quantity: deck_acceleration, value: 3.5, factor: 1.25}\n'
SWEEP = BRIDGE + """
sweep: {speed: [60.0, 110.0, 5.0], hslm_a: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]}
output: {probes: [5.0, 10.0, 15.0, 22.0, 32.5, 40.0]}
"""
STUDY = BRIDGE + """
load: {forces: [2.0e5, 1.0e5], positions: [0.0, -3.0], speed: 40.0}
study: {vary: {load_speed: [30.0, 40.0, 50.0], beam_mass: {normal: [1.8e4, 5.0e2]}}, draws: 9,
        statistics: {quantiles: [0.5, 0.9]}}
"""
COACH = f"""
options_file: {SOURCE}/options/scenes/three_span_train.yml
train_vehicles: coach
output: {{interval: 0.005, probes: [20.0, 40.0]}}
ts_dt: 1.0e-3
beam_elements_per_span: 8
track: {{profile: german_low, wavelengths: [2.0, 80.0]}}
"""
LIMITS = """
- {clause: "rule 1", quantity: deflection_over_span, value: 1/2500, text: "stiff"}
- {clause: "rule 2", quantity: amplification, value: 50.0, text: "=1+1"}
- {clause: "rule 3", quantity: deck_acceleration, value: 1.0e-3}
- {clause: "rule 4", quantity: car_acceleration, value: 1.0}
"""


class Reported(Computed):
    """Shares one folder of computations between all classes of a file."""
    shared = None

    @classmethod
    def setUpClass(cls):
        if Reported.shared is None:
            super().setUpClass()
            Reported.shared = cls.holder  # removed at the end of the process
        cls.folder = pathlib.Path(Reported.shared.name)

    @classmethod
    def tearDownClass(cls):
        language.choose("en")

    @classmethod
    def prepare(cls):
        (cls.folder / "limits.yml").write_text(LIMITS, encoding="utf-8")
        cls.compute("sweep", SWEEP)  # without limits: the report has to judge by itself
        for name, text in (("judged", SWEEP), ("study", STUDY), ("crossing", CROSSING), ("coach", COACH)):
            cls.compute(name, text, "-limits", "limits.yml")

    def source(self, name, line=None):
        return source.Source(self.folder / f"{name}.h5", line)

    def command(self, *words):
        """The command within this process: (exit status, standard output, standard error)."""
        out, error = io.StringIO(), io.StringIO()
        given = ["traverse-report", "--program", str(BINARY), *map(str, words)]
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error), contextlib.chdir(self.folder), \
                unittest.mock.patch.object(sys, "argv", given):
            try:
                status = main.main()
            except SystemExit as ended:
                status = ended.code
        return status, out.getvalue(), error.getvalue()

    def entries_of(self, names, *words):
        """What the command makes of these files: the entries of its report, and its arguments."""
        arguments = main.arguments_of([*(str(self.folder / f"{name}.h5") for name in names), "--program", str(BINARY),
                                       *words])
        arguments.limits = arguments.limits and str(self.folder / arguments.limits)
        language.choose(arguments.language or "en")
        with tempfile.TemporaryDirectory() as scratch, contextlib.chdir(self.folder):
            folders = [pathlib.Path(scratch) / str(number) for number in range(len(names))]
            for folder in folders:
                folder.mkdir()
            return [main.entry_of(source.Source(path), arguments, folder)
                    for path, folder in zip(arguments.results, folders)], arguments

    def book_of(self, name, *words):
        """The workbook of a file, without the pages of the report."""
        entries, arguments = self.entries_of([name], *words)
        asked = fatigue_sheet.Asked(arguments.factor, arguments.line, arguments.passages)
        workbook_sheets.write(self.folder / f"{name}.xlsx", title_sheet.Title(), [], entries, asked)
        return openpyxl.load_workbook(self.folder / f"{name}.xlsx")

    def columns(self, sheet):
        """Name -> values."""
        head = [cell.value for cell in sheet[1]]
        rows = list(sheet.iter_rows(min_row=2, values_only=True))
        return {name: [row[i] for row in rows] for i, name in enumerate(head)}
