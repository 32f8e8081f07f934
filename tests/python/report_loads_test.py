"""Which loads the report of scripts/traverse-report names, draws and counts as computed: trains of HSLM-A, real trains, a
crane."""

import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from reported import FACTOR, SIMPLE, SOURCE, TRAINS, Reported  # noqa: E402
from traverse_report import (  # noqa: E402
    checks_sheet, comparison_sheet, curve_sheet, decisions, fatigue_sheet, front_sheet, loads_sheet, main, page, title_sheet)

SEARCH = """
sweep: {speed: [60.0, 80.0, 5.0], hslm_a: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]}
limits: factor.yml
find: {option: beam_EI, between: [2.0e10, 9.0e10], keep: deck_acceleration, points: 4}
"""
SEEDS = f"""
vehicle: {{coach: {{file: {SOURCE}/options/vehicles/s300.yml}}}}
train: {{vehicles: coach, speed: 50.0}}
track: {{profile: german_low}}
study: {{vary: {{track_seed: 1:2}}, statistics: {{over: track_seed}}}}
output: {{probes: [5.0, 10.0, 15.0]}}
accuracy: 1.0e-2
"""
CRANE = f"""
beam: {{spans: 20.0, EI: 1.6e9, mass: 700.0, damping_ratios: [0.01, 0.01]}}
vehicle: {{trolley: {{file: {SOURCE}/options/vehicles/crane_trolley.yml}}}}
train: {{vehicles: trolley, positions: 5.0, speed_file: brakes.csv}}
ts: {{max_time: 3.0}}
accuracy: 1.0e-2
output: {{interval: 0.02, probes: [10.0]}}
"""


class Trains(Reported):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        (cls.folder / "factor.yml").write_text(FACTOR, encoding="utf-8")
        cls.compute("simple", SIMPLE + TRAINS)
        cls.compute("search", SIMPLE + SEARCH)
        cls.compute("seeds", SIMPLE + SEEDS)
        cls.compute("alone", SIMPLE + "load: {hslm_a: 7, speed: 60.0}\n")

    def said(self, one):
        results = {requirement.split(" (")[0]: found[0][0] for requirement, _, found in checks_sheet.rows_of(one, [])}
        return [results[f"dynamic analysis with {trains}"] for trains in ("all trains of HSLM-A", "real trains: resonance")]

    def test_a_search_has_all_trains_of_its_runs(self):
        one = self.source("search")
        self.assertEqual(list(one.hslm_trains), [f"A{number}" for number in range(1, 11)])
        self.assertEqual(one.train_in_words(), "trains A1 to A10 of HSLM-A")
        self.assertEqual([row[0] for row in loads_sheet.hslm_rows(one)], list(one.hslm_trains))
        self.assertEqual(self.said(one), ["computed, without a limit", "not verified"])
        self.assertTrue(decisions.defects(one).words.endswith(": 1.25"))
        report = page.Report()
        report.page("before")
        loads_sheet.sheet(report, one)
        self.assertEqual(report.pages[-1].heading, "Traffic loads")
        drawn = {text.get_text().strip() for ax in report.pages[-1].figure.axes for text in ax.texts}
        self.assertTrue(set(one.hslm_trains) <= drawn, drawn)

    def test_real_trains_need_several_speeds(self):
        self.assertEqual(self.said(self.source("study"))[1], "computed, without a limit")
        self.assertEqual(self.said(self.source("seeds"))[1], "not verified")

    def test_envelopes_say_what_varies(self):
        for name, what in (("simple", "all speeds"), ("seeds", "all runs")):
            report = page.Report()
            curve_sheet.envelope_sheet(report, self.source(name), [])
            titles = [ax.get_title(loc="left") + ax.get_title() for ax in report.pages[0].figure.axes[1:]]
            self.assertGreater(len(titles), 0)
            self.assertTrue(all(title.endswith(f"({what})") for title in titles), titles)

    def test_one_train_of_hslm_is_no_real_train(self):
        one = self.source("alone")
        self.assertEqual(list(one.hslm_trains), ["A7"])
        self.assertEqual(one.train_in_words(), "train A7 of HSLM-A")
        self.assertEqual(self.said(one), ["not verified", "not verified"])


class Crane(Reported):
    """A trolley with a load on ropes is no train: no norm of railway bridges applies."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        (cls.folder / "brakes.csv").write_text("0.0,1.0\n1.0,1.0\n2.0,0.0\n", encoding="utf-8")
        cls.compute("crane", CRANE)

    def test_the_report_has_no_scope_of_verification(self):
        entries, _ = self.entries_of(["crane"])
        (one, _, verdicts, _), = entries
        lines, colour = comparison_sheet.headline([(one, verdicts)])
        self.assertEqual((lines, colour), (["No limits were given: the results are not verified."], page.GREY))
        report = main.report_of([entries], title_sheet.Title(structure="S", date="2026"), lines, colour, fatigue_sheet.Asked())
        headings = {heading for sheet in report.pages for heading in sheet.headings}
        self.assertIn("Computation under moving loads", headings)
        self.assertIn("Summary of results", headings)
        self.assertFalse({"Scope of verification", "Ride comfort"} & headings)
        self.assertEqual(checks_sheet.rows_of(one, verdicts), [])

    def test_the_summary_has_the_sway_and_the_force_of_the_ropes(self):
        one = self.source("crane")
        rows = {words: (value, unit) for words, value, unit, _ in front_sheet.peak_rows(one)}
        vehicle = one.file["vehicles/0"]
        sway, unit = rows["greatest sway of a load on its ropes"]
        positions = {name: vehicle[f"{name}/position"][:] for name in ("load", "trolley")}
        top = positions["trolley"][:, 0]  # the rope begins above its centre, which does not turn
        hook = positions["load"][:, 0] - np.sin(positions["load"][:, 2])  # 1 m above the centre of the load
        self.assertEqual(unit, "mm")
        self.assertGreater(sway, 10.0)
        self.assertAlmostEqual(sway, 1e3 * np.abs(hook - top).max(), delta=1.0)
        self.assertEqual(rows["greatest force of all ropes of a load"], (1e-3 * vehicle["rope/force"][:].max(), "kN"))


if __name__ == "__main__":
    unittest.main()
