"""scripts/picture.py on small files of single runs: whatever a file holds is drawn, whatever it lacks is left out."""

import pathlib
import struct
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from drawn import Drawn, texts, write_run  # noqa: E402
import picture_data  # noqa: E402
import picture_panels  # noqa: E402
import picture_table  # noqa: E402
import picture_vehicles  # noqa: E402
import picture_words  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402


class PictureTest(Drawn):
    def test_the_script_writes_the_picture_and_the_formats(self):
        write_run(self.file)
        out = self.folder / "run.png"
        done = self.run_script("picture.py", self.file, out)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        data = out.read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(len(data), 20000)
        self.assertGreater(struct.unpack(">II", data[16:24])[0], 1000)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["run.h5", "run.png"])
        out.unlink()
        done = self.run_script("picture.py", self.file, out, "--formats", "svg,csv")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["run.csv", "run.h5", "run.svg"])
        self.assertIn("<svg", out.with_suffix(".svg").read_text(encoding="utf-8"))

    def test_the_table_holds_the_drawn_curves_with_their_units(self):
        write_run(self.file)
        figure = self.figure()
        picture_table.write(figure, self.folder / "run.csv")
        table = self.table(self.folder / "run.csv")
        name = "Deflection of the bridge, upward positive: middle of span 1 (10 m) (mm)"
        with h5py.File(self.file) as file:
            np.testing.assert_array_equal(table[name], 1e3 * file["probes/deflection"][:, 0])
            np.testing.assert_array_equal(table["Deflection of the bridge, upward positive: time (s)"], file["time"][:])
            np.testing.assert_array_equal(table["Wheel forces on the track: first vehicle, front wheel (kN)"],
                                          1e-3 * file["vehicles/0/front_wheel/normal_force"][:])
        lines = [line for ax in figure.axes for line in ax.get_lines() if len(line.get_xdata()) == 400]
        curves = [head for head, column in table.items() if len(column) == 400 and ": time (s)" not in head]
        self.assertEqual(len(lines), len(curves))
        for line in lines:
            self.assertTrue(any(np.array_equal(line.get_ydata(), column) for column in table.values()))

    def test_a_name_may_hold_what_looks_like_mathematics(self):
        write_run(self.file)
        with h5py.File(self.file, "r+") as file:
            file.attrs["scene"] = r"a$\foo$b <script>&"
        self.assert_drawn(r"a$\foo$b <script>&")

    def test_whole_run(self):
        write_run(self.file)
        whole = self.assert_drawn()
        write_run(self.file, vehicles=0)
        self.assertLess(self.assert_drawn(), whole)

    def test_long_train(self):
        write_run(self.file, vehicles=12, wheels=[f"wheel_{i}" for i in range(1, 5)])
        self.assert_drawn("all 48 wheels, least to greatest")

    def write_sensors(self, *names):
        write_run(self.file)
        t = np.linspace(0.0, 4.0, 400)
        with h5py.File(self.file, "a") as file:
            for i, name in enumerate(names):
                for signal in ("acceleration_x", "acceleration_y", "pitch_rate"):
                    file[f"vehicles/1/{name}/{signal}"] = (1.0 + i) * np.sin(9.0 * t)

    def test_sensors_have_a_panel(self):
        self.write_sensors("axle_box", "floor")
        figure = self.figure(["sensors"])
        titles = [ax.get_title(loc="left") for ax in figure.axes]
        self.assertEqual([title for title in titles if "sensors" in title], [
            "Acceleration along the track at the sensors", "Pitch rate of the sensors' bodies, counter-clockwise",
            "Vertical acceleration at the sensors"])
        last = figure.axes[-1]
        self.assertEqual([text.get_text() for text in last.texts], ["last vehicle, axle box", "last vehicle, floor"])
        self.assertAlmostEqual(np.max(last.get_lines()[1].get_ydata()), 2.0, places=3)

    def test_many_sensors_are_chosen_from(self):
        self.write_sensors(*(f"box_{i}" for i in range(9)))
        self.assert_drawn("(6 of 9)", "last vehicle, box 8")  # the greatest

    def test_long_names_become_numbers_with_a_key(self):
        long = "the_wheel_of_the_second_axle_of_the_leading_bogie_of_the_heavy_locomotive"
        write_run(self.file, wheels=(f"{long}_1", f"{long}_2"))
        with h5py.File(self.file, "a") as file:
            file.attrs["scene"] = "a scene whose name is so long that no heading of a picture ever holds it in one line"
        self.assert_drawn("1", f"1   first vehicle, {long.replace('_', ' ')} 1", "4   last")

    def test_title_and_note_keep_apart(self):
        write_run(self.file)
        with h5py.File(self.file, "a") as file:
            del file["probes"]
            file["probes/x"] = np.linspace(1.0, 39.0, 20)
            file["probes/deflection"] = -1e-3 * np.ones((400, 20)) * np.linspace(0.0, 1.0, 400)[:, None]
        self.assert_drawn("dashed: largest deflection", "places)")

    def test_places_that_move_for_a_short_time_are_drawn_for_this_time(self):
        write_run(self.file)
        with h5py.File(self.file, "a") as file:
            file["probes/deflection"][:] = 0.0
            file["probes/deflection"][100:121, 0] = -1e-3
            start, end = file["time"][100], file["time"][120]
        self.assert_drawn("time (s), only while these places move")
        low, high = self.figure().axes[1].get_xlim()
        self.assertTrue(low < start and end < high and high - low < 0.15 * 4.0, (low, high))

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

    def test_what_is_missing_is_left_out(self):
        for case in ({"beam": False}, {"wheels": ()}, {"rows": 1}, {"finished": False, "extra": 30}):
            with self.subTest(case):
                write_run(self.file, **case)
                self.assert_drawn()
        write_run(self.file)
        with h5py.File(self.file, "a") as file:
            del file["options"], file["shape"], file["supports"]
        self.assert_drawn()

    def test_modes(self):
        x = np.linspace(0.0, 40.0, 21)
        with h5py.File(self.file, "w") as file:
            file["modes/frequency"] = [2.0, 5.0, 9.0]
            file["modes/shape"] = [np.sin(np.pi * (k + 1) * x / 40) for k in range(3)]
        self.assert_drawn("5 Hz")
        with h5py.File(self.file, "a") as file:
            file["modes/x"] = x
            file["supports/x"] = [0.0, 40.0]
        self.assert_drawn()
        with h5py.File(self.file, "a") as file:
            del file["modes/shape"]
        self.assert_drawn()

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

    def test_refuses_in_one_line(self):
        h5py.File(self.file, "w").close()
        out = self.folder / "run.png"
        self.assert_refused(self.run_script("picture.py", self.file, out), "nothing", self.file)
        self.assert_refused(self.run_script("picture.py", self.folder / "missing.h5", out), "missing.h5")
        done = self.run_script("picture.py", self.file, out, "--formats", "gif")
        self.assert_refused(done, "allowed: png, svg, pdf, csv")
        with h5py.File(self.file, "w") as file:
            file["sweep/speed"] = [1.0]
            file["study/finished"] = [1.0]
        self.assert_refused(self.run_script("picture.py", self.file, out), self.file)
        self.assertFalse(out.exists())


