"""scripts/picture.py on small results files: whatever a file holds is drawn, whatever it lacks is left out."""

import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import h5py
import numpy as np
from matplotlib.text import Text

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
SCRIPTS = SOURCE / "scripts"
sys.path.insert(0, str(SCRIPTS))
import matplotlib.pyplot as plt  # noqa: E402
import animate  # noqa: E402
import picture  # noqa: E402
import picture_axes  # noqa: E402
import picture_data  # noqa: E402
import picture_hanging  # noqa: E402
import picture_model  # noqa: E402
import picture_motion  # noqa: E402
import picture_vehicles  # noqa: E402
import picture_words  # noqa: E402


def write_run(path, *, beam=True, vehicles=2, wheels=("front_wheel", "rear_wheel"), rows=400, finished=True, extra=0):
    """A results file as the program writes it; `extra`: rows beyond /time, as a killed run may leave."""
    n = rows + extra
    t = np.linspace(0.0, 4.0, n)
    with h5py.File(path, "w") as file:
        file.attrs["scene"] = "small_scene"
        file["time"] = t[:rows]
        options = np.array([["-train_speed", "50"], ["-support_types", "pinned,roller,roller"]], dtype=object)
        file.create_dataset("options", data=options, dtype=h5py.string_dtype())
        if beam:
            file["supports/x"] = [0.0, 20.0, 40.0]
            file["probes/x"] = [10.0, 30.0]
            file["probes/deflection"] = -1e-3 * np.stack([np.sin(t), np.cos(t)], axis=1)
            file["shape/x"] = np.linspace(0.0, 40.0, 21)
            file["shape/deflection"] = -1e-3 * np.sin(np.linspace(0.0, 2 * np.pi, 21))
            file["shape/deflection"].attrs["time"] = 1.5
        for k in range(vehicles):
            for body, height in (("car", 1.5), ("axle", 0.5)):
                file[f"vehicles/{k}/{body}/position"] = np.stack([50 * t - 10 * k, height + 0 * t, 0 * t], axis=1)
                file[f"vehicles/{k}/{body}/acceleration"] = np.stack([0 * t, np.sin(5 * t + k), 0 * t], axis=1)
            for wheel in wheels:
                file[f"vehicles/{k}/{wheel}/normal_force"] = 1e5 + 1e3 * np.sin(7 * t + k)
        if finished:
            file.create_group("summary").attrs["deflection"] = -1e-3
            file["summary"].attrs["deflection_place"] = 10.0


class PictureTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.file = self.folder / "run.h5"

    def run_script(self):
        out = self.folder / "run.png"
        command = [sys.executable, "-B", str(SCRIPTS / "picture.py"), str(self.file), str(out)]
        return subprocess.run(command, capture_output=True, text=True), out

    def assert_drawn(self):
        """The picture is there and not blank; its height in pixels."""
        done, out = self.run_script()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        data = out.read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(len(data), 20000)
        width, height = struct.unpack(">II", data[16:24])
        self.assertGreater(width, 1000)
        return height

    def test_a_name_may_hold_what_looks_like_mathematics(self):
        write_run(self.file)
        with h5py.File(self.file, "r+") as file:
            file.attrs["scene"] = r"a$\foo$b"
        self.assert_drawn()

    def test_whole_run(self):
        write_run(self.file)
        whole = self.assert_drawn()
        write_run(self.file, vehicles=0)
        self.assertLess(self.assert_drawn(), whole)

    def test_long_train(self):
        write_run(self.file, vehicles=12, wheels=[f"wheel_{i}" for i in range(1, 5)])
        self.assert_drawn()

    def write_sensors(self, *names):
        write_run(self.file)
        t = np.linspace(0.0, 4.0, 400)
        with h5py.File(self.file, "a") as file:
            for i, name in enumerate(names):
                for signal in ("acceleration_x", "acceleration_y", "pitch_rate"):
                    file[f"vehicles/1/{name}/{signal}"] = (1.0 + i) * np.sin(9.0 * t)

    def test_sensors_have_a_panel(self):
        write_run(self.file)
        without = self.assert_drawn()
        self.write_sensors("axle_box", "floor")
        self.assertGreater(self.assert_drawn(), without)
        with h5py.File(self.file) as file:
            results = picture_data.Results(file)
            panels = picture.panels(results, ["sensors"])
            titles, names = [], []
            for panel in panels[1:]:
                figure, ax = plt.subplots()
                panel(ax, None)
                titles.append(ax.get_title(loc="left"))
                names = [text.get_text() for text in ax.texts]
                lines = [line.get_ydata() for line in ax.get_lines()]
                plt.close(figure)
        self.assertEqual([title for title in titles if "sensors" in title], [
            "Acceleration along the track at the sensors", "Pitch rate of the sensors' bodies, counter-clockwise",
            "Vertical acceleration at the sensors"])
        self.assertEqual(names, ["last vehicle, axle box", "last vehicle, floor"])
        self.assertAlmostEqual(np.max(lines[1]), 2.0, places=3)

    def test_many_sensors_are_chosen_from(self):
        self.write_sensors(*(f"box_{i}" for i in range(9)))
        with h5py.File(self.file) as file:
            results = picture_data.Results(file)
            figure, ax = plt.subplots()
            picture.panels(results)[-1](ax, None)
            self.assertIn("(6 of 9)", ax.get_title(loc="left"))
            self.assertIn("last vehicle, box 8", [text.get_text() for text in ax.texts])  # the greatest
            plt.close(figure)

    def assert_within(self, *names):
        """Everything that is written lies within the picture, and no two words beside the same axes overlap."""
        drawn = {}

        def keep(figure, *words, **more):
            drawn["figure"] = figure

        with mock.patch.object(plt.Figure, "savefig", keep), mock.patch.object(plt, "close"):
            with h5py.File(self.file) as file:
                picture.draw(picture_data.Results(file), "out.png")
        figure = drawn["figure"]
        self.addCleanup(plt.close, figure)
        figure.draw_without_rendering()
        found = []
        for ax in figure.axes:
            beside = [text for text in [ax._left_title, *ax.texts] if text.get_text()]
            boxes = [(text.get_text(), Text.get_window_extent(text)) for text in beside]  # without the line to the curve
            for i, (words, box) in enumerate(boxes):
                self.assertTrue(0 <= box.x0 and box.x1 <= figure.bbox.width, words)
                self.assertTrue(0 <= box.y0 and box.y1 <= figure.bbox.height, words)
                for other, second in boxes[:i]:
                    shared = box.intersection(box, second)
                    self.assertFalse(shared is not None and shared.width > 2 and shared.height > 2, (words, other))
            found += [words for words, _ in boxes]
        for text in figure.texts:
            box = text.get_window_extent()
            self.assertTrue(0 <= box.x0 and box.x1 <= figure.bbox.width, text.get_text())
        for name in names:
            self.assertTrue(any(name in words for words in found), (name, found))

    def test_long_names_become_numbers_with_a_key(self):
        long = "the_wheel_of_the_second_axle_of_the_leading_bogie_of_the_heavy_locomotive"
        write_run(self.file, wheels=(f"{long}_1", f"{long}_2"))
        with h5py.File(self.file, "a") as file:
            file.attrs["scene"] = "a scene whose name is so long that no heading of a picture ever holds it in one line of it"
        self.assert_within("1", f"1   first vehicle, {long.replace('_', ' ')} 1", "4   last")

    def test_title_and_note_keep_apart(self):
        write_run(self.file)
        with h5py.File(self.file, "a") as file:
            del file["probes"]
            file["probes/x"] = np.linspace(1.0, 39.0, 20)
            file["probes/deflection"] = -1e-3 * np.ones((400, 20)) * np.linspace(0.0, 1.0, 400)[:, None]
        self.assert_within("dashed: largest deflection", "places)")

    def test_what_is_no_car_is_called_by_its_name(self):
        titles = []
        for name in ("car", "frame"):
            write_run(self.file, vehicles=1)
            with h5py.File(self.file, "a") as file:
                if name != "car":
                    file.move("vehicles/0/car", f"vehicles/0/{name}")
                results = picture_data.Results(file)
                figure, ax = plt.subplots()
                self.addCleanup(plt.close, figure)
                picture_vehicles.draw_accelerations(ax, results, picture_vehicles.cars_of(results))
                titles.append((ax.get_title(loc="left"), ax.texts[0].get_text()))
        self.assertEqual(titles, [("Vertical acceleration of the car body", "the car"),
                                  ("Vertical acceleration of the frame", "the frame")])

    def write_crane(self, swing):
        """A load that swings, by `swing` (degrees over time), on a rope of 5 m below the frame of a trolley that runs."""
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
            for name, rows in (("names", [["crane", "car"], ["crane", "axle"], ["crane", "load"]]),
                               ("joint_names", [["post", "weld"], ["rope", "distance"]])):
                file.create_dataset(f"{kind}/{name}", data=np.array(rows, dtype=object), dtype=h5py.string_dtype())
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
        self.assert_within("Angle of the hanging body from the vertical, positive ahead", "Force of its joint", "the vehicle, load", "the vehicle, rope")

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
            file.create_dataset("options", data=np.array(options, dtype=object), dtype=h5py.string_dtype())
            results = picture_data.Results(file)
            hanging, = picture_hanging.hanging_of(results)
            self.assertEqual((hanging.body, hanging.joint), ("load", "left and right"))
            np.testing.assert_allclose(hanging.swing, 0.3 * np.sin(t), atol=1e-9)
            np.testing.assert_allclose(hanging.force, 180e3)
            np.testing.assert_allclose(hanging.place[0], [0.0, -3.0], atol=1e-9)
            self.assertEqual([name for name, _ in picture_vehicles.drives_of(results, [])], ["left"])
            self.assertEqual(picture_vehicles.drives_of(results, ["left"]), [])
        self.assert_within("The load under its rope at some instants", "Sway: the load relative to the top of its ropes",
                           "Force of its ropes together", "the vehicle, left and right")

    def test_links_of_a_chain(self):
        write_run(self.file, vehicles=1)
        with h5py.File(self.file, "a") as file:
            t, kind = file["time"][:], "model/vehicles/0"
            file["model/train"] = [[0.0, 0.0]]
            names = [[f"link{i}", "distance"] for i in range(9)]
            for name, rows in (("names", [["chain", "car"], ["chain", "axle"]]), ("joint_names", names)):
                file.create_dataset(f"{kind}/{name}", data=np.array(rows, dtype=object), dtype=h5py.string_dtype())
            file[f"{kind}/bodies"] = [[0.0, 1.5, 1e3], [0.0, 0.5, 1e2]]
            file[f"{kind}/wheels"] = [[0.0, 0.5, 0.5]]
            file[f"{kind}/joints"] = [[0.0, 1.0, 0.0, 1.0]] * 9
            file[f"{kind}/joint_ends"] = [[0.0, 1.0, 0.0, 1.0]] * 9
            for i in range(9):
                file[f"vehicles/0/link{i}/reaction"] = np.column_stack([3e3 * (9 - i) + 0 * t, 4e3 * (9 - i) + 0 * t, 0 * t])
        self.assert_within("Force in the links of the chain (6 of 9)", "link 0", "link 8")

    def test_small_values_have_small_units(self):
        self.assertEqual(picture_axes.legible("mm", [np.array([0.004, -0.005])]), ("µm", 1e3))
        self.assertEqual(picture_axes.legible("mm", [np.array([0.004, -0.5])]), ("mm", 1.0))
        self.assertEqual(picture_axes.legible("kN", [np.zeros(3)]), ("kN", 1.0))
        self.assertEqual(picture_words.millimetres(-5.09e-6), "5.09 µm")

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
        self.assert_within("Centres of the bodies: x", "Centres of the bodies: y", "car")

    def test_no_beam(self):
        write_run(self.file, beam=False)
        self.assert_drawn()

    def test_no_wheels(self):
        write_run(self.file, wheels=())
        self.assert_drawn()

    def test_no_options_nor_shape(self):
        write_run(self.file)
        with h5py.File(self.file, "a") as file:
            del file["options"], file["shape"], file["supports"]
        self.assert_drawn()

    def test_static_response(self):
        write_run(self.file, rows=1)
        self.assert_drawn()

    def test_killed_run_with_ragged_end(self):
        write_run(self.file, finished=False, extra=30)
        self.assert_drawn()

    def test_modes(self):
        x = np.linspace(0.0, 40.0, 21)
        with h5py.File(self.file, "w") as file:
            file["modes/frequency"] = [2.0, 5.0, 9.0]
            file["modes/shape"] = [np.sin(np.pi * (k + 1) * x / 40) for k in range(3)]
        self.assert_drawn()
        with h5py.File(self.file, "a") as file:
            file["modes/x"] = x
            file["supports/x"] = [0.0, 40.0]
        self.assert_drawn()
        with h5py.File(self.file, "a") as file:
            del file["modes/shape"]
        self.assert_drawn()

    def test_sweep(self):
        with h5py.File(self.file, "w") as file:
            file["sweep/speed"] = np.linspace(30.0, 90.0, 13)
            file["sweep/peak_deflection"] = 1e-3 * np.ones((3, 13, 2))
        self.assert_drawn()

    def write_sweep(self, trains, missing=()):
        with h5py.File(self.file, "w") as file:
            file["sweep/speed"] = np.linspace(30.0, 90.0, 13)
            peaks = 1e-3 * np.arange(1.0, trains * 13 * 2 + 1).reshape(trains, 13, 2)
            for train, speed in missing:
                peaks[train, speed] = np.nan
            file["sweep/peak_deflection"] = peaks
            file["sweep/hslm_a"] = np.arange(1.0, trains + 1)
            file["sweep"].attrs.update({"modes": 3, "elements_per_span": 10})
            file.create_group("summary").attrs.update({
                "deflection": 0.0675, "deflection_place": 12.5, "deflection_speed": 95.5555556, "deflection_train": 10,
                "amplification": 8.15, "greatest_amplification": 9.9, "runs": trains * 13})
            file.attrs.update({"runs": trains * 13, "wall_seconds": 0.5})

    def drawn_sweep(self):
        figure, ax = plt.subplots()
        self.addCleanup(plt.close, figure)
        with h5py.File(self.file) as file:
            picture.draw_sweep(ax, picture_data.Results(file))
        return ax

    def test_sweep_draws_every_train(self):
        self.write_sweep(10)
        ax = self.drawn_sweep()
        self.assertEqual(len(ax.lines), 10)
        self.assertEqual({text.get_text() for text in ax.texts}, {f"train A{i}" for i in range(1, 11)})
        looks = {(line.get_color(), str(line.get_linestyle()), line._unscaled_dash_pattern[1]) for line in ax.lines}
        self.assertEqual(len({(colour, str(dashes)) for colour, _, dashes in looks}), 10)
        self.assert_drawn()

    def test_sweep_says_what_it_leaves_out(self):
        self.write_sweep(20, missing=[(0, 0), (3, 12)])
        self.assertIn(f"({picture_data.MOST_TRAINS} of 20 trains, 2 of 260 runs are missing)",
                      self.drawn_sweep().get_title(loc="left"))
        self.assert_drawn()

    def test_sweep_without_a_run(self):
        self.write_sweep(1, missing=[(0, i) for i in range(13)])
        self.assert_drawn()

    def test_sweep_in_words(self):
        self.write_sweep(10)
        with h5py.File(self.file) as file:
            results = picture_data.Results(file)
            said = "; ".join(picture_words.summary_in_words(results))
            self.assertEqual(picture_words.method_in_words(results), "by 3 modes")
            self.assertEqual(picture_words.sweep_in_words(results), "10 trains, 13 speeds from 108 to 324 km/h")
        self.assertEqual(said, "greatest deflection 67.5 mm, at 12.5 m by train A10 at 344 km/h; "
                               "8.15 times the static one")

    def test_head_and_curve_agree_or_say_why(self):
        for deepest, head, label in ((-1e-3, "greatest deflection 1 mm", "1 mm down"),
                                     (-2e-3, "greatest deflection at a probe 1 mm", "2 mm down, at 12 m")):
            write_run(self.file)
            with h5py.File(self.file, "a") as file:
                shape = np.zeros(21)
                shape[6] = deepest
                file["shape/deflection"][...] = shape
                results = picture_data.Results(file)
                self.assertTrue(picture_words.summary_in_words(results)[0].startswith(head))
                self.assertEqual(picture_words.worst_in_words(results, 12.0, deepest), label)

    def test_modes_left_out_are_said(self):
        self.assertEqual(picture_words.modes_in_words(np.ones(10), np.ones((10, 5))),
                         "drawn: the first 6 of 10 modes")
        self.assertEqual(picture_words.modes_in_words(np.ones(3), np.ones((3, 5))), "")

    def test_file_with_nothing_to_draw(self):
        h5py.File(self.file, "w").close()
        done, _ = self.run_script()
        self.assertEqual(done.returncode, 1)
        self.assertIn("nothing", done.stderr)
        self.assertIn(str(self.file), done.stderr)

    def test_missing_file(self):
        done, _ = self.run_script()
        self.assertEqual(done.returncode, 1)
        self.assertNotIn("Traceback", done.stderr)


