"""Fits and screens in scripts/traverse-report and scripts/page.py: the numbers are those of the file."""

import base64
import pathlib
import re
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser  # noqa: E402
from reported import SCRIPTS, Reported  # noqa: E402
import page  # noqa: E402
from traverse_page import data  # noqa: E402
from traverse_report import comparison_sheet, fatigue_sheet, main, screen_sheet, title_sheet  # noqa: E402
from traverse_report import page as pages  # noqa: E402

OPTIONS = SCRIPTS.parent / "options"
FIT = f"""
beam: {{spans: 30.0, EI: 1.0e10, mass: 9.0e3}}
load: {{forces: 1.7e5*6, positions: [0.0, -18.0, -36.0, -54.0, -72.0, -90.0], speed: 29.0}}
model: {{modes: 5, damping_ratios: 0.02}}
fit:
  vary: {{beam_EI: [5.0e9, 1.05e10], beam_mass: [4.5e3, 1.8e4], load_speed: [20.0, 35.0]}}
  to:
    lowest: {{frequency: 1, value: 1.95, sd: 0.01}}
    midspan: {{series: {OPTIONS}/studies/fit_to_a_passage.csv, quantity: deflection, x: 13.0, factor: -1.0e-3,
               align: true, offset: true}}
"""
STOCK = "name, spans, mass, EI, damping\n" + "".join(
    f"bridge {i}, {15 + i}, {12000 + 100 * i}, 9.0e9, 0.01\n" for i in range(7)) + "stiff, 15, 12000, 9.0e11, 0.01\n"
FLEET = "name; speed; position; load_kN\n" + "".join(
    f"train {k}; 250 km/h; {x}; {150 + 5 * k}\n" for k in range(6) for x in (0.0, 2.5, 18.5 + k, 21.0 + k))
SCREEN = f"""
scene: {{analysis: screen}}
screen: {{stock: stock.csv, fleet: fleet.csv, speeds: [100 km/h, 250 km/h, 10 km/h]}}
limits: {OPTIONS}/limits/en1990.yml
"""


