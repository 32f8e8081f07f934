"""What a results file says of the model, its envelopes and its statics, on small computations."""

import pathlib
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import CROSSING, SOURCE, Computed  # noqa: E402


class Model(Computed):
    @classmethod
    def prepare(cls):
        cls.compute("crossing", CROSSING)

    def test_the_file_says_what_was_modelled(self):
        with h5py.File(self.folder / "crossing.h5") as file:
            model = file["model"]
            self.assertEqual(list(model["spans"]), [20.0, 25.0])
            self.assertEqual(list(model["hinges"]), [26.0])
            kinds = [tuple(row) for row in model["supports"].asstr()[:]]
            self.assertEqual(kinds, [("pinned", "end"), ("free", "continuous"), ("roller", "end")])
            self.assertEqual(model["foundation/vertical"][:].tolist(), [[20.0, 2.0e9, 0.0, 0.0, 0.0, 0.0, 0.0]])
            self.assertEqual(model["forces/load"][:].tolist(), [[0.0, 2.0e5], [-3.0, 1.0e5]])
            self.assertIn("20", " ".join(row[1] for row in model["notes"].asstr()[:]))

    def test_the_envelope_holds_the_samples_and_reaches_the_peak(self):
        with h5py.File(self.folder / "crossing.h5") as file:
            least, greatest = file["envelope/moment"][:].T
            moment = file["probes/moment"][:]
            self.assertTrue(np.all(least <= moment.min(axis=0)) and np.all(greatest >= moment.max(axis=0)))
            summary = file["summary"].attrs
            most = np.abs(file["envelope/deflection"][:]).max()
            self.assertLess(abs(most / abs(summary["deflection"]) - 1.0), 0.01)
            place = int(np.argmin(np.abs(file["probes/x"][:] - summary["deflection_place"])))
            self.assertAlmostEqual(file["envelope/static_deflection"][place] / summary["static_deflection"], 1.0, 9)

    def test_vehicles_of_the_train_are_there(self):
        self.compute("vehicles", f"options_file: {SOURCE}/options/scenes/three_span_half_car.yml\n", "-ts_max_steps", "3")
        with h5py.File(self.folder / "vehicles.h5") as file:
            names = sorted(name for name in file["vehicles/0"] if "normal_force" in file[f"vehicles/0/{name}"])
            self.assertEqual(len(file["model/train"]), len(file["vehicles"]))
            index = int(file["model/train"][0, 0])
            self.assertEqual(len(file[f"model/vehicles/{index}/wheels"]), len(names))
            bodies = [row[1] for row in file[f"model/vehicles/{index}/names"].asstr()[:]]
            x = file["model/train"][0, 1] + file[f"model/vehicles/{index}/bodies"][0, 0]
            self.assertAlmostEqual(file[f"vehicles/0/{bodies[0]}/position"][0, 0], x, 6)

    def test_joints_have_their_ends_and_names(self):
        """A rope has an end on each of its bodies; a revolute has one place."""
        self.compute("hanging", """
vehicle:
  crane:
    bodies: [frame, load]
    joints: [pin, rope]
    frame: {mass: 1.0e3, inertia: 1.0e3, position: [0.0, 2.0]}
    load: {mass: 1.0e3, inertia: 1.0e3, position: [0.0, -3.0]}
    pin: {type: revolute, bodies: [ground, frame], point: [0.0, 3.0]}
    rope: {type: distance, bodies: [frame, load], from: [0.0, 1.5], to: [0.0, -3.0]}
train: {vehicles: crane, positions: 0.0}
ts: {dt: 1.0e-3, max_time: 5.0e-3}
""")
        with h5py.File(self.folder / "hanging.h5") as file:
            group = file["model/vehicles/0"]
            self.assertEqual(group["joint_names"].asstr()[:].tolist(), [["pin", "revolute"], ["rope", "distance"]])
            self.assertEqual(group["joint_ends"][:].tolist(), [[0.0, 3.0, 0.0, 3.0], [0.0, 1.5, 0.0, -3.0]])
            self.assertEqual(group["joints"][:].tolist(), [[0.0, 3.0, -1.0, 0.0], [0.0, 1.5, 0.0, 1.0]])


class Amplification(Computed):
    def test_it_is_over_all_that_stands_on_the_bridge(self):
        """A wheel and a force side by side, so slow that the bridge bends as at rest under both."""
        self.compute("both", """
beam: {spans: 20.0, EI: 3.0e10, mass: 1.8e4, damping_ratios: 0.05, elements_per_span: 8}
support: {types: [pinned, roller]}
vehicle:
  car:
    bodies: [box]
    drivers: [level]
    wheels: [wheel]
    box: {mass: 2.0e4, inertia: 1.0e3, position: [0.0, 0.5]}
    level: {body: box, coordinate: phi}
    wheel: {body: box, radius: 0.5, law: linear, stiffness: 1.0e8}
train: {vehicles: car, positions: 0.0, speed: 1.0}
load: {forces: 2.0e5, positions: 0.0, speed: 1.0}
ts: {dt: 5.0e-3, max_time: 20.0}
""")
        with h5py.File(self.folder / "both.h5") as file:
            summary = file["summary"].attrs
            together = (2.0e4 * 9.81 + 2.0e5) * 20.0 ** 3 / 48.0 / 3.0e10
            self.assertLess(abs(summary["static_deflection"] / together - 1.0), 1e-6)
            self.assertLess(abs(summary["amplification"] - 1.0), 0.02)


if __name__ == "__main__":
    unittest.main()
