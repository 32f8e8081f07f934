"""scripts/convert.py modes: real files of CalculiX and MYSTRAN (tests/data/models), and the same modes in a universal file.

The .inp and .bdf files beside them are the inputs of these programs.
"""

import pathlib
import re
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from converted import MODELS, SKEW, SOURCE, Converting, dataset, universal_of  # noqa: E402
from converted import SKEW_TRACK as LEFT  # noqa: E402
from small_runs import BINARY  # noqa: E402
import convert_modes  # noqa: E402

SLAB, BEAM, PUNCH = MODELS / "skew_slab.frd", MODELS / "beam.frd", [MODELS / "skew_slab.pch", MODELS / "skew_slab.bdf"]
# The track on the other side of the middle of the slab.
RIGHT = [f"{-2.25 * SKEW:.4f},-2.25,0", f"{15.0 - 2.25 * SKEW:.4f},-2.25,0"]
IN_MM = ["--length", "mm", "--mass", "t"]
# Of the beam in beam.inp, in SI: Timoshenko's beam, simply supported.
SPAN, WIDTH, HEIGHT, E, RHO = 20.0, 0.5, 1.0, 3.0e10, 2500.0
EI, GA = E * WIDTH * HEIGHT**3 / 12.0, 5.0 / 6.0 * 0.5 * E * WIDTH * HEIGHT
MASS, INERTIA = RHO * WIDTH * HEIGHT, RHO * WIDTH * HEIGHT**3 / 12.0


def frequency_of(n):
    k = n * np.pi / SPAN
    a, b, c = INERTIA * MASS / GA, MASS + INERTIA * k**2 + EI * MASS * k**2 / GA, EI * k**4
    return np.sqrt((b - np.sqrt(b * b - 4.0 * a * c)) / (2.0 * a)) / (2.0 * np.pi)


