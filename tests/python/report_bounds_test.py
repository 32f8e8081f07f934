"""scripts/traverse-report on several files of one structure: all pages of the governing one, one page of each other one."""

import pathlib
import re
import sys
import unittest

import openpyxl

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from reported import BRIDGE, Reported  # noqa: E402
from traverse_report import bounds, checks_sheet, curves, fatigue_sheet, language, limits, main, title_sheet  # noqa: E402
from traverse_report.page import GREEN, RED  # noqa: E402

SWEEP = BRIDGE + """
sweep: {speed: [60.0, 100.0, 10.0], hslm_a: [1, 2]}
output: {probes: [5.0, 10.0, 15.0, 22.0, 32.5, 40.0]}
"""
LIMITS = """
- {clause: "rule 1", quantity: deflection_over_span, value: 1/2500}
- {clause: "rule 2", quantity: deck_acceleration, value: 15.0}
- {clause: "rule 3", quantity: car_acceleration, value: 1.0}
"""
# Stiffness, mass, structure. The stiff bridge has smaller deflections, and as it is light greater accelerations.
FILES = {"stiff": ("3.4e10", "1.5e4", "Viaduct"), "soft": ("3.0e10", "1.8e4", "Viaduct"),
         "elsewhere": ("3.0e10", "1.8e4", "Footbridge")}


