"""Traverse against what CalculiX and DOLFINx computed for its scenes (tests/data/finite_elements.csv): a train of moving
forces, a sprung mass in contact with its bridge, a force on three spans, the frequencies of a haunched bridge.

The bounds are the error of the other program, of which what another step or mesh changes is an estimate, and 1e-4 of ours.
"""

import csv
import os
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BUILD = os.path.dirname(os.environ.get("TRAVERSE_BINARY", str(SOURCE / "build" / "traverse")))
sys.path.insert(0, str(SOURCE / "benchmarks"))
import peers_calculix  # noqa: E402
import peers_rows  # noqa: E402


def table():
    with open(SOURCE / "tests" / "data" / "finite_elements.csv", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def stored(program, scene):
    return [float(row["value"]) for row in table() if row["program"] == program and row["scene"] == scene]


class AgainstFiniteElements(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def compare(self, ours, theirs, bound):
        self.assertEqual(len(ours), len(theirs))
        for ours_, theirs_ in zip(ours, theirs):
            self.assertLess(abs(ours_ / theirs_ - 1), bound, (ours_, theirs_))

    def peaks(self, ours, count):
        return [ours.peak(i) for i in range(count)]

    def test_train_of_forces(self):
        bridge = peers_rows.Bridge("scenes", "hslm_two_spans")
        ours = peers_calculix.forces_by_traverse(BUILD, self.folder, bridge, 3.48)
        self.compare(self.peaks(ours, 2), stored("CalculiX", "hslm_two_spans"), 2e-4)  # steps of 1 ms: 1e-4

    def test_sprung_mass_in_contact(self):
        scene = peers_rows.Bridge("scenes", "r3_sprung_mass").file
        ours = peers_rows.Ours(BUILD, self.folder, {"options_file": scene})
        self.compare(self.peaks(ours, 1), stored("CalculiX", "r3_sprung_mass"), 5e-4)  # steps of 2 ms: 3e-4

    def test_force_on_three_spans(self):
        scene = peers_rows.Bridge("scenes", "r6_three_spans").file
        ours = peers_rows.Ours(BUILD, self.folder, {"options_file": scene, "beam_elements_per_span": 12, "ts_dt": 5e-4,
                                                    "output_interval": 5e-4})
        self.compare(self.peaks(ours, 3), stored("DOLFINx", "r6_three_spans"), 2e-4)  # steps of 0.25 ms: 2e-4

    def test_frequencies(self):
        bridge = peers_rows.Bridge("bridges", "haunched")
        for program, bound in (("CalculiX", 2e-4), ("DOLFINx", 2e-5)):  # twice the elements: 7e-5; a quarter of them: 2e-5
            theirs = stored(program, "haunched")
            rows = list(peers_rows.of_modes(BUILD, self.folder, bridge, theirs, 0.0))
            self.compare([row.ours for row in rows], theirs, bound)

    def test_page_has_the_stored_values(self):
        with open(SOURCE / "doc" / "comparison.md", encoding="utf-8") as file:
            lines = file.read().splitlines()
        for program in ("CalculiX", "DOLFINx"):
            start = lines.index(peers_rows.page_table(program, [])[0]) + 2
            values = [line.split("|")[3].strip() for line in lines[start:lines.index("", start)]]
            self.assertEqual(values, [f"{float(row['value']):.5g}" for row in table() if row["program"] == program])


if __name__ == "__main__":
    unittest.main()
