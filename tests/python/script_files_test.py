"""Files that the scripts write and read: the same command works again, no other file is written, and files of strangers end
in a result or one line."""

import contextlib
import importlib
import io
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import zipfile
from unittest import mock

import h5py
import matplotlib.figure
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from module_scenes import traverse  # noqa: E402
from small_runs import CROSSING, SOURCE, Computed  # noqa: E402

SCRIPTS = SOURCE / "scripts"
sys.path.insert(0, str(SCRIPTS))
import checked_results  # noqa: E402
import input_files  # noqa: E402
import output_files  # noqa: E402

VERSION = f"Traverse {checked_results.VERSION}".encode()
MINE = b"mine, mine\n1,2\n"
# Each command with its outputs.
COMMANDS = {
    ("picture.py", "r.h5", "a.png"): ["a.png"],
    ("picture.py", "r.h5", "b.png", "--formats", "svg,pdf,csv"): ["b.svg", "b.pdf", "b.csv"],
    ("compare.py", "r.h5", "q.h5", "-o", "c.png"): ["c.png"],
    ("page.py", "r.h5", "p.html"): ["p.html"],
    ("animate.py", "r.h5", "-o", "g.gif", "--frames", "2"): ["g.gif"],
    ("animate.py", "r.h5", "--space-time", "s.png"): ["s.png"],
    ("fatigue.py", "r.h5", "--of", "probes/moment", "--csv", "f.csv"): ["f.csv"],
    ("export.py", "r.h5", "--series", "probes/moment"): ["probes_moment.csv"],
    ("export.py", "r.h5", "--xdmf"): ["r.xdmf", "r.xdmf.h5"],
    ("traverse-report", "r.h5", "-o", "report"): ["report.pdf", "report.xlsx"],
}


class Scripts(Computed):
    @classmethod
    def prepare(cls):
        cls.compute("r", CROSSING)
        cls.compute("q", CROSSING, "-load_speed", "30")

    def script(self, name, *words):
        """(exit status, output, message) of a script that runs in this process, which has imported its modules."""
        module = importlib.import_module(name.removesuffix(".py") if name.endswith(".py") else "traverse_report.main")
        out, error = io.StringIO(), io.StringIO()
        with mock.patch.object(sys, "argv", [str(SCRIPTS / name), *words]), contextlib.chdir(self.folder), \
                contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
            try:
                status = module.main() or 0
            except SystemExit as end:
                if isinstance(end.code, str):
                    print(end.code, file=sys.stderr)
                status = end.code if isinstance(end.code, int) else int(end.code is not None)
        return status, out.getvalue(), error.getvalue()

    def refused(self, part, name, *words):
        status, out, error = self.script(name, *words)
        self.assertIn(status, range(1, 127))
        self.assertEqual((len(error.splitlines()), out), (1, ""), error)
        self.assertIn(part, error)