class WordsTest(unittest.TestCase):
    def test_places(self):
        supports = np.array([0.0, 25.0, 55.0])
        self.assertEqual(picture_data.place_in_words(12.5, supports), "middle of span 1 (12.5 m)")
        self.assertEqual(picture_data.place_in_words(47.5, supports), "three quarters of span 2 (47.5 m)")
        self.assertEqual(picture_data.place_in_words(55.0, supports), "right end of span 2 (55 m)")
        self.assertEqual(picture_data.place_in_words(30.0, supports), "span 2, at 30 m")
        self.assertEqual(picture_data.place_in_words(10.0, np.array([0.0, 20.0])), "middle of the span (10 m)")
        self.assertEqual(picture_data.place_in_words(3.0, None), "at 3 m")

    def test_labels_do_not_overlap(self):
        for wanted in ([0.5] * 6, [0.99, 0.98, 0.02], [0.1, 0.9]):
            placed = np.sort(picture_data.spread(wanted, 0.1, 0.03, 0.97))
            self.assertTrue(np.all(np.diff(placed) > 0.099), placed)
            self.assertTrue(placed[0] >= 0.03 - 1e-3 and placed[-1] <= 0.97 + 1e-3, placed)

    def test_thinning_keeps_peaks(self):
        time = np.linspace(0.0, 1.0, 100001)
        values = np.sin(40 * time)
        values[77777] = 9.0
        t, v = picture_data.thin(time, values)
        self.assertLess(len(t), 10000)
        self.assertEqual(v.max(), 9.0)
        self.assertTrue(np.all(np.diff(t) > 0))


if __name__ == "__main__":
    unittest.main()
