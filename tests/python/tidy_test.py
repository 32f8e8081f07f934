"""Which files scripts/tidy.py takes: those changed last, in a small repository of its own."""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
specification = importlib.util.spec_from_file_location("tidy", SOURCE / "scripts/tidy.py")
tidy = importlib.util.module_from_spec(specification)
specification.loader.exec_module(tidy)


class Changed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not shutil.which("git"):
            raise unittest.SkipTest("git is not installed")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.git("init", "--quiet")
        self.commit("src/beam/beam.cpp", "include/traverse/beam/beam.hpp", "src/beam/old.cpp")
        self.commit("include/traverse/beam/shape.hpp", "README.md", "scripts/x.py")
        (self.root / "src/beam/old.cpp").unlink()
        self.commit("src/beam/mesh.cpp", "tests/unit/mesh_test.cpp")

    def git(self, *words):
        subprocess.run(["git", "-C", self.root, "-c", "user.name=n", "-c", "user.email=e", *words], check=True)

    def write(self, *names):
        for name in names:
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(str(len(list(self.root.rglob("*")))), encoding="utf-8")

    def commit(self, *names):
        self.write(*names)
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", "m")

    def test_the_newest_first_and_each_once(self):
        self.assertEqual(tidy.changed(self.root), ["src/beam/mesh.cpp", "tests/unit/mesh_test.cpp",
                                                   "include/traverse/beam/shape.hpp", "src/beam/beam.cpp"])

    def test_what_is_not_committed_comes_before(self):
        self.write("src/track/new.cpp", "src/beam/beam.cpp")
        self.assertEqual(tidy.changed(self.root)[:3], ["src/beam/beam.cpp", "src/track/new.cpp", "src/beam/mesh.cpp"])

    def test_a_header_stands_for_its_source(self):
        self.commit("include/traverse/beam/mesh.hpp", "src/beam/mesh.hpp")
        self.assertEqual(tidy.changed(self.root)[0], "src/beam/mesh.cpp")
        self.assertEqual(len(tidy.changed(self.root)), 4)

    def test_since_a_revision(self):
        self.assertEqual(tidy.changed(self.root, "HEAD~1"), ["src/beam/mesh.cpp", "tests/unit/mesh_test.cpp"])


if __name__ == "__main__":
    unittest.main()
