"""scripts/traverse-report on small computations: its pages, curves and first page."""

import pathlib
import re
import sys
import unittest

import numpy as np
import openpyxl
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from reported import BRIDGE, LIMITS, Reported  # noqa: E402
from traverse_report import (  # noqa: E402
    checks_sheet, comparison_sheet, curve_sheet, curves, fatigue_sheet, hslm, limits, loads_sheet, main, page, source,
                             structure, title_sheet)

# EN 1991-2, table 6.3: number of intermediate coaches, coach length D, bogie axle spacing d, point force P.
HSLM_A = {"A1": (18, 18, 2.0, 170), "A2": (17, 19, 3.5, 200), "A3": (16, 20, 2.0, 180), "A4": (15, 21, 3.0, 190),
          "A5": (14, 22, 2.0, 170), "A6": (13, 23, 2.0, 180), "A7": (13, 24, 2.0, 190), "A8": (12, 25, 2.5, 190),
          "A9": (11, 26, 2.0, 210), "A10": (11, 27, 2.0, 210)}


def texts_of(sheet):
    """The texts of a page from top to bottom and from left to right."""
    found = sorted(sheet.paper.texts, key=lambda text: (-text.get_position()[1], text.get_position()[0]))
    return [text.get_text() for text in found]


class Pages(Reported):
    def test_ten_trains_are_ten_lines_that_differ(self):
        one = source.Source(self.folder / "sweep.h5")
        report = page.Report()
        drawn = curve_sheet.curve_sheets(report, one, limits.read_limits(self.folder / "limits.yml"))
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
        report = page.Report()
        curve_sheet.curve_sheets(report, one, rows)
        places = [line.get_ydata()[0] for p in report.pages for ax in p.figure.axes for line in ax.get_lines()
                  if line.get_color() == curves.RED]
        self.assertEqual(sorted(places), [1.5, 2.5])

    def test_no_cell_is_a_formula(self):
        cells = [cell for sheet in self.book_of("judged", "--no-governing-run") for row in sheet.iter_rows()
                 for cell in row]
        self.assertEqual([cell.value for cell in cells if cell.data_type in ("f", "e")], [])
        self.assertIn("=1+1", [cell.value for cell in cells])

    def test_pages_are_a4_and_all_there(self):
        status, said, error = self.command("sweep.h5", "crossing.h5", "-o", "both", "--limits", "limits.yml",
                                           "--no-governing-run")
        self.assertEqual((status, error), (0, ""))
        pdf = (self.folder / "both.pdf").read_bytes()
        boxes = re.findall(rb"/MediaBox \[ ?0 0 ([\d.]+) ([\d.]+) ?\]", pdf)
        self.assertEqual(len(boxes), int(re.search(r"\((\d+) pages\)", said)[1]))
        for width, height in boxes:
            self.assertAlmostEqual(float(width), 595.4, 0)
            self.assertAlmostEqual(float(height), 841.7, 0)
        self.assertGreaterEqual(len(boxes), 15)
        self.assertIn("2 verdicts", openpyxl.load_workbook(self.folder / "both.xlsx").sheetnames)

    def test_results_without_limits_are_left_alone(self):
        for path in self.folder.glob("*.pdf"):
            path.unlink()
        self.assertEqual(self.command("--if-limits", "crossing.h5"), (0, "", ""))
        self.assertEqual(list(self.folder.glob("*.pdf")), [])
        status, _, error = self.command("--if-limits", "study.h5", "--no-governing-run")
        self.assertEqual((status, error), (0, ""))
        self.assertTrue((self.folder / "study.pdf").is_file())

    def headline(self, names, limits_text):
        """Of the title page: its first line and its colour."""
        (self.folder / "own.yml").write_text(limits_text, encoding="utf-8")
        entries, _ = self.entries_of(names, "--limits", "own.yml", "--no-governing-run")
        lines, colour = comparison_sheet.headline([(one, verdicts) for one, _, verdicts, _ in entries])
        return lines, colour

    def test_of_two_files_the_worst_one_decides(self):
        for names in (("sweep", "crossing"), ("crossing", "sweep")):
            lines, colour = self.headline(names, LIMITS[:LIMITS.index("- {clause: \"rule 2\"")])
            self.assertEqual(lines[0], "Of 2 results files: Limits exceeded: 1 of 2 evaluated.")
            self.assertIn("sweep.h5", lines[1])
            self.assertEqual(colour, page.RED)

    def test_green_only_where_all_were_evaluated_and_complied_with(self):
        self.assertEqual(self.headline(("crossing", "sweep"),
                                       "- {clause: a, quantity: amplification, value: 50.0}\n")[1], page.GREEN)
        self.assertEqual(self.headline(("crossing", "sweep"),
                                       "- {clause: a, quantity: car_acceleration, value: 50.0}\n")[1], page.GREY)


