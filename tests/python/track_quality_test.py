"""scripts/track_quality.py on profiles whose roughness is known, and on a profile that the program has generated."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BINARY = os.environ.get("TRAVERSE_BINARY", str(SOURCE / "build" / "traverse"))
sys.path.insert(0, str(SOURCE / "scripts"))
import track_quality  # noqa: E402

SPACING = 0.05
X = SPACING * np.arange(40000)

# The matrices of a step and the vectors of the input that M. W. Sayers, T. D. Gillespie and W. D. O. Paterson, Guidelines
# for conducting and calibrating road roughness measurements, World Bank Technical Paper 46 (1986), have for two distances.
PUBLISHED = {
    0.1: ([[.9994014, 4.442351e-3, 2.188854e-4, 5.72179e-5], [-.2570548, .975036, 7.966216e-3, 2.458427e-2],
           [3.960378e-3, 3.814527e-4, .9548048, 4.055587e-3], [1.687312, .1638951, -19.34264, .7948701]],
          [3.793992e-4, .2490886, 4.123478e-2, 17.65532]),
    0.25: ([[.9966071, 1.091514e-2, -2.083274e-3, 3.190145e-4], [-.5563044, .9438768, -.8324718, 5.064701e-2],
            [2.153176e-2, 2.126763e-3, .7508714, 8.221888e-3], [3.335013, .3376467, -39.12762, .4347564]],
           [5.476107e-3, 1.388776, .2275968, 35.79262])}

SCENE = """
track: {profile: iso8608_B, wavelengths: [0.5, 50.0], seed: 3}
vehicle:
  mass:
    bodies: [axle]
    wheels: [wheel]
    drivers: [level]
    axle: {mass: 1.0e3, inertia: 1.0, position: [0.0, 0.5]}
    wheel: {body: axle, radius: 0.3, law: linear, stiffness: 1.0e6}
    level: {body: axle, coordinate: phi}
