"""The samples that scripts/page.py keeps of long curves."""

import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from traverse_page.packing import Curve, kept_rows  # noqa: E402


class PackingTest(unittest.TestCase):
    def test_fewer_samples_keep_all_extremes(self):
        time = np.linspace(0.0, 1.0, 50_001)
        band = np.column_stack([np.cos(9 * time), np.cos(9 * time) + 1.0])
        curves = [Curve("a", np.sin(40 * time)), Curve("b", band)]
        curves[0].values[[777, 31_000]] = 9.0, -9.0
        curves[1].values[44_444, 1] = np.nan
        rows = kept_rows(curves, 1000)
        self.assertLessEqual(len(rows), 1002)
        self.assertTrue({0, 777, 31_000, 50_000} <= set(rows))
        self.assertTrue(np.all(np.diff(rows) > 0))


if __name__ == "__main__":
    unittest.main()
