"""Universal and MATLAB files for the tests of scripts/convert.py, and its calls."""

import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest

import h5py
import numpy as np

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
MODELS = SOURCE / "tests/data/models"
sys.path.insert(0, str(SOURCE / "scripts"))
import convert  # noqa: E402
import convert_calculix  # noqa: E402

SKEW = np.tan(np.radians(25.0))
# Points of a track to the left of the middle of skew_slab.
SKEW_TRACK = [f"{2.25 * SKEW:.4f},2.25,0", f"{15.0 + 2.25 * SKEW:.4f},2.25,0"]
TEXTS = ["Girder, channel", "NONE", "01-Jan-26 10:00:00", "NONE", "NONE"]


def dataset(kind, lines):
    return "\n".join(["    -1", f"{kind:>6}", *lines, "    -1", ""])


def rows(values, width, digits, numbers):
    """Fortran's 6E13.5 and the like."""
    cells = [f"{value:{width}.{digits}E}" for value in values]
    return ["".join(cells[i:i + numbers]) for i in range(0, len(cells), numbers)]


def head_58(kind, total, even, first=0.0, step=0.0, function=1, node=12, direction=-3, axis="acc", unit="m/s2",
            entity="NONE", quantity=12, abscissa=17):
    dof = f"{function:5d}{0:10d}{0:5d}{0:10d} {entity:10}{node:10d}{direction:4d} {'NONE':10}{0:10d}{0:4d}"
    form = f"{kind:10d}{total:10d}{even:10d}{first:13.5E}{step:13.5E}{0.0:13.5E}"
    none = f"{0:10d}{0:5d}{0:5d}{0:5d} {'NONE':20} {'NONE':20}"
    return [*TEXTS, dof, form, f"{abscissa:10d}{0:5d}{0:5d}{0:5d} {'Time':20} {'s':20}",
            f"{quantity:10d}{0:5d}{0:5d}{0:5d} {axis:20} {unit:20}", none, none]


def units_164(length, force):
    return dataset(164, [f"{9:10d}{'USER_DEFINED':20}{1:10d}", f"{length:25.17E}{force:25.17E}{1.0:25.17E}".replace("E", "D"),
                         f"{273.15:25.17E}"])


def universal_of(path, turn=None, newer=False):
    """The model and modes of a results file of CalculiX as datasets 2411 and 55, or 2414. turn: the angle of complex
    shapes."""
    ids, points, modes = convert_calculix.read_frd(path)
    places = ["".join(f"{x:25.16E}" for x in point).replace("E", "D") for point in points]
    text = dataset(2411, [line for one, place in zip(ids, places) for line in (f"{one:10d}{1:10d}{1:10d}{11:10d}", place)])
    for mode in modes:
        values = mode.fields["DISP"].values
        analysis, kind = ("2", 2) if turn is None else ("3", 5)
        omega = 2.0 * np.pi * mode.frequency
        eigenvalue = [-0.02 * omega, omega * np.sqrt(1.0 - 0.02**2)]
        real = [mode.frequency, mode.mass, 0.02, 0.0] if turn is None else eigenvalue + [0.0] * 4
        if turn is not None:
            values = (values[:, :, None] * [np.cos(turn), np.sin(turn)]).reshape(len(values), 6)
        if newer:
            lines = [f"{mode.number:10d}", "Mode shapes", f"{1:10d}", *TEXTS, f"{1:10d}{2:10d}{2:10d}{8:10d}{kind:10d}{3:10d}",
                     f"{0:10d}{0:10d}{1:10d}{0:10d}{0:10d}{mode.number:10d}{0:10d}{0:10d}", f"{0:10d}{0:10d}",
                     *rows([0.0, mode.frequency, 0.0, mode.mass, 0.02, 0.0], 13, 5, 6), *rows([0.0] * 6, 13, 5, 6)]
        else:
            lines = [*TEXTS, f"{1:10d}{analysis:>10}{2:10d}{8:10d}{kind:10d}{3:10d}",
                     f"{2:10d}{len(real):10d}{1:10d}{mode.number:10d}", *rows(real, 13, 5, 6)]
        for one, row in zip(mode.fields["DISP"].ids, values):
            lines += [f"{one:10d}", *rows(row, 13, 5, 6)]
        text += dataset(2414 if newer else 55, lines)
    return text


def write_hdf5(path, content):
    """A MATLAB file of version 7.3: reversed dimensions after a block of the user."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, value in content.items():
            file[name] = np.atleast_2d(value).T if np.ndim(value) == 1 else np.asarray(value).T
    with open(path, "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")


class Converting(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode("latin-1"))
        return str(path)

    def run_with(self, *words):
        """(exit status, output, error) of the command."""
        out, error = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
            try:
                status = convert.main([str(word) for word in words])
            except SystemExit as ended:
                status = ended.code
        return status, out.getvalue(), error.getvalue()

    def converted(self, *words):
        status, out, error = self.run_with(*words)
        self.assertEqual((status, error), (0, ""))
        return out

    def refused(self, part, *words):
        status, _, error = self.run_with(*words)
        self.assertEqual(status, 2, error)
        self.assertEqual(len(error.splitlines()), 1, error)
        self.assertIn(part, error)
