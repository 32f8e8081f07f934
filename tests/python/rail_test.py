"""Forces of rail and bridge in the report and in the exports: their numbers are those of the results file."""

import csv
import pathlib
import subprocess
import sys
import unittest
import xml.etree.ElementTree as tree

import h5py
import openpyxl

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import SOURCE, Computed  # noqa: E402

SCRIPTS = SOURCE / "scripts"
DECK = """
scene: {analysis: rail}
beam: {spans: 12.0, EI: 2.0e9, EA: 4.0e9, mass: 3000.0, surface_height: 1.0, temperature: {uniform: 30.0, expansion: 1.0e-5}}
support: {types: [roller, roller]}
foundation: {longitudinal: {x: [0.0, 12.0], k: [2.0e8, 1.0e7], limit: [0.0, 2.0e4]}}
track:
  rail: {EI: 1.28e7, EA: 3.2212e9, mass: 120.0, area: 0.0153, ends: held, temperature: 40.0, expansion_devices: 12.3}
  spacing: 0.6
  pad: {k: 1.0e8}
  longitudinal: {k: 6.0e6, limit: 12000.0, loaded_k: 1.8e7, loaded_limit: 36000.0}
  approach: 60.0
uic774: {train_length: 30.0, fronts: [0.0, 12.0, 6.0]}
"""
CASES = {"temperature", "bending", "braking", "traction", "separate", "in_sequence", "at_once"}


class Rail(Computed):
    @classmethod
    def prepare(cls):
        cls.compute("rail", DECK, "-limits", str(SOURCE / "options/limits/uic774_devices.yml"))

    def run_script(self, *words):
        run = subprocess.run([sys.executable, "-B", *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stderr, "")
        return run.stdout

    def test_report(self):
        self.run_script(SCRIPTS / "traverse-report", "rail.h5")
        book = openpyxl.load_workbook(self.folder / "rail.xlsx")
        with h5py.File(self.folder / "rail.h5") as file:
            group = file["rail_forces"]
            rows = list(book["Track and bridge"].iter_rows(values_only=True))
            self.assertEqual(len(rows), 1 + len(CASES))
            row = dict(zip(rows[0], next(row for row in rows if row[0] == "loads in sequence")))
            for name, value, factor in (("Rail relative to deck or ground (mm)", group["in_sequence/slip"][0], 1e3),
                                        ("Movement of the expansion device, x = 12.3 m (mm)", group["in_sequence/opening"][0], 1e3),
                                        ("Longitudinal bearing force, x = 12 m (kN)", group["in_sequence/bearing"][1], 1e-3)):
                self.assertAlmostEqual(row[name] / (factor * value), 1.0, 12)
            stress = list(book["Rail stresses"].iter_rows(values_only=True))
            self.assertAlmostEqual(stress[7][stress[0].index("Braking, least (MPa)")] / (1e-6 * group["braking/least_stress"][6]),
                                   1.0, 12)
            verdicts = {row[-1]: dict(zip(("limit", "value", "unit"), row[3:])) for row in
                        book["Verdicts"].iter_rows(values_only=True)}
            found = verdicts["rail_device_opening"]
            self.assertAlmostEqual(found["value"] / (1e3 * abs(group["in_sequence/opening"][0])), 1.0, 12)
            self.assertEqual(found["unit"], "mm")

    def test_tables(self):
        named = self.run_script(SCRIPTS / "export.py", "rail.h5", "--list").split()
        self.assertEqual(named, [*(f"rail_forces/{name}" for name in ("stress", "slip", "bearings", "devices", "peaks")),
                                 "verdicts"])
        self.run_script(SCRIPTS / "export.py", "rail.h5", "-o", "tables")
        with h5py.File(self.folder / "rail.h5") as file:
            group = file["rail_forces"]
            for name, at, quantity in (("slip", "sleeper_x", "greatest_slip"), ("bearings", "bearing_x", "bearing"),
                                       ("devices", "device_x", "opening")):
                with open(self.folder / f"tables/rail_forces_{name}.csv", encoding="utf-8") as table:
                    rows = list(csv.DictReader(table))
                self.assertEqual([float(row["x (m)"]) for row in rows], list(group[at][:]))
                column = next(head for head in rows[0] if head.startswith(f"at_once/{quantity} ("))
                self.assertEqual([float(row[column]) for row in rows], list(group[f"at_once/{quantity}"][:]))
            with open(self.folder / "tables/rail_forces_peaks.csv", encoding="utf-8") as table:
                peaks = {row["case"]: row for row in csv.DictReader(table)}
            self.assertEqual(set(peaks), CASES)
            self.assertEqual(float(peaks["braking"]["slip, train's front (m)"]), group["braking/slip"][2])

    def test_xdmf(self):
        self.run_script(SCRIPTS / "export.py", "rail.h5", "--xdmf")
        root = tree.parse(self.folder / "rail.xdmf").getroot()
        names = [one.get("Name") for one in root.iter("Attribute")]
        self.assertIn("in_sequence least stress (Pa)", names)
        self.assertEqual(len(names), 4 * len(CASES))
        with h5py.File(self.folder / "rail.h5") as file, h5py.File(self.folder / "rail.xdmf.h5") as out:
            self.assertEqual(list(out["rails/0/in_sequence least stress"][:]),
                             list(file["rail_forces/in_sequence/least_stress"][:]))
            self.assertEqual(list(out["sleepers/0/points"][:, 0]), list(file["rail_forces/sleeper_x"][:]))


if __name__ == "__main__":
    unittest.main()
