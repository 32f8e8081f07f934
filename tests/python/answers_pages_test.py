"""Searches and sensitivity analyses in scripts/traverse-report and scripts/page.py: the numbers are those of the file."""

import base64
import pathlib
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser  # noqa: E402
from reported import CROSSING, Reported  # noqa: E402
import page  # noqa: E402
from traverse_page import data  # noqa: E402
from traverse_report import comparison_sheet, fatigue_sheet, main, title_sheet  # noqa: E402

BOUND = 4.0e-3  # m
SEARCH = CROSSING + f"""
find: {{option: load_speed, between: [30.0, 70.0], quantity: peak_deflection, equals: {BOUND}, points: 9}}
study: {{vary: {{beam_mass: [1.8e4, 2.2e4]}}}}
"""
UNCERTAIN = CROSSING + """
study: {draws: 8, vary: {load_speed: [30.0, 40.0], beam_EI: {normal: [3.0e10, 1.0e9]}, beam_mass: {uniform: [1.7e4, 1.9e4]}}}
"""
METHODS = ("sobol", "morris", "local")


class Answers(Reported):
    @classmethod
    def prepare(cls):
        cls.compute("search", SEARCH)
        for method in METHODS:
            cls.compute(method, UNCERTAIN, "-study_sensitivity", method)

    def reported(self, name, *words):
        """The entry of a file, and the pages of its report by their headings."""
        entries, _ = self.entries_of([name], *words)
        lines, colour = comparison_sheet.headline([(one, verdicts) for one, _, verdicts, _ in entries])
        report = main.report_of([[entry] for entry in entries], title_sheet.Title(structure="S", date="2026"), lines, colour,
                                fatigue_sheet.Asked())
        found = {}
        for sheet in report.pages:
            found.setdefault(sheet.heading, []).append(sheet)
        return entries[0], found, lines

    def results(self, name):
        file = h5py.File(self.folder / f"{name}.h5", "r", locking=False)
        self.addCleanup(file.close)
        return file

    def words_of(self, sheets):
        return " ".join(text.get_text() for sheet in sheets for text in sheet.paper.texts)

    def test_the_search_in_a_report(self):
        file, (entry, sheets, lines) = self.results("search"), self.reported("search")
        of_all = file["find/interval_answer"][:] == len(file["answer"]) - 1
        first = file["find/interval"][:][of_all][0]
        self.assertIn("Search, no verification of one structure. Speed with greatest deflection up to 4 mm", lines[0])
        self.assertIn(f"{3.6 * first[1]:.5g} km/h", lines[0])
        words = self.words_of(sheets["Search for values"])
        self.assertIn("mass per length 22 t/m", words)
        self.assertIn(f"above {3.6 * first[1]:.5g} km/h: greatest deflection", words)
        curves = [line.get_ydata() for line in sheets["Search for values"][0].figure.axes[1].get_lines()]
        for i in range(2):
            np.testing.assert_array_equal(curves[i], file["find/ratio"][i])

    def test_the_run_closest_to_the_bound_is_repeated(self):
        file, (entry, _, _) = self.results("search"), self.reported("search")
        governing = entry[3]
        self.assertEqual(governing.trouble, "")
        ratio = file["find/ratio"][-1]
        at_bound = ratio[ratio <= 1.0].max()
        own = np.isin(np.round(governing.source.file["probes/x"][:], 6), np.round(file["study/probes_x"][0], 6))
        peak = np.abs(governing.source.file["probes/deflection"][:, own]).max()
        self.assertAlmostEqual(peak / BOUND / at_bound, 1.0, delta=0.02)

    def test_the_search_in_german(self):
        _, sheets, lines = self.reported("search", "--language", "de", "--no-governing-run")
        self.assertIn("Suche nach Werten", sheets)
        self.assertIn("Suche, kein Nachweis eines Bauwerks.", lines[0])

    def test_sensitivity_analyses_in_a_report(self):
        rows = {"sobol": "total", "morris": "effect_magnitude", "local": "effect_of_deviation"}
        for method, name in rows.items():
            with self.subTest(method):
                file, (entry, sheets, _) = self.results(method), self.reported(method, "--no-governing-run")
                self.assertEqual(entry[0].runs.over, ["beam_EI", "beam_mass"])
                self.assertEqual(len(entry[0].runs.lines()), 1)
                drawn = sheets["Sensitivity analysis"][0].figure.axes[1]
                factor = 1.0 if method == "sobol" else 1e3  # mm
                expected = factor * file[f"sensitivity/{name}"][0]
                bars = [bar.get_width() for bar in drawn.patches[:2]]
                np.testing.assert_allclose(bars, expected[np.argsort(-np.abs(expected))])
                words = self.words_of(sheets["Sensitivity analysis"])
                self.assertIn("bending stiffness EI", words)
                self.assertIn("greatest bending moment", words)

    def test_the_workbooks_have_the_numbers(self):
        file, book = self.results("search"), self.book_of("search", "--no-governing-run")
        found = self.columns(book["Search for values"])
        np.testing.assert_allclose(found["Greatest (km/h)"], 3.6 * file["find/interval"][:, 1])
        ratios = self.columns(book["Ratio to the bound"])
        np.testing.assert_allclose(ratios["Speed (km/h)"], 3.6 * file["find/value"][:])
        np.testing.assert_allclose(ratios["All runs"], file["find/ratio"][-1])
        chart, = book["Ratio to the bound"]._charts
        self.assertEqual(len(chart.series), len(file["answer"]) + 1)  # and the bound
        file = self.results("morris")
        found = self.columns(self.book_of("morris", "--no-governing-run")["Sensitivity analysis"])
        expected = 1e3 * file["sensitivity/effect_magnitude_high"][0]  # mm
        order = np.argsort(-file["sensitivity/effect_magnitude"][0])
        np.testing.assert_allclose(found["Size of the effect, greatest"][:2], expected[order])
        self.assertEqual(found["Unit"][:2], ["mm", "mm"])
        bars = self.book_of("morris", "--no-governing-run")["Sensitivity analysis"]._charts
        factors = len(file["factor"])
        self.assertEqual([one.series[0].val.numRef.f.split("!")[1] for one in bars],
                         [f"$D${2 + i * factors}:$D${1 + (i + 1) * factors}" for i in range(len(file["quantity"]))])

    def test_the_pages_have_the_curve_and_the_tables(self):
        found, file = data.collect(self.folder / "search.h5"), self.results("search")
        chart, = (one for one in found["along"] if one["title"] == "Ratio to the bound")
        for i, curve in enumerate(chart["curves"]):
            values = np.frombuffer(base64.b64decode(curve["columns"][0]["f32"]), dtype="<f4")
            np.testing.assert_allclose(values, file["find/ratio"][i], rtol=1e-6)
        self.assertEqual(chart["limits"], [["bound", 1.0]])
        table, = (one for one in found["tables"] if one["title"] == "Search for values")
        self.assertEqual([row[0] for row in table["rows"]], ["mass per length 18 t/m", "mass per length 22 t/m", "all runs"])
        for method in METHODS:
            table, = (one for one in data.collect(self.folder / f"{method}.h5")["tables"]
                      if one["title"] == "Sensitivity analysis")
            self.assertEqual(len(table["rows"]), 2 * len(self.results(method)["quantity"]))

    def test_the_factor_of_a_limit_is_said(self):
        (self.folder / "factor.yml").write_text("- {clause: our rules, quantity: deflection_over_span, value: 1/5000, "
                                                "factor: 1.25, text: ours}\n", encoding="utf-8")
        self.compute("kept", SEARCH.replace(f"quantity: peak_deflection, equals: {BOUND}", "keep: deflection_over_span"),
                     "-limits", "factor.yml")
        table, = (one for one in data.collect(self.folder / "kept.h5")["tables"] if one["title"] == "Search for values")
        self.assertEqual(table["note"], "Speed that keeps the limit: deflection over span length × 1.25")

    def test_of_many_curves_the_page_draws_those_that_matter(self):
        self.compute("many", CROSSING + f"""
find: {{option: beam_EI, between: [2.0e10, 6.0e10], quantity: peak_deflection, equals: {BOUND}, points: 12}}
study: {{vary: {{load_speed: [30.0, 40.0, 50.0], beam_mass: [1.8e4, 2.2e4]}}}}
""")
        file, runs = self.results("many"), data.collect(self.folder / "many.h5")["runs"]
        combinations = {*zip(file["study/beam_EI"][:], file["study/beam_mass"][:])}
        self.assertTrue(runs["lineNote"].startswith(f"Drawn: 4 of {len(combinations)} curves, "), runs["lineNote"])
        self.assertEqual(len(runs["lines"]), 4)  # of both masses at the answer, of one beyond it, and the greatest one
        ratio, run = file["find/ratio"][-1], file["find/run"][-1].astype(int)
        at_bound = run[np.where(ratio <= 1.0, ratio, 0.0).argmax()]
        wanted = [file[f"study/{name}"][at_bound] for name in ("beam_EI", "beam_mass", "load_speed")]
        chosen = [one["values"][runs["first"]] for one in runs["parameters"]]
        np.testing.assert_allclose(sorted(chosen), sorted([1e-6 * wanted[0], 1e-3 * wanted[1], 3.6 * wanted[2]]), rtol=1e-8)
        greatest = np.unravel_index(np.abs(file["study/peak_deflection"][:]).argmax(), file["study/peak_deflection"].shape)[0]
        drawn = np.frombuffer(base64.b64decode(runs["quantities"][0]["values"]["f32"]), dtype="<f4")
        self.assertAlmostEqual(drawn.max() / (1e3 * np.abs(file["study/peak_deflection"][greatest]).max()), 1.0, places=6)

    def test_the_pages_open_in_a_browser(self):
        browser = Browser()
        self.addCleanup(browser.close)
        for name, title in (("search", "Search for values"), ("sobol", "Sensitivity analysis")):
            page.write(self.folder / f"{name}.h5", self.folder / f"{name}.html")
            browser.open(self.folder / f"{name}.html")
            self.assertIn(title, browser.evaluate("document.getElementById('verdicts').textContent"))
            self.assertEqual(browser.complaints(), [])


if __name__ == "__main__":
    unittest.main()
