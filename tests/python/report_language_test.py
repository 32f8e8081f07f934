"""The languages of scripts/traverse-report: the table of texts is complete, and no text on a page is outside of it."""

import ast
import pathlib
import re
import sys
import unittest
import unittest.mock

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from reported import SCRIPTS, Reported  # noqa: E402
from traverse_check import rules, scene  # noqa: E402
from traverse_page import along, histories  # noqa: E402
from traverse_serve import forms, pages  # noqa: E402
from traverse_report import (  # noqa: E402
    annex_sheet, checks_sheet, comparison_sheet, fatigue_sheet, front_sheet, language, main, model_sheet, quantities,
    rail_sheet, run_sheet, source, static_sheet, title_sheet)

RAIL = f"options_file: {SCRIPTS.parent}/options/scenes/uic774_e13.yml\nuic774: {{fronts: [0.0, 60.0, 60.0]}}\n"
SOURCES = [path for folder in ("traverse_report", "traverse_page", "traverse_check", "traverse_serve")
           for path in (SCRIPTS / folder).glob("*.py")] + list(SCRIPTS.glob("picture_*.py"))
WORD = re.compile(r"[A-Za-zÄÖÜäöüßéèêàç]{4,}")
# Names and symbols that are the same in every language.
SAME = set("traverse HSLM Sperling factor line report limits".split())
# Words of the program for effects, materials and reasons of missing verdicts, which the table translates.
OF_PROGRAM = SCRIPTS.parent / "src"


