"""Runs that stop and go on give what a run in one piece gives; results files are run again."""

import os
import pathlib
import resource
import shutil
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import BINARY, SOURCE  # noqa: E402

sys.path.insert(0, str(SOURCE / "benchmarks"))
from scene_texts import beam, car  # noqa: E402

SCENES = SOURCE / "options/scenes"
WORK = {"wall_seconds", "factorisations", "solves"}  # of the summary: what tells of the work done
# Name, scene, options, steps before the stop.
KINDS = [
    ("elements", "three_span_half_car", ["-beam_elements_per_span", "4", "-ts_dt", "2e-3", "-ts_max_time", "1.0"], 150),
    ("modes", "three_span_half_car",
     ["-beam_elements_per_span", "4", "-ts_dt", "2e-3", "-model_modes", "6", "-ts_max_time", "1.0"], 150),
    ("linear vehicles over modes", "three_span_train",
     ["-beam_elements_per_span", "4", "-ts_dt", "2e-3", "-model_modes", "6", "-model_vehicles", "linear",
      "-ts_max_time", "0.8"], 150),
    ("spans apart", "danyang_kunshan", ["-ts_dt", "1e-2", "-ts_max_time", "1.5", "-output_interval", "0.1"], 60),
    ("lost contact", "wheel_over_a_bump", [], 200),
    ("impacts", "bouncing_ball", [], 400),
    ("friction", "freight_wagon", ["-ts_dt", "2e-3", "-ts_max_time", "0.4"], 80),
    ("mechanism", "slider_crank", [], 100),
    *((f"{vehicles} vehicles after they have stopped", "train_brakes_to_rest",
       ["-beam_elements_per_span", "4", "-ts_dt", "1e-2", "-ts_max_time", "15.5", "-model_vehicles", vehicles], 1500)
      for vehicles in ("full", "linear")),
    ("foundation with a gap", "prop_with_gap", ["-ts_max_time", "0.1"], 100),
    ("layered track", "ballasted_viaduct", ["-ts_dt", "2e-3", "-ts_max_time", "0.06"], 12),
    ("hanging sleepers", "transition_zone",
     ["-ts_dt", "2e-3", "-track_elements_per_bay", "2", "-train_positions", "-12", "-ts_max_time", "0.12"], 30),
    ("sleepers that slide", "braking_on_ballast",
     ["-ts_dt", "2e-3", "-train_vehicles", "wagon", "-track_approach", "60", "-ts_max_time", "0.2"], 50),
    ("exact in time", "r1_moving_force", ["-model_modes", "3"], 7),
    ("adaptive steps", "three_span_half_car",
     ["-beam_elements_per_span", "4", "-ts_dt", "2e-3", "-ts_adapt_type", "ladder", "-ts_type", "esdirk4",
      "-ts_max_time", "0.6"], 100),
    ("a type of PETSc", "three_span_half_car",
     ["-beam_elements_per_span", "4", "-ts_dt", "2e-3", "-ts_type", "arkimex", "-ts_max_time", "0.4"], 70),
]

OUT_OF_BALANCE = f"""
beam: {{spans: [24.0, 24.0], EI: 2.07006e+10, mass: 2969.06, damping_ratios: 0.0251, continuity: simply_supported}}
support: {{types: roller*3}}
vehicle: {{coach: {{file: {SOURCE}/options/vehicles/s300.yml}}}}
train: {{vehicles: coach*3, speed: 74.0}}
scene: {{tail: 1.0}}
"""


LEFT_OUT = ("options", "option", "input", "input_file", "input_option")


def content(file):
    """All that a file holds but where it came from and what tells of the work done, notes among that."""
    found = {}

    def take(name, item):
        if isinstance(item, h5py.Dataset) and name.split("/")[0] not in LEFT_OUT and name != "model/notes":
            found[name] = item[()]

    with h5py.File(file) as results:
        results.visititems(take)
        found.update({"/summary " + name: value for name, value in results["summary"].attrs.items() if name not in WORK})
    return found


def is_same(one, other):
    if getattr(one, "dtype", None) is not None and one.dtype.kind == "f":
        return np.array_equal(one, other, equal_nan=True)
    return np.array_equal(one, other)


def limit_files():
    resource.setrlimit(resource.RLIMIT_FSIZE, (3_000_000, 3_000_000))


class Folder(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def command(self, scene, options, file, ranks=1):
        ahead = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
        return [*ahead, str(BINARY), "-options_file", str((SCENES / scene).with_suffix(".yml")), "-output_quiet", *options,
                "-output_file", file]

    def run_it(self, command, status=0, **how):
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, **how)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def assert_same(self, one, other):
        one, other = content(self.folder / one), content(self.folder / other)
        self.assertEqual(one.keys(), other.keys())
        self.assertEqual([name for name in one if not is_same(one[name], other[name])], [])

    def refusal(self, command, *words):
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)


