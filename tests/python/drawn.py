"""Small results files as the program writes them and their pictures, for tests of scripts/picture.py and compare.py."""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import h5py
import numpy as np
from matplotlib.text import Text
from matplotlib.transforms import Bbox

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
SCRIPTS = SOURCE / "scripts"
sys.path.insert(0, str(SCRIPTS))
import matplotlib.pyplot as plt  # noqa: E402
import picture  # noqa: E402
import picture_data  # noqa: E402
import picture_page  # noqa: E402
import picture_table  # noqa: E402


def texts(file, name, rows):
    file.create_dataset(name, data=np.array(rows, dtype=object), dtype=h5py.string_dtype())


def write_run(path, *, beam=True, vehicles=2, wheels=("front_wheel", "rear_wheel"), rows=400, finished=True, extra=0,
              options=()):
    """A results file as the program writes it; `extra`: rows beyond /time, as a killed run may leave."""
    n = rows + extra
    t = np.linspace(0.0, 4.0, n)
    with h5py.File(path, "w") as file:
        file.attrs["scene"] = "small_scene"
        file["time"] = t[:rows]
        texts(file, "options", [["-train_speed", "50"], ["-support_types", "pinned,roller,roller"], *options])
        if beam:
            file["supports/x"] = [0.0, 20.0, 40.0]
            file["probes/x"] = [10.0, 30.0]
            file["probes/deflection"] = -1e-3 * np.stack([np.sin(t), np.cos(t)], axis=1)
            file["shape/x"] = np.linspace(0.0, 40.0, 21)
            file["shape/deflection"] = -1e-3 * np.sin(np.linspace(0.0, 2 * np.pi, 21))
            file["shape/deflection"].attrs["time"] = 1.5
        for k in range(vehicles):
            for body, height in (("car", 1.5), ("axle", 0.5)):
                file[f"vehicles/{k}/{body}/position"] = np.stack([50 * t - 10 * k, height + 0 * t, 0 * t], axis=1)
                file[f"vehicles/{k}/{body}/acceleration"] = np.stack([0 * t, np.sin(5 * t + k), 0 * t], axis=1)
            for wheel in wheels:
                file[f"vehicles/{k}/{wheel}/normal_force"] = 1e5 + 1e3 * np.sin(7 * t + k)
        if finished:
            file.create_group("summary").attrs["deflection"] = -1e-3
            file["summary"].attrs["deflection_place"] = 10.0


def written(figure):
    """[(text, its box)] of all that is written in a figure: titles, names, labels, numbers of the axes, legends."""
    figure.draw_without_rendering()
    found = [(text.get_text(), text.get_window_extent()) for text in figure.texts]
    for ax in picture_table.every_axes(figure):
        named = [ax._left_title, *ax.texts, *([ax.xaxis.label, ax.yaxis.label] if ax.axison else []),
                 *(ax.get_legend().get_texts() if ax.get_legend() else [])]
        for axis, limits in ((ax.xaxis, ax.get_xlim()), (ax.yaxis, ax.get_ylim())):
            named += [tick.label1 for tick in axis.get_major_ticks()
                      if ax.axison and min(limits) <= tick.get_loc() <= max(limits)]
        found += [(text.get_text(), Text.get_window_extent(text)) for text in named if text.get_visible()]
    return [(text, box) for text, box in found if text.strip()]


class Drawn(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.file = self.folder / "run.h5"

    def run_script(self, name, *words):
        command = [sys.executable, "-B", str(SCRIPTS / name), *map(str, words)]
        return subprocess.run(command, capture_output=True, text=True)

    def assert_refused(self, done, *words):
        """One line and a non-zero exit."""
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        for word in words:
            self.assertIn(str(word), done.stderr)

    def figure_of(self, draw):
        """The figure that a function of the scripts would save."""
        drawn = []
        with mock.patch.object(picture_page, "save", lambda figure, *others: drawn.append(figure)):
            draw()
        self.addCleanup(plt.close, drawn[0])
        return drawn[0]

    def figure(self, asked=()):
        with h5py.File(self.file) as file:
            return self.figure_of(lambda: picture.draw(picture_data.Results(file), "out.png", asked))

    def assert_readable(self, figure, *names):
        """Everything that is written lies within the picture, and no two texts overlap; the names are among them."""
        found = written(figure)
        for i, (words, box) in enumerate(found):
            self.assertTrue(-1 <= box.x0 and box.x1 <= figure.bbox.width + 1, words)
            self.assertTrue(-1 <= box.y0 and box.y1 <= figure.bbox.height + 1, words)
            for other, second in found[:i]:
                shared = Bbox.intersection(box, second)
                self.assertFalse(shared is not None and shared.width > 2 and shared.height > 2, (words, other))
        for name in names:
            self.assertTrue(any(name in words for words, _ in found), (name, [words for words, _ in found]))
        return figure

    def assert_drawn(self, *names, asked=()):
        """The picture is readable and no panel is empty; its height in inches."""
        figure = self.assert_readable(self.figure(asked), *names)
        for ax in picture_table.every_axes(figure):
            self.assertTrue(ax.has_data() or ax.child_axes or not ax.axison, ax.get_title(loc="left"))
        return figure.get_figheight()

    def table(self, path):
        """{heading: numbers} of a CSV file."""
        with open(path, encoding="utf-8", newline="") as file:
            head, *rows = csv.reader(file)
        return {name: [float(row[i]) for row in rows if row[i]] for i, name in enumerate(head)}
