"""scripts/decay.py on decays whose modes are known."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
sys.path.insert(0, str(SOURCE / "scripts"))
import decay  # noqa: E402

INTERVAL = 0.01
TIME = INTERVAL * np.arange(800)
MODES = [(1.7, 0.02, 3e-3, 0.3), (6.1, 0.015, 8e-4, 1.1)]  # undamped frequency (Hz), damping ratio, amplitude, phase


def free(*modes):
    total = np.zeros_like(TIME)
    for frequency, ratio, amplitude, phase in modes:
        omega = 2.0 * np.pi * frequency
        total += amplitude * np.exp(-ratio * omega * TIME) * np.cos(omega * np.sqrt(1.0 - ratio**2) * TIME + phase)
    return total


class Decay(unittest.TestCase):
    def test_two_modes_without_noise(self):
        found, constant, rest = decay.modes_of(free(*MODES) + 1e-3, INTERVAL, 2)
        for mode, (frequency, ratio, amplitude, _) in zip(found, MODES):
            self.assertAlmostEqual(mode.frequency / (frequency * np.sqrt(1.0 - ratio**2)), 1.0, places=8)
            self.assertAlmostEqual(mode.ratio, ratio, places=8)
            self.assertAlmostEqual(mode.amplitude, amplitude, places=8)
        self.assertAlmostEqual(constant, 1e-3, places=8)
        self.assertLess(rest, 1e-9)

    def test_standard_errors_cover_the_noise(self):
        """100 standardised errors of independent draws: their mean square is 1, with a deviation of sqrt(2/100)."""
        squares = []
        for seed in range(25):
            noise = 5e-5 * np.random.default_rng(seed).standard_normal(TIME.size)
            found, _, _ = decay.modes_of(free(*MODES) + noise, INTERVAL, 2)
            for mode, (frequency, ratio, _, _) in zip(found, MODES):
                squares.append(((mode.frequency - frequency * np.sqrt(1.0 - ratio**2)) / mode.frequency_error) ** 2)
                squares.append(((mode.ratio - ratio) / mode.ratio_error) ** 2)
        self.assertAlmostEqual(np.mean(squares), 1.0, delta=5.0 * np.sqrt(2.0 / len(squares)))

    def test_logarithmic_decrement(self):
        found = decay.decrement_of(free(MODES[0]), INTERVAL, 1.7)
        self.assertAlmostEqual(found.value, 2.0 * np.pi * 0.02 / np.sqrt(1.0 - 0.02**2), delta=1e-5)
        self.assertAlmostEqual(found.ratio, 0.02, delta=2e-6)
        self.assertAlmostEqual(found.frequency, 1.7 * np.sqrt(1.0 - 0.02**2), delta=1e-4)
        noisy = free(MODES[0]) + 5e-5 * np.random.default_rng(3).standard_normal(TIME.size)
        self.assertAlmostEqual(decay.decrement_of(noisy, INTERVAL, 1.7, 5e-5).ratio, 0.02, delta=5e-4)
        self.assertIsNone(decay.decrement_of(np.linspace(1.0, 0.0, 50), INTERVAL, 10.0))


class Program(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_on(self, text, *words):
        path = self.folder / "series.csv"
        path.write_text(text)
        return subprocess.run([sys.executable, "-B", str(SOURCE / "scripts" / "decay.py"), str(path), *words],
                              capture_output=True, text=True)

    def test_table(self):
        rows = "".join(f"{t:.4f}; {5.0 if t < 1.0 else v:.12g}\n" for t, v in zip(TIME, free(MODES[0])))
        for head in ("", "# t; v\n", "time (s),probes/deflection at 12.5 m (m)\n", "time [s];v\n"):
            with self.subTest(head):
                done = self.run_on(head + rows, "--from", "1.0")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn("1.69966", done.stdout)
                self.assertRegex(done.stdout, r"logarithmic decrement 0\.1257 of \d+ maxima: damping ratio 0\.02,")

    def test_refusals(self):
        rows = "".join(f"{t:.4f} {v:.12g}\n" for t, v in zip(TIME, free(MODES[0])))
        for text, words, part in ((rows, ["--column", "3"], "no column 3"), (rows, ["--from", "7.95"], "5 finite rows"),
                                  (rows, ["--modes", "0"], "allowed: 1 to 10"), ("t v\nunits\n" + rows, [], "no column 2"), ("0 x\n" + rows, [], "'x'"),
                                  ("0 1\n" + rows.replace("0.0000 ", "0.005 "), [], "equal intervals"),
                                  ("".join(f"{t} 1\n" for t in TIME), [], "0 oscillations"), ("", [], "no column 2")):
            with self.subTest(part):
                done = self.run_on(text, *words)
                self.assertEqual(done.returncode, 1)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(part, done.stderr)


if __name__ == "__main__":
    unittest.main()
