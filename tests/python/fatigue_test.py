"""scripts/fatigue.py: cycles against the worked example of ASTM E1049, damage and ranges against their formulas."""

import collections
import csv
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
import fatigue  # noqa: E402


def histogram(values):
    counts = collections.Counter()
    for cycle in fatigue.rainflow(values):
        counts[cycle.range] += cycle.count
    return dict(counts)


class Rainflow(unittest.TestCase):
    def test_worked_example_of_the_standard(self):
        example = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]  # E1049-85, figure 6
        self.assertEqual(histogram(example), {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5})
        means = [cycle.mean for cycle in fatigue.rainflow(example) if cycle.count == 1.0]
        self.assertEqual(means, [1.0])

    def test_values_between_reversals_change_nothing(self):
        turning = np.array([0.0, 7.0, 2.0, 5.0, -3.0, 4.0, 0.0])
        dense = np.interp(np.arange(0.0, 6.01, 0.25), np.arange(7.0), turning)
        self.assertEqual(histogram(dense), histogram(turning))
        self.assertEqual(histogram(np.repeat(turning, 3)), histogram(turning))

    def test_every_reversal_is_half_a_cycle(self):
        values = np.random.default_rng(3).normal(size=2000)
        reversals = fatigue.reversals(values)
        cycles = fatigue.rainflow(values)
        self.assertEqual(2.0 * sum(c.count for c in cycles), len(reversals) - 1)
        self.assertEqual(max(c.range for c in cycles), np.ptp(values))

    def test_nothing_turns(self):
        self.assertEqual(fatigue.rainflow([]), [])
        self.assertEqual(fatigue.rainflow([2.0, 2.0]), [])
        self.assertEqual(fatigue.rainflow([0.0, 1.0, 2.0]), [fatigue.Cycle(2.0, 1.0, 0.5)])


class Damage(unittest.TestCase):
    def repeated(self, line, stress):
        return 1.0 / line.damage([fatigue.Cycle(stress, 0.0, 1.0)])

    def test_line_of_the_norm(self):
        line = fatigue.en1993(71.0)
        self.assertAlmostEqual(self.repeated(line, 71.0) / 2e6, 1.0, places=12)
        constant = 71.0 * 0.4 ** (1 / 3)  # 0.737 of the category
        self.assertAlmostEqual(self.repeated(line, constant * (1 + 1e-12)) / 5e6, 1.0, places=9)
        self.assertAlmostEqual(self.repeated(line, constant * (1 - 1e-12)) / 5e6, 1.0, places=9)
        cut_off = constant * 0.05**0.2  # 0.549 of that
        self.assertAlmostEqual(self.repeated(line, cut_off * (1 + 1e-12)) / 1e8, 1.0, places=9)
        self.assertEqual(line.damage([fatigue.Cycle(cut_off * (1 - 1e-12), 0.0, 1e9)]), 0.0)

    def test_equivalent_range_does_the_same_damage(self):
        cycles = fatigue.rainflow(np.random.default_rng(4).normal(size=500))
        line = fatigue.line_of("slope:5,2,1e6")
        one = fatigue.Cycle(fatigue.equivalent_range(cycles, 5.0, 2e6), 0.0, 2e6)
        self.assertAlmostEqual(line.damage([one]) / line.damage(cycles), 1.0, places=12)


class Command(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.run_of("a.h5", [0.0, 4.0, 1.0, 3.0, 0.0])
        self.run_of("b.h5", [0.0, 2.0, 0.0])

    def run_of(self, name, values):
        with h5py.File(self.folder / name, "w") as file:
            file["time"] = np.arange(float(len(values)))
            file["probes/moment"] = np.column_stack([values, np.multiply(values, -2.0)])

    def call(self, *words):
        command = [sys.executable, "-B", str(SOURCE / "scripts" / "fatigue.py"), *words]
        return subprocess.run(command, capture_output=True, text=True, cwd=self.folder)

    def test_trains_of_a_day(self):
        done = self.call("a.h5=3", "b.h5=10", "--of", "/probes/moment[1]", "--factor", "1/2", "--line", "slope:3,4,100",
                         "--csv", "cycles.csv")
        self.assertEqual(done.stderr, "")
        with open(self.folder / "cycles.csv", newline="") as file:
            rows = [(row["series"], float(row["range"]), float(row["count"])) for row in csv.DictReader(file)]
        name = "/probes/moment[1]"
        self.assertEqual(rows, [(name, 2.0, 3.0), (name, 4.0, 1.5), (name, 4.0, 1.5), (name, 2.0, 5.0),
                                (name, 2.0, 5.0)])
        damage = (13.0 * 0.5**3 + 3.0) / 100.0
        self.assertIn(f"{damage:14.4e}{1.0 / (damage * 365.25):10.4g}", done.stdout)
        self.assertEqual(self.call("a.h5", "--of", "probes/moment").stdout.count("/probes/moment["), 2)

    def test_bad_input_is_named_in_one_line(self):
        for words, complaint in {
                ("a.h5", "--of", "/probes/shear"): "a.h5 has no series /probes/shear over /time",
                ("a.h5", "--of", "/probes/moment[2]"): "/probes/moment[2]: its columns are [2]",
                ("none.h5", "--of", "/probes/moment"): "none.h5 is no results file that can be read",
                ("a.h5=0", "--of", "/probes/moment"): "a.h5=0: passages a day are a number above 0",
                ("a.h5", "--of", "/probes/moment", "--line", "en1993:-1"): "allowed: en1993:CATEGORY or slope:",
        }.items():
            done = self.call(*words)
            self.assertNotEqual(done.returncode, 0, words)
            self.assertIn(complaint, done.stderr.splitlines()[-1])


if __name__ == "__main__":
    unittest.main()
