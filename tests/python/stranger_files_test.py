"""Files that are damaged or made by strangers: no signal, no wait, and nothing believed that is not so."""

import os
import pathlib
import resource
import signal
import struct
import subprocess
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import BINARY, Computed  # noqa: E402

FORCES = """
beam: {spans: [20.0], EI: 1.234e10, mass: 9.0e3, elements_per_span: 4}
load: {forces: [2.0e5], speed: 40.0}
output: {interval: 0.005}
ts: {dt: 0.005}
"""
ENDLESS = FORCES + "scene: {tail: 1.0e6}\n"
STUDY = FORCES + "study: {vary: {beam_mass: [8.0e3, 9.0e3, 1.0e4]}}\nmodel: {modes: 2}\n"
OPEN = "beam: {spans: [20.0], EI: 1.234e10, mass: 9.0e3}\nload: {forces: [2.0e5], speed: 40.0}\n"


class Files(Computed):
    def program(self, *words, **how):
        return subprocess.run([BINARY, *words], cwd=self.folder, capture_output=True, text=True, timeout=600, **how)

    def refused(self, part, *words, status=None):
        done = self.program(*words)
        self.assertIn(done.returncode, range(1, 127) if status is None else [status], (words, done.stderr))
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertTrue(done.stderr.startswith("traverse: "), done.stderr)
        self.assertIn(part, done.stderr)

    def bytes_of(self, name):
        return bytearray((self.folder / name).read_bytes())

    def write(self, name, content):
        (self.folder / name).write_bytes(content)


