"""scripts/export.py and scripts/animate.py: tables and XDMF hold what the file holds, pictures show it, wrong input is
named."""

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
SCRIPTS = SOURCE / "scripts"
sys.path.insert(0, str(SCRIPTS))
import animate  # noqa: E402
import picture_data  # noqa: E402
import picture_motion  # noqa: E402

TEXT = h5py.string_dtype()
STATIONS = (5.0, 10.0, 25.0, 30.0)


def put(file, name, values, unit):
    file.create_dataset(name, data=values, dtype=TEXT if unit == "text" else None).attrs["unit"] = unit


def write_run(path, rows=41, extra=3):
    """Two wagons over spans of 20 m and 15 m that do not touch; a killed run may leave `extra` rows beyond /time."""
    t = 0.05 * np.arange(rows + extra)
    with h5py.File(path, "w") as file:
        put(file, "time", t[:rows], "s")
        put(file, "options", [["-train_speed", "20"]], "text")
        put(file, "supports/x", [0.0, 20.0, 35.0], "m")
        put(file, "supports/reaction", np.random.default_rng(1).normal(size=(len(t), 3, 3)), "N, N, N m")
        put(file, "probes/x", STATIONS, "m")
        for k, (name, unit) in enumerate({"deflection": "m", "velocity": "m/s", "moment": "N m"}.items()):
            put(file, f"probes/{name}", -1e-3 * np.sin(np.outer(t, np.arange(1.0, 5.0)) + k), unit)
        put(file, "model/spans", [20.0, 15.0], "m")
        put(file, "model/supports", [["pinned", "end"], ["roller", "separate"], ["roller", "end"]], "text")
        put(file, "model/train", [[0.0, -3.0], [0.0, -15.0]], "1, m")
        put(file, "model/vehicles/0/names", [["wagon", "car"], ["wagon", "axle"]], "text")
        put(file, "model/vehicles/0/bodies", [[0.0, 2.0, 2e4], [1.0, 0.5, 1e3]], "m, m, kg")
        put(file, "model/vehicles/0/wheels", [[1.0, 0.5, 0.5]], "m, m, m")
        for k, origin in enumerate((-3.0, -15.0)):
            for body, x, y in (("car", 0.0, 1.9), ("axle", 1.0, 0.49)):
                position = np.stack([origin + x + 20.0 * t, y - 2e-3 * np.sin(t), 1e-4 * t], axis=1)
                put(file, f"vehicles/{k}/{body}/position", position, "m, m, rad")
                put(file, f"vehicles/{k}/{body}/velocity", 2.0 * position, "m/s, m/s, rad/s")


def write_sweep(path):
    with h5py.File(path, "w") as file:
        put(file, "probes/x", [5.0, 10.0], "m")
        put(file, "sweep/speed", [40.0, 50.0, 60.0], "m/s")
        put(file, "sweep/hslm_a", [3.0, 7.0], "1")
        put(file, "sweep/peak_deflection", np.arange(12.0).reshape(2, 3, 2), "m")
        put(file, "sweep/static_deflection", [[1.0, 2.0], [3.0, 4.0]], "m")
        put(file, "sweep/added", [0.0, 1.0, 0.0], "1")
        file["sweep/x"] = file["probes/x"]


def write_study(path):
    with h5py.File(path, "w") as file:
        put(file, "study/finished", [1.0, 1.0, 0.0], "1")
        put(file, "study/load_speed", [40.0, 50.0, 60.0], "m/s")
        put(file, "study/peak_moment", [[1.0, 2.0], [3.0, 4.0], [np.nan, np.nan]], "N m")
        put(file, "study/judged", [[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]], "as /verdicts/quantity")
        put(file, "verdicts/quantity", [["deck_acceleration", "m/s2"], ["end_rotation", "rad"]], "text")
        put(file, "verdicts/clause", [["EN 1", "a"], ["EN 2", "b"]], "text")


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        write_run(self.folder / "run.h5")
        write_sweep(self.folder / "sweep.h5")
        write_study(self.folder / "study.h5")

    def call(self, script, *words):
        command = [sys.executable, "-B", str(SCRIPTS / f"{script}.py"), *map(str, words)]
        return subprocess.run(command, capture_output=True, text=True, cwd=self.folder)

    def made(self, script, *words):
        done = self.call(script, *words)
        self.assertEqual((done.stderr, done.returncode), ("", 0))
        return done.stdout.split("\n")[:-1]

    def refused(self, script, *words):
        """The one line that says why."""
        done = self.call(script, *words)
        self.assertEqual((done.returncode, done.stdout), (2, ""), words)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        return done.stderr

    def table(self, name):
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            heads, *rows = csv.reader(file)
        self.assertEqual(len(set(heads)), len(heads))
        return heads, np.array(rows, dtype=float)

    def motion(self):
        file = h5py.File(self.folder / "run.h5")
        self.addCleanup(file.close)
        return picture_motion.Motion(picture_data.Results(file))