class Whole(Reported):
    """Title, contents, references and the scope of verification of whole reports."""

    def made(self, names, *words):
        entries, arguments = self.entries_of(names, *words)
        sources = [one for one, *_ in entries]
        title = title_sheet.title_of(sources, main.given_title(arguments), None)
        structure.read(sources, main.given_title(arguments), self.folder)
        lines, colour = comparison_sheet.headline([(one, verdicts) for one, _, verdicts, _ in entries])
        report = main.report_of([[entry] for entry in entries], title, lines, colour, fatigue_sheet.Asked())
        report.fill_references()
        return report, title

    def test_contents_and_references_name_the_pages(self):
        report, _ = self.made(["judged", "crossing"], "--limits", "limits.yml", "--no-governing-run")
        self.assertEqual([one.heading for one in report.pages[1:3]], ["Contents", "Comparison of the results"])
        rows = {}
        for text in report.pages[1].paper.texts:
            rows.setdefault(round(text.get_position()[1], 3), []).append(text.get_text())
        entries = [row for row in rows.values() if len(row) == 3 and row[-1].isdigit()]
        self.assertGreater(len(entries), 15)
        for number, heading, at in entries:
            shown = report.pages[int(at) - 1]
            if number.count("."):
                self.assertIn(f"{number}  {heading}", texts_of(shown))
        compared = [int(text) for text in texts_of(report.pages[2]) if text.isdigit() and int(text) > 3]
        self.assertEqual([report.pages[at - 1].heading for at in compared], ["Summary of results"] * 2)

    def test_the_title_page_has_what_the_options_and_the_command_say(self):
        Image.new("RGB", (60, 20), "blue").save(self.folder / "logo.png")
        self.compute("titled", BRIDGE + "load: {forces: [2.0e5], speed: 40.0}\n", "-report_project", "Old $project$",
                     "-report_author",
                     "A. Author", "-report_logo", "logo.png", "-report_norm_edition", "EN 1991-2:2003")
        report, title = self.made(["titled"], "--project", "New project", "--checker", "C. Checker", "--revision", "B")
        words = texts_of(report.pages[0])
        for text in ("New project", "A. Author", "C. Checker", "EN 1991-2:2003", "titled.h5", "Signature"):
            self.assertIn(text, words)
        self.assertNotIn("Old $project$", words)
        self.assertIn(title_sheet.digest_of(self.folder / "titled.h5"), "".join(words))
        self.assertEqual(title.logo.size, (60, 20))
        self.assertTrue(words[1].startswith("No limits were given"), words)  # below the heading

    def test_material_drawings_and_cross_section_are_in_the_basis_of_calculation(self):
        Image.new("RGB", (300, 100), "grey").save(self.folder / "section.png")
        self.compute("described", BRIDGE + """
load: {forces: [2.0e5], speed: 40.0}
report: {material: C50/60, drawings: [B-101, B-102 a], cross_section: section.png}
""")
        for words, material, origin in (((), "C50/60", "described.yml, line 9"),
                                        (("--material", "S355"), "S355", "command line")):
            report, _ = self.made(["described"], *words)
            basis = next(sheet for sheet in report.pages if sheet.heading == "Basis of calculation")
            texts = texts_of(basis)
            self.assertEqual(texts[texts.index("Material"):][:3], ["Material", material, origin])
            self.assertEqual(texts[texts.index("Drawings"):][:2], ["Drawings", "B-101, B-102 a"])
            pictures = [ax for ax in basis.figure.axes if ax.get_images()]
            self.assertEqual([ax.get_images()[0].get_array().shape[:2] for ax in pictures], [(100, 300)])
            width, height = pictures[0].get_position().size * (page.WIDTH, page.HEIGHT)
            self.assertAlmostEqual(width / height, 3.0)

    def test_a_bad_picture_is_said(self):
        (self.folder / "bad.png").write_bytes(b"no picture")
        for name, said in (("bad.png", "no PNG or JPEG"), ("none.png", "no such file"), ("/dev/zero", "no such file")):
            for option in ("--logo", "--cross-section"):
                status, _, error = self.command("crossing.h5", option, name)
                self.assertEqual((status, len(error.strip().splitlines())), (1, 1))
                self.assertIn(said, error)

    def test_the_cross_section_is_not_written_over(self):
        Image.new("RGB", (30, 10)).save(self.folder / "drawn.pdf")
        status, _, error = self.command("crossing.h5", "--cross-section", "drawn.pdf", "-o", "drawn")
        self.assertEqual(status, 1)
        self.assertIn("drawn.pdf is read by this command", error)

    def test_trains_of_hslm_are_those_of_the_norm(self):
        rows = loads_sheet.hslm_rows(source.Source(self.folder / "sweep.h5"))
        self.assertEqual([row[0] for row in rows], list(HSLM_A))
        for name, count, length, spacing, force, *_ in rows:
            for found, expected in zip((count, length, spacing, 1e-3 * force), HSLM_A[name]):
                self.assertAlmostEqual(found, expected, 6, name)

    def test_the_forces_of_the_trains_are_those_of_the_program(self):
        of_program = source.Source(self.folder / "sweep.h5").model.forces
        self.assertEqual(list(of_program), list(map(hslm.name_of, hslm.TRAINS)))
        for number, name in zip(hslm.TRAINS, of_program):
            own, expected = hslm.forces_of(number), of_program[name]
            np.testing.assert_allclose(own[:, 0], np.sort(expected[:, 0])[::-1] - expected[:, 0].max(), atol=1e-9)
            np.testing.assert_allclose(own[:, 1], expected[:, 1])

    def test_the_scope_says_what_was_verified(self):
        one = source.Source(self.folder / "judged.h5")
        judged = limits.judge(one, limits.limits_of(one, None, None))
        rows = {requirement: results for requirement, _, results in checks_sheet.rows_of(one, judged)}
        self.assertEqual(len(rows), len(checks_sheet.clauses()["requirements"]))
        said = {requirement.split(" (")[0]: results[0][0] for requirement, results in rows.items()}
        self.assertEqual(said["vertical acceleration of the deck"], "exceeded")
        self.assertEqual(said["twist of the deck"], "not verified: the beam does not twist")
        self.assertEqual(said["rotation of the deck ends"], "not verified: no limit given")
        self.assertEqual(said["relative rotation of adjacent deck ends"], "not applicable: no joint between two decks")
        self.assertEqual(said["dynamic analysis with all trains of HSLM-A"], "computed, without a limit")

    def test_every_clause_has_known_sources_and_quantities(self):
        table, one = checks_sheet.clauses(), source.Source(self.folder / "sweep.h5")
        names = {name for name, _ in one.file["quantities/limits"].asstr()}
        for row in table["requirements"]:
            self.assertLessEqual(set(row["sources"]), set(table["sources"]), row)
            self.assertLessEqual(set(row.get("quantities", ())), names, row)
            self.assertIn(row.get("computed", "norm"), checks_sheet.COMPUTED)


