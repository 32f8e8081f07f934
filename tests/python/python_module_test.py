"""import traverse: runs, sweeps and studies as Datasets; passages step by step, with forces; errors."""

import copy
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
sys.path.insert(0, str(SOURCE / "python"))
import traverse  # noqa: E402

BRIDGE = {"spans": [20.0], "EI": 3.0e10, "mass": 1.8e4, "elements_per_span": 8}
FORCES = {
    "beam": BRIDGE,
    "load": {"forces": [2.0e5, 1.0e5], "positions": [0.0, -3.0], "speed": 40.0},
    "ts": {"dt": 1.0e-3, "max_time": 0.3},
    "output": {"interval": 0.01, "probes": [5.0, 10.0]},
}
# A sprung wheel that leaves a bridge at a bump and comes down again.
HOPPING = {
    "beam": {"spans": 20.0, "EI": 8.323e9, "mass": 2303.0, "elements_per_span": 6, "damping_ratios": 0.01},
    "vehicle": {"sprung": {
        "bodies": ["axle", "body"], "joints": ["guide"], "springs": ["suspension"], "drivers": ["level"],
        "wheels": ["wheel"],
        "axle": {"mass": 1000.0, "inertia": 100.0, "position": [0.0, 0.46]},
        "body": {"mass": 5750.0, "inertia": 100.0, "position": [0.0, 1.5]},
        "guide": {"type": "prismatic", "bodies": ["axle", "body"], "point": [0.0, 1.0], "axis": [0.0, 1.0]},
        "suspension": {"bodies": ["axle", "body"], "from": [0.0, 0.46], "to": [0.0, 1.5], "stiffness": 1.595e6,
                       "damping": 2.0e4},
        "level": {"body": "axle", "coordinate": "phi", "value": 0.0},
        "wheel": {"body": "axle", "radius": 0.46, "law": "hertz", "stiffness": 3.64e10}}},
    "train": {"vehicles": "sprung", "positions": 0.0, "speed": 30.0},
    "track": {"profile": "bump", "bump": {"start": 7.5, "length": 2.0, "height": 0.02}},
    "ts": {"dt": 1.0e-3, "max_time": 0.4},
    "output": {"interval": 0.01, "probes": [5.0, 10.0]},
}
# One body that nothing holds, where there is no gravity.
FREE = {
    "vehicle": {"stone": {"bodies": ["rock"], "rock": {"mass": 2.0, "inertia": 0.5, "position": [0.0, 0.0]}}},
    "train": {"vehicles": "stone", "positions": 0.0},
    "gravity": 0.0, "scene": {"start": "given"},
    "ts": {"dt": 0.01, "max_time": 1.0}, "output": {"interval": 0.05},
}


