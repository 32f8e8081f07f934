"""The measured bridges: each page has its scene and the rows of the script, and says what a run prints."""

import dataclasses
import importlib.util
import os
import pathlib
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from examples_test import differences  # noqa: E402

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2])).resolve()
sys.path.insert(0, str(SOURCE / "scripts"))
specification = importlib.util.spec_from_file_location("measured_bridges", SOURCE / "scripts" / "measured_bridges.py")
bridges = importlib.util.module_from_spec(specification)
specification.loader.exec_module(bridges)
QUICK = {"indian_truss": 4, "amsterdam_slab": 6, "leirelva_stringer": 8, "slovenian_beams": 8, "vransko": 1}  # first rows


def page(name):
    return bridges.page_of(name).read_text(encoding="utf-8")


def on_page(text, first_line):
    """The rows of the table that begins with this line."""
    return re.search(re.escape(first_line) + r"\n\|[ -|]*\n((?:\|.*\n)*)", text)[1].splitlines()


def written(text, bridge):
    """The lines of both tables of a page."""
    return on_page(text, bridges.VALUES[0]) + on_page(text, bridges.ASSUMED[0].format(bridge.watched.quantity))


class Pages(unittest.TestCase):
    def test_each_names_its_scene_and_its_source(self):
        for name in bridges.BRIDGES:
            with self.subTest(name):
                self.assertTrue((SOURCE / "options" / "measured" / f"{name}.yml").is_file())
                self.assertIn(f"build/traverse -options_file options/measured/{name}.yml\n", page(name))
                self.assertRegex(page(name), r"(?m)^## Source\n\n[^#]*https://")

    def test_each_has_the_rows_of_the_script(self):
        for name, bridge in bridges.BRIDGES.items():
            starts = [f"| {row.quantity} | {bridges.in_digits(row.measured, row.digits)} |" for row in bridge.rows]
            starts += [f"| {each.what} | {each.used} | {'; '.join(label for label, _ in each.instead)} |"
                       for each in bridge.assumptions]
            lines = written(page(name), bridge)
            with self.subTest(name):
                self.assertEqual([line[:len(start)] for line, start in zip(lines, starts)], starts)
                self.assertEqual(len(lines), len(starts))

    def test_the_index_names_them_and_no_other(self):
        index = (SOURCE / "doc" / "measured.md").read_text(encoding="utf-8")
        self.assertEqual(re.findall(r"\(measured/(\w+)\.md\)", index), list(bridges.BRIDGES))
        self.assertEqual(sorted(path.stem for path in (SOURCE / "doc" / "measured").iterdir()), sorted(bridges.BRIDGES))

    def test_a_page_without_its_table_is_refused(self):
        with self.assertRaisesRegex(bridges.Failed, "one table that begins with"):
            bridges.with_table("# A page\n", bridges.VALUES)


@unittest.skipUnless(os.environ.get("TRAVERSE_BINARY"), "TRAVERSE_BINARY names no program")
class Run(unittest.TestCase):
    def test_computes_what_the_pages_say(self):
        for name, rows in QUICK.items():
            bridge = dataclasses.replace(bridges.BRIDGES[name], rows=bridges.BRIDGES[name].rows[:rows])
            table = bridges.values_table(bridge, bridges.Scene(name, os.environ["TRAVERSE_BINARY"]))
            with self.subTest(name):
                self.assertEqual(differences(table[2:], on_page(page(name), table[0])[:rows]), [])

    def test_prints_both_tables_and_notices_a_stale_one(self):
        values, assumed = bridges.tables("belleville", os.environ["TRAVERSE_BINARY"])
        found, text = values[2:] + assumed[2:], page("belleville")
        bridge = bridges.BRIDGES["belleville"]
        self.assertEqual(differences(found, written(text, bridge)), [])
        stale = text.replace("| 2.10 |", "| 2.20 |", 1)  # the second frequency
        self.assertEqual(len(differences(found, written(stale, bridge))), 1)

    def test_a_scene_that_fails_says_why(self):
        with self.assertRaisesRegex(bridges.Failed, "belleville.yml -beam_mass -1: .*beam_mass"):
            bridges.Scene("belleville", os.environ["TRAVERSE_BINARY"]).results("-beam_mass -1")


if __name__ == "__main__":
    unittest.main()
