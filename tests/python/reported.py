"""What tests of scripts/traverse-report share: small computations, and the command itself."""

import pathlib
import subprocess
import sys

import openpyxl

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import BINARY, BRIDGE, CROSSING, SOURCE, Computed  # noqa: E402

SCRIPTS = SOURCE / "scripts"
sys.path.insert(0, str(SCRIPTS))
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
    @classmethod
    def prepare(cls):
        (cls.folder / "limits.yml").write_text(LIMITS, encoding="utf-8")
        cls.compute("sweep", SWEEP)  # without limits: the report has to judge by itself
        for name, text in (("judged", SWEEP), ("study", STUDY), ("crossing", CROSSING), ("coach", COACH)):
            cls.compute(name, text, "-limits", "limits.yml")

    def report(self, *words):
        return subprocess.run([sys.executable, "-B", SCRIPTS / "traverse-report", "--program", BINARY, *map(str, words)],
                              cwd=self.folder, capture_output=True, text=True)

    def book_of(self, name, *words):
        run = self.report(f"{name}.h5", *words)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stderr, "")
        return openpyxl.load_workbook(self.folder / f"{name}.xlsx")

    def columns(self, sheet):
        """Name -> values."""
        head = [cell.value for cell in sheet[1]]
        rows = list(sheet.iter_rows(min_row=2, values_only=True))
        return {name: [row[i] for row in rows] for i, name in enumerate(head)}