def rows_of(path):
    """(words, numbers) of each line of a file of modes."""
    lines = [line.split(", ") for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return [([cell for cell in line if not cell[-1:].isdigit()], np.array([cell for cell in line if cell[-1:].isdigit()], float))
            for line in lines]


class Modes(Converting):
    def modes_of(self, *words, name="m.txt", damping=("--damping", "0.01")):
        """({word: numbers}, [stations with shapes of each track], output) of a converted file."""
        out = self.converted("modes", *words, *damping, "-o", self.folder / name)
        rows, tracks, outputs = {}, [], {}
        for line in (self.folder / name).read_text(encoding="utf-8").splitlines():
            first, *cells = line.split(", ")
            if line.startswith("#"):
                continue
            if first == "output":
                outputs[cells[0]] = (cells[1], np.array(cells[2:], dtype=float))
            elif first == "track":
                tracks.append([])
            elif first.isidentifier():
                rows[first] = np.array(cells, dtype=float)
            else:
                tracks[-1].append([float(first), *map(float, cells)])
        return rows | outputs, [np.array(track) for track in tracks], out

    def test_a_beam_has_the_frequencies_shapes_masses_and_moments_of_the_closed_form(self):
        rows, (track,), out = self.modes_of(BEAM, *IN_MM, "--track", "0,0,0", "20000,0,0", "--modes", 2, 4,
                                            "--output", "sagging=-STRESS:SYZ@11:N m", "--output", "middle=DISP:z@11")
        self.assertIn("20 m, 21 nodes on it", out)
        np.testing.assert_allclose(track[:, 0], np.linspace(0.0, 20.0, 21), rtol=1e-12)
        for n in (1, 2):
            self.assertAlmostEqual(rows["frequency"][n - 1] / frequency_of(n), 1.0, delta=1e-3 * n**2)
            exact = np.sin(n * np.pi * track[:, 0] / SPAN)
            shape = track[:, n] * (track[:, n] @ exact) / (track[:, n] @ track[:, n])
            np.testing.assert_allclose(shape, exact, atol=2e-3)
            # The modal mass of a sine is half of the beam's, for a shape of 1 m; rotation of the sections adds k^2 h^2 / 12.
            scaled = rows["modal_mass"][n - 1] / np.abs(track[:, n]).max()**2
            self.assertAlmostEqual(scaled / (0.5 * SPAN * (MASS + INERTIA * (n * np.pi / SPAN)**2)), 1.0, delta=5e-3)
        unit, moments = rows["sagging"]
        self.assertEqual(unit, "N m")
        self.assertAlmostEqual(-moments[0] / (EI * (np.pi / SPAN)**2 * rows["middle"][1][0]), 1.0, delta=1e-2)
        self.assertAlmostEqual(rows["middle"][1][0], track[10, 1], places=12)

    def test_deflections_under_a_moving_force_are_those_of_the_beam(self):
        """Two modes of CalculiX, and the program's own two modes of the same beam."""
        self.modes_of(BEAM, *IN_MM, "--track", "0,0,0", "20000,0,0", "--modes", 2, 4)
        scenes = {"beam": f"beam: {{spans: {SPAN}, EI: {EI}, mass: {MASS}, GA: {GA}, rotary_inertia: {INERTIA}, damping_ratios: 0.01}}\n"
                          "scene: {analysis: modes}\nmodes: {count: 2}\n"}
        for name, modes in (("given", "m.txt"), ("own", "beam.h5")):
            scenes[name] = (f"bridge: {{modes_file: {modes}}}\nload: {{forces: [2.0e5], speed: 40.0}}\n"
                            "output: {interval: 0.005, probes: [5.0, 10.0]}\nscene: {tail: 0.5}\n")
        for name, scene in scenes.items():
            (self.folder / f"{name}.yml").write_text(scene, encoding="utf-8")
            done = subprocess.run([BINARY, "-options_file", f"{name}.yml", "-output_file", f"{name}.h5"], cwd=self.folder,
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(self.folder / "given.h5") as given, h5py.File(self.folder / "own.h5") as own:
            one, other = given["probes/deflection"][()], own["probes/deflection"][()]
            np.testing.assert_allclose(given["time"][()], own["time"][()], atol=1e-12)
        self.assertLess(np.abs(one - other).max() / np.abs(other).max(), 4e-3)
        self.assertLess(other.min(), -1e-3)

    def test_a_skew_slab_of_two_programs_and_formats(self):
        """CalculiX and MYSTRAN agree on the first mode along both tracks; a universal file has the modes of CalculiX."""
        tracks = ["--track", *LEFT, "--track", *RIGHT]
        ccx, (left, right), out = self.modes_of(SLAB, MODELS / "skew_slab.dat", *tracks, "--output", "moment=SECTION:MY@MID")
        self.assertIn("15 m, ", out)
        punch, (other, _), _ = self.modes_of(*PUNCH, *tracks, "--modal-mass", 1, name="p.txt")
        self.assertAlmostEqual(ccx["frequency"][0] / punch["frequency"][0], 1.0, delta=2e-3)
        self.assertAlmostEqual(np.abs(left[:, 1]).max() / np.abs(other[:, 1]).max(), 1.0, delta=1e-2)
        for i, sign in ((1, 1.0), (2, -1.0)):  # the slab looks the same turned round
            np.testing.assert_allclose(right[::-1, i], sign * left[:, i], atol=0.02 * np.abs(left[:, i]).max())
        for turn, newer, mass in ((None, False, ()), (0.7, False, ("--modal-mass", 1)), (None, True, ()), (0.7, True, ())):
            path = self.write("s.unv", universal_of(SLAB, turn, newer))
            same, (again, _), _ = self.modes_of(path, *tracks, *mass, name=f"u{turn}{newer}.txt", damping=())
            np.testing.assert_allclose(same["frequency"], ccx["frequency"], rtol=1e-5)
            np.testing.assert_allclose(same["damping_ratio"], 0.02, rtol=1e-4)
            for i in (1, 2):
                sign = np.sign(again[:, i] @ left[:, i])
                np.testing.assert_allclose(sign * again[:, i], left[:, i], atol=1e-4 * np.abs(left[:, i]).max())
        # Of a strip without curvature across, M = EI phi'' (1 to 1 / (1 - nu^2)).
        unit, moment = ccx["moment"]
        plate = 3.4e10 * 10.0 * 0.8**3 / 12.0 * (np.pi / 15.0)**2 * np.abs(left[:, 1]).max()
        self.assertEqual(unit, "N m")
        self.assertGreater(abs(moment[0]) / plate, 0.8)
        self.assertLess(abs(moment[0]) / plate, 1.4)

    def test_the_modes_of_a_scene_are_those_of_its_model(self):
        """options/bridges/skew_slab.txt, by the command of doc/guide/convert.md."""
        page = (SOURCE / "doc/guide/convert.md").read_text(encoding="utf-8")
        command = re.search(r"scripts/convert.py (modes tests/data/models/skew_slab.frd .*? -o )skew_slab.txt", page, re.DOTALL)[1]
        words = [SOURCE / word if word.startswith("tests/") else word for word in command.replace("\\\n", " ").split()]
        self.converted(*words, self.folder / "s.txt")
        made, kept = rows_of(self.folder / "s.txt"), rows_of(SOURCE / "options/bridges/skew_slab.txt")
        self.assertEqual([words for words, _ in made], [words for words, _ in kept])
        for (_, numbers), (_, others) in zip(made, kept):
            np.testing.assert_allclose(numbers, others, atol=1e-6 * np.abs(others).max())

    def test_both_tracks_run_in_the_program(self):
        self.modes_of(SLAB, "--track", *LEFT, "--track", *RIGHT)
        peaks = []
        for track in (1, 2):
            scene = f"bridge: {{modes_file: m.txt, track: {track}}}\nload: {{forces: [2.0e5], speed: 40.0}}\noutput: {{probes: 7.5}}\n"
            (self.folder / "scene.yml").write_text(scene, encoding="utf-8")
            done = subprocess.run([BINARY, "-options_file", "scene.yml", "-output_file", f"{track}.h5"], cwd=self.folder,
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            with h5py.File(self.folder / f"{track}.h5") as file:
                peaks.append(file["probes/deflection"][()].min())
        self.assertLess(peaks[0], 0.0)
        self.assertAlmostEqual(peaks[1] / peaks[0], 1.0, delta=0.05)

    def test_interpolation_between_nodes(self):
        """Known shapes on a skew mesh, off its rows of nodes: relative errors, which fall with the mesh."""
        errors = []
        for across, along in ((8, 12), (16, 24), (32, 48)):
            x, y = (one.ravel() for one in np.meshgrid(np.linspace(0.0, 15.0, along + 1), np.linspace(-5.0, 5.0, across + 1)))
            shape = np.sin(np.pi * x / 15.0) * (1.0 + 0.06 * y)
            points = np.column_stack([x + y * SKEW, y, 0.0 * y])
            shapes = np.column_stack([0 * x, 0 * x, shape])[:, :, None]
            model = convert_modes.Model(np.arange(len(x)), points, [], shapes, 1.0, 1.0)
            track = convert_modes.track_of([f"{1.7 * SKEW},1.7,0", f"{15.0 + 1.7 * SKEW},1.7,0"], model, (2, 1.0))
            errors.append(np.abs(track.shapes[:, 0] - 1.102 * np.sin(np.pi * track.x / 15.0)).max())
        self.assertLess(errors[0], 5e-3)
        self.assertLess(errors[2], 2e-4)

    def test_up_and_supported_ends(self):
        down, (track,), _ = self.modes_of(BEAM, *IN_MM, "--track", 1, 21, "--modes", 2)
        _, (turned,), _ = self.modes_of(BEAM, *IN_MM, "--track", 1, 21, "--modes", 2, "--up", "-z", name="d.txt")
        np.testing.assert_allclose(turned[:, 1], -track[:, 1])
        _, (sideways,), _ = self.modes_of(BEAM, *IN_MM, "--track", 1, 21, "--modes", 1, "--up", "y", name="y.txt")
        self.assertGreater(np.abs(sideways[:, 1]).max(), 0.1)
        # Three sensors on a line, and supports beside them.
        sensors = dataset(15, [f"{i:10d}{0:10d}{0:10d}{0:10d}{5.0 * i:13.5E}{0.0:13.5E}{0.0:13.5E}" for i in (1, 2, 3)])
        head = ["NONE"] * 5 + [f"{1:10d}{2:10d}{2:10d}{8:10d}{2:10d}{3:10d}", f"{2:10d}{4:10d}{1:10d}{1:10d}",
                               f"{4.2:13.5E}{9e4:13.5E}{0.01:13.5E}{0.0:13.5E}"]
        values = [line for i, z in ((1, 0.7), (2, 1.0), (3, 0.7)) for line in (f"{i:10d}", f"{0.0:13.5E}{0.0:13.5E}{z:13.5E}")]
        path = self.write("test.unv", sensors + dataset(55, head + values))
        rows, (measured,), out = self.modes_of(path, "--track", "0,0,0", "20,0,0", "--supported-ends", name="s.txt", damping=())
        np.testing.assert_allclose(measured, [[0, 0], [5, 0.7], [10, 1], [15, 0.7], [20, 0]])
        self.assertEqual((rows["modal_mass"][0], rows["damping_ratio"][0]), (9e4, 0.01))
        self.assertIn("3 nodes on it, its ends at rest", out)
        self.refused("3 nodes within", "modes", path, "--track", "0,0,0", "20,0,0")

    def test_grid_entries(self):
        grids = (MODELS / "skew_slab.bdf").read_text()
        wide = []
        for line in grids.splitlines():
            cells = line.split(",")
            wide.append("GRID*   {:>16}{:>16}{:>16}{:>16}\n*       {:>16}".format(*cells[1:6]) if cells[0] == "GRID" else line)
        words = ["--track", *LEFT, "--modal-mass", 1]
        first = self.modes_of(*PUNCH, *words)[1][0]
        short = grids.replace(",5.0000,", ",.5+1,").replace(",-5.0000,", ",-5.D0,")
        for name, text in (("w.bdf", "\n".join(wide)), ("e.bdf", short)):
            again = self.modes_of(PUNCH[0], self.write(name, text), *words, name=f"{name}.txt")[1][0]
            np.testing.assert_allclose(again, first, rtol=1e-9, atol=1e-15)
        self.refused("node 1 has its positions in the coordinate system 7", "modes", PUNCH[0],
                     self.write("c.bdf", grids.replace("GRID,1,,", "GRID,1,7,")))
        self.refused("1 nodes have displacements but no coordinates, such as 7", "modes", PUNCH[0],
                     self.write("n.bdf", grids.replace("GRID,7,,", "$RID,7,,")))
        self.refused("no GRID entries; name the bulk data too", "modes", PUNCH[0])
        cut = PUNCH[0].read_text().splitlines()[:-10]
        self.refused("mode 3 has 40 nodes, other ones than the 45 of mode 1: the file is cut off", "modes", PUNCH[1],
                     self.write("c.pch", "\n".join(cut) + "\n"))

    def test_forces_of_elements_in_a_punch_file(self):
        """Cards of MSC Nastran for bars and shells: the moment of the model's units in N m."""
        lines = PUNCH[0].read_text().splitlines()
        head = [line for line in lines if line.startswith("$EIGENVALUE") and "MODE =     1" in line][0]
        cards = ["$TITLE   = X", "$SUBTITLE=", "$LABEL   =", "$ELEMENT FORCES", "$REAL OUTPUT", "$SUBCASE ID =           1",
                 "$ELEMENT TYPE =          34  BAR", head[:72], f"{7:10d}{'':8}{1.5:18.6E}{2.5:18.6E}{3.5:18.6E}",
                 f"-CONT-{'':12}{4.5:18.6E}{5.5:18.6E}{6.5:18.6E}", f"-CONT-{'':12}{7.5:18.6E}{8.5:18.6E}"]
        path = self.write("f.pch", "\n".join(lines + [f"{line:72}{i:8d}" for i, line in enumerate(cards)]) + "\n")
        words = [path, PUNCH[1], "--track", *LEFT, "--modes", 1, "--modal-mass", 1]
        rows, _, _ = self.modes_of(*words, "--output", "m=BAR:M1A@7", "--output", "n=-BAR:AF@7")
        self.assertEqual((rows["m"][0], rows["m"][1][0], rows["n"][0], rows["n"][1][0]), ("N m", 1.5, "N", -7.5))
        self.refused("BAR of mode 1 has M1A, M2A", "modes", *words, "--damping", 1e-2, "--output", "m=BAR:MY@7",
                     "-o", self.folder / "x.txt")

    def test_refusals(self):
        text, out = SLAB.read_text(), ["-o", self.folder / "x.txt", "--damping", "0.01", "--track", *LEFT]
        line = text.splitlines()[20]
        for content, part in ((text[:5000], ": the file ends here"), (text.replace(line + "\n", "", 1), "lines; by its head there are"),
                              (text.replace(line, line[:20] + "         NaN" + line[32:], 1), ":21: '"),
                              (re.sub("    2C                *93", f"    2C{999999999:30d}", text, count=1),
                               "by its head there are 999999999"),
                              (re.sub("2(    [1-8])MODAL", r"0\1OTHER", text), "no mode shapes"),
                              ("x,y\n1,2\n", "is no file of modes; allowed: a universal file")):
            with self.subTest(part):
                self.refused(part, "modes", self.write("bad.frd", content), *out)
        for words, part in ((["--track", "0,0,0", "1,0"], "--track 1,0: allowed: points x,y,z"),
                            (["--track", "0,0,0"], "at least two points"),
                            (["--track", "0,0,0", "99999"], "there is no node 99999"),
                            (["--track", "-9,0,0", "15,0,0"], "shapes are not continued beyond nodes"),
                            (["--track", "0,40,0", "15,40,0"], "0 nodes within 3 of it"),
                            (["--modes", "9"], "has no mode 9; it has 1, 2, 3"),
                            (["--damping", "0.1", "0.2"], "2 numbers for 8 modes"),
                            (["--output", "a=STRESS:SXX@1"], "mode 1 has DISP"),
                            (["--output", "a b=DISP:z@1"], "allowed: NAME=FIELD"),
                            (["--output", "a=DISP:z@1:kg"], "add its unit, :Pa, :N"),
                            (["--output", "a=DISP:z@9999"], "at 93 places: 1, 2, 3")):
            with self.subTest(part):
                self.refused(part, "modes", SLAB, *out, *words)
        self.refused("does not have the damping ratio of mode 1; give --damping", "modes", SLAB, "--track", *LEFT, *out[:2])
        self.refused("give --modal-mass, which is 1 for shapes normalised by the mass matrix", "modes", *PUNCH, *out)
        self.refused("-o needs --track", "modes", SLAB, "-o", self.folder / "x.txt")
        self.refused("mode 1 has 1.96199 Hz here, 6.92984 Hz in the results file", "modes", SLAB, MODELS / "beam.dat")
        mixed = universal_of(SLAB, 0.0).replace(" 0.00000E+00 ", " 1.00000E-03 ")
        self.refused("is complex", "modes", self.write("c.unv", mixed))
        for words in (["--length", "furlong"], ["--damping", "2"], ["--within", "nan"]):
            status, _, error = self.run_with("modes", SLAB, *words)
            self.assertEqual(status, 2)
            self.assertIn(f"argument {words[0]}: '{words[1]}'; allowed: ", error)
        self.assertFalse((self.folder / "x.txt").exists())


if __name__ == "__main__":
    import unittest
    unittest.main()
