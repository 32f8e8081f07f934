"""traverse.Passage: in pieces as in one go, under forces, and what it refuses."""

import copy
import os
import pathlib
import subprocess
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from module_scenes import BRIDGE, FORCES, FREE, HOPPING, SOURCE, InFolder, traverse  # noqa: E402


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
            self.refused(2, "no vehicle 1099511627776", passage.set_force, vehicle=2**40, body="body", fy=1.0)
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


class Errors(InFolder):
    def test_scenes_that_are_refused(self):
        self.refused(2, "beam_EI = -1.*problem", traverse.Passage, FORCES | {"beam": BRIDGE | {"EI": -1.0}})
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
        code = f"import traverse; traverse.Passage({FORCES!r}).advance()"
        run = subprocess.run(["/usr/bin/python3", "-B", "-c", code], capture_output=True, text=True,
                             env=os.environ | {"PYTHONPATH": str(SOURCE / "python")})
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""))


if __name__ == "__main__":
    unittest.main()