class Pages(Reported):
    @classmethod
    def prepare(cls):
        (cls.folder / "stock.csv").write_text(STOCK, encoding="utf-8")
        (cls.folder / "fleet.csv").write_text(FLEET, encoding="utf-8")
        cls.compute("fit", FIT, status=3)  # beam_EI ends at its bound
        cls.compute("example", f"options_file: {OPTIONS}/studies/fit_to_a_passage.yml\n")
        cls.compute("screen", SCREEN)

    def results(self, name):
        file = h5py.File(self.folder / f"{name}.h5", "r", locking=False)
        self.addCleanup(file.close)
        return file

    def reported(self, name, *words):
        """The pages behind the title page of the report of a file by their headings, and the lines of its title page."""
        entries, _ = self.entries_of([name], *words)
        lines, colour = comparison_sheet.headline([(one, verdicts) for one, _, verdicts, _ in entries])
        report = main.report_of([[entry] for entry in entries], title_sheet.Title(structure="S", date="2026"), lines, colour,
                                fatigue_sheet.Asked())
        found = {}
        for sheet in report.pages[1:]:
            for heading in sheet.headings:
                found.setdefault(heading, []).append(sheet)
        return found, lines

    def words_of(self, sheets):
        return " ".join(text.get_text() for sheet in sheets for text in sheet.paper.texts)

    def curves_of(self, sheets):
        return [line.get_ydata() for sheet in sheets for ax in sheet.figure.axes[1:] for line in ax.get_lines()]

    def test_a_fit_has_its_estimates(self):
        file, (sheets, lines) = self.results("fit"), self.reported("fit")
        self.assertTrue(lines[0].startswith("Fit, no verification. Estimates: bending stiffness EI 10\u202f500 MN m² (at a "
                                            "bound); mass per length "), lines[0])
        self.assertNotIn("Scope of verification", sheets)
        words = self.words_of(sheets["Fit to measurements"])
        mass, speed = file["fit/estimate"][1] / 1e3, 3.6 * file["fit/estimate"][2]
        for number in re.findall(r"Mass per length t/m ([\d.]+) ([\d.]+)", words) or self.fail(words):
            self.assertAlmostEqual(float(number[0]) / mass, 1.0, delta=1e-4)
            self.assertAlmostEqual(float(number[1]) / (file["fit/standard_error"][1] / 1e3), 1.0, delta=0.06)
        self.assertIn(f"Speed km/h {speed:.5g}"[:-1], words)
        for text in ("Shift of the clock of midspan s", "Offset of midspan mm", "at a bound", "deflection, x = 13 m",
                     "beam_EI is at its upper bound", "lowest"):
            self.assertIn(text, words)

    def test_strong_correlations_are_said(self):
        file, (sheets, _) = self.results("example"), self.reported("example")
        value = file["fit/correlation"][0, 1]
        self.assertGreater(value, 0.9)
        self.assertIn(f"above 0.9: bending stiffness EI and mass per length: {value:.3f}.",
                      self.words_of(sheets["Fit to measurements"]))

    def test_the_curves_of_a_fit_are_those_of_the_file(self):
        file, (sheets, _) = self.results("example"), self.reported("example")
        curves = self.curves_of(sheets["Fit to measurements"])
        for i, name in enumerate(("measured", "computed")):
            np.testing.assert_allclose(curves[i], 1e3 * file[f"fit/series/midspan/{name}"][:])
        chart, = data.collect(self.folder / "example.h5")["along"]
        for curve, name in zip(chart["curves"], ("measured", "computed")):
            values = np.frombuffer(base64.b64decode(curve["columns"][0]["f32"]), dtype="<f4")
            np.testing.assert_allclose(values, 1e3 * file[f"fit/series/midspan/{name}"][:], rtol=1e-6)

    def test_a_screen_has_the_governing_pair(self):
        file, (sheets, lines) = self.results("screen"), self.reported("screen")
        ratio = file["screen/ratio"][:]
        bridge, formation = np.unravel_index(np.argmax(ratio), ratio.shape)
        pair = file["bridge"].asstr()[bridge], file["formation"].asstr()[formation]
        exceeding = int((file["screen/exceeding_speeds"][:] > 0.0).sum())
        self.assertIn(f"{exceeding} of {ratio.size} pairs", lines[0])
        self.assertIn(", ".join(pair), self.words_of(sheets["Summary of results"]))
        first, *others = sheets["Screen of bridges and formations"]
        words = self.words_of([first, *others])
        self.assertIn(f"by the bound: {file['summary'].attrs['pairs_by_bound']}; by passages: "
                      f"{file['summary'].attrs['pairs_by_passages']}", words)
        self.assertRegex(words, rf"{pair[0]} {pair[1]} {ratio.max():.3f}")
        self.assertRegex(words, r"stiff 15 [\d.]+ train \d 0\.\d+ no restriction")
        self.assertIn(f"The {screen_sheet.MOST_PAIRS} of {ratio.size} with the largest ratio.", words)
        self.assertEqual(sum(text.get_text() == "passages" or text.get_text() == "bound" for sheet in (first, *others)
                             for text in sheet.paper.texts), screen_sheet.MOST_PAIRS)
        mesh, = first.figure.axes[1].collections
        np.testing.assert_allclose(np.sort(mesh.get_array().ravel()), np.sort(ratio.ravel()))

    def test_permitted_speeds_are_those_of_the_restricted_pairs(self):
        file = self.results("screen")
        permitted, exceeding = (file[f"screen/{name}"][:] for name in ("permitted_speed", "exceeding_speeds"))
        self.assertTrue((exceeding > 0.0).any())
        found = self.columns(self.book_of("screen")["Bridges"])
        column = found["Greatest speed permitted to all formations (km/h)"]
        for name, speed in zip(found["Bridge"], column):
            i = list(file["bridge"].asstr()[:]).index(name)
            exceeded = exceeding[i] > 0.0
            if exceeded.any():
                self.assertAlmostEqual(speed, 3.6 * permitted[i][exceeded].min())
            else:
                self.assertIsNone(speed)
        pairs = self.columns(self.book_of("screen")["Pairs"])
        np.testing.assert_allclose(pairs["Ratio"], -np.sort(-file["screen/ratio"][:].ravel()))

    def test_the_workbook_of_a_fit_has_the_numbers(self):
        file, book = self.results("fit"), self.book_of("fit")
        found = self.columns(book["Fit to measurements"])
        np.testing.assert_allclose(found["Estimate"], file["fit/estimate"][:] * [1e-6, 1e-3, 3.6, 1.0, 1e3])
        self.assertEqual(found["Remark"][:2], ["at a bound", None])
        series = self.columns(book["Series 1"])
        for name in ("measured", "computed"):
            np.testing.assert_allclose(series[f"{name.capitalize()} (mm)"], 1e3 * file[f"fit/series/midspan/{name}"][:])
        self.assertEqual(self.charted(book["Series 1"]), [["Time of the measurement (s)", "Measured (mm)", "Computed (mm)",
                                                           "Residual (mm)"]])
        np.testing.assert_allclose(np.array(self.columns(book["Correlations"])["Mass per length"], dtype=float),
                                   file["fit/correlation"][1])
        np.testing.assert_allclose(self.columns(book["Starts of the fit"])["Speed (km/h)"],
                                   3.6 * file["fit/starts/estimate"][:, 2])
        self.assertAlmostEqual(self.columns(book["Measured frequencies"])["Computed (Hz)"][0],
                               file["fit/frequencies/computed"][0])

    def charted(self, sheet):
        """The heads of the columns of each chart, that of the first axis first."""
        def head(reference):
            return sheet[re.search(r"!\$([A-Z]+)\$", reference)[1] + "1"].value

        return [[head(chart.series[0].xVal.numRef.f), *(head(one.yVal.numRef.f) for one in chart.series)]
                for chart in sheet._charts]

    def test_the_workbook_of_a_screen_has_formations_and_bars(self):
        file, book = self.results("screen"), self.book_of("screen")
        rows = self.columns(book["Formations"])
        ratio = dict(zip(file["formation"].asstr()[:], file["screen/formation_ratio"][:]))
        np.testing.assert_allclose(rows["Ratio"], [ratio[name] for name in rows["Formation"]])
        self.assertEqual(rows["Ratio"], sorted(rows["Ratio"], reverse=True))
        for name, count in (("Bridges", len(file["bridge"])), ("Formations", len(file["formation"]))):
            sheet, (bars,) = book[name], book[name]._charts
            column = re.fullmatch(rf"'{name}'!\$([A-Z])\$2:\$\1\${count + 1}", bars.series[0].val.numRef.f)
            self.assertEqual(sheet[f"{column[1]}1"].value, "Ratio")

    def test_texts_stay_on_the_page_in_every_language(self):
        for name in ("fit", "screen"):
            for language, said in (("de", "kein Nachweis"), ("fr", "pas de vérification")):
                sheets, lines = self.reported(name, "--language", language)
                self.assertIn(said, lines[0])
                for sheet in (one for several in sheets.values() for one in several):
                    renderer = sheet.figure.canvas.get_renderer()
                    for text in sheet.paper.texts:
                        box = text.get_window_extent(renderer)
                        self.assertLess(box.x1 / sheet.figure.dpi, pages.RIGHT + 0.05, text.get_text())
                        self.assertGreater(box.y0 / sheet.figure.dpi, 0.3, text.get_text())

    def test_both_in_one_report_with_the_command(self):
        status, _, error = self.command("fit.h5", "screen.h5", "-o", "both")
        self.assertEqual((status, error), (0, ""))
        self.assertTrue((self.folder / "both.pdf").is_file() and (self.folder / "both.xlsx").is_file())

    def test_the_page_of_a_screen_has_the_map_and_the_bridges(self):
        file, found = self.results("screen"), data.collect(self.folder / "screen.h5")
        ratio, heat = file["screen/ratio"][:], found["heat"]
        values = np.frombuffer(base64.b64decode(heat["values"]["f32"]), dtype="<f4").reshape(ratio.shape)
        rows, columns = (list(file[name].asstr()[:]) for name in ("bridge", "formation"))
        order = np.ix_([rows.index(name) for name in heat["rows"]], [columns.index(name) for name in heat["columns"]])
        np.testing.assert_allclose(values, ratio[order], rtol=1e-6)
        table, = (one for one in found["tables"] if one["title"] == "Bridges")
        self.assertEqual(sorted(row[0] for row in table["rows"]), sorted(rows))
        self.assertEqual(table["rows"][0][4], f"{np.nanmax(file['screen/bridge_ratio'][:]):.3f}")

    def test_the_pages_open_in_a_browser(self):
        browser = Browser()
        self.addCleanup(browser.close)
        for name, title in (("fit", "Fit to measurements"), ("screen", "Bridges")):
            page.write(self.folder / f"{name}.h5", self.folder / f"{name}.html")
            browser.open(self.folder / f"{name}.html")
            self.assertIn(title, browser.evaluate("document.getElementById('verdicts').textContent"))
            self.assertEqual(browser.complaints(), [])
        heat = data.collect(self.folder / "screen.h5")["heat"]
        said = browser.evaluate("(page.heat.point(page.heat.left + 2, page.heat.top + 2), page.heat.said.textContent)")
        self.assertTrue(said.startswith(f"{heat['rows'][0]}, {heat['columns'][0]}: response / limit "), said)
        colours = browser.evaluate("(([x, y]) => [...page.heat.canvas.getContext('2d').getImageData(x, y, 1, 1).data])"
                                   "([page.heat.left + 2, page.heat.top + 2])")
        worst = max(self.results("screen")["screen/ratio"][:].ravel())
        self.assertGreater(worst, 1.0)
        self.assertGreater(colours[0], colours[2])  # red


if __name__ == "__main__":
    unittest.main()
