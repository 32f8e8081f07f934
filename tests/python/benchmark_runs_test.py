"""What the benchmark scripts share (benchmarks/runs.py), on coarse runs: sizes, steps, peaks between samples."""

import os
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BUILD = pathlib.Path(os.environ["TRAVERSE_BINARY"]).parent
sys.path.insert(0, str(SOURCE / "benchmarks"))
import runs  # noqa: E402


class BenchmarkRuns(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def run_scene(self, name, options):
        file = os.path.join(self.folder, name + ".h5")
        return runs.Run(BUILD, {"options_file": runs.scene(name)} | options, file)

    def test_sprung_mass(self):
        run = self.run_scene("r3_sprung_mass", {"beam_elements_per_span": 8, "ts_dt": 0.05, "output_interval": 0.05,
                                                "step_kinks": "false"})
        self.assertEqual(run.unknowns, 2 * 9 + 1)
        self.assertEqual(run.steps, 20)
        self.assertGreater(run.seconds, 0.0)
        # REAL_CASES R3, converged; between samples 0.05 s apart, a fifth of the bridge's period.
        self.assertAlmostEqual(runs.peak(run.file) / -4.18626809e-4, 1.0, delta=2e-4)

    def test_layered_track(self):
        run = self.run_scene("r8_ballasted_bridge", {"ts_dt": 1e-2, "output_interval": 1e-2, "ts_max_steps": 2,
                                                     "track_approach": 57.6, "track_elements_per_bay": 2})
        # 276 bays: rail of two elements a bay, sleepers, bridge of 166 elements, ballast beside its 83 bays, the coach.
        self.assertEqual(run.unknowns, 2 * 553 + 277 + 2 * 167 + (276 - 83) + 10)

    def test_failures_are_said(self):
        with self.assertRaisesRegex(RuntimeError, "beam_elements"):
            self.run_scene("r3_sprung_mass", {"beam_elements_per_span": 0})


if __name__ == "__main__":
    unittest.main()