class ResultsFiles(Files):
    @classmethod
    def prepare(cls):
        cls.compute("run", FORCES)
        cls.compute("study", STUDY)
        cls.compute("part", FORCES, "-ts_max_steps", "60")

    def test_a_flipped_bit_of_a_text_is_refused(self):
        self.assertEqual(self.program("run.h5", "-describe").returncode, 0)
        content = self.bytes_of("run.h5")
        for text in (b"1.234e10", b"[20.0]", b"load_speed"):
            at = content.find(text)
            self.assertGreater(at, 0, text)
            while at > 0:
                flipped = bytearray(content)
                flipped[at + 3] ^= 1
                self.write("flipped.h5", flipped)
                done = self.program("flipped.h5", "-describe")
                if done.returncode == 0:  # a text that is for people alone: /options
                    self.assertIn("1.234e+10", done.stdout.replace("1.23e+10", "1.234e+10"))
                else:
                    self.assertIn("not those that were written", done.stderr)
                at = content.find(text, at + 1)

    def test_flipped_sizes_of_texts_end_by_no_signal(self):
        """A text of a length of its own: its length, the place of its heap, its number there."""
        content = self.bytes_of("run.h5")
        heaps = [at for at in range(0, len(content) - 4, 8) if content[at:at + 4] == b"GCOL"]
        places = [at for heap in heaps for at in range(4, len(content) - 16)
                  if content[at:at + 8] == struct.pack("<Q", heap)]
        self.assertGreater(len(places), 10)
        for at in places[::len(places) // 4]:
            for offset, bit in ((-1, 6), (-3, 4), (2, 1), (8, 5)):
                flipped = bytearray(content)
                flipped[at + offset] ^= 1 << bit
                self.write("flipped.h5", flipped)
                done = self.program("flipped.h5", "-describe")
                self.assertIn(done.returncode, range(0, 127), (at, offset, done.stderr))
                self.assertEqual(len(done.stderr.splitlines()), 0 if done.returncode == 0 else 1, done.stderr)

    def test_a_changed_row_of_a_study_is_not_gone_on_with(self):
        words = ["-options_file", "study.yml", "-study_resume", "-output_file"]
        self.write("again.h5", self.bytes_of("study.h5"))
        done = self.program(*words, "again.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("3 known before", done.stdout)
        with h5py.File(self.folder / "again.h5", "r+") as file:
            value = file["study/peak_deflection"][1, 0]
            file["study/peak_deflection"][1, 0] = np.nextafter(value, 1.0)
        self.refused("run 1 are not those that were written", *words, "again.h5")

    def test_changed_rows_are_not_taken_up(self):
        words = ["-options_file", "part.yml", "-restart", "part.h5.checkpoint", "-output_file", "next.h5"]
        whole = self.bytes_of("part.h5")
        with h5py.File(self.folder / "part.h5", "r+") as file:
            file["probes/deflection"][7, 0] *= 1.5
        self.refused("do not hold the rows that the checkpoint was written with", *words, status=4)
        self.assertFalse((self.folder / "next.h5").exists())
        self.write("part.h5", whole)
        self.assertEqual(self.program(*words).returncode, 0)

    def test_rows_in_another_file_are_not_written_to(self):
        """The same numbers, so that their digest is right, in a file that HDF5 would extend."""
        users = self.folder / "users.bin"
        whole = self.bytes_of("part.h5")
        with h5py.File(self.folder / "part.h5", "r+") as file:
            values = file["probes/deflection"][()]
            del file["probes/deflection"]
            layout, space = h5py.h5p.create(h5py.h5p.DATASET_CREATE), h5py.h5s.create_simple(values.shape, (
                h5py.h5s.UNLIMITED, *values.shape[1:]))
            layout.set_external(os.fsencode(users), 0, h5py.h5f.UNLIMITED)
            apart = h5py.h5d.create(file["probes"].id, b"deflection", h5py.h5t.NATIVE_DOUBLE, space, layout)
            apart.write(h5py.h5s.ALL, h5py.h5s.ALL, values)
        before = users.read_bytes()
        self.refused("do not hold the rows", "-options_file", "part.yml", "-restart", "part.h5.checkpoint", "-output_file",
                     "beside.h5", status=4)
        self.assertEqual(users.read_bytes(), before)
        self.write("part.h5", whole)

    def test_what_stands_in_other_files_is_not_read(self):
        with h5py.File(self.folder / "leading.h5", "w") as file:
            file["modes"] = h5py.ExternalLink("pipe.h5", "/modes")
            file["input/options"] = h5py.ExternalLink("pipe.h5", "/input/options")
        os.mkfifo(self.folder / "pipe.h5")  # it would be waited for
        (self.folder / "elsewhere.yml").write_text("bridge: {modes_file: leading.h5}\nload: {forces: [2.0e5], speed: 40.0}\n")
        self.refused("stand in other files", "-options_file", "elsewhere.yml", "-describe")
        self.refused("stand in other files", "leading.h5", "-describe")

    def test_modes_of_a_damaged_file(self):
        self.compute("modes", FORCES, "-scene_analysis", "modes", "-modes_count", "3")
        content = self.bytes_of("modes.h5")
        (self.folder / "given.yml").write_text("bridge: {modes_file: bad.h5}\nload: {forces: [2.0e5], speed: 40.0}\n")
        generator = np.random.default_rng(1)
        for at in generator.integers(48, len(content), 12):
            flipped = bytearray(content)
            flipped[at] ^= 1 << int(generator.integers(8))
            self.write("bad.h5", flipped)
            done = self.program("-options_file", "given.yml", "-describe")
            self.assertIn(done.returncode, range(0, 127), (at, done.stderr))
            self.assertEqual(len(done.stderr.splitlines()), 0 if done.returncode == 0 else 1, done.stderr)


class Choices(Files):
    def test_are_bound_to_their_scene_and_within_ranges(self):
        self.compute("open", OPEN)
        said = "stored choice for the same scene"
        self.assertIn(said, self.program("-options_file", "open.yml", "-output_file", "open.h5").stdout)
        kept, = (self.folder / ".traverse_choices").iterdir()
        whole = kept.read_bytes()
        words = ["-options_file", "open.yml", "-output_file", "open.h5", "-accuracy", "3e-3"]
        self.assertEqual(self.program(*words).returncode, 0)
        other, = [path for path in kept.parent.iterdir() if path != kept]
        mine = other.read_bytes()
        other.write_bytes(whole)  # of another accuracy
        self.assertNotIn(said, self.program(*words).stdout)
        for bad in (b"", whole[:40], mine + b"x", mine[:-1] + b"?"):
            other.write_bytes(bad)
            done = self.program(*words)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn(said, done.stdout)
            self.assertNotEqual(other.read_bytes(), bad)
        self.assertIn(said, self.program(*words).stdout)  # what was damaged has been replaced

    def test_links_and_pipes_in_their_place_stay(self):
        (self.folder / "links").mkdir()
        self.compute("links/open", OPEN)
        kept, = (self.folder / "links/.traverse_choices").iterdir()
        users = self.folder / "users.txt"
        users.write_text("mine")
        for put in (os.mkfifo, lambda path: path.symlink_to(users)):
            kept.unlink()
            put(kept)
            kind = kept.lstat().st_mode
            self.compute("links/open", OPEN)
            self.assertEqual(kept.lstat().st_mode, kind)
            self.assertEqual(users.read_text(), "mine")
            self.assertEqual(list(kept.parent.iterdir()), [kept])


class Limits(Files):
    """What the system lets a process take: one line, a status, results that can be read."""

    @classmethod
    def prepare(cls):
        (cls.folder / "endless.yml").write_text(ENDLESS, encoding="utf-8")

    def test_of_processor_time(self):
        done = self.program("-options_file", "endless.yml", "-output_file", "r.h5",
                            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (3, 3)))
        self.assertEqual(done.returncode, 128 + signal.SIGXCPU, done.stdout[-300:] + done.stderr)
        with h5py.File(self.folder / "r.h5") as file:
            self.assertGreater(len(file["time"]), 10)

    def test_of_the_size_of_files(self):
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_DFL)  # Python ignores it
            resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, 1_000_000))

        done = self.program("-options_file", "endless.yml", "-output_file", "s.h5", preexec_fn=limit)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("File too large", done.stderr)
        with h5py.File(self.folder / "s.h5") as file:
            self.assertGreater(len(file["time"]), 10)

    def test_of_standard_error(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([BINARY, "-no_such_option", "1"], cwd=self.folder, stdout=subprocess.PIPE, stderr=full)
        self.assertEqual(done.returncode, 2)


class PlainC(Files):
    """Calls that no program should make."""

    def test_null_and_closed(self):
        (self.folder / "scene.yml").write_text(FORCES, encoding="utf-8")
        library = str(pathlib.Path(BINARY).parent / "libtraverse.so")
        calls = f"""
import ctypes, math
c = ctypes.CDLL({library!r})
c.traverse_error.restype = ctypes.c_char_p
c.traverse_time.restype = c.traverse_end.restype = c.traverse_interval.restype = ctypes.c_double
c.traverse_quantities.restype = ctypes.c_size_t
words = (ctypes.c_char_p * 2)(b"-options_file", b"scene.yml")
holes = (ctypes.c_char_p * 2)(b"-options_file", None)
passage = ctypes.c_void_p()
there = ctypes.byref(passage)
assert c.traverse_open(2, words, None) == 2
assert c.traverse_open(2, None, there) == 2
assert c.traverse_open(-1, words, there) == 2
assert c.traverse_open(2, holes, there) == 2, c.traverse_error()
assert passage.value is None
assert c.traverse_open(2, words, there) == 0, c.traverse_error()
numbers = ctypes.c_double(1.0)
assert c.traverse_read(passage, None, ctypes.byref(numbers), ctypes.c_size_t(1)) == 2
assert c.traverse_read(passage, b"/probes/deflection", None, ctypes.c_size_t(1)) == 2
assert c.traverse_describe(passage, ctypes.c_size_t(0), None) == 2
assert c.traverse_set_body_force(passage, 0, None, numbers, numbers, numbers) == 2
c.traverse_close(None)
c.traverse_close(passage)
c.traverse_close(passage)
for gone in (passage, None):
    assert c.traverse_advance(gone, ctypes.c_double(0.1)) == 2
    assert c.traverse_read(gone, b"/probes/deflection", ctypes.byref(numbers), ctypes.c_size_t(1)) == 2
    assert c.traverse_set_beam_force(gone, numbers, numbers) == 2
    assert math.isnan(c.traverse_time(gone)) and c.traverse_quantities(gone) == 0
    assert b"passage is" in c.traverse_error()
assert c.traverse_open(2, words, there) == 0, c.traverse_error()
"""
        done = subprocess.run([sys.executable, "-c", calls], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
