"""scripts/comfort.py on series whose indices follow from formulas."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
sys.path.insert(0, str(SOURCE / "scripts"))
import comfort  # noqa: E402

INTERVAL = 0.005


def sine(hertz, seconds, amplitude=0.3):
    return amplitude * np.sin(2.0 * np.pi * hertz * np.arange(0.0, seconds - 0.5 * INTERVAL, INTERVAL))


class Weights(unittest.TestCase):
    def test_of_a_sine(self):
        felt = comfort.comfort(sine(8.0, 60.0), INTERVAL)
        self.assertAlmostEqual(felt.rms, 0.3 / np.sqrt(2.0), places=12)
        # The start and the end of the series are no sine: a few parts in a thousand of the first and the last window.
        self.assertAlmostEqual(felt.weighted / (felt.rms * comfort.weighting_b(8.0)), 1.0, delta=5e-3)
        self.assertAlmostEqual(felt.n_mv / (6.0 * felt.rms * comfort.weighting_b(8.0)), 1.0, delta=5e-3)
        self.assertEqual(felt.windows, 12)
        self.assertAlmostEqual(felt.sperling, (100.0 * 0.3 * comfort.sperling_b(8.0)) ** 0.3, places=10)

    def test_limits_of_wb(self):
        low, middle, high = comfort.weighting_b([0.05, 1.0, 1000.0])
        self.assertAlmostEqual(low / (0.4 * (0.05 / 0.4) ** 2), 1.0, delta=0.02)  # the high-pass alone
        self.assertAlmostEqual(middle, 0.4, delta=0.02)
        self.assertLess(high, 0.01)
        f = np.linspace(0.5, 80.0, 20000)
        most = f[np.argmax(comfort.weighting_b(f))]
        self.assertTrue(5.0 < most < 16.0, most)  # where the body feels most

    def test_two_sines_add_in_the_power(self):
        both = comfort.sperling(sine(2.0, 20.0) + sine(9.0, 20.0), INTERVAL)
        each = [comfort.sperling(sine(f, 20.0), INTERVAL) for f in (2.0, 9.0)]
        self.assertAlmostEqual(both ** (1 / 0.15), sum(w ** (1 / 0.15) for w in each), places=6)

    def test_a_short_run_is_one_window(self):
        self.assertEqual(comfort.comfort(sine(8.0, 2.0), INTERVAL).windows, 1)


class Command(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        vertical, pitch = sine(4.0, 20.0), sine(4.0, 20.0, 0.01)
        with h5py.File(self.folder / "run.h5", "w") as file:
            file["time"] = INTERVAL * np.arange(len(vertical))
            file["vehicles/0/car/acceleration"] = np.column_stack([0.0 * vertical, vertical, pitch])
            file["vehicles/0/car/position"] = np.ones((len(vertical), 3))

    def call(self, *words):
        command = [sys.executable, "-B", str(SOURCE / "scripts" / "comfort.py"), *words]
        return subprocess.run(command, capture_output=True, text=True, cwd=self.folder)

    def test_a_place_off_the_centre_feels_the_pitch(self):
        done = self.call("run.h5", "--at", "0,10")
        self.assertEqual(done.stderr, "")
        at = [line.split() for line in done.stdout.splitlines()[1:]]
        self.assertEqual([row[3] for row in at], ["0", "10"])
        self.assertAlmostEqual(float(at[1][4]) / float(at[0][4]), 4.0 / 3.0, delta=1e-3)

    def test_bad_input_is_named_in_one_line(self):
        for words, complaint in {
                ("run.h5", "--body", "roof"): "comfort.py: run.h5: vehicle 0 has no body roof",
                ("none.h5",): "comfort.py: none.h5 is no results file that can be read",
        }.items():
            done = self.call(*words)
            self.assertEqual((done.returncode, done.stderr), (1, complaint + "\n"))


if __name__ == "__main__":
    unittest.main()
