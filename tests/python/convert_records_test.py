"""scripts/convert.py records: universal files and MATLAB files as tables, which the program reads."""

import csv
import pathlib
import subprocess
import sys

import numpy as np
from scipy.io import savemat

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from converted import Converting, dataset, head_58, rows, units_164, write_hdf5  # noqa: E402
from small_runs import BINARY  # noqa: E402

VALUES = np.array([-1.5, 2.25e-3, -3.125e4, 4.0, 5.5, -6.25, 7.0, 8.0])


class Records(Converting):
    def table(self, name="t.csv"):
        """(head, numbers) of a table."""
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            head, *lines = csv.reader(file)
        return head, np.array(lines, dtype=float)

    def of_universal(self, content, *words):
        out = self.converted("records", self.write("r.unv", content), "-o", self.folder / "t.csv", *words)
        return *self.table(), out

    def test_even_times_by_columns_and_by_blanks(self):
        """Negative numbers of 6E13.5 have no blank between them; other programs set blanks."""
        head = head_58(2, 8, 1, 0.5, 0.25)
        for data in (rows(VALUES, 13, 5, 6), ["  ".join(f"{value:.6g}" for value in VALUES)]):
            names, numbers, out = self.of_universal(dataset(58, head + data))
            self.assertEqual(names, ["time [s]", "acc 12 -Z [m/s2]"])
            np.testing.assert_allclose(numbers, np.column_stack([0.5 + 0.25 * np.arange(8), VALUES]), rtol=1e-12)
            self.assertIn("row 2, 'Girder, channel'", out)

    def test_numbers_without_blanks(self):
        cells = [f"{value:13.6E}" for value in -np.abs(VALUES)]
        _, numbers, _ = self.of_universal(dataset(58, head_58(2, 8, 1, 0.0, 0.1) + ["".join(cells[:6]), "".join(cells[6:])]))
        np.testing.assert_allclose(numbers[:, 1], -np.abs(VALUES))

    def test_uneven_times_and_double_precision(self):
        times = np.array([0.0, 0.1, 0.3, 0.35, 0.5, 0.9, 1.0, 1.5])
        pairs = np.column_stack([times, VALUES]).ravel()
        single = dataset(58, head_58(2, 8, 0) + rows(pairs, 13, 5, 6))
        double = dataset(58, head_58(4, 8, 0) + [f"{x:13.5E}{y:20.12E}{z:13.5E}{w:20.12E}" for x, y, z, w in pairs.reshape(4, 4)])
        for text in (single, double, dataset(58, head_58(4, 8, 0) + rows(pairs, 20, 12, 4)).replace("E+", "D+")):
            _, numbers, _ = self.of_universal(text)
            np.testing.assert_allclose(numbers, np.column_stack([times, VALUES]), rtol=1e-12)

    def test_binary(self):
        times = 0.25 * np.arange(8)
        both = np.rec.fromarrays([times.astype("f4"), VALUES], dtype=[("x", "f4"), ("y", "f8")])
        for order, sign in ((1, "<"), (2, ">")):
            for kind, even, data in ((2, 1, VALUES.astype(sign + "f4")), (4, 1, VALUES.astype(sign + "f8")),
                                     (2, 0, np.column_stack([times, VALUES]).astype(sign + "f4")),
                                     (4, 0, np.column_stack([times, VALUES]).astype(sign + "f8")),
                                     (4, 0, both.astype([("x", sign + "f4"), ("y", sign + "f8")]))):
                with self.subTest(order=order, kind=kind, even=even):
                    head = f"    58b{order:6d}{2:6d}{11:12d}{data.nbytes:12d}" + "     0     0           0           0"
                    lines = ["    -1", head, *head_58(kind, 8, even, 0.0, 0.25), ""]
                    content = "\r\n".join(lines).encode() + data.tobytes() + b"\r\n    -1\r\n"
                    _, numbers, _ = self.of_universal(content)
                    np.testing.assert_allclose(numbers, np.column_stack([times, VALUES]), rtol=1e-7)

    def test_units(self):
        """A label that is known wins; otherwise type and dataset 164 convert to SI; without both nothing is said."""
        data = rows(VALUES, 13, 5, 6)
        for units, label, quantity, head, factor in (
                (units_164(1000.0, 1.0), "NONE", 8, "acc 12 -Z [m]", 1e-3), (units_164(1000.0, 1.0), "g", 12, "acc 12 -Z [g]", 1.0),
                (units_164(39.37, 0.2248), "NONE", 9, "acc 12 -Z [N]", 1.0 / 0.2248), ("", "m/s^2", 12, "acc 12 -Z [m/s2]", 1.0),
                (units_164(1000.0, 1.0), "NONE", 2, "acc 12 -Z [Pa]", 1e6), ("", "NONE", 12, "acc 12 -Z", 1.0),
                ("", "m/s\u00b2", 12, "acc 12 -Z [m/s2]", 1.0)):
            with self.subTest(label=label, quantity=quantity):
                text = units + dataset(58, head_58(2, 8, 1, 0.0, 0.1, unit=label, quantity=quantity) + data)
                names, numbers, _ = self.of_universal(text)
                self.assertEqual(names[1], head)
                np.testing.assert_allclose(numbers[:, 1], factor * VALUES, rtol=1e-11)
                (self.folder / "t.csv").unlink()

    def test_channels_with_the_same_times_share_a_table(self):
        data = rows(VALUES, 13, 5, 6)
        text = dataset(151, ["anything"] * 7)
        for i, (step, entity) in enumerate(((0.1, "A"), (0.1, "B"), (0.2, "B"), (0.1, "B"))):
            text += dataset(58, head_58(2, 8, 1, 0.0, step, node=i, entity=entity) + data)
        text += dataset(58, head_58(2, 8, 1, 0.0, 0.1, function=4, abscissa=18) + data)
        names, _, out = self.of_universal(text)
        self.assertEqual(names, ["time [s]", "A -Z [m/s2]", "B 1 -Z [m/s2]", "B 3 -Z [m/s2]"])
        self.assertEqual(self.table("t_2.csv")[0], ["time [s]", "B 2 -Z [m/s2]"])
        self.assertIn("not read: row ", out)
        self.assertIn("frequency response function is no record over time", out)
        (self.folder / "t.csv").unlink()
        names, _, _ = self.of_universal(text, "--channels", "B 3 -Z", "B 1 -Z")
        self.assertEqual(names, ["time [s]", "B 1 -Z [m/s2]", "B 3 -Z [m/s2]"])
        self.refused("there is no channel C; there are A -Z, B 1 -Z", "records", self.folder / "r.unv", "--channels", "C")

    def test_matlab_files(self):
        times, two = 0.01 * np.arange(50), np.arange(100.0).reshape(50, 2)
        content = {"t": times, "acc": np.sin(times), "both": two, "fs": 100.0, "other": np.arange(7.0)}
        write_hdf5(self.folder / "h.mat", content)
        whole = {"run": content, "note": "text", "cells": np.array([1, "a"], dtype=object)}
        savemat(self.folder / "s.mat", whole)
        savemat(self.folder / "c.mat", content, do_compression=True)
        for name, prefix in (("h.mat", ""), ("s.mat", "run."), ("c.mat", "")):
            with self.subTest(name):
                out = self.converted("records", self.folder / name, "-o", self.folder / "m.csv", "--channels", f"{prefix}acc",
                                     f"{prefix}both_2")
                head, numbers = self.table("m.csv")
                self.assertEqual(head, ["time [s]", f"{prefix}acc", f"{prefix}both_2"])
                np.testing.assert_allclose(numbers, np.column_stack([times, np.sin(times), two[:, 1]]), rtol=1e-11)
                self.assertIn(f"not read: {prefix}other has 7 values for 50 times", out)
                (self.folder / "m.csv").unlink()
        self.refused("has no vector x; name it by --time, or give the samples a second by --rate; there are acc (50), ",
                     "records", self.folder / "h.mat", "--time", "x")
        savemat(self.folder / "n.mat", {"t": times, "acc": np.where(times > 0.2, np.nan, 1.0)})
        self.refused("acc: value 22 is no finite number", "records", self.folder / "n.mat")
        savemat(self.folder / "r.mat", {"acc": np.sin(times)})
        self.refused("has 0 vectors of times", "records", self.folder / "r.mat")
        self.converted("records", self.folder / "r.mat", "--rate", "200", "-o", self.folder / "m.csv")
        np.testing.assert_allclose(self.table("m.csv")[1], np.column_stack([times / 2.0, np.sin(times)]), rtol=1e-11)

    def test_the_program_reads_a_table(self):
        """A force that varies over time, in kN, with a comma in the name of the file's channel."""
        force = 1e2 * np.sin(np.arange(200) / 20.0)
        head = head_58(2, 200, 1, 0.0, 0.01, axis="F, left", unit="kN", quantity=9)
        self.of_universal(dataset(58, head + rows(force, 13, 5, 6)))
        scene = ("beam: {spans: 20.0, EI: 1.0e10, mass: 9.0e3}\nload: {forces: 1.0, table: t.csv, positions: 10.0, speed: 0.0}\n"
                 "ts: {max_time: 1.0}\n")
        (self.folder / "scene.yml").write_text(scene, encoding="utf-8")
        done = subprocess.run([BINARY, "-options_file", "scene.yml", "-describe"], cwd=self.folder, capture_output=True,
                              text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("kN", done.stdout)

    def test_refusals(self):
        data = rows(VALUES, 13, 5, 6)
        good = dataset(58, head_58(2, 8, 1, 0.0, 0.1) + data)
        for content, part in (
                (good[:-20], "expected"),
                (good.replace(data[0], data[0][:-13]), ":2: 7 numbers; by its head the dataset has 8"),
                (dataset(58, head_58(2, 10**9, 1, 0.0, 0.1) + data), "by its head the dataset has 1000000000"),
                (dataset(58, head_58(2, 8, 1, 0.0, -0.1) + data), ":9: the times do not increase"),
                (dataset(58, head_58(5, 4, 1, 0.0, 0.1) + data), ":9: ordinates of type 5"),
                (good.replace("2.25000E-03", "        NaN"), ":14: 'NaN' is no finite number"),
                (good.replace("2.25000E-03", "2.2_000E-03"), ":14: '2.2_000E-03' is no finite number"),
                (good.replace("2.25000E-03", "2.25000E+93"), ":14: '2.25000E+93' is no finite number"),
                (dataset(58, head_58(2, 8, 1, 0.0, 0.1))[:-8], ":13: the file ends here; expected -1, which ends the dataset"),
                (dataset(2414, ["x"]), "no dataset 58 of a record over time"),
                ("time,acc\n0,1\n", "is no file of records"),
                (good.replace(f"{'s':20}", f"{'h':20}"), ":10: the abscissa has the unit h; allowed: s, ms, min"),
                ("    -1\n   58b     1     2          11   999999999\n" + good, "by its head; the file has")):
            with self.subTest(part):
                self.refused(part, "records", self.write("bad.unv", content), "-o", self.folder / "t.csv")
                self.assertFalse((self.folder / "t.csv").exists())

    def test_no_other_file_is_written_over(self):
        path = self.write("r.unv", dataset(58, head_58(2, 8, 1, 0.0, 0.1) + rows(VALUES, 13, 5, 6)))
        other = self.write("mine.csv", "a,b\n1,2\n")
        self.refused("is there already", "records", path, "-o", other)
        self.refused("allowed: .csv", "records", path, "-o", self.folder / "x.txt")


if __name__ == "__main__":
    import unittest
    unittest.main()