def literals(path):
    """The texts that a file looks up in the table: the constants in the calls of t()."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("t", "said"):
            parts = [node.args[0]] if not isinstance(node.args[0], ast.IfExp) else [node.args[0].body,
                                                                                    node.args[0].orelse]
            yield from (part.value for part in parts if isinstance(part, ast.Constant))


def of_tables():
    """The texts of the tables of the report."""
    yield from (row.words for row in quantities.QUANTITIES.values())
    for table in (model_sheet.KINDS, front_sheet.WORDS, rail_sheet.CASES, source.WORDS, scene.WORDS, scene.NAMES):
        yield from table.values()
    yield from (words for words, _ in annex_sheet.ESTIMATED.values())
    yield from (words for _, words in static_sheet.DRAWN)
    yield from (words for words, *_ in (*rail_sheet.PEAKS.values(), *rail_sheet.FORCES.values()))
    yield from (words for *_, words in run_sheet.EFFECTS)
    yield from (title for _, _, title, *_ in histories.COLUMNS)
    yield from (title for title, _ in along.ENVELOPES.values())
    for form in forms.forms().values():
        yield from (form.title, form.words, form.verb, *(heading for heading, _ in form.groups))
        for field in form.fields:
            yield from filter(None, (field.label, field.hint))
            yield from field.choices.values() if field.name != "train_vehicles" else ()
    yield from pages.STATES.values()
    for row in checks_sheet.clauses()["requirements"]:
        yield from (row[name] for name in ("requirement", "value", "remark") if name in row)
    limits = [row for path in (SCRIPTS.parent / "options/limits").glob("*.yml")
              for row in yaml.safe_load(path.read_text(encoding="utf-8"))]
    limits += [*rules.data()["rules"].values(), *rules.data()["direct_fastening"].values()]
    yield from (row["text"] for row in limits if "text" in row)


class Table(unittest.TestCase):
    def test_every_text_is_in_the_table(self):
        for path in sorted(SOURCES):
            for text in literals(path):
                self.assertIn(text, language.table(), path.name)
        for text in of_tables():
            self.assertIn(text, language.table())

    def test_every_text_is_in_every_language_with_the_same_parts(self):
        for row in language.table().values():
            self.assertEqual(set(row), set(language.LANGUAGES))
            parts = [sorted(re.findall(r"{\w+}", row[name])) for name in language.LANGUAGES]
            self.assertTrue(all(row[name].strip() for name in language.LANGUAGES), row)
            self.assertEqual(parts, [parts[0]] * len(parts), row)

    def test_every_text_of_the_table_is_used(self):
        code = "".join(path.read_text(encoding="utf-8") for path in SOURCES)
        used = {text for path in SOURCES for text in literals(path)} | set(of_tables())
        program = "".join(path.read_text(encoding="utf-8") for path in OF_PROGRAM.rglob("*.?pp")).replace("_", " ")
        for text in language.table():
            if text not in used and f'"{text}"' not in code:
                self.assertIn(text.replace("_", " "), program)

    def test_numbers_have_the_decimal_sign_of_the_language(self):
        for name, expected in (("en", ("1.5", "−0.002", "25\u202f515", "2·10⁻⁵", "0")),
                               ("de", ("1,5", "−0,002", "25\u202f515", "2·10⁻⁵", "0"))):
            language.choose(name)
            self.assertEqual(tuple(map(language.digits, (1.5, -0.002, 25515.2, 2e-5, -0.0))), expected)
        language.choose("en")


class Pages(Reported):
    def made(self, name, *words):
        """The results of a file, and all axes of its report."""
        entries, _ = self.entries_of([name], "--limits", "limits.yml", *words)
        lines, colour = comparison_sheet.headline([(one, verdicts) for one, _, verdicts, _ in entries])
        report = main.report_of([entries], title_sheet.Title(structure="S", date="2026"), lines, colour,
                                fatigue_sheet.Asked())
        report.fill_references()
        return entries[0][0], [ax for sheet in report.pages for ax in sheet.figure.axes]

    def words_of_file(self, one):
        """The words that a results file and its limits bring along."""
        words = [(self.folder / "limits.yml").read_text(encoding="utf-8"), one.title(), one.path.name]
        for name in ("options", "model/notes", "verdicts/verdict", "input/sources"):
            if name in one.file:
                words += one.file[name].asstr()[:].ravel().tolist()
        words += [name for vehicle in one.results.vehicles for name in vehicle]
        return set(WORD.findall(" ".join(words))) | (self.words_of_file(one.governing) if one.governing else set())

    def test_no_text_on_a_page_is_outside_of_the_table(self):
        def masked(text):
            return re.sub(r"({\w+})|[^\W\d_]", lambda found: found[1] or "ж", text)

        table = {text: dict.fromkeys(language.LANGUAGES, masked(text)) for text in language.table()}
        self.compute("rail", RAIL)
        for name in ("judged", "study", "coach", "rail"):
            with unittest.mock.patch.object(language, "table", lambda: table):
                one, axes = self.made(name)
            texts = [text for ax in axes for text in texts_of(ax) if not re.fullmatch("[0-9a-f]{8,}", text)]  # digests
            self.assertGreater(sum("ж" in text for text in texts), 50)
            self.assertEqual({word for text in texts for word in WORD.findall(text)} - self.words_of_file(one) - SAME,
                             set(), name)

    def test_german_axes_have_decimal_commas(self):
        _, axes = self.made("judged", "--language", "de")
        ticks = [text for ax in axes if ax.axison for text in ticks_of(ax) if re.search(r"[.,]", text)]
        self.assertGreater(len(ticks), 5)
        self.assertEqual([text for text in ticks if "." in text], [])


def ticks_of(ax):
    return [text.get_text() for text in (*ax.get_xticklabels(), *ax.get_yticklabels())]


def texts_of(ax):
    """The texts of axes, with titles, labels and legends."""
    legend, titles = ax.get_legend(), [ax.title, ax._left_title, ax._right_title]
    titles += [ax.xaxis.label, ax.yaxis.label] if ax.axison else []
    return [text.get_text() for text in [*ax.texts, *titles, *(legend.get_texts() if legend else ())]
            if text.get_text()]


if __name__ == "__main__":
    unittest.main()
