"""scripts/includes.py on small trees of its own: what it lets pass and what it fails on."""

import os
import pathlib
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))


class Includes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("include/traverse/base/error.hpp", "#include <string>")
        self.write("include/traverse/beam/beam.hpp", '#include "traverse/base/error.hpp"')
        self.write("src/beam/beam.cpp", '#include "traverse/beam/beam.hpp"', '#include "slice.hpp"')
        self.write("src/beam/slice.hpp", "#include <petscvec.h>")
        self.write("src/app/run.cpp", '#include "traverse/beam/beam.hpp"')

    def write(self, name, *lines):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")

    def check(self, *arguments, root=None):
        return subprocess.run(["/usr/bin/python3", "-B", SOURCE / "scripts/includes.py", *arguments, root or self.root],
                              capture_output=True, text=True)

    def assert_fails_with(self, *words):
        run = self.check()
        self.assertEqual(run.returncode, 1, run.stdout)
        self.assertEqual(len(run.stderr.splitlines()), 1, run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)

    def test_the_project_itself(self):
        run = self.check(root=SOURCE)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertEqual(len(run.stdout.splitlines()), 1, run.stdout)

    def test_includes_that_point_down(self):
        run = self.check()
        self.assertEqual((run.returncode, run.stderr), (0, ""))

    def test_an_include_that_points_up(self):
        self.write("src/base/error.cpp", '#include "traverse/base/error.hpp"', '#include "traverse/beam/beam.hpp"')
        self.assert_fails_with("src/base/error.cpp:2", '"traverse/beam/beam.hpp" points up, from base to beam')

    def test_one_that_points_up_into_src(self):
        self.write("src/base/error.cpp", '#  include "../beam/slice.hpp"')
        self.assert_fails_with("src/base/error.cpp:1", "from base to beam")
        self.write("src/base/error.cpp", "#include <beam/slice.hpp>")
        self.assert_fails_with("src/base/error.cpp:1", "from base to beam")

    def test_a_header_that_is_not_installed_in_one_that_is(self):
        self.write("include/traverse/beam/beam.hpp", '#include "traverse/base/error.hpp"', '#include "beam/slice.hpp"')
        self.assert_fails_with("include/traverse/beam/beam.hpp:2", "is not installed")

    def test_a_folder_without_a_layer(self):
        self.write("src/attic/old.cpp", '#include "traverse/base/error.hpp"')
        self.assert_fails_with("The folder attic stands in no layer")

    def test_a_circle(self):
        self.write("include/traverse/beam/mesh.hpp", '#include "traverse/beam/line.hpp"')
        self.write("include/traverse/beam/line.hpp", '#include "traverse/beam/mesh.hpp"')
        self.assert_fails_with("Files include one another", "beam/line.hpp -> include/traverse/beam/mesh.hpp")

    def test_petsc_in_mechanics(self):
        self.write("src/contact/law.cpp", "#include <petscmat.h>")
        self.assert_fails_with("src/contact/law.cpp:1", "petscmat.h brings headers of PETSc into contact")

    def test_petsc_in_mechanics_through_another_header(self):
        self.write("include/traverse/base/petsc.hpp", "#include <petscts.h>")
        self.write("include/traverse/base/handle.hpp", '#include "traverse/base/petsc.hpp"')
        self.write("src/track/profile.cpp", "#include <vector>", '#include "traverse/base/handle.hpp"')
        self.assert_fails_with("src/track/profile.cpp:2", "brings headers of PETSc into track")

    def test_a_room_of_too_many_lines(self):
        run = self.check()
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("beam 66.7%", run.stdout)  # 4 lines of 6
        run = self.check("--limit-rooms")
        self.assertEqual(run.returncode, 1, run.stdout)
        self.assertIn("beam 66.7%", run.stderr)
        for room in ("app", "results", "integrate", "coupling", "contact", "multibody", "track", "modes", "solve",
                     "options", "base"):
            self.write(f"src/{room}/lines.cpp", *["// a line"] * 50)
        run = self.check("--limit-rooms")
        self.assertEqual((run.returncode, run.stderr), (0, ""))

    def test_a_folder_without_sources(self):
        self.assertEqual(self.check(root=self.root / "src").returncode, 1)


if __name__ == "__main__":
    unittest.main()
