"""What CTest knows of every test: labels, the lists that they come from, and how a run of all of them is summed up."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BUILD = pathlib.Path(os.environ["TRAVERSE_BINARY"]).parent
sys.path.insert(0, str(SOURCE / "tests"))
import discover  # noqa: E402

KINDS = {"unit", "verification", "invariance", "robustness", "mpi", "python", "benchmarks"}


def listed(*words):
    """{name: (command, labels)} of the tests that ctest would run; programs that are not built have none."""
    with tempfile.TemporaryDirectory() as folder:  # where CTest writes a log, which is not that of the run around this test
        pathlib.Path(folder, "CTestTestfile.cmake").write_text(f'subdirs("{BUILD}")\n', encoding="utf-8")
        text = subprocess.run(["ctest", "--test-dir", folder, "--show-only=json-v1", *words], check=True,
                              capture_output=True, text=True).stdout
    found = {}
    for test in json.loads(text)["tests"]:
        labels = [each["value"] for each in test["properties"] if each["name"] == "LABELS"]
        if not test["name"].endswith("_NOT_BUILT"):
            found[test["name"]] = test["command"], set(labels[0] if labels else [])
    return found


def cases(tests):
    """The names of all cases: those of a GoogleTest program that one test runs together, and the tests that run none."""
    found = []
    for name, (command, _) in tests.items():
        chosen = [word.partition("=")[2] for word in command if word.startswith("--gtest_filter=")]
        kind = name.split(".")[0]
        found += [f"{kind}.{case}" for case in chosen[0].split(":")] if chosen else [name]
    return sorted(found)


class Labels(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.alone, cls.batches = listed(), listed("-C", "Batches")
        cls.rooms = {room for rooms in discover.rooms().values() for room in rooms}

    def test_every_test_has_its_kind_its_speed_and_its_rooms(self):
        for name, (_, labels) in (self.alone | self.batches).items():
            with self.subTest(name):
                self.assertIn(name.split(".")[0], labels & KINDS)
                self.assertEqual(len(labels & {"quick", "slow"}), 1)
                self.assertTrue(labels & self.rooms, "tests/rooms.txt does not name its file")

    def test_batches_run_the_same_cases(self):
        self.assertEqual(cases(self.batches), cases(self.alone))
        self.assertLess(len(self.batches), len(self.alone))

    def test_slow_tests_exist(self):
        built = {name.split(".")[0] for name in self.alone}
        named = {name for name in discover.slow_tests() if name.split(".")[0] in built}
        self.assertEqual(named, {name for name, (_, labels) in self.alone.items() if "slow" in labels})

    def test_the_list_of_rooms_names_every_file_and_rooms_that_exist(self):
        rooms = discover.rooms()
        files = {f"{path.parent.name}/{path.name}" for path in (SOURCE / "tests").glob("*/*_test.*")}
        self.assertEqual(set(rooms), files)
        for file, names in rooms.items():
            for room in names:
                self.assertTrue((SOURCE / "src" / room).is_dir() or (SOURCE / room).is_dir(), (file, room))


BATCH = """1/3 Testing: unit.band_test
1/3 Test: unit.band_test
Command: "/b/unit_tests" "--gtest_filter=Band.Solves:Band.Skips:Band.Differs/0:Band.Stops:Band.Waits"
[ RUN      ] Band.Solves
text without an end of line[       OK ] Band.Solves (1500 ms)
[ SECONDS  ] Band.Solves 0.25
[ RUN      ] Band.Skips
[  SKIPPED ] Band.Skips (0 ms)
[ RUN      ] Band.Differs/0
[  FAILED  ] Band.Differs/0, where GetParam() = 8-byte object <00-00> (2 ms)
[ RUN      ] Band.Stops
Test time =   2.00 sec
Test Failed.
"""
OTHERS = """2/3 Testing: python.rail_test
Command: "/usr/bin/python3" "rail_test.py"
Test time =  40.50 sec
Test Passed.
3/3 Testing: mpi.2_ranks.part_1
Command: "mpirun" "mpi_tests"
Test time =   1.00 sec
Test Failed.
"""
# As CTest 3.25 writes them: a test that skips itself, and one whose program does not exist.
SKIPPED = """2/3 Testing: python.page_test
Command: "/usr/bin/python3" "page_test.py"
Output:
Ran 0 tests in 0.004s
<end of output>
Test time =   0.18 sec
----------------------------------------------------------
Test Pass Reason:
Skip regular expression found in output. Regex=[Ran 0 tests in]
"python.page_test" end time: Nov 28 16:46 UTC
"""
MISSING = """Unable to find executable: /no/such
3/3 Testing: benchmark.lanes
Command: ""
Test time =   0.00 sec
Test Passed.
"""


class Summary(unittest.TestCase):
    def summary(self, text, *words):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "LastTest.log"
            if text:
                log.write_text(text, encoding="utf-8")
            return subprocess.run([sys.executable, "-B", str(SOURCE / "scripts/test_summary.py"), *words, str(log)],
                                  check=True, capture_output=True, text=True).stdout.splitlines()

    def test_cases_of_a_batch_count_by_themselves(self):
        lines = self.summary(BATCH + OTHERS)
        self.assertEqual(lines[-2:], ["1 skipped", "2 passed, 4 failed"])

    def test_a_case_that_a_crash_leaves_out_has_failed(self):
        failed = [line for line in self.summary(BATCH + OTHERS) if line.startswith("Failed")]
        self.assertEqual(failed, ["Failed: unit.Band.Differs/0", "Failed: unit.Band.Stops, which did not end",
                                  "Failed: unit.Band.Waits, which did not start", "Failed: mpi.2_ranks.part_1"])

    def test_a_test_that_skips_itself_has_not_failed(self):
        self.assertEqual(self.summary(BATCH + SKIPPED)[-2:], ["2 skipped", "1 passed, 3 failed"])

    def test_a_program_that_does_not_exist_has_failed(self):
        lines = self.summary(BATCH + MISSING)
        self.assertEqual(lines[-3:], ["Failed: benchmark.lanes, which did not start", "1 skipped", "1 passed, 4 failed"])

    def test_the_slowest_come_first(self):
        lines = self.summary(BATCH + OTHERS)
        self.assertEqual([line.split() for line in lines[1:4]],
                         [["40.5", "python.rail_test"], ["1.0", "mpi.2_ranks.part_1"], ["0.2", "unit.Band.Solves"]])

    def test_slow_are_those_without_which_the_others_take_so_long(self):
        self.assertEqual(self.summary(BATCH + OTHERS, "--slow", "2"), ["40.5 python.rail_test"])
        self.assertEqual(self.summary(BATCH + OTHERS, "--slow", "1"), ["40.5 python.rail_test", "1.0 mpi.2_ranks.part_1"])

    def test_nothing_was_run(self):
        self.assertEqual(self.summary(""), ["0 passed, 0 failed"])


if __name__ == "__main__":
    unittest.main()
