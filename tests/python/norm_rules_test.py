"""The rules of scripts/traverse-check: the flow chart of EN 1991-2 figure 6.9, track defects, and its conclusions."""

import pathlib
import re
import sys
import unittest

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import SOURCE  # noqa: E402

sys.path.insert(0, str(SOURCE / "scripts"))
from traverse_check import flow_chart, outcome, question, rules, track_defects  # noqa: E402
from traverse_report import language, limits  # noqa: E402

BRIDGE = ("--span", "28", "--EI", "260 GN.m2", "--mass", "19 t/m", "--type", "prestressed", "--line-speed", "250 km/h")


class LoadModels(unittest.TestCase):
    def test_the_report_has_a_sketch_of_each(self):
        text = (SOURCE / "include/traverse/options/norm_rules.hpp").read_text(encoding="utf-8")
        rows = re.findall(r'{"(\w+)", "([^"]+)", (?:true|false), (?:true|false)}', text)
        self.assertEqual(len(rows), text.split("load_models[] = {")[1].split("};")[0].count('{"'))
        sketches = yaml.safe_load((SOURCE / "scripts/traverse_report/load_models.yml").read_text(encoding="utf-8"))
        self.assertEqual([title for _, title in rows], list(sketches))


class TrackDefects(unittest.TestCase):
    """phi'' of EN 1991-2 annex C, by hand for L = 10 m and n0 = 9 Hz: (56/e + 50 (90/80 - 1)/e^0.25)/100 = 0.25469."""

    def test_a_bridge_of_10_m(self):
        part = flow_chart.Part(10.0, 9.0, True)
        for speed, careful, expected in ((22.0, False, 1.25469), (80.0, True, 1.127345), (11.0, False, 1.127345)):
            self.assertAlmostEqual(track_defects.factor([part], speed, careful), expected, 4)

    def test_long_bridges_have_none(self):
        parts = [flow_chart.Part(60.0, 1.2, True), flow_chart.Part(100.0, 0.7, True)]
        self.assertAlmostEqual(track_defects.factor(parts, 80.0, False), 1.0, 4)


class Verdicts(unittest.TestCase):
    """The conclusions of the check from verdicts that are given here."""

    def verdict(self, quantity, value, limit=1.0):
        row = limits.Limit("clause", quantity, limit, "")
        return limits.Verdict(row, limits.word_of(value, row), value, "", "")

    def test_trains_above_the_load_models_exceed_a_limit(self):
        found = [self.verdict("deck_acceleration", 2.0, 3.5), self.verdict("train_over_lm71", 1.2)]
        self.assertEqual(outcome.status(found), outcome.EXCEEDED)
        self.assertIn("must include the dynamic effects of the trains", outcome.consequence(found))
        self.assertEqual(outcome.consequence([self.verdict("train_over_lm71", 0.9)]), "")


class FlowChart(unittest.TestCase):
    """EN 1991-2 figure 6.9; n0 and L of the parts are given here."""

    def answer(self, length, n0, *words, separate=True):
        found = flow_chart.answer(flow_chart.Part(length, n0, separate), question.ask([*BRIDGE, *words]))
        return found.needed, " ".join(f"{clause} {said}" for clause, said in found.steps)

    def test_a_slow_line_within_the_limits(self):
        self.assertFalse(self.answer(28.0, 5.0, "--line-speed", "200 km/h")[0])

    def test_a_slow_line_outside_of_the_limits(self):
        for n0 in (3.2, 7.9):
            needed, said = self.answer(28.0, n0, "--line-speed", "160 km/h")
            self.assertTrue(needed)
            self.assertIn("outside 3.28 to 7.84 Hz", said)

    def test_a_slow_line_on_a_continuous_bridge(self):
        needed, said = self.answer(35.0, 9.0, "--line-speed", "160 km/h", separate=False)
        self.assertFalse(needed)
        self.assertIn("very good passenger comfort", said)

    def test_a_fast_line(self):
        for length, n0, words, said in ((28.0, 5.0, (), "cannot be decided without a torsional frequency"),
                                        (28.0, 5.0, ("--torsional-frequency", "6.1 Hz"), "tables F.1 and F.2"),
                                        (28.0, 5.0, ("--torsional-frequency", "5.9 Hz"), "not above 1.2 n0 = 6 Hz"),
                                        # 1000 m/s: 17.857 Hz between forks 28 m apart
                                        (28.0, 5.0, ("--GJ", "160 GN.m2", "--polar-inertia", "160 t.m"),
                                         "nT = 17.86 Hz is above 1.2 n0 = 6 Hz"),
                                        (28.0, 5.0, ("--GJ", "16 GN.m2", "--polar-inertia", "160 t.m"),
                                         "nT = 5.647 Hz is not above 1.2 n0 = 6 Hz"),
                                        (45.0, 3.0, (), "L >= 40 m"),
                                        (28.0, 5.0, ("--complex",), "no simple structure")):
            needed, steps = self.answer(length, n0, *words)
            self.assertTrue(needed)
            self.assertIn(said, steps)
        self.assertTrue(self.answer(35.0, 4.0, separate=False)[0])

    def test_slow_but_complex(self):
        self.assertTrue(self.answer(28.0, 5.0, "--line-speed", "160 km/h", "--complex")[0])

    def test_lengths_without_limits(self):
        for length in (3.9, 101.0):
            self.assertIsNone(flow_chart.limits_of_n0(length))
            self.assertTrue(self.answer(length, 5.0, "--line-speed", "160 km/h")[0])

    def test_the_steps_are_in_the_language(self):
        language.choose("de")
        try:
            said = self.answer(28.0, 5.0, "--line-speed", "200 km/h")[1]
        finally:
            language.choose("en")
        self.assertIn("n0 = 5 Hz liegt innerhalb von 3,28 bis 7,84 Hz", said)

    def test_every_rule_has_a_clause_and_known_sources(self):
        known = rules.data()["sources"]
        for name, row in [*rules.data()["rules"].items(), *rules.data()["direct_fastening"].items()]:
            self.assertLessEqual(set(row["sources"]), set(known), name)
        self.assertEqual(rules.clause("frequencies"), "EN 1991-2 figure 6.10")  # confirmed by two sources
        self.assertTrue(rules.clause("torsion").endswith("⁰"))


if __name__ == "__main__":
    unittest.main()
