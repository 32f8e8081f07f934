"""import traverse: runs, sweeps and studies as Datasets, their errors, and the example."""

import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from module_scenes import BRIDGE, FORCES, SOURCE, InFolder, traverse  # noqa: E402


class Runs(InFolder):
    def test_a_scene_of_a_dictionary(self):
        results = traverse.run(FORCES, output="kept.h5", folder=self.folder, load_speed=50.0)
        with h5py.File(self.folder / "kept.h5") as file:
            np.testing.assert_array_equal(results["deflection"], file["probes/deflection"][()])
            np.testing.assert_array_equal(results["supports_reaction"].sel(component="fy"), file["supports/reaction"][:, :, 1])
            self.assertEqual(results["moment"].attrs["units"], file["probes/moment"].attrs["unit"])
            self.assertEqual(results.attrs["summary_deflection"], file["summary"].attrs["deflection"])
        self.assertEqual(results["deflection"].dims, ("time", "x"))
        self.assertEqual(results["x"].values.tolist(), [5.0, 10.0])
        self.assertEqual((results["time"].attrs["units"], results["time"].values[-1]), ("s", 0.3))
        self.assertIn("load_speed 50", results.attrs["options"])
        self.assertEqual(list(self.folder.iterdir()), [self.folder / "kept.h5"])

    def test_files_that_a_dictionary_names(self):
        (self.folder / "EI.csv").write_text("0,3e10\n20,3e10\n", encoding="utf-8")
        scene = FORCES | {"beam": BRIDGE | {"EI": pathlib.Path("EI.csv")}}
        found = traverse.run(scene, folder=self.folder)
        np.testing.assert_allclose(found["deflection"], traverse.run(FORCES)["deflection"], rtol=1e-9, atol=1e-12)
        self.refused(2, "EI.csv", traverse.run, scene)

    def test_numbers_of_numpy_and_a_file(self):
        scene = FORCES | {"load": {"forces": np.array([2.0e5, 1.0e5]), "positions": (0.0, -3.0), "speed": np.float64(40.0)}}
        plain = traverse.run(FORCES)
        np.testing.assert_array_equal(traverse.run(scene)["deflection"], plain["deflection"])
        file = self.folder / "forces.yml"
        file.write_text("beam: {spans: 20, EI: 3e10, mass: 1.8e4, elements_per_span: 8}\n"
                        "load: {forces: [2e5, 1e5], positions: [0, -3], speed: 40}\n", encoding="utf-8")
        again = traverse.run(file, ts_dt=1e-3, ts_max_time=0.3, output_interval=0.01, output_probes=[5.0, 10.0])
        np.testing.assert_array_equal(again["deflection"], plain["deflection"])

    def test_on_two_ranks(self):
        traverse.Passage(FORCES).close()  # MPI has started in this process
        np.testing.assert_allclose(traverse.run(FORCES, ranks=2)["deflection"], traverse.run(FORCES)["deflection"],
                                   rtol=1e-9, atol=1e-12)

    def test_refusals(self):
        self.refused(2, "beam_EI.*scene.yml", traverse.run, FORCES | {"beam": BRIDGE | {"EI": -1.0}})
        self.refused(2, "ts_tpye", traverse.run, FORCES, ts_tpye="rk")
        self.refused(2, "not_there.yml", traverse.run, "not_there.yml")
        self.refused(4, "no results file", traverse.open, self.folder / "not_there.h5")

    def test_ranks_are_a_number_of_processes(self):
        for ranks in (-1, 0, "x", "2", 1.5, True, None, 10**9):
            self.refused(2, "ranks = .*: allowed: a whole number", traverse.run, FORCES, ranks=ranks)

    def test_what_computes_nothing_has_no_results(self):
        kept = self.folder / "kept.h5"
        traverse.run(FORCES, output=kept)
        for options in ({"check": True}, {"version": True}):
            for output in (None, kept):  # not the results of the earlier run either
                self.refused(2, "without results", traverse.run, FORCES, output=output, **options)

    def test_a_sweep(self):
        results = traverse.run(FORCES | {"sweep": {"speed": [30.0, 50.0, 5.0]}})
        self.assertEqual(results["peak_deflection"].dims, ("hslm_a", "speed", "x"))
        self.assertEqual(results["speed"].values.tolist(), [30.0, 35.0, 40.0, 45.0, 50.0])
        alone = traverse.run(FORCES, load_speed=45.0)
        swept = results["peak_deflection"].sel(speed=45.0, x=10.0).item()
        self.assertAlmostEqual(swept / abs(alone.attrs["summary_deflection"]), 1.0, delta=1e-3)

    def test_load_models(self):
        scene = {"beam": BRIDGE, "scene": {"analysis": "envelope"}, "norm": {"load_models": ["lm71", "sw2"]}}
        results = traverse.run(scene)
        self.assertEqual(results["static_load"].values.tolist(), ["LM71", "SW/2"])
        self.assertEqual(results["static_moment"].dims, ("static_load", "static_x", "extreme"))
        self.assertIn("6.3.2", results["static_load_words"].sel(static_load="LM71").values[1])
        middle = results["static_moment"].sel(static_load="LM71", extreme="greatest").interp(static_x=10.0).item()
        self.assertAlmostEqual(middle / 6240e3, 1.0, delta=0.1)  # of a simple span of 20 m

    def test_a_study(self):
        results = traverse.study(FORCES, {"beam_EI": [2.0e10, 3.0e10], "load_speed": {"from": 30, "to": 50, "step": 10}})
        self.assertEqual(results["peak_moment"].dims, ("beam_EI", "load_speed", "x"))
        self.assertEqual(results["beam_EI"].values.tolist(), [2.0e10, 3.0e10])
        self.assertEqual(results["load_speed"].values.tolist(), [30.0, 40.0, 50.0])
        alone = traverse.run(FORCES, beam_EI=2.0e10, load_speed=30.0)
        studied = results["peak_deflection"].sel(beam_EI=2.0e10, load_speed=30.0).max().item()
        self.assertAlmostEqual(studied / abs(alone.attrs["summary_deflection"]), 1.0, delta=1e-3)

    def test_a_study_of_rows_and_of_spans(self):
        vary = {"beam_spans": [20.0, 25.0], "load_speed": [30.0, 40.0]}
        results = traverse.study(FORCES | {"output": {"interval": 0.01}}, vary, study_combine="together")
        self.assertEqual(results["peak_deflection"].dims, ("row", "probe"))
        self.assertEqual(results["load_speed"].dims, ("row",))
        self.assertEqual(results["probes_x"].values[:, 0].tolist(), [10.0, 12.5])

    def test_an_interrupted_run_has_results(self):
        path = self.folder / "slow.h5"
        code = (f"import traverse\ntry: traverse.run({FORCES!r}, ts_dt=1e-8, output={str(path)!r})\n"
                "except KeyboardInterrupt: print('interrupted')")
        run = subprocess.Popen([sys.executable, "-B", "-c", code], stdout=subprocess.PIPE, text=True,
                               env=os.environ | {"PYTHONPATH": str(SOURCE / "python")})
        while run.poll() is None and not (path.exists() and path.stat().st_size > 0):
            time.sleep(0.1)
        run.send_signal(signal.SIGINT)
        self.assertEqual((run.wait(300), run.stdout.read()), (0, "interrupted\n"))
        run.stdout.close()
        self.assertEqual(traverse.open(path).attrs["summary_ended"], "ended by signal 2")

    def test_a_scene_that_is_no_study_and_no_fit(self):
        for vary in (None, {}):
            with self.assertRaisesRegex(traverse.Error, "is not a study or a sweep"):
                traverse.study(FORCES, vary)
        with self.assertRaisesRegex(traverse.Error, "is not a fit"):
            traverse.fit(FORCES)

    def test_a_search_with_an_answer_for_each_stiffness(self):
        scene, bound = FORCES | {"model": {"modes": 1}}, 1.7e-3  # m
        results = traverse.find(scene, "load_speed", [20.0, 60.0], quantity="peak_deflection", equals=bound, find_points=9,
                                study_vary_beam_EI=[2.5e10, 3.0e10])
        self.assertEqual(results["answer"].values.tolist(), ["beam_EI 2.5e+10", "beam_EI 3e+10", "all"])
        self.assertEqual(results["find_ratio"].dims, ("answer", "find_value"))
        self.assertEqual(results["find_value"].values.tolist(), results["load_speed"].values.tolist())
        peaks = results["peak_deflection"].max("x").transpose("beam_EI", "load_speed").values
        np.testing.assert_allclose(results["find_ratio"][:2], peaks / bound)
        np.testing.assert_array_equal(results["find_ratio"][2], results["find_ratio"][:2].max("answer"))
        self.assertEqual((results.attrs["find_option"], results.attrs["find_accuracy"]), ("load_speed", 1e-3))
        ends = [(int(answer), speed) for answer, interval, at_end in zip(
            results["find_interval_answer"], results["find_interval"].values, results["find_interval_at_end"].values)
            for speed, is_end in zip(interval, at_end) if not is_end and answer < 2]
        self.assertGreater(len(ends), 1)
        for answer, speed in ends:
            alone = traverse.run(scene, load_speed=speed, beam_EI=[2.5e10, 3.0e10][answer])
            self.assertAlmostEqual(abs(alone.attrs["summary_deflection"]) / bound, 1.0, delta=5e-3)

    def test_sensitivity_analyses(self):
        scene = FORCES | {"model": {"modes": 1}}
        vary = {"beam_EI": {"normal": [3e10, 1e9]}, "beam_rotary_inertia": {"uniform": [0.0, 1.0]}}
        local = traverse.sensitivity(scene, vary, "local").sel(quantity="peak_deflection")
        self.assertEqual(local["factor"].values.tolist(), ["beam_EI", "beam_rotary_inertia"])
        low, high = (traverse.run(scene, beam_EI=EI).attrs["summary_deflection"] for EI in (2.99e10, 3.01e10))
        slope = (abs(high) - abs(low)) / 2e8
        self.assertAlmostEqual(local["sensitivity_derivative"].sel(factor="beam_EI").item() / slope, 1.0, delta=0.05)
        morris = traverse.sensitivity(scene, vary, "morris", draws=4)
        self.assertEqual(morris["sensitivity_effect_magnitude"].dims, ("quantity", "factor"))
        self.assertEqual((morris.sizes["point"], morris.attrs["sensitivity_base_samples"]), (4 * (2 + 1), 4))
        sobol = traverse.sensitivity(scene, vary, draws=16)
        self.assertEqual((sobol.sizes["point"], sobol.attrs["sensitivity_method"]), (16 * (2 + 2), "sobol"))
        total = sobol["sensitivity_total"].sel(quantity="peak_deflection")
        self.assertGreater(total.sel(factor="beam_EI").item(), 10.0 * total.sel(factor="beam_rotary_inertia").item())

    def test_refusals_of_searches_and_sensitivity_analyses(self):
        between, uncertain = [1e10, 1e11], {"beam_EI": {"normal": [3e10, 1e9]}}
        self.refused(2, "no limits of runs", traverse.find, FORCES, "beam_EI", between)
        self.refused(2, "needs find_equals", traverse.find, FORCES, "beam_EI", between, quantity="peak_deflection")
        self.refused(2, "not above the first", traverse.find, FORCES, "beam_EI", between[::-1], "limits", "peak_deflection", 1e-3)
        self.refused(2, "give either", traverse.find, FORCES, "beam_EI", between, "end_rotation", "peak_deflection", 1e-3)
        self.refused(2, "study_draws is missing", traverse.sensitivity, FORCES, uncertain)
        self.refused(2, "none, local, morris, sobol", traverse.sensitivity, FORCES, uncertain, "best")

    def test_modes(self):
        results = traverse.run({"beam": BRIDGE, "scene": {"analysis": "modes"}, "modes": {"count": 2}})
        first = np.pi / (2.0 * 20.0**2) * np.sqrt(3.0e10 / 1.8e4)  # Hz, of a simple beam
        self.assertAlmostEqual(results["modes_frequency"].values[0] / first, 1.0, delta=1e-4)
        self.assertEqual(results["modes_shape"].dims, ("mode", "modes_x"))


class Example(InFolder):
    def test_runs_and_draws(self):
        run = subprocess.run(["/usr/bin/python3", "-B", SOURCE / "examples/three_span_train.py", self.folder], cwd=SOURCE,
                             capture_output=True, text=True,
                             env=os.environ | {"MPLBACKEND": "Agg", "PYTHONPATH": str(SOURCE / "python")})
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["python_crossing.png", "python_damper.png", "python_speeds.png"])
        self.assertRegex(run.stdout, r"largest deflection at 40 m: 0\.\d+ mm, with a damper 0\.\d+ mm")


if __name__ == "__main__":
    unittest.main()