class InFolder(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def refused(self, status, pattern, call, *words, **options):
        with self.assertRaisesRegex(traverse.Error, pattern) as caught:
            call(*words, **options)
        self.assertEqual(caught.exception.status, status)
        self.assertEqual(len(str(caught.exception).splitlines()), 1)


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

    def test_a_sweep(self):
        results = traverse.run(FORCES | {"sweep": {"speed": [30.0, 50.0, 5.0]}})
        self.assertEqual(results["peak_deflection"].dims, ("hslm_a", "speed", "x"))
        self.assertEqual(results["speed"].values.tolist(), [30.0, 35.0, 40.0, 45.0, 50.0])
        alone = traverse.run(FORCES, load_speed=45.0)
        swept = results["peak_deflection"].sel(speed=45.0, x=10.0).item()
        self.assertAlmostEqual(swept / abs(alone.attrs["summary_deflection"]), 1.0, delta=1e-3)

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

    def test_modes(self):
        results = traverse.run({"beam": BRIDGE, "scene": {"analysis": "modes"}, "modes": {"count": 2}})
        first = np.pi / (2.0 * 20.0**2) * np.sqrt(3.0e10 / 1.8e4)  # Hz, of a simple beam
        self.assertAlmostEqual(results["modes_frequency"].values[0] / first, 1.0, delta=1e-4)
        self.assertEqual(results["modes_shape"].dims, ("mode", "modes_x"))


class Pieces(InFolder):
    """A passage in pieces is the run of the program, to the last bit."""

    def same(self, scene, **options):
        whole = traverse.run(scene, **options)
        with traverse.Passage(scene, **options) as passage:
            self.assertEqual((passage.time, passage.interval), (0.0, whole["time"].attrs["interval"]))
            for number, time in enumerate(whole["time"].values):
                if number % 3 != 2:  # one in three is passed by
                    passage.advance(time - 0.3 * passage.interval)
                    self.assertEqual(passage.time, time)
                    now = passage.read()
                    for name in now.data_vars:
                        np.testing.assert_array_equal(now[name], whole[name].sel(time=time), f"{name} at {time} s")
        return whole

    def test_of_forces(self):
        self.assertIn("supports_reaction", self.same(FORCES))

    def test_of_a_wheel_that_hops(self):
        self.assertGreater(self.same(HOPPING, model_vehicles="full").attrs["summary_contact_losses"], 0)

    def test_of_linear_vehicles_over_modes(self):
        level = {key: value for key, value in HOPPING.items() if key != "track"}
        self.same(level, model_vehicles="linear", model_modes=4)

    def test_of_modes_that_are_exact_in_time(self):
        self.same(FORCES, model_modes=3, model_damping_ratios=0.01)

    def test_of_steps_with_an_error_control(self):
        self.same(HOPPING, model_vehicles="full", ts_type="esdirk4", ts_adapt_type="ladder")

    def test_of_a_type_of_petsc(self):
        self.same(HOPPING, model_vehicles="full", ts_type="arkimex")

    def test_of_what_the_accuracy_chooses(self):
        open_scene = copy.deepcopy(HOPPING)
        del open_scene["ts"]["dt"], open_scene["beam"]["elements_per_span"]
        self.same(open_scene, model_vehicles="full", accuracy=1e-2)

    def test_the_end_between_two_samples(self):
        whole = traverse.run(FORCES, ts_max_time=0.304, output="kept.h5", folder=self.folder)
        with h5py.File(self.folder / "kept.h5") as file, traverse.Passage(FORCES, ts_max_time=0.304) as passage:
            self.assertEqual(passage.advance(0.303), 0.304)
            np.testing.assert_array_equal(passage.read("moment"), file["end/probes/moment"][0])
        self.assertEqual(whole["time"].values[-1], 0.3)

    def test_two_at_once(self):
        with traverse.Passage(FORCES) as first, traverse.Passage(HOPPING) as second:
            while first.time < 0.2:
                first.advance()
                second.advance()
            np.testing.assert_array_equal(first.read("deflection"), traverse.run(FORCES)["deflection"].sel(time=0.2))
            whole = traverse.run(HOPPING, model_vehicles="full")
            np.testing.assert_array_equal(second.read("deflection"), whole["deflection"].sel(time=0.2))


class Forces(InFolder):
    def test_impulse_and_energy(self):
        with traverse.Passage(FREE) as passage:
            passage.advance(0.1)
            passage.set_force(body="rock", fx=3.0, moment=-0.1)
            passage.advance(0.3)
            self.assertAlmostEqual(passage.time, 0.3, places=15)
            x, y, angle = passage.read("vehicles_0_rock_velocity")
            self.assertAlmostEqual(x, 3.0 * 0.2 / 2.0, places=12)
            self.assertAlmostEqual(angle, -0.1 * 0.2 / 0.5, places=12)
            self.assertEqual(y, 0.0)
            self.assertAlmostEqual(passage.read("energy_work"), 0.5 * 2.0 * x**2 + 0.5 * 0.5 * angle**2, places=12)
            passage.set_force(body="rock")
            passage.advance(1.0)
            self.assertAlmostEqual(passage.read("vehicles_0_rock_velocity")[0], x, places=12)
            self.assertAlmostEqual(passage.read("vehicles_0_rock_position")[0], 0.5 * 1.5 * 0.2**2 + 0.7 * x, places=12)

    def test_a_table_over_time(self):
        """The same force as an actuator's table, which comes on and goes within 1e-6 s about that time."""
        table = "0,0,0\n0.0999995,0,0\n0.1000005,0,-2e4\n0.1999995,0,-2e4\n0.2000005,0,0\n"
        (self.folder / "push.csv").write_text(table, encoding="utf-8")
        driven = copy.deepcopy(HOPPING)
        driven["vehicle"]["sprung"] |= {"actuators": ["push"], "push": {"body": "body", "table": "push.csv"}}
        fine = {"model_vehicles": "full", "ts_dt": 2e-4}
        table = traverse.run(driven, folder=self.folder, **fine)
        with traverse.Passage(HOPPING, **fine) as passage:
            largest = {"deflection": 0.0, "vehicles_0_body_position": 0.0}
            while passage.time < passage.end:
                passage.set_force(body="body", fy=-2.0e4 if 0.095 < passage.time < 0.195 else 0.0)
                passage.advance()
                at = table.sel(time=passage.time)
                for name in largest:
                    off = np.abs(passage.read(name) - at[name].values) / np.abs(table[name]).max().item()
                    largest[name] = max(largest[name], off.max())
        free = traverse.run(HOPPING, **fine)
        self.assertGreater(np.abs(free["deflection"] - table["deflection"]).max() / np.abs(table["deflection"]).max(), 0.05)
        for name, off in largest.items():
            self.assertLess(off, 1e-5, name)

    def test_a_force_on_the_beam(self):
        """A force that comes onto a simple beam at rest, by its modes: 2 F/(m L w^2) sin^2 (1 - cos w t) each."""
        beam = {"beam": BRIDGE | {"elements_per_span": 32}, "load": {"forces": 0.0, "positions": 0.0, "speed": 0.0},
                "ts": {"dt": 1.0e-4, "max_time": 0.2}, "output": {"interval": 0.01, "probes": [10.0]}}
        force, start = -1.0e5, 0.05
        odd = np.arange(1, 60, 2)
        omega = (odd * np.pi / 20.0) ** 2 * np.sqrt(3.0e10 / 1.8e4)

        def midspan(time):
            return np.sum(2.0 * force / (1.8e4 * 20.0 * omega**2) * (1.0 - np.cos(omega * max(time - start, 0.0))))

        with traverse.Passage(beam) as passage:
            passage.advance(start)
            passage.set_force(x=10.0, fy=force)
            off = work = 0.0
            while passage.time < 0.2:
                passage.advance()
                off = max(off, abs(passage.read("deflection")[0] - midspan(passage.time)))
                work = max(work, abs(passage.read("energy_work") - force * passage.read("deflection")[0]))
            self.assertLess(off, 1e-4 * np.abs(force) * 20.0**3 / (48.0 * 3.0e10))
            self.assertLess(work, 1e-9 * passage.read("energy_work"))

    def test_a_force_on_a_span_that_rests(self):
        """Of separate spans, behind which nothing else moves: as where all of them are stepped."""
        beam = BRIDGE | {"spans": "20*6", "continuity": "simply_supported"}
        scene = FORCES | {"beam": beam, "output": {"interval": 0.01, "probes": [10.0, 90.0]}}

        def deflection(**options):
            with traverse.Passage(scene, **options) as passage:
                passage.advance(0.05)
                passage.set_force(x=90.0, fy=-1.0e5)
                passage.advance(0.15)
                passage.set_force(x=90.0)
                passage.advance(0.25)
                return passage.read("deflection")

        self.assertGreater(abs(deflection()[1]), 1e-4)
        np.testing.assert_allclose(deflection(), deflection(model_window=0.0), rtol=1e-9)

    def test_refusals(self):
        with traverse.Passage(HOPPING) as passage:
            self.refused(2, "no body wing", passage.set_force, body="wing", fy=1.0)
            self.refused(2, "no vehicle 1", passage.set_force, vehicle=1, body="body", fy=1.0)
            self.refused(2, "21.*not on the beam.*20", passage.set_force, x=21.0, fy=1.0)
            self.refused(2, "finite", passage.set_force, body="body", fy=np.nan)
            self.refused(2, "a body or a station", passage.set_force, fy=1.0)
            self.refused(2, "only fy", passage.set_force, x=1.0, fx=1.0)
            self.refused(2, "beyond the end.*0.4 s", passage.advance, 0.5)
            self.refused(2, "beyond the end", passage.advance, np.nan)
            self.refused(2, "no quantity wings", passage.read, "wings")
            self.assertEqual(passage.advance(), 0.01)
        self.refused(2, "closed", passage.advance)
        self.refused(2, "model_vehicles full", traverse.Passage(HOPPING, model_vehicles="linear").set_force, body="body")
        self.refused(2, "model_modes 0", traverse.Passage(FORCES, model_modes=3).set_force, x=1.0)
        self.refused(2, "needs a beam", traverse.Passage(FREE).set_force, x=1.0)


class Example(InFolder):
    def test_runs_and_draws(self):
        run = subprocess.run(["/usr/bin/python3", "-B", SOURCE / "examples/three_span_train.py", self.folder], cwd=SOURCE,
                             capture_output=True, text=True,
                             env=os.environ | {"MPLBACKEND": "Agg", "PYTHONPATH": str(SOURCE / "python")})
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["python_crossing.png", "python_damper.png", "python_speeds.png"])
        self.assertRegex(run.stdout, r"largest deflection at 40 m: 0\.\d+ mm, with a damper 0\.\d+ mm")


