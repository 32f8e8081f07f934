"""scripts/export.py for every kind of analysis: a row for each run, answer, effect, estimate, value, pair, mode and station."""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as tree

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
        subprocess.run([sys.executable, "-B", SOURCE / "scripts" / "export.py", file, "-o", self.folder, "--xdmf"], check=True,
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

    def grids(self):
        """The values of each grid of the XDMF file by their names, with the points."""
        grids = tree.parse(self.folder / "results.xdmf").getroot().findall("Domain/Grid/Grid")
        with h5py.File(self.folder / "results.xdmf.h5") as file:
            return {grid.get("Name"): {"points": file[grid.find("Geometry/DataItem").text.split(":")[1]][:]} |
                    {one.get("Name"): file[one.find("DataItem").text.split(":")[1]][:] for one in grid.findall("Attribute")}
                    for grid in grids}

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
        np.testing.assert_array_equal(self.grids()["A2"]["peak_moment (N m)"], results["sweep/peak_moment"][1].ravel())

    def test_verdicts(self):
        results = self.run_and_export("scenes/r1_moving_force.yml", "-limits", SOURCE / "options/limits/en1990.yml")
        verdicts = self.table("verdicts.csv")
        self.assertEqual(list(verdicts["quantity"]), list(results["verdicts/quantity"].asstr()[:, 0]))
        self.assertEqual(list(verdicts["verdict"]), list(results["verdicts/verdict"].asstr()[:, 0]))
        self.assert_column(verdicts["value"], results["verdicts/value"][:])

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
        line = self.grids()["static effects"]
        np.testing.assert_array_equal(line["moment under LM71, greatest (N m)"], results["static/moment"][1, :, 1])
        np.testing.assert_array_equal(line["points"][:, 0], results["static/x"][:])

    def test_forces_of_the_rail(self):
        results = self.run_and_export("scenes/uic774_e13.yml")
        self.assert_column(self.table("rail_forces_stress.csv")["x (m)"], results["rail_forces/x"][:])

    def test_search(self):
        results = self.run_and_export("studies/permitted_speeds.yml", "-sweep_hslm_a", "1,2", "-find_points", "5")
        ratios = self.table("find_ratios.csv")
        self.assert_column(ratios["load_speed (m/s)"], results["find/value"][:])
        self.assert_column(ratios["ratio of load_hslm_a 2 (1)"], results["find/ratio"][1])
        worst = results["find/run"][:].astype(int)[1]
        self.assert_column(ratios["run of load_hslm_a 2"], worst)
        governing = results["criterion"].asstr()[:][results["find/limit"][:].astype(int)[1]]
        self.assertEqual(list(ratios["limit of load_hslm_a 2"]), list(governing))
        self.assertIn("deck_acceleration", governing)
        surface = self.grids()["ratios"]
        np.testing.assert_array_equal(surface["ratio"], results["find/ratio"][:].ravel())
        self.assertAlmostEqual(surface["points"][:, 2].max(), 0.5)
        self.assertEqual(len(self.grids()["runs"]["points"]), len(results["study/finished"]))
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
        self.assert_column(self.table("fit_correlations.csv")["correlation with beam_mass (1)"], results["fit/correlation"][1])
        self.assert_column(self.table("fit_starts.csv")["beam_EI (N m2)"], results["fit/starts/estimate"][:, 0])
        self.assert_column(self.table("fit_deviations.csv")["standard_deviation"], results["fit/series_sd"][:])
        line = self.grids()[f"{name} computed"]
        np.testing.assert_array_equal(line["computed (m)"], results[f"fit/series/{name}/computed"][:])
        measured, computed = line["measured (m)"], line["computed (m)"]
        both = np.concatenate([measured, computed])
        np.testing.assert_allclose(line["points"][:, 1], (computed - both.min()) / np.ptp(both))

    def test_screen(self):
        results = self.run_and_export("scenes/screen_line.yml")
        pairs = self.table("screen.csv")
        bridges, formations = results["screen/ratio"].shape
        self.assertEqual(len(pairs["bridge"]), bridges * formations)
        self.assertEqual(pairs["formation"][1], results["formation"].asstr()[1])
        self.assert_column(pairs["permitted_speed (m/s)"], results["screen/permitted_speed"][:].ravel())
        rows, names = self.table("screen_bridges.csv"), results["formation"].asstr()[:]
        self.assert_column(rows["bridge_frequency (Hz)"], results["screen/bridge_frequency"][:])
        self.assertEqual(list(rows["governing_formation"]),
                         [names[int(i)] for i in results["screen/governing_formation"][:]])
        rows, names = self.table("screen_formations.csv"), results["bridge"].asstr()[:]
        self.assertEqual(list(rows["governing_bridge"]), [names[int(i)] for i in results["screen/governing_bridge"][:]])
        surface = self.grids()["pairs"]
        i, j = surface["bridge"].astype(int), surface["formation"].astype(int)
        np.testing.assert_array_equal(surface["permitted_speed (m/s)"], results["screen/permitted_speed"][:][i, j])
        self.assertEqual(surface["ratio (1)"][0], surface["ratio (1)"].max())  # the worst bridge and formation are first


if __name__ == "__main__":
    unittest.main()