class Bounds(Reported):
    @classmethod
    def setUpClass(cls):
        super(Reported, cls).setUpClass()  # with computations of its own
        cls.addClassCleanup(cls.holder.cleanup)

    @classmethod
    def prepare(cls):
        (cls.folder / "limits.yml").write_text(LIMITS, encoding="utf-8")
        for name, (stiffness, mass, structure) in FILES.items():
            cls.compute(name, SWEEP, "-limits", "limits.yml", "-beam_EI", stiffness, "-beam_mass", mass,
                        "-report_structure", structure)

    def entries(self, *names):
        return self.entries_of(names, "--no-governing-run")[0]

    def made(self, groups):
        report = main.report_of(groups, title_sheet.Title(structure="S", date="2026"), ["said"], "#666666",
                                fatigue_sheet.Asked())
        report.fill_references()
        return report

    def names(self, group):
        return [source.path.stem for source, *_ in group]

    def test_the_governing_file_is_the_first_of_its_structure(self):
        for order in (("stiff", "elsewhere", "soft"), ("soft", "stiff", "elsewhere")):
            groups = sorted(map(self.names, bounds.groups_of(self.entries(*order))))
            self.assertEqual(groups, [["elsewhere"], ["soft", "stiff"]])

    def test_the_command_may_name_the_structure_of_all_files(self):
        entries = self.entries("stiff", "elsewhere", "soft")
        for source, *_ in entries:
            source.replaced = {"report_structure": "Bridge"}
        self.assertEqual([self.names(group) for group in bounds.groups_of(entries)], [["elsewhere", "stiff", "soft"]])

    def test_each_other_file_has_one_page(self):
        entries = self.entries("stiff", "soft", "elsewhere")
        report = self.made(bounds.groups_of(entries))
        whole = self.made([[entry] for entry in entries])
        self.assertEqual([page.heading for page in report.pages].count("Results of stiff.h5"), 1)
        self.assertEqual([page.heading for page in report.pages].count("Basis of calculation"), 2)
        self.assertEqual([page.heading for page in whole.pages].count("Basis of calculation"), 3)
        self.assertGreater(len(whole.pages), len(report.pages) + 8)

    def test_the_page_has_differences_and_utilisations_of_both_files(self):
        groups = bounds.groups_of(self.entries("stiff", "soft"))
        report = self.made(groups)
        number, = [i for i, page in enumerate(report.pages, 1) if page.heading == "Results of stiff.h5"]
        rows = {}
        for text in report.pages[number - 1].paper.texts:
            rows.setdefault(round(text.get_position()[1], 3), {})[text.get_position()[0]] = text.get_text()
        rows = [[row[x] for x in sorted(row)] for row in rows.values()]
        self.assertIn(["Bending stiffness EI", "34\u202f000 MN m²", "30\u202f000 MN m²"], rows)
        (_, _, governing, _), (_, _, other, _) = groups[0]
        for one, of_governing in zip(other[:2], governing[:2]):
            row = next(row for row in rows if language.percent(one.utilisation) in row)
            self.assertIn(language.percent(of_governing.utilisation), row)
        compared = {text.get_text() for text in report.pages[2].paper.texts}
        self.assertLessEqual({"Bending stiffness EI", str(number)}, compared)
        drawn = [ax for ax in report.pages[number - 1].figure.axes if ax.get_title("left")]
        self.assertEqual(len(drawn), 4)
        for ax in drawn:  # the governing file, two trains and perhaps a limit
            self.assertEqual([line.get_color() for line in ax.get_lines()][:3], [curves.PALE, *curves.COLOURS[:2]])

    def test_the_scope_has_the_worst_of_all_files(self):
        group, = bounds.groups_of(self.entries("stiff", "soft"))
        worst = bounds.worst_of(group)
        self.assertEqual([one.limit.clause for one in worst], ["rule 1", "rule 2", "rule 3"])
        for i, one in enumerate(worst[:2]):
            values = {source.path.name: verdicts[i].value for source, _, verdicts, _ in group}
            self.assertEqual(one.value, max(values.values()))
            self.assertEqual(values[one.file or "soft.h5"], one.value)
        self.assertEqual([one.file for one in worst], ["", "stiff.h5", ""])
        left = [(*group[0][:2], group[0][2][:1], None), group[1]]
        self.assertEqual([(one.limit.clause, one.file) for one in bounds.worst_of(left)],
                         [("rule 1", ""), ("rule 2", "stiff.h5")])
        rows = {requirement: results for requirement, _, results in checks_sheet.rows_of(group[0][0], worst)}
        said, = (results for requirement, results in rows.items() if "acceleration of the deck" in requirement)
        self.assertEqual([(words, anchor) for words, *_, anchor in said],
                         [("complied with (stiff.h5)", ("", "stiff.h5"))])

    def test_a_decision_of_another_file_that_is_not_satisfied_is_a_result(self):
        (soft, *_), (stiff, *_) = bounds.groups_of(self.entries("stiff", "soft"))[0]
        soft.line, stiff.line = (main.line_of(main.arguments_of(["x.h5", "--line-speed", f"{speed} km/h"]))
                                 for speed in (300, 310))  # the runs end at 360 km/h

        def results(one, other):
            rows = checks_sheet.rows_of(one, [], [other])
            return next(found for requirement, _, found in rows if requirement.startswith("range of speeds"))

        self.assertEqual([colour for _, colour, *_ in results(soft, stiff)], [GREEN, RED])
        self.assertTrue(results(soft, stiff)[1][0].endswith(" (stiff.h5)"))
        self.assertEqual([colour for _, colour, *_ in results(stiff, soft)], [RED])

    def test_the_workbook_has_all_numbers_of_all_files(self):
        pages = []
        for words in ((), ("--all-bounds",)):
            status, said, error = self.command("stiff.h5", "soft.h5", "-o", "both", "--no-governing-run", *words)
            self.assertEqual((status, error), (0, ""))
            pages.append(int(re.search(r"\((\d+) pages\)", said)[1]))
            book = openpyxl.load_workbook(self.folder / "both.xlsx")
            self.assertLessEqual({"1 runs", "2 runs", "1 verdicts", "2 verdicts", "2 basis"}, set(book.sheetnames))
        self.assertGreater(pages[1], pages[0] + 8)

    def test_limits_with_other_factors_are_the_same(self):
        one = limits.Limit("a", "amplification", 2.0, "")
        self.assertEqual(limits.key_of(one), limits.key_of(one._replace(factor=1.1, text="b")))


if __name__ == "__main__":
    unittest.main()