class Written(Scripts):
    def test_the_same_command_works_again(self):
        for words, outputs in COMMANDS.items():
            with self.subTest(words=words):
                self.assertEqual(self.script(*words)[::2], (0, ""))
                kept = {}
                for name in outputs:  # a copy of the user remains as it is
                    self.names_its_version(self.folder / name)
                    os.link(self.folder / name, self.folder / f"other_{name}")
                    kept[name] = (self.folder / name).read_bytes()
                    os.chmod(self.folder / name, 0o640)
                self.assertEqual(self.script(*words)[::2], (0, ""))
                for name in outputs:
                    path, other = self.folder / name, self.folder / f"other_{name}"
                    self.assertEqual(other.read_bytes(), kept[name])
                    self.assertFalse(path.samefile(other))
                    self.assertEqual(path.stat().st_mode & 0o777, 0o640)
                    path.unlink()
        self.assertEqual(list(self.folder.glob(".traverse_*.*")), [])

    def names_its_version(self, path):
        """Every file but a table in CSV, whose first line is its head."""
        if path.suffix == ".h5":
            with h5py.File(path) as file:
                self.assertEqual(file.attrs["version"], checked_results.VERSION)
        elif path.suffix == ".xlsx":
            with zipfile.ZipFile(path) as book:
                self.assertIn(VERSION, book.read("docProps/core.xml"))
        elif path.suffix != ".csv":
            self.assertIn(VERSION, path.read_bytes(), path.name)

    def test_files_of_other_versions_are_replaced(self):
        words = ("page.py", "r.h5", "p.html")
        self.assertEqual(self.script(*words)[::2], (0, ""))
        path = self.folder / "p.html"
        content = path.read_bytes()
        for other in (b"Traverse", b"Traverse 1.23.4"):  # 0.1.0 did not write its version
            path.write_bytes(content.replace(VERSION, other))
            self.assertEqual(self.script(*words)[::2], (0, ""))
            self.assertEqual(path.read_bytes(), content)
        path.write_bytes(content.replace(VERSION, b"Traverse by me"))
        self.refused("p.html is there already", *words)
        path.unlink()

    def test_another_file_stays_as_it_is(self):
        for words, outputs in COMMANDS.items():
            for name in outputs:
                with self.subTest(words=words, name=name):
                    (self.folder / name).write_bytes(MINE)
                    self.refused(f"{name} is there already", *words)
                    self.assertEqual((self.folder / name).read_bytes(), MINE)
                    (self.folder / name).unlink()

    def test_a_disk_without_room_is_named(self):
        usual = resource.getrlimit(resource.RLIMIT_FSIZE)
        for words, outputs in COMMANDS.items():
            with self.subTest(words=words):
                resource.setrlimit(resource.RLIMIT_FSIZE, (20, usual[1]))
                try:
                    status, _, error = self.script(*words)
                finally:
                    resource.setrlimit(resource.RLIMIT_FSIZE, usual)
                self.assertIn(status, range(1, 127))
                self.assertRegex(error, rf"\A[\w.-]+: ({'|'.join(outputs)}): File too large\n\Z")
                self.assertFalse(any((self.folder / name).exists() for name in outputs))
        self.assertEqual(list(self.folder.glob(".traverse_*.*")), [])

    def test_a_signal_leaves_no_unfinished_file(self):
        words = [sys.executable, "-B", str(SCRIPTS / "animate.py"), "r.h5", "-o", "long.gif", "--frames", "2000"]
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number=number), subprocess.Popen(words, cwd=self.folder, stderr=subprocess.PIPE) as process:
                while process.poll() is None and not list(self.folder.glob(".traverse_*.gif")):
                    time.sleep(0.01)
                process.send_signal(number)
                self.assertEqual((process.stderr.read(), process.wait()), (b"", 128 + number))
                self.assertEqual(list(self.folder.glob(".traverse_*")), [])
                self.assertFalse((self.folder / "long.gif").exists())

    def test_a_signal_at_any_point_of_writing_leaves_no_unfinished_file(self):
        path, before, error = self.folder / "text.txt", {one: signal.getsignal(one) for one in output_files.SIGNALS}, sys.stderr
        point, passed = 0, None

        def at_one_point(*_):
            nonlocal passed
            passed += 1
            if passed == point:
                signal.raise_signal(signal.SIGTERM)
            return at_one_point

        def main():
            sys.settrace(at_one_point)
            output_files.write_text(path, "text\n")

        while passed is None or passed >= point:
            point, passed = point + 1, 0
            try:
                with self.assertRaises(SystemExit) as end:
                    output_files.run(main)
            finally:
                sys.settrace(None)
                sys.stderr = error
                for number, handler in before.items():
                    signal.signal(number, handler)
            self.assertIn(end.exception.code, (None, 128 + signal.SIGTERM))
            self.assertEqual(list(self.folder.glob(".traverse_*")), [], point)
            path.unlink(missing_ok=True)
        self.assertGreater(point, 100)

    def test_a_page_has_the_ending_of_a_page(self):
        self.refused("p.png: allowed: .html, .htm", "page.py", "r.h5", "p.png")

    def test_no_link_is_followed(self):
        users, path, words = self.folder / "users", self.folder / "a.png", ("picture.py", "r.h5", "a.png")
        path.symlink_to("users")
        self.refused("a.png is a link", *words)
        self.assertFalse(users.exists())
        users.write_bytes(MINE)
        self.refused("a.png is a link", *words)
        path.unlink()
        os.link(users, path)
        self.refused("a.png is there already", *words)
        path.unlink()
        path.mkdir()
        self.refused("a.png is no ordinary file", *words)
        path.rmdir()
        os.mkfifo(path)
        self.refused("a.png is no ordinary file", *words)
        path.unlink()
        self.assertEqual(users.read_bytes(), MINE)

    def test_an_input_stays_as_it_is(self):
        before = (self.folder / "r.h5").read_bytes()
        (self.folder / "r.png").unlink(missing_ok=True)
        os.link(self.folder / "r.h5", self.folder / "r.png")
        for words in (("picture.py", "r.h5", "r.png"), ("page.py", "r.h5", "r.h5"), ("page.py", "r.h5", "./r.png"),
                      ("compare.py", "r.h5", "q.h5", "-o", "r.png"), ("compare.py", "q.h5", "r.h5", "-o", "r.png"),
                      ("animate.py", "r.h5", "-o", "r.png"), ("animate.py", "q.h5", "--space-time", "r.png"),
                      ("fatigue.py", "r.h5", "--of", "probes/moment", "--csv", "r.h5")):
            with self.subTest(words=words):
                self.refused("r.", *words)
                self.assertEqual((self.folder / "r.h5").read_bytes(), before)
        (self.folder / "r.png").unlink()

    def test_a_picture_of_traverse_is_no_results_file(self):
        self.assertEqual(self.script("picture.py", "r.h5", "own.png")[0], 0)
        before = (self.folder / "own.png").read_bytes()
        self.refused("own.png", "picture.py", "own.png", "own.png")
        self.assertEqual((self.folder / "own.png").read_bytes(), before)

    def test_a_results_file_is_no_data_of_an_export(self):
        name = self.folder / "q.xdmf.h5"
        name.write_bytes((self.folder / "r.h5").read_bytes())
        self.refused("q.xdmf.h5 is there already", "export.py", "q.h5", "--xdmf")
        name.unlink()

    def test_pictures_of_other_programs_stay(self):
        figure = matplotlib.figure.Figure()
        for kind in ("png", "svg", "pdf"):
            figure.savefig(self.folder / f"users.{kind}")
            self.refused(f"users.{kind} is there already", "picture.py", "r.h5", f"users.{kind}")

    def test_a_table_with_the_head_of_another_command_stays(self):
        self.assertEqual(self.script("fatigue.py", "r.h5", "--of", "probes/moment", "--csv", "t.csv")[0], 0)
        before = (self.folder / "t.csv").read_bytes()
        self.refused("t.csv is there already", "picture.py", "r.h5", "t.csv")
        self.assertEqual((self.folder / "t.csv").read_bytes(), before)


