"""Bridges that twist against three-dimensional bodies by CalculiX (tests/data/solid_bridge*.csv): frequencies, static
values, skew bearings, warping, passages of HSLM-A5 on one track and of trains on two; sections against closed forms.

The bounds are what beams omit: the transverse curvature of the deck by Poisson's ratio, nu y^2/2 v'', which the one span
without Poisson's ratio does not have; and the bending of the deck beside its girder.
"""

import csv
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BINARY = os.environ.get("TRAVERSE_BINARY", str(SOURCE / "build" / "traverse"))
sys.path.insert(0, str(SOURCE / "benchmarks"))
import solid_beams  # noqa: E402
import solid_bridge  # noqa: E402
import solid_section  # noqa: E402
import solid_traverse  # noqa: E402
from solid_cases import RATIO, STEP, WITHOUT_POISSON, Cross, Girder, Slab  # noqa: E402

DECK = 1e-4  # of the first frequency: the deck bends beside its girder, with the square of the frequency


def stored(name):
    with open(SOURCE / "tests" / "data" / name, newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


class AgainstBodies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.bodies = {(row["case"], row["quantity"]): float(row["fine mesh"]) for row in stored("solid_bridge.csv")}
        cls.beam = solid_beams.beam_of(Cross, parts=4)
        # One span warps freely; warping stiffens its torsion by as much as the bending of the deck softens it.
        free = solid_beams.without_warping
        cls.one, cls.two = cls.traverse(folder, free(cls.beam), 1), cls.traverse(folder, cls.beam, 2)
        cls.plain = cls.traverse(folder, free(solid_beams.beam_of(Cross, WITHOUT_POISSON, parts=4)), 1)

    @staticmethod
    def traverse(folder, beam, spans):
        return solid_traverse.ByABeam(os.path.dirname(BINARY), folder.name, beam, spans)

    def compare(self, case, values, bound):
        """bound(quantity): of the difference in parts of the body's value."""
        self.assertGreater(len(values), 0)
        for (quantity, _), value in values.items():
            with self.subTest(case=case, quantity=quantity):
                body = self.bodies[case, quantity]
                self.assertLess(abs(value / body - 1), bound(quantity))

    def test_one_span(self):
        k = np.pi / Cross.span
        warping = self.beam.ECw * k**2 / (2 * self.beam.GJ)  # of the frequency, where all of it acts
        curvature = 0.2 / 2 * (self.beam.polar - 2 * self.beam.rotary) / self.beam.mass * k**2  # nu (y^2 - z^2)/2 v''

        def bound(quantity):
            if quantity.startswith("frequency"):
                n = int(quantity[-1])
                return 1.2 * curvature * n**2 + DECK * n**4 if "bending" in quantity else warping * n**2
            if "deflection" in quantity:
                return 3e-3
            return 2e-2 if quantity == "a force: twist at 20 m" else 6e-3  # the deck bends under the force

        self.compare("one span", self.one.values(), bound)

    def test_bending_without_poissons_ratio(self):
        values = {key: value for key, value in self.plain.values().items()
                  if "twist" not in key[0] and "torsion" not in key[0]}
        self.compare("one span without Poisson's ratio", values,
                     lambda quantity: DECK * int(quantity[-1])**4 if quantity.startswith("frequency") else 1e-3)

    def test_two_spans(self):
        """The inner fork holds the warping of both spans."""
        self.compare("two spans", self.two.frequencies(), lambda quantity: 1e-2)
        values = {key: value for key, value in self.two.values().items() if "a force: twist" not in key[0]}
        self.compare("two spans", values, lambda quantity: 2e-2 if "twist" in quantity else 5e-3)

    def passages(self, name):
        """(deflections, accelerations) by Traverse, with each train on its track."""
        trains = solid_bridge.PASSAGES[name]
        return self.one.passage(trains, solid_bridge.HSLM_A, np.arange(0, solid_bridge.until(trains), STEP))

    def phase(self, mode):
        """By which a resonance of the beam is behind that of the body, as their frequencies differ."""
        quantity = f"frequency of {mode} 1"
        return abs(self.one.frequencies()[quantity, "Hz"] / self.bodies["one span", quantity] - 1) / RATIO

    def test_trains(self):
        curves = stored("solid_bridge_trains.csv")
        behind = {"deflection": self.phase("bending"), "acceleration": self.phase("torsion")}
        self.assertLess(max(behind.values()), 0.2)  # the bounds below say something
        for name in solid_bridge.PASSAGES:
            moved, shaken = self.passages(name)
            rows = [row for row in curves if row["passage"] == name]
            at = [round(float(row["t"]) / STEP) for row in rows]
            self.assertEqual(len(at), solid_bridge.STORED)
            self.compare(name, solid_bridge.peaks(moved, shaken),
                         lambda quantity: 5e-2 if "acceleration" in quantity else 1.2e-2)
            for what, scale, histories in (("deflection", 1e3, moved), ("acceleration", 1.0, shaken)):
                for place, history in histories.items():
                    with self.subTest(passage=name, what=what, place=place):
                        body = np.array([float(row[f"{what} of {solid_bridge.PLACES[place]}"]) for row in rows])
                        largest = np.abs(scale * history).max()
                        self.assertLess(np.abs(scale * history[at] - body).max(), behind[what] * largest)

    def test_skew_bearings(self):
        slab = solid_traverse.skew(os.path.dirname(BINARY), self.folder, solid_beams.beam_of(Slab, parts=4))
        self.compare("skew slab", {key: value for key, value in slab.items() if "frequency" in key[0]},
                     lambda quantity: 1e-2)
        reactions = {quantity: value for (quantity, _), value in slab.items() if "reaction" in quantity}
        self.assertEqual(len(reactions), 4)
        for quantity, value in reactions.items():
            self.assertAlmostEqual(value, self.bodies["skew slab", quantity], delta=3.0)  # kN, of 1 MN

    def test_a_girder_that_warps(self):
        girder = solid_traverse.girder(os.path.dirname(BINARY), self.folder, solid_beams.beam_of(Girder))
        self.compare("girder", girder, lambda quantity: 1.2e-2)  # the web bends, and warping has inertia


class Sections(unittest.TestCase):
    def test_rectangle(self):
        """St. Venant's series for J; 5/6 of the area."""
        b, h = 5.0, 1.5
        found = solid_section.Section([-b / 2, -1.5, 0, 1.5, b / 2], [-h / 2, 0, h / 2], lambda y, z: True, 4)
        n = np.arange(1, 200, 2)
        series = b * h**3 / 3 * (1 - 192 * h / (np.pi**5 * b) * np.sum(np.tanh(n * np.pi * b / (2 * h)) / n**5))
        self.assertAlmostEqual(found.J / series, 1, delta=2e-4)
        self.assertAlmostEqual(found.shear_area / (5 / 6 * b * h), 1, delta=1e-4)
        self.assertAlmostEqual(found.polar / (b * h * (b * b + h * h) / 12), 1, delta=1e-9)

    def test_girder(self):
        """J and C_w of thin walls; the ends of the plates take 0.63 of their thickness, 5 % of the flanges, from J."""
        found = solid_beams.beam_of(Girder)
        E, nu, _ = Girder.material
        self.assertAlmostEqual(found.GJ / (E / (2 + 2 * nu) * (2 * 0.3 * 0.025**3 + 0.8 * 0.02**3) / 3), 1, delta=3e-2)
        self.assertAlmostEqual(found.ECw / (E * 0.025 * 0.3**3 * 0.8**2 / 24), 1, delta=1e-2)


if __name__ == "__main__":
    unittest.main()
