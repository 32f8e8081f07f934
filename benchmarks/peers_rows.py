"""What the scripts share that compute scenes of options/ with programs of finite elements: the scenes' bridges as numbers,
runs of Traverse, and rows of values side by side, in a table, and in doc/comparison.md.

The other programs read no file of ours and Traverse none of theirs: both get the numbers of the scene's file.
"""

import csv
import os
import sys
from typing import NamedTuple

import h5py
import numpy as np
import runs
import yaml

sys.path.insert(0, os.path.join(runs.ROOT, "scripts"))
import measured_bridges  # noqa: E402

PAGE = os.path.join(runs.ROOT, "doc", "comparison.md")
ACCURACY = 1e-4  # of our runs


class Bridge:
    """The beam of a file of options/; EI(x) and mass(x) in N m2 and kg/m; ends and middles: of the spans, m."""

    def __init__(self, kind, name):
        self.name, self.file = name, os.path.join(runs.ROOT, "options", kind, name + ".yml")
        with open(self.file) as file:
            self.options = yaml.safe_load(file)
        beam = self.options["beam"]
        self.ends = np.concatenate([[0.0], np.cumsum(numbers(beam["spans"]))])
        self.middles = (self.ends[1:] + self.ends[:-1]) / 2
        self.EI, self.mass = self.along("EI"), self.along("mass")

    def along(self, name):
        """The function of a number, or of a table of x and values, which is linear between its rows."""
        value = str(self.options["beam"][name])
        if not value.endswith(".csv"):
            return lambda x: np.full(np.shape(x), float(value))
        with open(os.path.join(os.path.dirname(self.file), value)) as file:
            table = np.array([line for line in csv.reader(file) if not line[0].startswith("#")], float)
        return lambda x: np.interp(x, table[:, 0], table[:, 1])

    @property
    def uniform(self):
        return not str(self.options["beam"]["EI"]).endswith(".csv")


def numbers(value):
    """20.0, [20.0, 20.0] or '20.0*3' as a list."""
    if isinstance(value, str):
        one, _, times = value.partition("*")
        return int(times) * [float(one)]
    return [float(one) for one in (value if isinstance(value, list) else [value])]


class Ours:
    """One run of Traverse: its seconds and its datasets."""

    def __init__(self, build, folder, options):
        run = runs.Run(build, {"accuracy": ACCURACY} | options, os.path.join(folder, "ours.h5"))
        self.seconds = run.processor_seconds
        with h5py.File(run.file) as file:
            names = "time", "probes/deflection", "modes/frequency"
            self.found = {name: file[name][:] for name in names if name in file}

    def peak(self, probe):
        """The largest deflection at a probe, mm, with its sign."""
        return largest(1e3 * self.found["probes/deflection"][:, probe])


def largest(values):
    return float(values[np.abs(values).argmax()])


class Row(NamedTuple):
    scene: str
    quantity: str
    unit: str
    theirs: float
    ours: float
    their_seconds: float  # of the processor, for all values of the scene
    our_seconds: float
    over_time: float = None  # the largest difference of the histories of all quantities of the scene

    @property
    def difference(self):
        return self.theirs / self.ours - 1


def apart(ours, t, theirs):
    """The largest difference of two histories [instant, probe] in parts of our largest value, at the instants of the one
    with fewer of them; theirs: m, at t."""
    time, found = ours.found["time"], ours.found["probes/deflection"]
    common = time[time <= t[-1]] if len(t) > len(time) else t
    mine, other = (np.stack([np.interp(common, instants, column) for column in values.T], axis=1)
                   for instants, values in ((time, found), (t, theirs)))
    return np.abs(other - mine).max() / np.abs(mine).max()


def of_peaks(scene, places, t, theirs, their_seconds, ours):
    """Rows of the largest deflections at probes, mm; theirs: m [instant, place]."""
    over_time = apart(ours, t, theirs)
    for i, place in enumerate(places):
        yield Row(scene, f"peak deflection at {place:g} m", "mm", 1e3 * largest(theirs[:, i]), ours.peak(i), their_seconds,
                  ours.seconds, over_time)


def of_modes(build, folder, bridge, theirs, their_seconds):
    """Rows of the first frequencies of a bridge, Hz."""
    ours = Ours(build, folder, {"options_file": bridge.file, "scene_analysis": "modes", "modes_count": len(theirs)})
    for i, values in enumerate(zip(theirs, ours.found["modes/frequency"])):
        yield Row(f"modes of `{bridge.name}`", f"frequency {i + 1}", "Hz", *values, their_seconds, ours.seconds)


def page_table(program, rows):
    """Lines of the table in doc/comparison.md; what is of a whole scene stands in its first line."""
    lines = [f"| scene | quantity | {program} | Traverse | difference | over time | {program}, s | Traverse, s |",
             8 * "| --- " + "|"]
    before = None
    for row in rows:
        words = [row.scene, f"{row.quantity}, {row.unit}", f"{row.theirs:.5g}", f"{row.ours:.5g}", f"{row.difference:.1e}",
                 "" if row.over_time is None else f"{row.over_time:.1e}", f"{row.their_seconds:.2g}", f"{row.our_seconds:.2g}"]
        if row.scene == before:
            words[0] = words[5] = words[6] = words[7] = ""
        before = row.scene
        lines.append("".join(f"| {word} " if word else "| " for word in words) + "|")
    return lines


def parser(text):
    arguments = runs.parser(text)
    arguments.add_argument("--write", action="store_true", help="also write the table into doc/comparison.md")
    return arguments


def tell(name, program, rows, given):
    """Prints the table, writes NAME.csv and, if asked for, the page."""
    table = page_table(program, rows)
    print("\n".join(table))
    runs.write_table(os.path.join(given.out, name + ".csv"), [*Row._fields, "difference"],
                     [[*row, row.difference] for row in rows])
    if given.write:
        with open(PAGE, encoding="utf-8") as file:
            page = file.read()
        try:
            page = measured_bridges.with_table(page, table)
        except measured_bridges.Failed as failed:
            sys.exit(f"{name}.py: {failed}")
        with open(PAGE, "w", encoding="utf-8") as file:
            file.write(page)