class Tables(Files):
    def test_series_over_time(self):
        self.assertEqual(self.made("export", "run.h5", "--series", "probes/deflection", "supports", "/vehicles/1/car",
                                   "-o", "out"), ["out/probes_deflection.csv", "out/supports.csv",
                                                  "out/vehicles_1_car.csv"])
        with h5py.File(self.folder / "run.h5") as file:
            time = file["time"][:]
            heads, rows = self.table("out/probes_deflection.csv")
            self.assertEqual(heads, ["time (s)", *(f"probes/deflection at {x:g} m (m)" for x in STATIONS)])
            np.testing.assert_array_equal(rows, np.column_stack([time, file["probes/deflection"][:41]]))
            heads, rows = self.table("out/supports.csv")
            self.assertEqual(heads[4:7], ["supports/reaction fx at 20 m (N)", "supports/reaction fy at 20 m (N)",
                                          "supports/reaction moment at 20 m (N m)"])
            np.testing.assert_array_equal(rows[:, 4:7], file["supports/reaction"][:41, 1])
            heads, rows = self.table("out/vehicles_1_car.csv")
            self.assertEqual(heads[3:5], ["vehicles/1/car/position angle (rad)", "vehicles/1/car/velocity x (m/s)"])
            np.testing.assert_array_equal(rows[:, 1:4], file["vehicles/1/car/position"][:41])

    def test_list_names_what_there_is(self):
        listed = self.made("export", "run.h5", "--list")
        self.assertEqual(len(listed), 3 + 2 * 4 + 1)
        self.assertIn(["probes/moment", "44", "x", "4", "N", "m"], [line.split() for line in listed])
        self.assertEqual(self.made("export", "sweep.h5", "--list"), ["sweep"])
        self.assertEqual(self.made("export", "run.h5", "-o", "all"),
                         [f"all/{name}.csv" for name in ("probes", "vehicles_0", "vehicles_1", "supports")])

    def test_sweep_has_a_row_for_every_train_and_speed(self):
        self.made("export", "sweep.h5")
        heads, rows = self.table("sweep.csv")
        self.assertEqual(heads, ["train", "sweep/speed (m/s)", "sweep/added (1)", "sweep/peak_deflection at 5 m (m)",
                                 "sweep/peak_deflection at 10 m (m)", "sweep/static_deflection at 5 m (m)",
                                 "sweep/static_deflection at 10 m (m)"])
        np.testing.assert_array_equal(rows[4], [7.0, 50.0, 1.0, 8.0, 9.0, 3.0, 4.0])
        self.assertEqual(len(rows), 6)

    def test_study_has_a_row_for_every_run(self):
        self.made("export", "study.h5", "--series", "study")
        heads, rows = self.table("study.csv")
        self.assertEqual(heads, ["study/finished (1)", "study/judged limit 1 deck_acceleration by EN 1 (m/s2)",
                                 "study/judged limit 2 end_rotation by EN 2 (rad)", "study/load_speed (m/s)",
                                 "study/peak_moment at probe 1 (N m)", "study/peak_moment at probe 2 (N m)"])
        np.testing.assert_array_equal(rows[1], [1.0, 0.3, 0.4, 50.0, 3.0, 4.0])
        self.assertTrue(np.isnan(rows[2, 4]))

    def test_wrong_input(self):
        (self.folder / "text.h5").write_text("no HDF5")
        h5py.File(self.folder / "empty.h5", "w").close()
        with h5py.File(self.folder / "bare.h5", "w") as file:
            put(file, "sweep/peak_deflection", np.zeros((1, 1, 1)), "m")
        for words, complaint in ((("none.h5",), "none.h5: is no results file that can be read"),
                                 (("text.h5", "--list"), "is no results file that can be read"),
                                 (("empty.h5",), "holds no series over time and no table"),
                                 (("run.h5", "--series", "probes", "probes/shear"), "no series or table probes"),
                                 (("bare.h5", "--xdmf"), "no deflections of a bridge over time: it is that of"),
                                 (("run.h5", "--xdmf", "--every", "0"), "--every: a number of samples from 1")):
            self.assertIn(complaint, self.refused("export", *words))
        self.assertEqual(list(self.folder.glob("*.csv")) + list(self.folder.glob("*.xdmf*")), [])


