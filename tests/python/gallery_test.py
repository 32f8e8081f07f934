"""The page of the gallery: it names every scene there is, and the command that writes it works."""

import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2])).resolve()
SCRIPT = SOURCE / "scripts" / "gallery.py"
LARGEST = 1_500_000  # bytes, all pictures together
sys.path.insert(0, str(SCRIPT.parent))
specification = importlib.util.spec_from_file_location("gallery", SCRIPT)
gallery = importlib.util.module_from_spec(specification)
specification.loader.exec_module(gallery)


class Page(unittest.TestCase):
    def setUp(self):
        self.text = (SOURCE / "doc" / "gallery.md").read_text(encoding="utf-8")

    def test_names_every_scene_with_its_source(self):
        self.assertGreater(len(gallery.names()), 30)
        for name in gallery.names():
            with self.subTest(name):
                self.assertTrue(f"options/{name}.yml`" in self.text or f"| `{name}` |" in self.text)
                self.assertIn(gallery.header(name)[1], self.text)

    def test_names_no_other_scene(self):
        named = re.findall(r"`(?:\./run\.sh -options_file options/)?((?:scenes|studies)/\w+)(?:\.yml)?`", self.text)
        self.assertEqual(sorted(named), gallery.names())

    def test_pictures_are_small(self):
        pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", self.text)
        self.assertEqual(pictures, [f"{pathlib.Path(name).name}.png" for name in gallery.SHOWN])
        self.assertLess(sum((SOURCE / "doc" / name).stat().st_size for name in pictures), LARGEST)


class Command(unittest.TestCase):
    def run_it(self, *words):
        return subprocess.run([sys.executable, "-B", SCRIPT, *words], capture_output=True, text=True)

    @unittest.skipUnless(os.environ.get("TRAVERSE_BINARY"), "TRAVERSE_BINARY names no program")
    def test_shows_a_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            run = self.run_it("--program", os.environ["TRAVERSE_BINARY"], "--folder", folder, "scenes/tapered_jib")
            self.assertEqual(run.returncode, 0, run.stderr)
            text = pathlib.Path(folder, "gallery.md").read_text(encoding="utf-8")
            self.assertTrue(pathlib.Path(folder, "tapered_jib.png").is_file())
        self.assertRegex(text, r"\| greatest deflection \| 153\.[23] mm \|")  # 153.2 +- 1e-3, as the scene's header expects
        self.assertNotIn("greatest acceleration", text)  # whose error the run does not know

    def test_refuses_what_it_cannot_show(self):
        self.assertIn("no scene of options/", self.run_it("--folder", "nowhere", "scenes/nothing").stderr)
        self.assertIn("--folder of its own", self.run_it("scenes/tapered_jib").stderr)


if __name__ == "__main__":
    unittest.main()