class Cells(unittest.TestCase):
    def test_no_text_is_a_formula(self):
        for text in ("=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1", "\r=1"):
            self.assertEqual(output_files.plain_cell(text), "'" + text)
        for value in ("-2.5e3", "+1", "-inf", "nan", "name", "", -3.0, 7):
            self.assertEqual(output_files.plain_cell(value), value)


class Results(Scripts):
    """Results files that are damaged, or lead to others."""

    READERS = [("picture.py", "bad.h5", "out.png"), ("compare.py", "r.h5", "bad.h5", "-o", "out.png"),
               ("export.py", "bad.h5", "-o", "out"), ("page.py", "bad.h5", "out.html"), ("animate.py", "bad.h5"),
               ("fatigue.py", "bad.h5", "--of", "probes/moment"), ("comfort.py", "bad.h5"),
               ("traverse-report", "bad.h5", "-o", "out")]

    def all_refuse(self, part):
        for words in self.READERS:
            with self.subTest(words=words):
                self.refused(part, *words)
        with self.assertRaisesRegex(traverse.Error, part):
            traverse.open(self.folder / "bad.h5")
        self.assertEqual(list(self.folder.glob("out.*")), [])

    def copy(self):
        (self.folder / "bad.h5").unlink(missing_ok=True)
        (self.folder / "bad.h5").write_bytes((self.folder / "r.h5").read_bytes())
        return h5py.File(self.folder / "bad.h5", "r+")

    def test_parts_in_other_files_are_not_read(self):
        with self.copy() as file:
            del file["probes/moment"]
            file["probes/moment"] = h5py.ExternalLink("q.h5", "/probes/moment")
        self.all_refuse("parts in other files")
        users = self.folder / "users.bin"
        users.write_bytes(np.arange(1000.0).tobytes())
        with self.copy() as file:
            shape = file["probes/moment"].shape
            del file["probes/moment"]
            file.create_dataset("probes/moment", shape, "f8", external=[(os.fsencode(users), 0, h5py.h5f.UNLIMITED)])
        self.all_refuse("parts in other files")
        with self.copy() as file:
            shape = file["probes/moment"].shape
            del file["probes/moment"]
            layout = h5py.VirtualLayout(shape, "f8")
            layout[...] = h5py.VirtualSource(self.folder / "q.h5", "probes/moment", shape)
            file.create_virtual_dataset("probes/moment", layout)
        self.all_refuse("parts in other files")

    def test_what_is_no_file_is_not_waited_for(self):
        (self.folder / "bad.h5").unlink(missing_ok=True)
        os.mkfifo(self.folder / "bad.h5")
        self.all_refuse("no results file that can be read")
        (self.folder / "bad.h5").unlink()
        for target in ("/dev/zero", "bad.h5", "nowhere"):
            (self.folder / "bad.h5").symlink_to(target)
            self.all_refuse("no results file that can be read")
            (self.folder / "bad.h5").unlink()

    def test_numbers_of_no_bytes_take_no_memory(self):
        with self.copy() as file:
            del file["probes/moment"]
            file.create_dataset("probes/moment", (10**11, 1), "f8", chunks=(1024, 1))
        self.all_refuse("no results file that can be read")

    def test_damaged_texts_end_no_process(self):
        content = (self.folder / "r.h5").read_bytes()
        heaps = [at for at in range(0, len(content) - 4, 8) if content[at:at + 4] == b"GCOL"]
        generator = np.random.default_rng(1)
        bad = self.folder / "bad.h5"
        bad.unlink(missing_ok=True)
        for at in [heap + int(generator.integers(4096)) for heap in heaps for _ in range(6)]:
            flipped = bytearray(content)
            flipped[at] ^= 1 << int(generator.integers(8))
            bad.write_bytes(flipped)
            with contextlib.suppress(checked_results.ResultsError):
                checked_results.check(bad)

    def test_data_of_another_form_are_one_line(self):
        with self.copy() as file:
            del file["time"], file["probes/x"]
            file["time"] = "now"
            file["probes/x"] = np.zeros((2, 2, 2))
        for words in self.READERS:
            with self.subTest(words=words):
                status, _, error = self.script(*words)
                self.assertEqual(len(error.splitlines()), 0 if status == 0 else 1, error)
        for path in self.folder.glob("out.*"):
            path.unlink()


class Texts(unittest.TestCase):
    def test_only_ordinary_files_of_a_limited_size(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            os.mkfifo(folder / "pipe")
            (folder / "self").symlink_to("self")
            (folder / "long").write_text("a" * 100)
            (folder / "latin").write_bytes(b"a: 1\nb: \xe4\n")
            (folder / "twice").write_text("a: 1\nb: {c: 1, c: 2}\n")
            for file, words in (("pipe", "no ordinary file"), ("/dev/zero", "no ordinary file"), (".", "no ordinary"),
                                ("self", "symbolic links"), ("long", "too large"), ("latin", "latin:2: is no text")):
                with self.assertRaisesRegex(input_files.InputError, words):
                    input_files.text_of(folder / file, 99)
            with self.assertRaisesRegex(input_files.InputError, "twice:2: c is given twice"):
                input_files.yaml_of(folder / "twice", "list")


if __name__ == "__main__":
    unittest.main()