class Xdmf(Files):
    def item(self, element):
        """The values that a DataItem names; its dimensions are theirs."""
        item = element.find("DataItem")
        name, place = item.text.split(":")
        with h5py.File(self.folder / "out" / name) as file:
            values = file[place][()]
        self.assertEqual(item.get("Dimensions"), " ".join(map(str, values.shape)))
        self.assertEqual(item.get("NumberType"), "Int" if values.dtype.kind == "i" else "Float")
        self.assertEqual(int(item.get("Precision")), values.dtype.itemsize)
        return values

    def test_every_instant_has_the_bridge_and_the_bodies(self):
        self.made("export", "run.h5", "--xdmf", "-o", "out", "--every", "10", "--exaggeration", "100")
        steps = tree.parse(self.folder / "out" / "run.xdmf").getroot().findall("Domain/Grid/Grid")
        with h5py.File(self.folder / "run.h5") as file:
            np.testing.assert_array_equal([float(step.find("Time").get("Value")) for step in steps],
                                          file["time"][::10])
            deflection, car = file["probes/deflection"][30], file["vehicles/1/car/position"]
            bridge, vehicles = steps[3].findall("Grid")
            cells = self.item(bridge.find("Topology"))
            self.assertEqual(bridge.find("Topology").get("TopologyType"), "Polyline")
            self.assertEqual(cells.tolist(), [[0, 1, 2, 3]])
            np.testing.assert_array_equal(self.item(bridge.find("Geometry")),
                                          np.column_stack([STATIONS, 100.0 * deflection, 0.0 * deflection]))
            named = {one.get("Name"): one for one in bridge.findall("Attribute")}
            self.assertEqual(list(named), ["displacement (m)", "deflection (m)", "velocity (m/s)", "moment (N m)"])
            np.testing.assert_array_equal(self.item(named["moment (N m)"]), file["probes/moment"][30])
            self.assertEqual(self.item(vehicles.find("Topology")).shape, (4, 1))
            points = self.item(vehicles.find("Geometry"))
            body = [k for k, one in enumerate(self.motion().bodies) if (one.vehicle, one.name) == (1, "car")]
            x, y, _ = car[30]
            np.testing.assert_allclose(points[body[0]], [x, car[0, 1] + 100.0 * (y - car[0, 1]), 0.0], rtol=1e-13)
            for attribute in vehicles.findall("Attribute"):
                self.assertEqual(len(self.item(attribute)), 4)

    def test_a_sweep_is_a_surface_for_each_train(self):
        self.made("export", "sweep.h5", "--xdmf", "-o", "out")
        grids = tree.parse(self.folder / "out" / "sweep.xdmf").getroot().findall("Domain/Grid/Grid")
        self.assertEqual([grid.get("Name") for grid in grids], ["A3", "A7"])
        for k, grid in enumerate(grids):
            points = self.item(grid.find("Geometry"))  # three speeds of two stations each, 5 m from each other
            np.testing.assert_allclose(points, [[x, y, 5.0 * k] for y in (0.0, 2.5, 5.0) for x in (5.0, 10.0)])
            self.assertEqual(self.item(grid.find("Topology")).tolist(), [[0, 1, 3, 2], [2, 3, 5, 4]])
            values = {one.get("Name"): self.item(one).tolist() for one in grid.findall("Attribute")}
            self.assertEqual(values, {"place (m)": [5.0, 10.0] * 3, "speed (m/s)": [40.0, 40.0, 50.0, 50.0, 60.0, 60.0],
                                      "peak_deflection (m)": [6.0 * k + i for i in range(6)]})

    def test_the_runs_of_a_study_are_points(self):
        with h5py.File(self.folder / "study.h5", "a") as file:
            file["study"].attrs["dimensions"] = "load_speed"
        self.made("export", "study.h5", "--xdmf", "-o", "out")
        grid, = tree.parse(self.folder / "out" / "study.xdmf").getroot().findall("Domain/Grid/Grid")
        self.assertEqual(self.item(grid.find("Geometry")).tolist(), [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]])
        values = {one.get("Name"): self.item(one) for one in grid.findall("Attribute")}
        self.assertEqual(values["study/load_speed (m/s)"].tolist(), [40.0, 50.0, 60.0])
        self.assertEqual(values["study/peak_moment at probe 2 (N m)"][1], 4.0)
        self.assertTrue(np.isnan(values["study/peak_moment at probe 2 (N m)"][2]))

    def test_readers_of_vtk_read_it(self):
        try:
            from vtkmodules import vtkIOXdmf2, vtkIOXdmf3
        except ImportError as error:
            self.skipTest(f"VTK's XDMF readers are not installed (Debian: python3-paraview): {error}")
        self.made("export", "run.h5", "--xdmf", "-o", "out")
        self.made("export", "sweep.h5", "--xdmf", "-o", "out")
        for reader in (vtkIOXdmf2.vtkXdmfReader(), vtkIOXdmf3.vtkXdmf3Reader()):
            reader.SetFileName(str(self.folder / "out" / "sweep.xdmf"))
            reader.Update()
            walk = reader.GetOutputDataObject(0).NewIterator()
            walk.InitTraversal()
            surface = walk.GetCurrentDataObject()
            self.assertEqual((surface.GetNumberOfCells(), surface.GetCell(0).GetClassName()), (2, "vtkQuad"))
            self.assertEqual(surface.GetPointData().GetArray("peak_deflection (m)").GetValue(5), 5.0)
        for reader in (vtkIOXdmf2.vtkXdmfReader(), vtkIOXdmf3.vtkXdmf3Reader()):
            reader.SetFileName(str(self.folder / "out" / "run.xdmf"))
            reader.UpdateInformation()
            with h5py.File(self.folder / "run.h5") as file:
                reader.UpdateTimeStep(file["time"][30])
                reader.Update()
                walk = reader.GetOutputDataObject(0).NewIterator()
                walk.InitTraversal()
                bridge = walk.GetCurrentDataObject()
                self.assertEqual((bridge.GetNumberOfPoints(), bridge.GetCell(0).GetClassName()), (4, "vtkPolyLine"))
                moment = bridge.GetPointData().GetArray("moment (N m)")
                self.assertEqual([moment.GetValue(i) for i in range(4)], list(file["probes/moment"][30]))
                walk.GoToNextItem()
                self.assertEqual(walk.GetCurrentDataObject().GetNumberOfPoints(), 4)


