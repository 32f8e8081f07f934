"""Trains by a timetable, and results of a line by train and span in place of series."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import BINARY, SOURCE  # noqa: E402

SPEED = 80.0  # m/s
SPAN, SPANS = 32.0, 40
FRONT_WHEEL = 10.0  # m, from the origin of the coach
LENGTH = SPAN * SPANS
UP, DOWN = [-5.0, 4.0, 30.0], [0.0, 7.5, -30.0]  # s; the last of each is not on the bridge during the run

LINE = f"""
beam: {{spans: {SPAN}*{SPANS}, elements_per_span: 6, EI: 3.795e11, mass: 3.0e4, continuity: simply_supported, damping_ratios: 0.02}}
support: {{types: roller}}
vehicle: {{coach: {{file: {SOURCE}/options/vehicles/s300.yml}}}}
model: {{vehicles: linear}}
step_kinks: false
ts: {{dt: 0.01, max_time: 22.0}}
"""
TIMETABLE = LINE + f"""
trains: [up, down]
up: {{vehicles: coach*2, spacing: 25.0, speed: {SPEED}, times: {[100.0 + t for t in UP]}}}
down: {{vehicles: coach*1, speed: {-SPEED}, times: {[100.0 + t for t in DOWN]}}}
trains_from: 100.0
output: {{probes_spacing: 16.0, interval: 1.0}}
"""
QUANTITIES = ("deflection", "acceleration", "moment")


class Timetable(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def run_scene(self, scene, file, *options, ranks=1):
        (self.folder / "line.yml").write_text(scene)
        ahead = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
        return subprocess.run([*ahead, str(BINARY), "-options_file", "line.yml", "-output_file", file, *options],
                              cwd=self.folder, capture_output=True, text=True)

    def results(self, scene, file, *options, ranks=1):
        done = self.run_scene(scene, file, *options, ranks=ranks)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        found = {}

        def take(name, item):
            if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and not name.startswith(("input", "option", "model")):
                found[name] = item[()]

        with h5py.File(self.folder / file) as results:
            results.visititems(take)
            found["names"] = [row[0].decode() for row in results["trains/name"][()]]
        return found

    def test_times_place_the_trains(self):
        """As trains with the positions that follow from their times."""
        timed = self.results(TIMETABLE, "timed.h5")
        self.assertEqual(timed["names"], ["up_1", "up_2", "down_1", "down_2"])
        np.testing.assert_allclose(timed["trains/on_bridge"][:, 0], [UP[0], UP[1], DOWN[0], DOWN[1]], atol=1e-9)
        blocks = ""
        for name, count, direction, entrance, times in (("up", 2, 1, 0.0, UP), ("down", 1, -1, LENGTH, DOWN)):
            for number, enters in enumerate(times[:2], 1):
                ahead = entrance - direction * SPEED * enters
                blocks += (f"{name}_{number}: {{vehicles: coach*{count}, positions: {ahead - direction * FRONT_WHEEL}, "
                           f"{'spacing: 25.0, ' if count > 1 else ''}speed: {direction * SPEED}}}\n")
        placed = self.results(LINE + blocks + "trains: [up_1, up_2, down_1, down_2]\noutput: {probes_spacing: 16.0, interval: 1.0}\n",
                              "placed.h5")
        self.assertEqual(timed.keys(), placed.keys())
        for name in timed:
            if name != "names":
                np.testing.assert_allclose(placed[name], timed[name], rtol=1e-9, atol=1e-9 * np.nanmax(np.abs(timed[name]), initial=1e-300),
                                           err_msg=name)

    def test_peaks_without_series(self):
        """Those of the run that computes all trains all the time, and stores everything."""
        all_series = self.results(TIMETABLE, "series.h5")
        peaks = self.results(TIMETABLE, "peaks.h5", "-output_series", "false")
        self.assertFalse([name for name in peaks if name.startswith(("vehicles", "supports", "probes/d"))])
        for name in (*(f"envelope/{quantity}" for quantity in QUANTITIES), "trains/least_wheel_force", "trains/greatest_wheel_force",
                     "trains/on_bridge"):
            np.testing.assert_allclose(peaks[name], all_series[name], rtol=0.0, atol=1e-8 * np.abs(all_series[name]).max(), err_msg=name)

        ends, probes = peaks["spans/x"], peaks["envelope/x"]
        self.assertEqual(ends.shape, (SPANS, 2))
        for quantity in QUANTITIES:
            largest = np.abs(peaks[f"envelope/{quantity}"]).max(axis=1)
            of_span = [largest[(probes >= left) & (probes <= right)].max() for left, right in ends]
            np.testing.assert_allclose(np.abs(peaks[f"spans/{quantity}"]), of_span, rtol=1e-9, err_msg=quantity)

    def test_train_of_a_peak(self):
        """Is on the span, or has left it last."""
        peaks = self.results(TIMETABLE, "peaks.h5", "-output_series", "false")
        names, ends = peaks["names"], peaks["spans/x"]
        speed = np.array([SPEED if name.startswith("up") else -SPEED for name in names])
        front = np.where(speed > 0, 0.0, LENGTH) - speed * peaks["trains/on_bridge"][:, 0]
        for span, (train, time) in enumerate(zip(peaks["spans/deflection_train"].astype(int), peaks["spans/deflection_time"])):
            place = front[train] + speed[train] * time
            self.assertLess(abs(place - ends[span].mean()), 70.0, f"span {span}, {names[train]}")

    def test_on_two_ranks_and_from_a_checkpoint(self):
        options = ("-output_series", "false")
        one = self.results(TIMETABLE, "one.h5", *options)
        two = self.results(TIMETABLE, "two.h5", *options, ranks=2)
        self.assertEqual(self.run_scene(TIMETABLE, "part.h5", *options, "-ts_max_steps", "900").returncode, 0)
        rest = self.results(TIMETABLE, "rest.h5", *options, "-restart", "part.h5.checkpoint")
        for name, values in one.items():
            if name == "names" or name.endswith(("_time", "residual")):
                continue
            scale = np.nanmax(np.abs(values), initial=0.0)
            np.testing.assert_allclose(two[name], values, rtol=0.0, atol=1e-6 * scale, err_msg=name)
            np.testing.assert_array_equal(rest[name], values, err_msg=name)

    def test_one_train(self):
        one = self.results(LINE + f"train: {{vehicles: coach*2, spacing: 25.0, speed: {SPEED}}}\n", "one.h5", "-output_series", "false")
        self.assertEqual(one["names"], ["train"])
        self.assertEqual(set(one["spans/deflection_train"]), {0.0})
        self.assertGreater(one["trains/least_wheel_force"][0], 0.0)

    def test_refusals(self):
        for change, message in ((("speed: 80.0, times", "positions: 3.0, speed: 80.0, times"), "up_positions"),
                                (("speed: 80.0", "speed: 0.0"), "up_times"),
                                (("trains_from: 100.0", "trains_from: 1e5"), "no train of the timetable")):
            done = self.run_scene(TIMETABLE.replace(*change), "none.h5")
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(message, done.stderr)
            self.assertFalse((self.folder / "none.h5").exists())


if __name__ == "__main__":
    unittest.main()