class LongNames(Reported):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.compute("three", BRIDGE + """
load: {forces: [2.0e5, 1.0e5], positions: [0.0, -3.0], speed: 40.0}
study: {vary: {load_speed: [30.0, 50.0], beam_mass: [1.6e4, 1.8e4, 2.0e4], beam_EI: [2.0e10, 3.0e10],
               model_damping_ratios: [0.01, 0.02]}}
""")

    def test_a_study_of_four_options_is_drawn(self):
        status, _, error = self.command("three.h5", "--no-governing-run", "--limits", "limits.yml")
        self.assertEqual((status, error), (0, ""))

    def test_names_of_curves_stay_on_the_page(self):
        one = source.Source(self.folder / "three.h5")
        long_unit = {"beam_EI": "N m2 " * 20}
        for units in ({}, long_unit):
            one.runs.units = one.runs.units | units
            report = page.Report()
            curve_sheet.curve_sheets(report, one, [])
            curve_sheet.envelope_sheet(report, one, [])
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
        self.assertEqual(curves.names_of(runs)[0], "16, 20\u202f000, 0.01")
        self.assertEqual(runs.lines_in_words(), "mass per length (t/m), bending stiffness EI (MN m²), damping ratio")
        self.assertEqual(runs.lines()[0][0],
                         "mass per length 16 t/m, bending stiffness EI 20\u202f000 MN m², damping ratio 0.01")


if __name__ == "__main__":
    unittest.main()