class Spline(Files):
    def test_cubic_with_the_conditions_of_its_ends_is_found_again(self):
        knots, x = np.array([0.0, 3.0, 4.5, 10.0]), np.linspace(0.0, 10.0, 57)
        clamped = picture_motion.spline_matrix(knots, x, (True, True))
        np.testing.assert_allclose(clamped @ (2 * knots**3 - 30 * knots**2), 2 * x**3 - 30 * x**2, atol=1e-10)
        straight = picture_motion.spline_matrix(knots, np.array([-2.0, 12.0])) @ (3.0 * knots + 1.0)
        np.testing.assert_allclose(straight, [-5.0, 37.0], atol=1e-12)
        simple = picture_motion.spline_matrix(np.array([0.0, 5.0, 10.0]), x) @ [0.0, 1.0, 0.0]
        s = np.minimum(x, 10.0 - x) / 5.0  # two cubics without curvature at the ends: s (3 - s^2) / 2
        np.testing.assert_allclose(simple, s * (3.0 - s**2) / 2.0, atol=1e-13)

    def test_through_stations_and_supports(self):
        motion = self.motion()
        for row in (0, 17, 40):
            drawn = motion.deflection(row)
            np.testing.assert_allclose(np.interp(STATIONS, motion.x, drawn), motion.at_stations[row], atol=1e-15)
            np.testing.assert_allclose(np.interp([0.0, 20.0, 35.0], motion.x, drawn), 0.0, atol=1e-15)
        right = motion.x > 20.0  # the left span's stations say nothing about a span that is separate
        self.assertFalse(motion.matrix[right][:, :2].any())

    def test_the_line_at_a_free_joint_is_that_of_one_span(self):
        """Where no support holds the ends of two spans, the point between them belongs to the right one."""
        with h5py.File(self.folder / "run.h5", "a") as file:
            del file["model/supports"]
            put(file, "model/supports", [["pinned", "end"], ["free", "hinge"], ["roller", "end"]], "text")
        motion = self.motion()
        joint, after = np.searchsorted(motion.x, [20.0, 20.0], side="left") + [0, 1]
        np.testing.assert_allclose(motion.matrix[joint], motion.matrix[after], atol=0.1)
        self.assertFalse(motion.matrix[joint, :2].any())

    def test_a_span_without_a_station_is_not_known(self):
        with h5py.File(self.folder / "run.h5", "a") as file:
            del file["probes"]
            put(file, "probes/x", [5.0, 20.0], "m")  # the second over a support
            put(file, "probes/deflection", np.ones((41, 1)) * [-1e-3, 0.0], "m")
        motion = self.motion()
        known = ~np.isnan(motion.deflection(3))
        np.testing.assert_array_equal(known, (motion.x <= 20.0) | (motion.x == 35.0))
        self.assertIn("spans without a station are not drawn", motion.in_words())
        self.made("animate", "run.h5", "-o", "run.png", "--space-time", "st.png")