train: {vehicles: mass, positions: 0.0, speed: 80.0}
ts: {max_time: 5.0, dt: 5.0e-4}
output: {profile: auto, interval: 0.01}
"""


def gain(wavelength):
    """Mean rectified slope between axle and body over the slope's amplitude, for a sine: by the frequency response of the
    quarter car of Sayers (1995), and of the mean over 0.25 m."""
    s = 2j * np.pi / wavelength * 80.0 / 3.6
    body = np.array([[s**2 + 6.0 * s + 63.3, -6.0 * s - 63.3],
                     [-6.0 * s - 63.3, 0.15 * s**2 + 6.0 * s + 63.3 + 653.0]])
    sprung, axle = np.linalg.solve(body, [0.0, 653.0])
    return 2.0 / np.pi * abs(axle - sprung) * abs(np.sinc(0.25 / wavelength))


def rough(density, exponent, seed):
    """A profile with the density Gd(n0) (m3) and this exponent, for waves of 0.15 to 200 m."""
    n = np.geomspace(0.005, 6.7, 3000)
    middle, random = np.sqrt(n[1:] * n[:-1]), np.random.default_rng(seed)
    height = np.zeros_like(X)
    for wave, amplitude in zip(middle, np.sqrt(2.0 * density * (middle / 0.1)**-exponent * np.diff(n))):
        height += amplitude * np.cos(2.0 * np.pi * (wave * X + random.uniform()))
    return height


class Roughness(unittest.TestCase):
    def test_published_matrices(self):
        """Single precision: seven digits of the matrices, and of the vectors less, because terms cancel."""
        for spacing, (matrix, vector) in PUBLISHED.items():
            found = track_quality.transition(spacing)
            np.testing.assert_allclose(found[0], matrix, rtol=2e-6)
            np.testing.assert_allclose(found[1], vector, rtol=2e-5, atol=4e-7)

    def test_sines(self):
        """The steady part of the response; straight lines between stations lose the square of their share of a wave."""
        for wavelength in (2.0, 5.0, 10.0, 15.0, 50.0):
            with self.subTest(wavelength):
                steps = round(wavelength / SPACING) * max(1, round(100.0 / wavelength))
                found = track_quality.rectified_slopes(np.sin(2.0 * np.pi * X / wavelength), SPACING)
                exact = gain(wavelength) * 2.0 * np.pi / wavelength
                self.assertAlmostEqual(np.mean(found[10000:10000 + steps]) / exact, 1.0,
                                       delta=2.0 * (SPACING / wavelength)**2 + 1e-4)

    def test_distance_of_the_stations(self):
        """Stations 0.25 m apart and less have about the same index."""
        height = rough(16e-6, 2.0, 1)
        fine = np.mean(track_quality.rectified_slopes(height, SPACING))
        self.assertAlmostEqual(np.mean(track_quality.rectified_slopes(height[::5], 5 * SPACING)) / fine, 1.0, delta=0.03)

    def test_bands(self):
        """The gain of a Butterworth filter of order 4 at each end."""
        for wavelength in (1.0, 3.0, 10.0, 25.0, 40.0, 70.0, 200.0):
            for shortest, longest in track_quality.BANDS.values():
                exact = 1.0 / np.sqrt((1.0 + (shortest / wavelength)**8) * (1.0 + (wavelength / longest)**8))
                found = track_quality.in_band(np.sin(2.0 * np.pi * X / wavelength), SPACING, shortest, longest)
                self.assertAlmostEqual(np.sqrt(2.0) * np.std(found[4000:36000]), exact, delta=2e-3)

    def test_classes(self):
        for name, density in zip("ABCDEFGH", 16e-6 * 4.0**np.arange(8)):
            for factor in (0.51, 1.0, 1.99):
                if (name, factor) != ("A", 0.51):
                    self.assertEqual(track_quality.class_of(density * factor), name)
        for exponent in (2.0, 2.6):
            found = track_quality.spectrum_of(rough(64e-6, exponent, 2), SPACING)
            self.assertAlmostEqual(found.exponent, exponent, delta=0.1)
        found = track_quality.spectrum_of(rough(64e-6, 2.0, 2), SPACING)
        self.assertAlmostEqual(found.density / 64e-6, 1.0, delta=0.1)
        self.assertIsNone(track_quality.spectrum_of(rough(64e-6, 2.0, 2)[:400], SPACING))


class Program(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def command(self, *words):
        return subprocess.run([str(word) for word in words], capture_output=True, text=True, cwd=self.folder)

    def run_on(self, path, *words):
        return self.command(sys.executable, "-B", SOURCE / "scripts" / "track_quality.py", path, *words)

    def table(self, text):
        path = self.folder / "profile.csv"
        path.write_text(text)
        return path

    def test_generated_profile(self):
        """Results file and exported table have the same lines, and the class of the spectrum."""
        (self.folder / "scene.yml").write_text(SCENE)
        done = self.command(BINARY, "-options_file", "scene.yml", "-output_file", "run.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.command(sys.executable, "-B", SOURCE / "scripts" / "export.py", "run.h5", "--series", "track/profile")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        of_results = self.run_on("run.h5", "--from", "25")
        self.assertEqual((of_results.returncode, of_results.stderr), (0, ""))
        self.assertEqual(self.run_on("track_profile.csv", "--from", "25").stdout, of_results.stdout)
        self.assertIn("class B", of_results.stdout)
        rows = [line.split() for line in of_results.stdout.splitlines()[1:5]]
        self.assertEqual([len(row) for row in rows], [5] * 4)
        self.assertAlmostEqual(np.mean([float(row[2]) for row in rows[:3]]), float(rows[3][2]), delta=0.1)
        again = self.command(BINARY, "-options_file", "scene.yml", "-output_file", "again.h5", "-track_profile",
                             "track_profile.csv", "-track_profile_shape", "spline")
        self.assertEqual(again.returncode, 0, again.stderr)
        forces = []
        for name in ("run.h5", "again.h5"):
            with h5py.File(self.folder / name) as file:
                forces.append(file["vehicles/0/wheel/normal_force"][:])
        self.assertLess(np.max(np.abs(forces[1] - forces[0])), 1e-4 * np.max(np.abs(forces[0])))

    def test_uneven_rows(self):
        x = np.delete(np.arange(0.0, 200.0, 0.1), [500, 900])
        done = self.run_on(self.table("x [m]; height [m]\n" + "".join(f"{a:.4f}; {1e-3 * np.sin(a):.12g}\n" for a in x)))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("not evenly spaced: straight lines between them, every 0.1 m", done.stdout)

    def test_what_a_short_profile_has(self):
        done = self.run_on(self.table("".join(f"{0.8 * i:.1f} {0.001 * (i % 3)}\n" for i in range(30))))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for part in ("no IRI: the stations are 0.8 m apart", "no D1: it needs 50 m", "no D2", "no class of ISO 8608"):
            self.assertIn(part, done.stdout)

    def test_refusals(self):
        rows = "".join(f"{0.1 * i:.1f},{0.001 * (i % 7)}\n" for i in range(100))
        for text, words, part in (("", [], "has 0 rows"), (rows + "x,y\n", [], "profile.csv:101: allowed: x and height"),
                                  ("x (mm),h (mm)\n" + rows, [], "profile.csv:1: allowed"), (rows + "1;2,5\n", [], ":101:"),
                                  (rows + "nan,1\n", [], "not finite"), (rows + "1.0,0.0\n", [], "does not increase"),
                                  (rows, ["--length", "0"], "--length 0: allowed: above 0"),
                                  (rows, ["--length", "0.01"], "at least the distance of the stations"),
                                  (rows, ["--from", "9.5"], "has 5 rows there"), (rows, ["--train", "up"], "--train")):
            with self.subTest(part):
                done = self.run_on(self.table(text), *words)
                self.assertEqual((done.returncode, done.stdout), (1, ""))
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(part, done.stderr)
        (self.folder / "no.h5").write_text("x")
        for path, part in (("none.csv", "No such file"), ("no.h5", "no results file"), (".", "no ordinary file")):
            done = self.run_on(path)
            self.assertEqual(done.returncode, 1)
            self.assertIn(part, done.stderr)


if __name__ == "__main__":
    unittest.main()
