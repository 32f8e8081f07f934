"""What the tests of the benchmark scripts share: a script run at its smallest size, its tables and its pictures."""

import csv
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BUILD = pathlib.Path(os.environ["TRAVERSE_BINARY"]).parent


def start(name, *words, more=()):
    """The finished process of benchmarks/NAME.py; more: of its environment."""
    command = [sys.executable, "-B", str(SOURCE / "benchmarks" / (name + ".py")), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, env=os.environ | dict(more))


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def start_smallest(self, name):
        return start(name, BUILD, self.folder, "--smallest")

    def run_smallest(self, name):
        """What the script prints; it ends without a complaint and leaves nothing but its tables and pictures."""
        done = self.start_smallest(name)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        for path in self.folder.iterdir():
            self.assertIn(str(path), done.stdout)
        return done.stdout

    def table(self, name, columns):
        """Rows of a CSV file that has these columns."""
        with open(self.folder / name, newline="") as file:
            reader = csv.DictReader(file)
            rows = list(reader)
        self.assertEqual(reader.fieldnames, columns)
        self.assertGreater(len(rows), 0)
        for row in rows:
            self.assertEqual(len(row), len(columns), row)
        return rows

    def assert_positive(self, rows, *columns):
        for row in rows:
            for column in columns:
                self.assertGreater(float(row[column]), 0.0, (column, row))

    def assert_errors(self, rows, column, bound):
        """Above 0, as no two ways of computing agree to the last bit, and below the bound; empty ones do not count."""
        values = [abs(float(row[column])) for row in rows if row[column] != ""]
        self.assertGreater(len(values), 0)
        self.assertGreater(min(values), 0.0)
        self.assertLess(max(values), bound, column)

    def assert_picture(self, name):
        data = (self.folder / name).read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", data[16:24])
        self.assertGreater(width * height, 200 * 1000)
        self.assertGreater(len(data), 10000)  # a blank one takes less
