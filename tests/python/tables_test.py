"""Tables as people write them: a scene is the same, to the last bit, whatever the spelling of its files."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BINARY = os.environ.get("TRAVERSE_BINARY", str(SOURCE / "build/traverse"))
SCENE = """beam: {spans: [20.0], EI: EI.csv, mass: 1.0e4, elements_per_span: 8}
load: {LOAD, speed: 40.0}
model: {modes: 0}
output: {probes: [10.0], interval: 0.01}
ts: {dt: 0.002}
"""
PLAIN = "0, 8.25e9\n7.5, 1.25e10\n20, 8.25e9\n"  # x (m), EI (N m2)
AXLES = "0 100000\n-2.5 150000\n-12.5 120000\n"   # x (m), force (N)


class Spellings(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_scene(self, EI=PLAIN, beside="EI: EI.csv", load="file: axles.csv", axles=AXLES, words=()):
        (self.folder / "scene.yml").write_text(SCENE.replace("EI: EI.csv", beside).replace("LOAD", load), encoding="utf-8")
        (self.folder / "EI.csv").write_bytes(EI if isinstance(EI, bytes) else EI.encode())
        (self.folder / "axles.csv").write_text(axles, encoding="utf-8")
        return subprocess.run([BINARY, "-options_file", "scene.yml", "-output_file", "run.h5", *words], cwd=self.folder,
                              capture_output=True, text=True)

    def deflection(self, *args, **given):
        done = self.run_scene(*args, **given)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        with h5py.File(self.folder / "run.h5") as file:
            return file["probes/deflection"][:], done.stdout

    def test_five_spellings_of_one_file(self):
        expected, said = self.deflection()
        self.assertGreater(np.abs(expected).max(), 1e-4)
        self.assertNotIn("EI.csv:", said)
        named = "EI: {name: EI.csv, columns: [Station, EI], unit: MN m2, shift: -12300}"
        for text, beside, note in (
                ("0;8,25e9\n7,5;1,25e10\n20;8,25e9\n", "EI: EI.csv", "EI.csv: columns separated by semicolons, decimal commas\n"),
                ("# x\tEI (MN m2)\n0\t8,25e3\n7,5\t1,25e4\n20\t8,25e3\n", "EI: EI.csv",
                 "EI.csv: columns separated by tabs, decimal commas, EI in MN m2\n"),
                (b'\xef\xbb\xbf"x [mm]","EI [kN m^2]"\r\n0,8.25e6\r\n7500,1.25e7\r\n20000,8.25e6\r\n', "EI: EI.csv",
                 "EI.csv: x in mm, EI in kN m^2\n"),
                ('Station;Remark;EI\n12+300,0;"a; b";8250,0\n12+307,5;;12500,0\n12+320,0;;8250,0\n', named,
                 "EI.csv: columns separated by semicolons, decimal commas\n")):
            with self.subTest(text=text):
                found, said = self.deflection(text, beside)
                self.assertTrue(np.array_equal(found, expected))
                self.assertIn(note, said)

    def test_axles_of_a_formation(self):
        expected, _ = self.deflection()
        fleet = "name;load_kN;spacing\nlong;90;0\nlong;90;30\nshort;100;0\nshort;150;2,5\nshort;120;10\n"
        found, _ = self.deflection(load="file: axles.csv, formation: short", axles=fleet)
        self.assertTrue(np.array_equal(found, expected))
        station = "time,load_1_kN,load_2_kN,load_3_kN,spacing_1,spacing_2\n8:00,100,150,120,2.5,10\n8:01,90,90,,3,\n"
        found, _ = self.deflection(load="file: axles.csv, formation: axles 1", axles=station)
        self.assertTrue(np.array_equal(found, expected))
        refused = self.run_scene(axles=fleet)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("load_file = axles.csv (scene.yml:2): has 2 formations; load_formation names one of them: long, short",
                      refused.stderr)

    def test_options_beside_a_table(self):
        refused = self.run_scene(words=["-beam_EI_decimal", "dot"])
        self.assertIn("beam_EI_decimal = dot (command line): allowed: one of point, comma", refused.stderr)
        refused = self.run_scene(words=["-load_table_unit", "kN"])
        self.assertIn("load_table_unit = kN (command line): needs load_table, the table that it is for", refused.stderr)
        _, said = self.deflection(words=["-beam_mass_factor", "2"])
        self.assertIn("beam_mass_factor has no effect: beam_mass names no table", said)
        double, _ = self.deflection(words=["-beam_EI_factor", "2", "-load_file_factor", "2"])
        self.assertTrue(np.all(np.isfinite(double)))
        asked = subprocess.run([BINARY, "-help", "load_file_unit"], capture_output=True, text=True, check=True).stdout
        self.assertIn("-load_file_unit", asked)


if __name__ == "__main__":
    unittest.main()
