"""scripts/export.py for every kind of analysis: a row for each run, answer, effect, estimate, value, pair, mode and station."""

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

    def test_sweep(self):
        results = self.run_and_export("scenes/hslm_sweep.yml", "-sweep_speed", "40,60,10", "-sweep_hslm_a", "1,2",
                                      "-model_modes", "3", "-output_probes", "4,10")
        rows = self.table("sweep.csv")
        self.assert_column(rows["train"], [1, 1, 1, 2, 2, 2])
        self.assert_column(rows["sweep/speed (m/s)"], [40, 50, 60, 40, 50, 60])
        self.assert_column(rows["sweep/peak_deflection at 4 m (m)"], results["sweep/peak_deflection"][:, :, 0].ravel())
        self.assertFalse([head for head in rows if head.startswith("sweep/x")])

    def test_natural_modes(self):
        results = self.run_and_export("scenes/r1_moving_force.yml", "-scene_analysis", "modes", "-beam_damping_ratios", "0.01")
        undamped = self.table("modes_undamped.csv")
        self.assert_column(undamped["frequency (Hz)"], results["modes/frequency"][:])
        self.assert_column(self.table("modes_damped.csv")["damping_ratio (1)"], results["modes/damping_ratio"][:])
        self.assert_column(self.table("modes_shapes.csv")["shape of mode 2 (1)"], results["modes/shape"][1])

    def test_static_effects(self):
        results = self.run_and_export("scenes/line_class_d2.yml")
        effects = self.table("static_effects.csv")
        self.assert_column(effects["moment under LM71, greatest (N m)"], results["static/moment"][1, :, 1])
        self.assert_column(self.table("static_reactions.csv")["x (m)"], results["static/reaction_x"][:])

    def test_forces_of_the_rail(self):
        results = self.run_and_export("scenes/uic774_e13.yml")
        self.assert_column(self.table("rail_forces_stress.csv")["x (m)"], results["rail_forces/x"][:])

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
