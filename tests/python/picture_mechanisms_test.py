"""scripts/picture.py: cranes, chains, mechanisms, and what scripts/animate.py draws of them."""

import pathlib
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from drawn import Drawn, texts, write_run  # noqa: E402
import animate  # noqa: E402
import picture_data  # noqa: E402
import picture_hanging  # noqa: E402
import picture_model  # noqa: E402
import picture_motion  # noqa: E402
import picture_vehicles  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402


class MechanismTest(Drawn):
    def write_crane(self, swing):
        """A load that swings, by `swing` (degrees over time), on a rope of 5 m below the frame of a moving trolley."""
        write_run(self.file, vehicles=1)
        with h5py.File(self.file, "a") as file:
            t, angle = file["time"][:], np.radians(swing)
            frame = file["vehicles/0/car/position"][:]
            file["vehicles/0/load/position"] = np.column_stack([frame[:, 0] + 5 * np.sin(angle),
                                                                frame[:, 1] - 5 * np.cos(angle), 0 * t])
            file["vehicles/0/load/acceleration"] = np.zeros((len(t), 3))
            file["vehicles/0/rope/reaction"] = np.column_stack([30e3 + 0 * t, 40e3 + 0 * t, 0 * t])
            file["model/train"] = [[0.0, 0.0]]
            kind = "model/vehicles/0"
            texts(file, f"{kind}/names", [["crane", "car"], ["crane", "axle"], ["crane", "load"]])
            texts(file, f"{kind}/joint_names", [["post", "weld"], ["rope", "distance"]])
            file[f"{kind}/bodies"] = [[0.0, 1.5, 1e3], [0.0, 0.5, 1e2], [0.0, -3.5, 2e4]]
            file[f"{kind}/wheels"] = [[0.0, 0.5, 0.5]]
            file[f"{kind}/joints"] = [[0.0, 1.0, 0.0, 1.0], [0.0, 1.5, 0.0, 2.0]]
            file[f"{kind}/joint_ends"] = [[0.0, 1.0, 0.0, 1.0], [0.0, 1.5, 0.0, -3.5]]

    def test_swing_and_rope_force_of_a_crane(self):
        swing = 6.0 * np.sin(np.linspace(0.0, 7.0, 400))
        self.write_crane(swing)
        with h5py.File(self.file) as file:
            hanging, = picture_hanging.hanging_of(picture_data.Results(file))
            self.assertEqual((hanging.body, hanging.joint), ("load", "rope"))
            np.testing.assert_allclose(hanging.swing, swing, atol=1e-9)
            np.testing.assert_allclose(hanging.force, 50e3)
            model = picture_model.Model(picture_data.Results(file))
            left, low, width, height = picture_model.body_boxes(model, 0)[2]
            self.assertLess(low + height, -2.0)  # below the track: the rope is no part of the load
            self.assertAlmostEqual(left + 0.5 * width, 0.0)
            self.assertEqual(picture_model.rods(model, 0)[:, :4].tolist(), [[0.0, 1.5, 0.0, -3.5]])
        self.assert_drawn("Angle of the hanging body from the vertical, positive ahead",
                          "Force in the joint of the hanging body", "load", "rope")

    def test_a_load_on_two_ropes(self):
        self.write_crane(0.0 * np.zeros(400))
        with h5py.File(self.file, "a") as file:
            t = file["time"][:]
            file["vehicles/0/load/position"][:, 0] += 0.3 * np.sin(t)
            kind = "model/vehicles/0"
            for name in ("joints", "joint_ends", "joint_names"):
                rows = file[f"{kind}/{name}"][:1]
                del file[f"{kind}/{name}"]
                file[f"{kind}/{name}"] = rows
            file[f"{kind}/springs"] = [[-0.5, 1.5, -0.5, -3.0, 0.0, 2.0], [0.5, 1.5, 0.5, -3.0, 0.0, 2.0]]
            for name in ("left", "right"):
                file[f"vehicles/0/{name}/force"] = 9e4 + 0.0 * t
            options = [["vehicle_crane_springs", "left, right"], ["vehicle_crane_left_side", "tension"],
                       ["vehicle_crane_right_side", "tension"], ["vehicle_crane_left_winding_table", "hoist.csv"]]
            del file["options"]
            texts(file, "options", options)
            results = picture_data.Results(file)
            hanging, = picture_hanging.hanging_of(results)
            self.assertEqual((hanging.body, hanging.joint), ("load", "left and right"))
            np.testing.assert_allclose(hanging.swing, 0.3 * np.sin(t), atol=1e-9)
            np.testing.assert_allclose(hanging.force, 180e3)
            np.testing.assert_allclose(hanging.place[0], [0.0, -3.0], atol=1e-9)
            self.assertEqual([name for name, _ in picture_vehicles.drives_of(results, [])], ["left"])
            self.assertEqual(picture_vehicles.drives_of(results, ["left"]), [])
        self.assert_drawn("The load under its rope at some instants", "Sway: the load relative to the top of its ropes",
                          "Force of the ropes of the load together", "left and right")

    def test_links_of_a_chain(self):
        write_run(self.file, vehicles=1)
        with h5py.File(self.file, "a") as file:
            t, kind = file["time"][:], "model/vehicles/0"
            file["model/train"] = [[0.0, 0.0]]
            names = [[f"link{i}", "distance"] for i in range(9)]
            texts(file, f"{kind}/names", [["chain", "car"], ["chain", "axle"]])
            texts(file, f"{kind}/joint_names", names)
            file[f"{kind}/bodies"] = [[0.0, 1.5, 1e3], [0.0, 0.5, 1e2]]
            file[f"{kind}/wheels"] = [[0.0, 0.5, 0.5]]
            file[f"{kind}/joints"] = [[0.0, 1.0, 0.0, 1.0]] * 9
            file[f"{kind}/joint_ends"] = [[0.0, 1.0, 0.0, 1.0]] * 9
            for i in range(9):
                force = 1e3 * (9 - i) + 0 * t
                file[f"vehicles/0/link{i}/reaction"] = np.column_stack([3 * force, 4 * force, 0 * t])
        self.assert_drawn("Force in the links of the chain (6 of 9)", "link 0", "link 8")

    def test_the_load_is_drawn_below_the_bridge(self):
        self.write_crane(0.0 * np.zeros(400))
        with h5py.File(self.file) as file:
            motion = picture_motion.Motion(picture_data.Results(file))
            stage = animate.Stage(motion, 1.0)
            self.addCleanup(plt.close, stage.figure)
            stage.draw(100)
            low, high = stage.ax.get_ylim()
            shapes = picture_motion.outline(motion, 100, 1.0)
        self.assertLess(low, -4.0)
        self.assertAlmostEqual((high - low) / stage.width, stage.tall / animate.AXES[0])  # to scale
        self.assertEqual(sum(len(shape.points) == 2 for shape in shapes), 1)
        lowest = min(shape.points[:, 1].min() for shape in shapes)
        self.assertGreater(lowest, low)

    def test_a_mechanism_shows_where_its_bodies_are(self):
        write_run(self.file, beam=False, wheels=())
        self.assert_drawn("Centres of the bodies: x", "Centres of the bodies: y", "car")


if __name__ == "__main__":
    unittest.main()
