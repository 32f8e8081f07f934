"""The version: CMakeLists.txt has it, and everything else agrees. Former names of options end in a version that is still to come."""

import re
import subprocess
import sys
import tempfile
import unittest
import pathlib

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from module_scenes import traverse  # noqa: E402
from small_runs import BINARY, BRIDGE, SOURCE  # noqa: E402


def text_of(name):
    return (SOURCE / name).read_text(encoding="utf-8")


VERSION = re.search(r"^project\(traverse VERSION (\d+\.\d+\.\d+)", text_of("CMakeLists.txt"), re.MULTILINE)[1]
NUMBERS = [int(number) for number in VERSION.split(".")]
# (former name, present name, version in which it ends)
FORMER = re.findall(r'OldName\{"(\w+)", "(\w+)", "([\d.]+)"\}', text_of("src/options/old_names.hpp"))


class Version(unittest.TestCase):
    def test_the_program_says_it_first(self):
        for word in ("-version", "--version"):
            lines = subprocess.run([BINARY, word], capture_output=True, text=True, check=True).stdout.splitlines()
            self.assertEqual(lines[0], f"traverse {VERSION}")
            for library in ("PETSc", "SLEPc", "HDF5"):
                self.assertEqual(len([line for line in lines if re.fullmatch(rf"{library} \d+\.\d+\.\d+", line)]), 1, lines)

    def test_the_library_and_python(self):
        from traverse.shared_library import library
        self.assertEqual(traverse.__version__, VERSION)
        self.assertEqual(library().traverse_version().decode(), VERSION)

    def test_documents(self):
        cited = yaml.safe_load(text_of("CITATION.cff"))
        section = re.search(r"^## \[(\S+)\] - (\S+)$", text_of("CHANGELOG.md"), re.MULTILINE)
        self.assertEqual((cited["version"], str(cited["date-released"])), section.groups())
        self.assertEqual(section[1], VERSION)
        self.assertEqual(re.findall(r'^    version\("([^"]+)"\)', text_of("packaging/spack/package.py"), re.MULTILINE)[0], VERSION)


class FormerNames(unittest.TestCase):
    def test_each_is_documented_and_has_time(self):
        self.assertEqual(len(FORMER), text_of("src/options/old_names.hpp").count("OldName{"))
        rows = re.findall(r"^\| `-(\w+)` \| `-(\w+)` \| ([\d.]+) \|$", text_of("doc/stability.md"), re.MULTILINE)
        self.assertEqual(rows, FORMER)
        for _, _, until in FORMER:
            self.assertGreater([int(number) for number in until.split(".")], NUMBERS)

    def test_each_is_read_with_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "a.yml")
            scene.write_text(BRIDGE + "load: {forces: 1.0e5, speed: 40.0}\n", encoding="utf-8")
            for former, present, until in FORMER:
                said = [subprocess.run([BINARY, "-options_file", scene, f"-{name}"], capture_output=True, text=True,
                                       check=True).stdout.splitlines() for name in (present, former)]
                note = [line for line in said[1] if f"{former} is the former name of {present}" in line]
                self.assertEqual(len(note), 1, said[1])
                self.assertIn(f"until version {until}", note[0])
                self.assertEqual([line for line in said[1] if line not in note], said[0])


if __name__ == "__main__":
    unittest.main()
