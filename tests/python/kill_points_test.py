"""Runs, studies and screens that are killed at any change of a file: the file is readable, all finished runs are found again,
and nothing is refused."""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import BINARY, SOURCE, Computed  # noqa: E402

sys.path.insert(0, str(SOURCE / "scripts"))
import checked_results  # noqa: E402

# Ends the process before its KILL_AT-th change of a file.
SHIM = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/types.h>
#include <unistd.h>
static void count(void) {
  static long left = -1;
  if (left < 0) left = atol(getenv("KILL_AT"));
  if (--left == 0) kill(getpid(), SIGKILL);
  if (left == 0) left = 1L << 40;
}
#define REAL(name) count(); static __typeof__(&name) real; if (!real) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)
ssize_t pwrite64(int f, const void* d, size_t n, off64_t at) { REAL(pwrite64); return real(f, d, n, at); }
ssize_t pwrite(int f, const void* d, size_t n, off_t at) { REAL(pwrite); return real(f, d, n, at); }
int ftruncate64(int f, off64_t n) { REAL(ftruncate64); return real(f, n); }
int ftruncate(int f, off_t n) { REAL(ftruncate); return real(f, n); }
int posix_fallocate(int f, off_t a, off_t n) { REAL(posix_fallocate); return real(f, a, n); }
int rename(const char* a, const char* b) { REAL(rename); return real(a, b); }
int unlink(const char* a) { REAL(unlink); return real(a); }
"""
STUDY = """
beam: {spans: [20.0], EI: 8.0e9, mass: 8000.0, elements_per_span: 4}
load: {forces: [1.0e5], speed: 40.0}
ts: {dt: 5.0e-3}
study: {vary: {beam_mass: [7000.0, 7500.0, 8000.0]}}
output: {probes: [10.0]}
"""
STOCK = "name, spans, EI, mass, damping\na, 15, 4e9, 9e3, 0.01\nb, 20, 8e9, 9e3, 0.01\nc, 25, 2e10, 9e3, 0.01\n"
FLEET = "name; speed; spacing; load_t\none; 250 km/h; 0; 15\none; 250 km/h; 2.5; 15\n"
LIMITS = "- {clause: A, quantity: deck_acceleration, value: 3.5}\n"
SCREEN = "scene: {analysis: screen}\nscreen: {stock: stock.csv, fleet: fleet.csv, speeds: [40 km/h, 100 km/h, 20 km/h]}\n" \
         "limits: limits.yml\n"


@unittest.skipUnless(shutil.which("cc"), "there is no C compiler")
class Killed(Computed):
    @classmethod
    def prepare(cls):
        (cls.folder / "shim.c").write_text(SHIM)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", "shim.so", "shim.c"], cwd=cls.folder, check=True)
        for name, text in (("stock.csv", STOCK), ("fleet.csv", FLEET), ("limits.yml", LIMITS)):
            (cls.folder / name).write_text(text)
        cls.compute("study", STUDY)
        cls.compute("screen", SCREEN)

    def run_once(self, *words, kill_at=None):
        """Whether the run has ended by itself, and its output; any other end than that or the kill is a failure."""
        own = dict(os.environ)
        if kill_at:
            own |= {"LD_PRELOAD": str(self.folder / "shim.so"), "KILL_AT": str(kill_at)}
        done = subprocess.run([BINARY, *words], cwd=self.folder, env=own, capture_output=True, text=True, timeout=600)
        self.assertIn(done.returncode, (0, -signal.SIGKILL), done.stderr)
        return done.returncode == 0, done.stdout

    def clear(self):
        for path in self.folder.glob("r.h5*"):
            path.unlink()

    def kills(self, begin, words, step):
        """Kills the command at every `step`-th change of a file. begin: puts the file in its place first."""
        at = 1
        while True:
            self.clear()
            begin()
            if self.run_once(*words, kill_at=at)[0]:
                break
            yield at
            at += step
        self.assertGreater(at, 2 * step)

    def kill_points(self, begin, words, finished, step):
        """Resumes each killed command. finished(output): the number of runs that the resumed command has found."""
        for at in self.kills(begin, words, step):
            yield at, finished(self.run_once(*words)[1])

    def test_samples_of_a_run_stay_readable(self):
        (self.folder / "run.yml").write_text(STUDY.partition("study:")[0] + "output: {probes: [10.0]}\n")
        most = 0
        for at in self.kills(lambda: None, ("-options_file", "run.yml", "-output_file", "r.h5"), 11):
            path = self.folder / "r.h5"
            if not path.exists() or path.stat().st_size == 0:
                continue
            checked_results.check(path)
            with h5py.File(path) as file:
                rows = len(file["time"])
                self.assertTrue((np.diff(file["time"][:]) > 0.0).all(), at)
                self.assertGreaterEqual(len(file["probes/deflection"]), rows)
            self.assertGreaterEqual(rows, most, at)  # samples that were written are never lost again
            most = rows
        self.assertGreater(most, 10)

    def copy(self, name):
        return lambda: shutil.copy(self.folder / f"{name}.h5", self.folder / "r.h5")

    def known(self, output):
        return next((int(line.split()[0]) for line in output.splitlines() if "are read from the existing" in line), 0)

    def test_a_resumed_study_finds_all_runs(self):
        words = ("-options_file", "study.yml", "-output_file", "r.h5", "-study_resume", "-study_vary_beam_mass",
                 "7000,7500,8000,9000")
        for at, known in self.kill_points(self.copy("study"), words, self.known, 19):
            self.assertGreaterEqual(known, 3, at)
        with h5py.File(self.folder / "r.h5") as file, h5py.File(self.folder / "study.h5") as whole:
            self.assertTrue((file["study/finished"][:] == 1.0).all())
            self.assertTrue(np.array_equal(file["study/peak_deflection"][:3], whole["study/peak_deflection"]))

    def test_a_study_is_resumed_wherever_it_was_killed(self):
        words = ("-options_file", "study.yml", "-output_file", "r.h5", "-study_resume")
        before = 0
        for at, known in self.kill_points(lambda: None, words, self.known, 13):
            self.assertGreaterEqual(known, before, at)  # finished runs are never lost again
            before = known
        self.assertEqual(before, 3)

    def test_screens_and_sweeps_begin_again(self):
        (self.folder / "sweep.yml").write_text(STUDY.partition("study:")[0] + "sweep: {speed: [30, 40, 5]}\n")
        for words in (("-options_file", "screen.yml", "-screen_resume"), ("-options_file", "sweep.yml")):
            for _ in self.kill_points(lambda: None, (*words, "-output_file", "r.h5"), len, 37):
                with h5py.File(self.folder / "r.h5") as file:
                    self.assertEqual(file["summary"].attrs["ended"], "reached its end")


if __name__ == "__main__":
    unittest.main()
