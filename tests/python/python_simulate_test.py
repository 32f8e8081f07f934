"""traverse.simulate: problems as values, their results against those of the program, observers, tables, ranks, stops."""

import os
import pickle
import pathlib
import signal
import subprocess
import sys
import unittest
import warnings

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from module_scenes import BRIDGE, FORCES, HOPPING, SOURCE, InFolder, traverse  # noqa: E402

OPEN = {"beam": {"spans": 20.0, "EI": 3e10, "mass": 1.8e4, "damping_ratios": 0.01}, "load": {"forces": 1e5}}
ENVIRONMENT = os.environ | {"PYTHONPATH": str(SOURCE / "python"), "OMPI_ALLOW_RUN_AS_ROOT": "1",
                            "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
                            "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}


class Simulate(InFolder):
    def setUp(self):
        super().setUp()
        caught = warnings.catch_warnings()
        caught.__enter__()
        self.addCleanup(caught.__exit__, None, None, None)
        warnings.simplefilter("ignore", traverse.UnusualInput)

    def test_one_problem_has_the_peaks_of_its_run(self):
        whole = traverse.run(HOPPING, model_vehicles="full")
        found = traverse.simulate(traverse.Problem(HOPPING, model_vehicles="full"))
        self.assertEqual(found["peak_deflection"].max(), abs(whole.attrs["summary_deflection"]))
        self.assertEqual(found["greatest_wheel_force"], whole.attrs["summary_greatest_wheel_force"])
        self.assertEqual(found["contact_losses"], whole.attrs["summary_contact_losses"])
        self.assertEqual(found["steps"], whole.attrs["summary_steps"])
        self.assertEqual(found["x"].values.tolist(), whole["x"].values.tolist())

    def test_many_problems_are_the_runs_of_a_study(self):
        speeds = np.linspace(20.0, 60.0, 21)
        study = traverse.study(OPEN, {"load_speed": speeds.tolist()})
        found = traverse.simulate([traverse.Problem(OPEN, load_speed=speed) for speed in speeds])
        self.assertEqual(found["peak_deflection"].dims, ("load_speed", "x"))
        np.testing.assert_array_equal(found["load_speed"], speeds)
        np.testing.assert_allclose(found["load_speed_kmh"], 3.6 * speeds)
        for name in ("peak_deflection", "peak_acceleration", "peak_moment", "peak_deflection_time"):
            np.testing.assert_array_equal(found[name], study[name])
        self.assertRegex(found.attrs["model"], "by [0-9]+ modes")

    def test_several_options_differ(self):
        problems = [traverse.Problem(OPEN, load_speed=40.0, beam={"EI": EI, "damping_ratios": ratio})
                    for EI in (2e10, 3e10) for ratio in (0.01, 0.02)]
        found = traverse.simulate([*problems, problems[0].with_options(beam_spans=[20.0, 20.0])])
        self.assertEqual(found["beam_EI"].dims, ("case",))
        np.testing.assert_array_equal(found["beam_damping_ratios"][:4], [0.01, 0.02, 0.01, 0.02])
        self.assertEqual(found["peak_deflection"].dims, ("case", "probe"))
        self.assertTrue(np.isnan(found["peak_deflection"][0, 1]) and found["peak_deflection"][4, 1] > 0.0)
        alone = traverse.simulate(problems[2])["peak_deflection"].item()
        self.assertAlmostEqual(found["peak_deflection"][2, 0].item() / alone, 1.0, delta=2e-3)

    def test_an_array_in_place_of_a_file(self):
        t = np.arange(0.0, 1.0, 0.02)
        rows = np.c_[t, 2e4 * np.sin(20.0 * t)]
        np.savetxt(self.folder / "beat.csv", rows, fmt="%.17g")
        as_file = traverse.simulate(traverse.Problem(OPEN, folder=self.folder, load={"speed": 30.0, "table": "beat.csv"}))
        as_array = traverse.simulate(traverse.Problem(OPEN, load={"speed": 30.0, "table": rows}))
        self.assertEqual(as_file["peak_deflection"], as_array["peak_deflection"])
        plain = traverse.simulate(traverse.Problem(OPEN, load={"speed": 30.0, "table": rows}).with_options(load_table=None))
        self.assertGreater(abs(plain["peak_deflection"] / as_array["peak_deflection"] - 1.0), 0.01)

    def test_observers_are_passages(self):
        seen = []
        problem = traverse.Problem(FORCES)
        whole = traverse.simulate(problem, lambda now: seen.append((now.time, now.read("deflection"))))
        run = traverse.run(FORCES)
        np.testing.assert_array_equal([time for time, _ in seen], run["time"])
        np.testing.assert_array_equal([value for _, value in seen], run["deflection"])
        part = traverse.simulate(problem, lambda now: now.time < 0.1)
        self.assertLess(part["steps"], whole["steps"])
        with self.assertRaises(ZeroDivisionError):
            traverse.simulate(problem, lambda now: 1 / 0)

    def test_limits(self):
        (self.folder / "limits.yml").write_text("- {clause: own, quantity: deflection_over_span, value: 1e-4}\n",
                                                encoding="utf-8")
        judged = {"load_speed": 30.0, "limits": self.folder / "limits.yml"}
        one = traverse.simulate(traverse.Problem(OPEN, **judged))
        many = traverse.simulate([traverse.Problem(OPEN, **judged | {"load_speed": speed}) for speed in (30.0, 31.0)])
        self.assertEqual(one["criterion"].values.tolist(), ["deflection_over_span"])
        self.assertAlmostEqual(one["judged"].item() / (one["peak_deflection"].max().item() / 20.0), 1.0, delta=1e-9)
        self.assertAlmostEqual(many["judged"][0].item() / one["judged"].item(), 1.0, delta=2e-3)

    def test_refusals(self):
        good = traverse.Problem(OPEN, load_speed=30.0)
        self.refused(2, "problem 1: beam_EI = -1", traverse.simulate, [good, good.with_options(beam_EI=-1)])
        self.refused(2, "beam_IE.*did you mean beam_EI", traverse.simulate, good.with_options(beam_IE=1))
        self.refused(2, "there is no such file", traverse.simulate, traverse.Problem("not_there.yml"))
        self.refused(2, "a problem is one run", traverse.simulate, good.with_options(sweep_speed=[20.0, 30.0, 5.0]))
        self.refused(2, "finite", traverse.simulate, good.with_options(load_table=np.array([[0.0, 1.0], [1.0, np.nan]])))
        self.refused(2, "ranks", traverse.simulate, good, ranks=0)
        self.refused(2, "1j of a scene is of the type complex", traverse.Problem, FORCES, beam_EI=1j)
        self.refused(2, "no problem", traverse.simulate, [])
        self.refused(2, "5 is not a problem", traverse.simulate, [good, 5])

    def test_a_problem_is_a_value(self):
        load = {"speed": 30.0, "table": np.array([[0.0, 1e5], [3.0, 1e5]])}
        one = traverse.Problem(OPEN, load=load)
        self.assertEqual(one, pickle.loads(pickle.dumps(one)))
        self.assertEqual(len({one, traverse.Problem(OPEN, load=load), one.with_options(load_speed=31.0)}), 2)
        self.assertNotEqual(one, traverse.Problem(OPEN, load=load | {"table": 2.0 * load["table"]}))
        self.assertIn("load_speed='30.0'", repr(one))

    def test_the_other_results_of_a_failed_run(self):
        steps = {"ts_dt": 0.02, "ts_type": "rk", "beam": BRIDGE}  # unstable, but for the softest beam
        problems = [traverse.Problem(FORCES, **steps, beam_mass=mass) for mass in (1.8e9, 1.8e4)]
        with self.assertRaises(traverse.Error) as failed:
            traverse.simulate(problems)
        self.assertEqual(failed.exception.status, 3)
        self.assertIsNotNone(failed.exception.results)

    def test_progress_and_its_stop(self):
        slow = traverse.Problem(FORCES, ts_dt=1e-6)
        shares = []
        self.refused(130, "stopped", traverse.simulate, slow, progress=lambda done: shares.append(done) or len(shares) < 2)
        self.assertEqual(shares, [0.0, 0.0])
        with self.assertRaises(ZeroDivisionError):
            traverse.simulate(slow, progress=lambda done: 1 / 0)
        self.assertGreater(traverse.simulate(slow.with_options(ts_dt=1e-3))["steps"], 0)  # and the next one goes

    def test_a_signal_is_a_keyboard_interrupt(self):
        code = ("import traverse\ncalls = []\n"
                "def progress(done):\n    calls.append(done)\n    if len(calls) == 2: print('computes', flush=True)\n"
                f"try: traverse.simulate(traverse.Problem({FORCES!r}, ts_dt=1e-8), progress=progress)\n"
                "except KeyboardInterrupt: print('interrupted')")
        run = subprocess.Popen([sys.executable, "-B", "-c", code], stdout=subprocess.PIPE, text=True, env=ENVIRONMENT)
        self.assertEqual(run.stdout.readline(), "computes\n")
        run.send_signal(signal.SIGINT)
        self.assertEqual((run.wait(300), run.stdout.read()), (0, "interrupted\n"))
        run.stdout.close()

    def test_ranks_have_the_same_results(self):
        problems = [traverse.Problem(OPEN, load_speed=speed) for speed in (25.0, 30.0, 35.0, 40.0)]
        problems.append(traverse.Problem(HOPPING))
        alone, shared = traverse.simulate(problems), traverse.simulate(problems, ranks=2)
        self.assertTrue(alone.identical(shared))
        self.refused(2, "beam_EI", traverse.simulate, problems[0].with_options(beam_EI=-1), ranks=2)

    def test_the_example(self):
        run = subprocess.run([sys.executable, "-B", "-W", "ignore", SOURCE / "examples/resonance_curve.py", "curve.png"],
                             cwd=self.folder, capture_output=True, text=True, env=ENVIRONMENT | {"MPLBACKEND": "Agg"})
        self.assertRegex(run.stdout, r"^\d\.\d+ m/s2 at \d\d\.\d m/s\n$", run.stderr)
        self.assertGreater((self.folder / "curve.png").stat().st_size, 10000)

    def test_under_mpirun(self):
        code = ("import traverse\n"
                f"r = traverse.simulate([traverse.Problem({OPEN!r}, load_speed=v) for v in (30.0, 40.0)])\n"
                "print(repr(float(r['peak_deflection'].sum())))")
        run = subprocess.run(["mpirun", "-n", "2", sys.executable, "-B", "-W", "ignore", "-c", code], capture_output=True,
                             text=True, env=ENVIRONMENT, timeout=300)
        alone = traverse.simulate([traverse.Problem(OPEN, load_speed=speed) for speed in (30.0, 40.0)])
        self.assertEqual("".join(run.stdout.split()), 2 * repr(float(alone["peak_deflection"].sum())), run.stderr)


if __name__ == "__main__":
    unittest.main()