class Stopped(Folder):
    def stop_and_go_on(self, scene, options, steps, ranks=1):
        self.run_it(self.command(scene, options, "whole.h5", ranks))
        self.run_it(self.command(scene, [*options, "-ts_max_steps", str(steps)], "parts.h5", ranks))
        self.assertTrue((self.folder / "parts.h5.checkpoint").exists())
        self.run_it(self.command(scene, [*options, "-restart", "parts.h5.checkpoint"], "parts.h5", ranks))
        self.assertFalse((self.folder / "parts.h5.checkpoint").exists())
        self.assert_same("whole.h5", "parts.h5")

    def test_goes_on_bit_for_bit(self):
        for name, scene, options, steps in KINDS:
            with self.subTest(name):
                self.stop_and_go_on(scene, options, steps)

    def test_repeated_with_mechanisms(self):
        """Linear vehicles that prove out of balance, where the run has stopped before and after that."""
        scene = self.folder / "out_of_balance.yml"
        scene.write_text(OUT_OF_BALANCE)
        for steps in (200, 1500):
            self.stop_and_go_on(scene, ["-accuracy", "3e-4", "-beam_elements_per_span", "16", "-ts_dt", "1e-3"], steps)
            with h5py.File(self.folder / "whole.h5") as whole:
                self.assertIn("repeated with the mechanisms", str(whole["model/notes"][()]))

    def test_last_run_of_a_search(self):
        """The errors of a run that has gone on are those of a run in one piece, without trial runs again."""
        scene, options = "three_span_train", ["-accuracy", "1e-2"]
        self.run_it(self.command(scene, [*options, "-ts_max_steps", "300"], "parts.h5"))
        self.run_it(self.command(scene, [*options, "-restart", "parts.h5.checkpoint"], "parts.h5"))
        self.run_it(self.command(scene, [*options, "-accuracy_cache", "false"], "whole.h5"))
        self.assert_same("whole.h5", "parts.h5")
        with h5py.File(self.folder / "parts.h5") as parts:
            self.assertIn("stored choice", str(parts["model/notes"][()]))
            self.assertIn("expected_error_deflection", parts["summary"].attrs)

    def test_on_two_ranks(self):
        for _, scene, options, steps in (KINDS[0], KINDS[4]):
            with self.subTest(scene):
                self.stop_and_go_on(scene, [*options, "-step_ranks", "all"], steps, ranks=2)

    def test_on_another_number_of_ranks(self):
        _, scene, options, steps = KINDS[0]
        options = [*options, "-step_ranks", "all"]
        self.run_it(self.command(scene, options, "whole.h5"))
        self.run_it(self.command(scene, [*options, "-ts_max_steps", str(steps)], "parts.h5", 2))
        self.run_it(self.command(scene, [*options, "-restart", "parts.h5.checkpoint"], "parts.h5"))
        one, other = content(self.folder / "whole.h5"), content(self.folder / "parts.h5")
        series = [name for name, values in one.items() if isinstance(values, np.ndarray) and values.dtype.kind == "f"
                  and "residual" not in name and not name.startswith("end/") and np.abs(values).max(initial=0.0) > 0.0]
        self.assertGreater(len(series), 30)
        for name in series:
            off = np.nanmax(np.abs(one[name] - other[name])) / np.nanmax(np.abs(one[name]))
            self.assertLess(off, 1e-10, name)

    def endless(self, *options):
        return self.command("three_span_half_car",
                            ["-beam_elements_per_span", "4", "-ts_dt", "1e-3", "-ts_max_time", "1e5",
                             "-output_interval", "0.01", *options], "r.h5")

    def wait_for(self, name, child):
        begin = time.monotonic()
        while not (self.folder / name).exists() or (self.folder / name).stat().st_size == 0:
            self.assertIsNone(child.poll())
            self.assertLess(time.monotonic() - begin, 600.0)
            time.sleep(0.02)

    def test_signals(self):
        child = subprocess.Popen(self.endless("-checkpoint_interval", "0"), cwd=self.folder, text=True,
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(child.kill)
        self.wait_for("r.h5", child)
        child.send_signal(signal.SIGUSR1)
        self.wait_for("r.h5.checkpoint", child)
        self.assertIsNone(child.poll())  # it goes on
        first = (self.folder / "r.h5.checkpoint").read_bytes()
        child.send_signal(signal.SIGTERM)
        out, err = child.communicate()
        self.assertEqual((child.returncode, err), (128 + signal.SIGTERM, ""))
        self.assertIn("ended by signal 15", out)
        self.assertNotEqual((self.folder / "r.h5.checkpoint").read_bytes(), first)
        with h5py.File(self.folder / "r.h5") as results:
            end = results["summary"].attrs["end_time"]
        again = [*self.endless("-restart", "r.h5.checkpoint"), "-ts_max_time", str(end + 1.0)]
        self.run_it(again)
        self.run_it([*self.endless(), "-ts_max_time", str(end + 1.0), "-output_file", "whole.h5"])
        with h5py.File(self.folder / "r.h5") as parts, h5py.File(self.folder / "whole.h5") as whole:
            self.assertTrue(np.array_equal(parts["time"][:], whole["time"][:]))
            difference = np.abs(parts["probes/deflection"][:] - whole["probes/deflection"][:]).max()
            self.assertLess(difference, 1e-12 * np.abs(whole["probes/deflection"][:]).max())

    def test_a_file_that_cannot_grow(self):
        """The checkpoint before and the results up to then stay whole."""
        signal_before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # as Python has it, for the child too
        self.addCleanup(signal.signal, signal.SIGXFSZ, signal_before)
        done = subprocess.run(self.endless("-checkpoint_interval", "0.01", "-output_probes", "10*50"), cwd=self.folder,
                              capture_output=True, text=True, preexec_fn=limit_files, restore_signals=False)
        self.assertEqual(done.returncode, 4, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        with h5py.File(self.folder / "r.h5") as results:
            rows = len(results["time"])
            self.assertGreater(rows, 1)
            self.assertTrue(np.isfinite(results["probes/deflection"][:rows]).all())
        self.assertFalse((self.folder / "r.h5.checkpoint.part").exists())
        again = self.endless("-output_probes", "10*50", "-restart", "r.h5.checkpoint")
        done = subprocess.run([*again, "-ts_max_steps", "1"], cwd=self.folder, capture_output=True, text=True)
        taken = int(re.search(r"has taken (\d+) steps already", done.stderr)[1])
        self.run_it([*again, "-ts_max_steps", str(taken + 1)])

    def test_refused(self):
        _, scene, options, steps = KINDS[0]
        self.run_it(self.command(scene, [*options, "-ts_max_steps", str(steps)], "r.h5"))
        go_on = [*options, "-restart", "r.h5.checkpoint"]
        before = (self.folder / "r.h5").read_bytes()
        self.refusal(self.command(scene, [*go_on, "-train_speed", "30"], "r.h5"), "another scene")
        self.refusal(self.command(scene, [*go_on, "-ts_max_time", "0.1"], "r.h5"), "0.1 s")
        self.refusal(self.command(scene, [*go_on, "-sweep_speed", "20,30,10"], "r.h5"), "studies and sweeps")
        self.refusal(self.command(scene, [*options, "-restart", "nothing"], "r.h5"), "no such file")
        self.refusal(self.command(scene, [*options, "-restart", "r.h5"], "r.h5"), "is no checkpoint")
        damaged = bytearray((self.folder / "r.h5.checkpoint").read_bytes())
        damaged[len(damaged) // 2] ^= 1
        (self.folder / "damaged").write_bytes(damaged)
        self.refusal(self.command(scene, [*options, "-restart", "damaged"], "r.h5"), "damaged")
        self.assertEqual((self.folder / "r.h5").read_bytes(), before)
        os.remove(self.folder / "r.h5")
        self.refusal(self.command(scene, go_on, "r.h5"), "not there")


class Again(Folder):
    def test_runs_what_results_came_from(self):
        """The scene, its tables and vehicle files are away by then."""
        shutil.copytree(SOURCE / "options", self.folder / "options")
        for scene in ("tapered_jib", "freight_wagon", "hslm_two_spans"):
            short = {"freight_wagon": ["-ts_dt", "2e-3", "-ts_max_time", "0.2"]}.get(scene, [])
            self.run_it([str(BINARY), "-options_file", f"options/scenes/{scene}.yml", "-output_quiet", *short,
                         "-output_file", f"{scene}.h5"])
        shutil.rmtree(self.folder / "options")
        for scene in ("tapered_jib", "freight_wagon", "hslm_two_spans"):
            with self.subTest(scene):
                self.run_it([str(BINARY), f"{scene}.h5"])
                self.assert_same(f"{scene}.h5", f"{scene}_again.h5")
        self.run_it([str(BINARY), "freight_wagon_again.h5", "-ts_max_time", "0.1", "-output_file", "short.h5"])
        with h5py.File(self.folder / "short.h5") as results:
            self.assertAlmostEqual(results["summary"].attrs["end_time"], 0.1)

    def test_goes_on_without_the_scene(self):
        shutil.copytree(SOURCE / "options", self.folder / "options")
        run = [str(BINARY), "-options_file", "options/scenes/freight_wagon.yml", "-output_quiet", "-ts_dt", "2e-3",
               "-ts_max_time", "0.2"]
        self.run_it([*run, "-output_file", "whole.h5"])
        self.run_it([*run, "-output_file", "parts.h5", "-ts_max_steps", "50"])
        shutil.rmtree(self.folder / "options")
        self.run_it([str(BINARY), "parts.h5", "-restart", "parts.h5.checkpoint", "-ts_max_steps", "100000"])
        self.assert_same("whole.h5", "parts.h5")
        self.assertFalse((self.folder / "parts_again.h5").exists())

    def test_files_without_texts(self):
        with h5py.File(self.folder / "old.h5", "w") as old:
            old.attrs["program"] = "traverse"
        self.refusal([str(BINARY), "old.h5"], "old.h5", "no texts of its scene")


if __name__ == "__main__":
    unittest.main()
