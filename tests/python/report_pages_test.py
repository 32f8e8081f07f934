"""scripts/traverse-report on small computations: its pages, curves and first page."""

import pathlib
import re
import sys
import unittest

import openpyxl

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from reported import BRIDGE, LIMITS, Reported  # noqa: E402
from traverse_report import curves, limits, page, sheets, source, summary_sheet  # noqa: E402


class Pages(Reported):
    def test_ten_trains_are_ten_lines_that_differ(self):
        one = source.Source(self.folder / "sweep.h5")
        report = page.Report("", "")
        drawn = sheets.curve_sheets(report, one, limits.read_limits(self.folder / "limits.yml"))
        self.assertEqual(set(drawn.values()), {10})
        self.assertEqual(set(drawn), {"peak_deflection", "peak_acceleration", "peak_moment", "amplification"})
        ax = report.pages[0].figure.axes[1]
        lines = [line for line in ax.get_lines() if len(line.get_xdata()) == 11]
        self.assertEqual(len(lines), 10)
        looks = {(line.get_color(), str(line.get_linestyle()), str(line._dash_pattern)) for line in lines}
        self.assertEqual(len(looks), 10)
        self.assertTrue({f"A{i}" for i in range(1, 11)} <= {text.get_text() for text in ax.texts})

    def test_all_looks_differ(self):
        self.assertEqual(len({str(curves.look(i)) for i in range(curves.MOST_LINES)}), curves.MOST_LINES)

    def test_limit_lines_stand_at_the_limit(self):
        one = source.Source(self.folder / "sweep.h5")
        rows = [limits.Limit("x", "unfiltered_deck_acceleration", 2.5, ""), limits.Limit("y", "amplification", 1.5, "")]
        report = page.Report("", "")
        sheets.curve_sheets(report, one, rows)
        places = [line.get_ydata()[0] for p in report.pages for ax in p.figure.axes for line in ax.get_lines()
                  if line.get_color() == curves.RED]
        self.assertEqual(sorted(places), [1.5, 2.5])

    def test_no_cell_is_a_formula(self):
        cells = [cell for sheet in self.book_of("judged", "--no-governing-run") for row in sheet.iter_rows() for cell in row]
        self.assertEqual([cell.value for cell in cells if cell.data_type in ("f", "e")], [])
        self.assertIn("=1+1", [cell.value for cell in cells])

    def test_pages_are_a4_and_all_there(self):
        run = self.report("sweep.h5", "crossing.h5", "-o", "both", "--limits", "limits.yml")
        self.assertEqual(run.returncode, 0, run.stderr)
        pdf = (self.folder / "both.pdf").read_bytes()
        boxes = re.findall(rb"/MediaBox \[ ?0 0 ([\d.]+) ([\d.]+) ?\]", pdf)
        said = int(re.search(r"\((\d+) pages\)", run.stdout)[1])
        self.assertEqual(len(boxes), said)
        for width, height in boxes:
            self.assertAlmostEqual(float(width), 595.4, 0)
            self.assertAlmostEqual(float(height), 841.7, 0)
        self.assertGreaterEqual(said, 12)
        self.assertIn("2 verdicts", openpyxl.load_workbook(self.folder / "both.xlsx").sheetnames)

    def test_results_without_limits_are_left_alone(self):
        for path in self.folder.glob("*.pdf"):
            path.unlink()
        run = self.report("--if-limits", "crossing.h5")
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""))
        self.assertEqual(list(self.folder.glob("*.pdf")), [])
        run = self.report("--if-limits", "study.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertTrue((self.folder / "study.pdf").is_file())

    def first_page(self, names, limits_text):
        """Of a report of several files: its words and their colours."""
        (self.folder / "own.yml").write_text(limits_text, encoding="utf-8")
        entries = []
        for number, name in enumerate(names):
            one = source.Source(self.folder / f"{name}.h5")
            entries.append((one, limits.judge(one, limits.read_limits(self.folder / "own.yml")), 3 * number + 1))
        report = page.Report("", "")
        report.page("the first file's")
        summary_sheet.sheet(report, entries)
        self.assertEqual(len(report.pages), 2)
        self.assertEqual(report.pages[1].heading, "the first file's")
        return {text.get_text(): text.get_color() for text in report.pages[0].paper.texts}

    def test_of_two_files_the_broken_one_decides(self):
        for names in (("sweep", "crossing"), ("crossing", "sweep")):
            texts = self.first_page(names, LIMITS[:LIMITS.index("- {clause: \"rule 2\"")])
            said = next(text for text in texts if text.startswith("Of 2 results files"))
            self.assertIn("1 of 2 judged limits is BROKEN", said)
            self.assertEqual(texts[said], page.RED)
            self.assertTrue(any(text.startswith("Least margin of all: -") and "sweep.h5" in text for text in texts), texts)
            self.assertTrue({"2", "5"} <= set(texts), texts)  # pages of the files

    def test_green_only_where_all_were_judged_and_kept(self):
        kept = "- {clause: a, quantity: amplification, value: 50.0}\n"
        texts = self.first_page(("crossing", "sweep"), kept)
        self.assertEqual(texts[next(text for text in texts if text.startswith("Of 2"))], page.GREEN)
        none = "- {clause: a, quantity: car_acceleration, value: 50.0}\n"
        texts = self.first_page(("crossing", "sweep"), none)
        self.assertEqual(texts[next(text for text in texts if text.startswith("Of 2"))], page.GREY)


class LongNames(Reported):
    @classmethod
    def prepare(cls):
        (cls.folder / "limits.yml").write_text(LIMITS, encoding="utf-8")
        cls.compute("three", BRIDGE + """
load: {forces: [2.0e5, 1.0e5], positions: [0.0, -3.0], speed: 40.0}
study: {vary: {load_speed: [30.0, 50.0], beam_mass: [1.6e4, 1.8e4, 2.0e4], beam_EI: [2.0e10, 3.0e10],
               model_damping_ratios: [0.01, 0.02]}}
""")

    def test_a_study_of_four_options_is_drawn(self):
        run = self.report("three.h5", "--no-governing-run", "--limits", "limits.yml")
        self.assertEqual((run.returncode, run.stderr), (0, ""))

    def test_names_of_curves_stay_on_the_page(self):
        one = source.Source(self.folder / "three.h5")
        long_unit = {"beam_EI": "N m2 " * 20}
        for units in ({}, long_unit):
            one.runs.units = one.runs.units | units
            report = page.Report("", "")
            sheets.curve_sheets(report, one, [])
            sheets.envelope_sheet(report, one)
            for sheet in report.pages:
                renderer = sheet.figure.canvas.get_renderer()
                for ax in sheet.figure.axes[1:]:
                    legend = ax.get_legend()
                    for text in [*ax.texts, ax._left_title, *(legend.get_texts() if legend else ())]:
                        right = text.get_window_extent(renderer).x1 / sheet.figure.dpi
                        self.assertLess(right, page.RIGHT + 0.05, text.get_text())

    def test_of_several_options_the_name_of_a_curve_has_the_values(self):
        runs = source.Source(self.folder / "three.h5").runs
        self.assertEqual(runs.line_names, ["beam_mass", "beam_EI", "model_damping_ratios"])
        self.assertEqual(curves.names_of(runs)[0], "16000, 2e10, 0.01")
        self.assertEqual(runs.lines_in_words(), "beam_mass (kg/m), beam_EI (N m²), model_damping_ratios")
        self.assertEqual(runs.lines()[0][0], "beam_mass 16000 kg/m, beam_EI 2e10 N m², model_damping_ratios 0.01")


if __name__ == "__main__":
    unittest.main()