class Pictures(Files):
    def test_wheels_and_bodies_are_where_the_file_has_them(self):
        motion = self.motion()
        shapes = picture_motion.outline(motion, 20, 100.0)
        wheels = [shape for shape in shapes if shape.radius]
        self.assertEqual((len(shapes), len(wheels)), (4, 2))
        with h5py.File(self.folder / "run.h5") as file:
            axle = file["vehicles/1/axle/position"]
            sway = axle[20, 1] - axle[0, 1]
            np.testing.assert_allclose(wheels[1].points, [[axle[20, 0], 0.5 + 100.0 * sway]], atol=1e-12)
            np.testing.assert_allclose(list(picture_motion.wheel_places(motion, [0, 20]))[1],
                                       axle[:][[0, 20], 0], atol=1e-12)

    def test_frames_and_what_they_say(self):
        from PIL import Image
        self.assertEqual(self.made("animate", "run.h5", "-o", "run.gif", "--frames", "5", "--from", "0.5"), ["run.gif"])
        with Image.open(self.folder / "run.gif") as picture:
            self.assertEqual((picture.n_frames, picture.size), (5, (1100, 420)))
        stage = animate.Stage(self.motion(), 250.0)
        self.addCleanup(animate.plt.close, stage.figure)
        stage.draw(7)
        said = " ".join(text.get_text() for text in stage.ax.texts)
        self.assertIn("drawn 250 times too large", said)
        self.assertIn("between the 4 stations and the supports: cubic splines", said)
        self.assertIn("0.350 s", said)

    def test_exaggeration_is_chosen_from_the_greatest(self):
        self.assertEqual([animate.rounded(value) for value in (0.3, 4.9, 50.0, 770.0)], [1.0, 2.0, 50.0, 500.0])
        stage = animate.Stage(self.motion(), None)
        self.addCleanup(animate.plt.close, stage.figure)
        self.assertLessEqual(1e-3 * stage.factor, animate.DRAWN * stage.width)
        self.assertGreater(1e-3 * stage.factor, 0.3 * animate.DRAWN * stage.width)

    def test_space_time(self):
        self.assertEqual(self.made("animate", "run.h5", "--space-time", "st.png"), ["st.png"])
        data = (self.folder / "st.png").read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(len(data), 20000)
        self.assertFalse((self.folder / "run.gif").exists())

    def test_wrong_input(self):
        for words, complaint in ((("none.h5",), "is no results file that can be read"),
                                 (("sweep.h5",), "it is that of a sweep"), (("study.h5",), "it is that of a study"),
                                 (("run.h5", "--from", "3"), "stored from 0 to 2 s"),
                                 (("run.h5", "-o", "run.avi"), "run.avi: allowed: .gif, .mp4")):
            self.assertIn(complaint, self.refused("animate", *words))
        done = self.call("animate", "run.h5", "--frames", "0")
        self.assertEqual(done.returncode, 2)
        self.assertIn("number above 0", done.stderr)

    def test_mp4_needs_ffmpeg(self):
        os.environ["PATH"], kept = str(self.folder), os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", kept)
        with self.assertRaisesRegex(ValueError, "needs ffmpeg"):
            animate.writer_of(pathlib.Path("run.mp4"), 20)


if __name__ == "__main__":
    unittest.main()
