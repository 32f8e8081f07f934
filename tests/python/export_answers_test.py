"""scripts/export.py for searches, sensitivity analyses, fits and screens: a row for each answer, effect, estimate, value and
pair."""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
PROGRAM = os.environ.get("TRAVERSE_BINARY", SOURCE / "build" / "traverse")


class Answers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_and_export(self, scene, *words):
        """The results file of a scene, whose tables are written."""
        file = self.folder / "results.h5"
        subprocess.run([PROGRAM, "-options_file", SOURCE / "options" / scene, "-output_file", file, "-output_quiet", *words],
                       check=True, stdout=subprocess.DEVNULL)
        subprocess.run([sys.executable, "-B", SOURCE / "scripts" / "export.py", file, "-o", self.folder], check=True,
                       stdout=subprocess.DEVNULL)
        results = h5py.File(file)
        self.addCleanup(results.close)
        return results

    def table(self, name):
        """The columns of a table by their heads."""
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            heads, *rows = csv.reader(file)
        self.assertEqual(len(set(heads)), len(heads))
        return dict(zip(heads, zip(*rows)))

    def assert_column(self, column, values):
        np.testing.assert_array_equal(np.array(column, dtype=float), np.asarray(values, dtype=float))

    def test_search(self):
        results = self.run_and_export("studies/permitted_speeds.yml", "-sweep_hslm_a", "1,2", "-find_points", "5")
        ratios = self.table("find_ratios.csv")
        self.assert_column(ratios["load_speed (m/s)"], results["find/value"][:])
        self.assert_column(ratios["ratio of load_hslm_a 2 (1)"], results["find/ratio"][1])
        intervals = self.table("find_intervals.csv")
        self.assertEqual(set(intervals["answer"]), {"load_hslm_a 1", "load_hslm_a 2", "all"})
        self.assert_column(intervals["to (m/s)"], results["find/interval"][:, 1])

    def test_sensitivity_analysis(self):
        results = self.run_and_export("studies/gradient.yml")
        effects = self.table("sensitivity.csv")
        self.assertEqual(effects["factor"][:2], ("beam_EI", "beam_mass"))
        self.assertEqual((effects["quantity"][8], effects["unit"][8]), ("peak_acceleration", "m/s2"))
        self.assert_column(effects["elasticity (1)"], results["sensitivity/elasticity"][:].ravel())

    def test_fit(self):
        results = self.run_and_export("studies/fit_to_a_passage.yml")
        estimates = self.table("fit_estimates.csv")
        self.assertEqual((estimates["unknown"][0], estimates["unit"][0]), ("beam_EI", "N m2"))
        self.assert_column(estimates["estimate"], results["fit/estimate"][:])
        name = results["measured_series"].asstr()[0]
        series = self.table(f"fit_series_{name}.csv")
        self.assert_column(series["computed (m)"], results[f"fit/series/{name}/computed"][:])

    def test_screen(self):
        results = self.run_and_export("scenes/screen_line.yml")
        pairs = self.table("screen.csv")
        bridges, formations = results["screen/ratio"].shape
        self.assertEqual(len(pairs["bridge"]), bridges * formations)
        self.assertEqual(pairs["formation"][1], results["formation"].asstr()[1])
        self.assert_column(pairs["permitted_speed (m/s)"], results["screen/permitted_speed"][:].ravel())


if __name__ == "__main__":
    unittest.main()
