"""scripts/comments.py on small trees of its own, and on the project."""

import os
import pathlib
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2])).resolve()


class Comments(unittest.TestCase):
    def check(self, root):
        return subprocess.run(["/usr/bin/python3", "-B", SOURCE / "scripts/comments.py", root], capture_output=True,
                              text=True)

    def check_header(self, *lines):
        with tempfile.TemporaryDirectory() as folder:
            header = pathlib.Path(folder, "include", "traverse", "beam", "beam.hpp")
            header.parent.mkdir(parents=True)
            header.write_text("\n".join(lines) + "\n", encoding="utf-8")
            return self.check(folder)

    def test_the_project(self):
        found = self.check(SOURCE)
        self.assertEqual(found.returncode, 0, found.stdout)

    def test_a_file_without_a_head(self):
        found = self.check_header("#pragma once")
        self.assertEqual(found.returncode, 1)
        self.assertIn("include/traverse/beam/beam.hpp:1: does not open with a comment", found.stdout)

    def test_a_function_without_a_comment(self):
        found = self.check_header("// A beam.", "struct Beam {", "  /// m.", "  double length() const;", "",
                                  "  double mass(double x) const;", " private:", "  void build();", "};")
        self.assertEqual(found.returncode, 1)
        self.assertEqual(found.stdout.count("has no comment"), 1, found.stdout)
        self.assertIn("beam.hpp:6: has no comment: double mass(double x) const;", found.stdout)

    def test_one_comment_for_several_functions(self):
        self.assertEqual(self.check_header("// A beam.", "/// m, and kg.", "double length();", "double mass();").returncode, 0)


if __name__ == "__main__":
    unittest.main()