class Errors(InFolder):
    def test_scenes_that_are_refused(self):
        self.refused(2, "beam_EI.*scene.yml", traverse.Passage, FORCES | {"beam": BRIDGE | {"EI": -1.0}})
        self.refused(2, "not_there.yml", traverse.Passage, "not_there.yml")
        self.refused(2, "a sweep", traverse.Passage, FORCES | {"sweep": {"speed": [30.0, 50.0, 5.0]}})
        self.refused(2, "scene_analysis", traverse.Passage, FORCES, scene_analysis="modes")
        self.refused(2, "-help", traverse.Passage, FORCES, help="beam")
        for name in ("ts_tpye", "ts_adapt_tpye"):
            self.refused(2, name, traverse.Passage, FORCES, **{name: "rk"})
        self.refused(2, "ts_type", traverse.Passage, FORCES, ts_type="no_such_type")
        with traverse.Passage(FORCES) as passage:  # and after all of them the next one goes
            self.assertEqual(passage.advance(0.02), 0.02)

    def test_steps_that_cannot_be_taken(self):
        with traverse.Passage(HOPPING, ts_type="rk", ts_dt=0.01) as passage:
            self.refused(3, "step", passage.advance, 0.4)
            self.refused(3, "goes no further", passage.advance, 0.4)

    def test_nothing_is_printed(self):
        code = f"import sys; sys.path.insert(0, {str(SOURCE / 'python')!r}); import traverse; p = traverse.Passage({FORCES!r}); p.advance()"
        run = subprocess.run(["/usr/bin/python3", "-B", "-c", code], capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""))


if __name__ == "__main__":
    unittest.main()
