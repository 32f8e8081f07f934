"""doc/verification.md is what the tests say: tests that exist, bounds as asserted, errors below them."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
SCRIPT = SOURCE / "scripts" / "verification.py"


def check(root):
    return subprocess.run([sys.executable, "-B", str(SCRIPT), "--check", "--root", str(root)], capture_output=True,
                          text=True)


class VerificationPageTest(unittest.TestCase):
    def copy(self):
        """The tests and the page in a folder of their own."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = pathlib.Path(folder.name)
        shutil.copytree(SOURCE / "tests", root / "tests")
        (root / "doc").mkdir()
        for name in ("verification.md", "verification_figures.csv"):
            shutil.copy(SOURCE / "doc" / name, root / "doc")
        return root

    def change(self, root, name, old, new):
        path = root / name
        text = path.read_text()
        self.assertIn(old, text)
        path.write_text(text.replace(old, new))

    def test_is_what_the_script_writes(self):
        run = check(SOURCE)
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_another_bound_is_noticed(self):
        root = self.copy()
        self.change(root, "tests/verification/reference_cases_test.cpp", "1e-4 * 2.8324443e-3", "1e-3 * 2.8324443e-3")
        run = check(root)
        self.assertEqual(run.returncode, 1)
        self.assertIn("is not what the tests say", run.stderr)

    def test_a_test_that_is_gone_is_noticed(self):
        root = self.copy()
        self.change(root, "tests/verification/reference_cases_test.cpp", "TEST(R3, Peak)", "TEST(R3, Peaks)")
        run = check(root)
        self.assertEqual(run.returncode, 1)
        self.assertIn("no test is named R3.Peak", run.stderr)

    def test_an_assertion_that_is_gone_is_noticed(self):
        root = self.copy()
        self.change(root, "tests/verification/long_chain_test.cpp", "EXPECT_LT(error, 1e-8) << n;", "")
        run = check(root)
        self.assertEqual(run.returncode, 1)
        self.assertIn("no longer asserts", run.stderr)

    def test_an_error_beyond_its_bound_is_noticed(self):
        root = self.copy()
        self.change(root, "tests/verification/reference_cases_test.cpp", "2e-5 * 4.18626809e-4", "1e-6 * 4.18626809e-4")
        run = check(root)
        self.assertEqual(run.returncode, 1)
        self.assertIn("measured", run.stderr)

    def test_every_bound_of_its_own_among_ranks_is_on_the_page(self):
        text = "\n".join(path.read_text() for path in sorted((SOURCE / "tests" / "mpi").glob("*_test.cpp")))
        page = (SOURCE / "doc" / "verification.md").read_text()
        found = 0
        for body in re.split(r"^TEST\(", text, flags=re.MULTILINE)[1:]:
            suite, name = re.match(r"(\w+), (\w+)\)", body).groups()
            if suite == "Ranks" and re.search(r"\d, 1e-\d+\);", body):
                found += 1
                self.assertTrue(f"`{suite}.{name}`" in page, f"{suite}.{name} has a bound of its own and no row")
        self.assertGreaterEqual(found, 7)


if __name__ == "__main__":
    unittest.main()