class TrackTest(Drawn):
    """Layered tracks, gaps, and losses of contact."""

    def write_track(self, **more):
        options = [["-track_spacing", "0.6"], ["-track_pad_k", "1e8"], ["-track_ballast_k", "2e8"],
                   ["-vehicle_coach_wheels", "front_wheel, rear_wheel"]]
        write_run(self.file, vehicles=1, options=options)
        with h5py.File(self.file, "a") as file:
            t = file["time"][:]
            file["rail/deflection"] = 1.5 * file["probes/deflection"][:]
            file["track/hanging/x"] = [-3.0, -2.4]
            file["track/hanging/force"] = np.stack([3e4 * np.sin(t) ** 2, 2e4 * np.sin(t) ** 2], axis=1)
            file["track/hanging/gap"] = 5e-4 - 1e-4 * np.stack([t, t], axis=1)
            file["model/train"] = [[0.0, 0.0]]
            texts(file, "model/vehicles/0/names", [["coach", "car"], ["coach", "axle"]])
            file["model/vehicles/0/bodies"] = [[0.0, 1.5, 1e3], [0.0, 0.5, 1e2]]
            file["model/vehicles/0/wheels"] = [[1.0, 0.5, 0.5], [-1.0, 0.5, 0.5]]

    def test_a_layered_track_has_its_symbols_and_forces_over_the_place(self):
        self.write_track()
        self.assert_drawn("━ rail, on pads", "sleepers every 0.6 m", "▒ ballast", "hanging, open by\nup to 0.5 mm",
                          "Wheel forces over the place of the wheel", "Greatest force at each seat of the track",
                          "Deflection of the rail")
        figure = self.figure()
        picture_table.write(figure, self.folder / "run.csv")
        table = self.table(self.folder / "run.csv")
        seats = "Greatest force at each seat of the track, compression positive: "
        self.assertEqual(table[f"{seats}place along the track (m)"], [-3.0, -2.4])
        with h5py.File(self.file) as file:
            greatest = 1e-3 * file["track/hanging/force"][:].max(axis=0)
            np.testing.assert_allclose(table[f"{seats}hanging sleepers (kN)"], greatest)
            x = file["vehicles/0/axle/position"][:, 0] + 1.0
        np.testing.assert_allclose(table["Wheel forces over the place of the wheel: place along the track (m)"], x)
        self.assertLess(figure.axes[0].get_xlim()[0], -3.0)  # the hanging sleepers before the bridge are in the picture

    def test_the_scale_of_the_deflection_ends_below_the_symbols(self):
        """Track and train must not look as if they had a place on the axis of the deflection."""
        for sign in (1.0, -1.0):
            self.write_track()
            with h5py.File(self.file, "a") as file:
                file["shape/deflection"][...] = sign * np.abs(file["shape/deflection"][:])
            shape = self.assert_readable(self.figure(), "Above the bridge: symbols").axes[0]
            track = min(patch.get_window_extent().y0 for patch in [*shape.patches, *shape.collections])
            drawn = np.concatenate([values for _, _, values, _ in shape.kept_curves])
            for value in (*shape.get_yticks(), shape.spines["left"].get_bounds()[1], drawn.max()):
                self.assertLess(shape.transData.transform((0.0, value))[1], track)

    def test_a_spring_below_a_gap(self):
        write_run(self.file)
        with h5py.File(self.file, "a") as file:
            file["model/foundation/vertical"] = [[10.0, 1e8, 0.0, 5e-4, 1.0, 0.0, 0.0]]
            file["foundation/vertical/x"] = [10.0]
            file["foundation/vertical/force"] = 1e5 * np.ones((400, 1))
            texts(file, "model/supports", [["pinned", "end"], ["roller", "continuous"], ["roller", "end"]])
        self.assert_drawn("spring below a gap", "the spring below a gap of 0.5 mm acts", "Bearing forces on the bridge")

    def test_lost_contact_is_a_gap(self):
        write_run(self.file, vehicles=1)
        with h5py.File(self.file, "a") as file:
            file["vehicles/0/front_wheel/normal_force"][100:150] = 0.0
            file["separations/start"], file["separations/duration"] = [1.0], [0.5]
        self.assert_drawn("red bar: no contact")
        wheels, = (ax for ax in self.figure().axes if ax.get_title(loc="left") == "Wheel forces on the track")
        curve = next(line.get_ydata() for line in wheels.get_lines() if len(line.get_ydata()) == 400)
        self.assertEqual(np.count_nonzero(np.isnan(curve)), 48)  # the zeros beside other values stay
        kept = dict((name, values) for name, _, values, _ in wheels.kept_curves)
        self.assertEqual(np.count_nonzero(kept["front wheel"] == 0.0), 50)

    def test_panels_of_a_run_without_a_layered_track(self):
        write_run(self.file)
        with h5py.File(self.file) as file:
            self.assertEqual(len(picture_panels.panels(picture_data.Results(file))), 4)


if __name__ == "__main__":
    unittest.main()
