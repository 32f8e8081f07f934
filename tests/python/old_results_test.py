"""Files of earlier versions, in tests/data/results_VERSION: this version reads and repeats their results, still writes what they have, and
refuses their checkpoints. Results of a newer major version are refused in one line. doc/stability.md promises this.

The files were written by the program of that version and never since: a new folder is added for a version, none is changed."""

import lzma
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from module_scenes import traverse  # noqa: E402
from small_runs import BINARY, SOURCE  # noqa: E402

# The input and its model, which have the words of their version; and dimensions without values, as netCDF-4 has them.
NOT_COMPARED = re.compile(r"(input|model|options)(/|$)")
WITHOUT_VALUES = b"This is a netCDF dimension but not a netCDF variable."
SCRIPTS = {  # the command for each file; {} stands for the file
    "passage": ["traverse-report", "{}", "-o", "report"], "study": ["page.py", "{}", "page.html"],
    "modes": ["picture.py", "{}", "picture.png"], "sweep": ["export.py", "{}", "--xdmf", "-o", "xdmf"],
    "fit": ["export.py", "{}", "-o", "csv"], "screen": ["export.py", "{}", "-o", "csv"],
}


def items(file):
    """{path: object} of a file, with the root."""
    found = {"/": file}
    file.visititems(lambda name, item: found.setdefault(name, item) and None)
    return found


class OldResults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.folder, cls.files = pathlib.Path(holder.name), []
        for packed in sorted((SOURCE / "tests/data").glob("results_*/*.h5.xz")):
            path = cls.folder / packed.parent.name / packed.stem
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(lzma.decompress(packed.read_bytes()))
            cls.files.append(path)

    def run_in(self, folder, *words):
        return subprocess.run(words, cwd=folder, capture_output=True, text=True, env=os.environ | {"TRAVERSE_BINARY": str(BINARY)})

    def changed(self, path, version):
        """A copy of a file that another version says to have written."""
        copy = self.folder / f"by_{version}.h5"
        copy.write_bytes(path.read_bytes())
        with h5py.File(copy, "a") as file:
            file.attrs["version"] = version
        return copy

    def test_there_are_files_of_each_kind(self):
        self.assertEqual({path.stem for path in self.files}, set(SCRIPTS))

    def test_python_opens_them(self):
        for path in self.files:
            results = traverse.open(path)
            with self.subTest(file=path), h5py.File(path) as file:
                self.assertEqual(results.attrs["version"], path.parent.name.removeprefix("results_"))
                compared = 0
                for name, item in items(file).items():
                    variable = results.get(traverse.dataset.name_of(name))
                    if variable is None or "units" not in item.attrs or variable.attrs.get("units") != item.attrs["units"]:
                        continue
                    if variable.size == item.size and variable.dtype.kind == item.dtype.kind == "f":
                        np.testing.assert_array_equal(variable.values.ravel(), item[()].ravel(), name)
                        compared += 1
                self.assertGreater(compared, 0)

    def test_scripts_read_them(self):
        for path in self.files:
            script, *words = SCRIPTS[path.stem]
            with self.subTest(file=path, script=script):
                folder = path.with_suffix("")
                folder.mkdir()
                done = self.run_in(folder, SOURCE / "scripts" / script, *(word.format(path) for word in words))
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue([one for one in folder.rglob("*") if one.is_file() and one.stat().st_size > 0])

    def test_the_program_repeats_them_and_writes_what_they_have(self):
        for path in self.files:
            with self.subTest(file=path):
                again = self.folder / f"{path.stem}_again.h5"
                done = self.run_in(self.folder, BINARY, path, "-output_file", again)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                with h5py.File(path) as old, h5py.File(again) as new:
                    self.assertEqual(new.attrs["version"], traverse.__version__)
                    there, here = items(old), items(new)
                    for name, item in there.items():
                        if NOT_COMPARED.match(name) or item.attrs.get("NAME", b"").startswith(WITHOUT_VALUES):
                            continue
                        self.assertIn(name, here)
                        self.assertEqual(set(item.attrs) - set(here[name].attrs), set(), name)
                        if isinstance(item, h5py.Dataset):
                            self.assertEqual((item.attrs.get("unit"), item.dtype.kind, item.ndim, item.shape[1:]),
                                             (here[name].attrs.get("unit"), here[name].dtype.kind, here[name].ndim,
                                              here[name].shape[1:]), name)

    def test_the_program_reads_their_modes(self):
        modes = next(path for path in self.files if path.stem == "modes")
        done = self.run_in(self.folder, BINARY, "-bridge_modes_file", modes, "-load_forces", "1e5", "-load_speed", "40",
                           "-describe")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_their_checkpoints_are_refused(self):
        """Only the version that has written a checkpoint reads it: this file, and one of another layout."""
        packed = SOURCE / "tests/data/results_0.1.0/stopped.checkpoint.xz"
        content = lzma.decompress(packed.read_bytes())
        for name, text, part in (
                ("a.checkpoint", content, f"was written by version 0.1.0 of Traverse, this is {traverse.__version__}"),
                ("b.checkpoint", b"Traverse checkpoint 9" + content[21:], "is a checkpoint of another version")):
            (self.folder / name).write_bytes(text)
            done = self.run_in(self.folder, BINARY, "-beam_spans", "20", "-beam_EI", "1e10", "-beam_mass", "1e4",
                               "-load_forces", "2e5", "-load_speed", "40", "-output_file", "stopped.h5", "-restart", name)
            self.assertEqual(done.returncode, 4, done.stdout + done.stderr)
            self.assertIn(part, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_a_newer_major_version_is_refused(self):
        path = self.files[0]
        major = int(traverse.__version__.split(".")[0])
        newer, same = self.changed(path, f"{major + 1}.0.0"), self.changed(path, f"{major}.999.0")
        self.assertEqual(traverse.open(same).attrs["version"], f"{major}.999.0")
        message = f"was written by version {major + 1}.0.0 of Traverse, whose files version {traverse.__version__} cannot read"
        with self.assertRaisesRegex(traverse.Error, message):
            traverse.open(newer)
        for words in ([SOURCE / "scripts/export.py", newer, "--list"], [SOURCE / "scripts/traverse-report", newer, "-o", "x"],
                      [BINARY, newer, "-output_file", "y.h5"]):
            done = self.run_in(self.folder, *words)
            self.assertNotEqual(done.returncode, 0)
            self.assertRegex(done.stderr, message)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertFalse((self.folder / "y.h5").exists())


if __name__ == "__main__":
    unittest.main()
