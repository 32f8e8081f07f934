#!/usr/bin/python3
"""Computes the bridges of doc/measured, and prints or writes the computed values beside the measured ones.

measured_bridges.py                prints the tables of all bridges
measured_bridges.py NAME ...       prints those of some, by the names of their pages
measured_bridges.py --write        also writes the tables into the pages of doc/measured

measured_rows.py names the measured values, the assumptions and what to compute. The program is build/traverse, or
TRAVERSE_BINARY.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
from measured_rows import BRIDGES

ROOT = pathlib.Path(__file__).resolve().parent.parent
VALUES = ["| quantity | measured | computed | computed / measured |", "| --- | --- | --- | --- |"]
ASSUMED = ["| assumed | in the scene | instead | {} |", "| --- | --- | --- | --- |"]


class Failed(Exception):
    """A scene cannot be computed, or a page has no place for its table."""


class Scene:
    """The results of options/measured/NAME.yml with further options; each run is computed once."""

    def __init__(self, name, program):
        self.name, self.program, self.done = name, program, {}

    def results(self, *options):
        """{dataset: array} of the run, without the record of its input."""
        if options not in self.done:
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder, "run.h5")
                self.compute(path, options)
                with h5py.File(path, "r") as file:
                    found = {}
                    file.visititems(lambda key, item: found.update({key: item[()]}) if isinstance(item, h5py.Dataset) else None)
            self.done[options] = found
        return self.done[options]

    def compute(self, path, options):
        words = [word for option in options for word in option.split(" ", 1)]
        run = subprocess.run([self.program, "-options_file", ROOT / "options" / "measured" / f"{self.name}.yml", *words,
                              "-output_file", path, "-output_quiet"], cwd=ROOT, capture_output=True, text=True)
        if run.returncode != 0:
            raise Failed(f"options/measured/{self.name}.yml {' '.join(options)}: {run.stderr.strip() or run.stdout.strip()}")


def in_digits(value, digits):
    """A number with `digits` decimals, or the two ends of a range."""
    if isinstance(value, tuple):
        return " to ".join(in_digits(end, digits) for end in value)
    return f"{value:.{digits}f}"


def values_table(bridge, scene):
    lines = list(VALUES)
    for row in bridge.rows:
        computed = row.compute(scene)
        ratio = "" if isinstance(computed, tuple) or not row.compared else f"{computed / row.measured:.2f}"
        lines.append(f"| {row.quantity} | {in_digits(row.measured, row.digits)} | {in_digits(computed, row.digits)} "
                     f"| {ratio} |".replace("|  |", "| |"))
    return lines


def assumed_table(bridge, scene):
    row = bridge.watched
    lines = [ASSUMED[0].format(row.quantity), ASSUMED[1]]
    for assumption in bridge.assumptions:
        computed = [in_digits(row.compute(scene, *options), row.digits) for _, options in assumption.instead]
        lines.append(f"| {assumption.what} | {assumption.used} | {'; '.join(label for label, _ in assumption.instead)} "
                     f"| {'; '.join(computed)} |")
    return lines


def with_table(page, table):
    """The page with this table in place of the one that has the same first line, up to the next empty line."""
    pattern = re.compile(re.escape(table[0]) + r"\n(?:\|.*\n)*")
    if len(pattern.findall(page)) != 1:
        raise Failed(f"a page needs one table that begins with {table[0]}")
    return pattern.sub(lambda _: "\n".join(table) + "\n", page)


def page_of(name):
    return ROOT / "doc" / "measured" / f"{name}.md"


def tables(name, program):
    bridge, scene = BRIDGES[name], Scene(name, program)
    return [values_table(bridge, scene), assumed_table(bridge, scene)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write the tables into the pages")
    parser.add_argument("--program", default=os.environ.get("TRAVERSE_BINARY", str(ROOT / "build" / "traverse")))
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(BRIDGES))
    given = parser.parse_args()
    unknown = [name for name in given.names if name not in BRIDGES]
    if unknown:
        sys.exit(f"measured_bridges.py: {unknown[0]} is not one of {', '.join(BRIDGES)}")
    try:
        for name in given.names or BRIDGES:
            found = tables(name, given.program)
            print(name, *("\n".join(table) for table in found), sep="\n\n", end="\n\n", flush=True)
            if given.write:
                text = page_of(name).read_text(encoding="utf-8")
                for table in found:
                    text = with_table(text, table)
                page_of(name).write_text(text, encoding="utf-8")
    except (Failed, OSError) as error:
        sys.exit(f"measured_bridges.py: {error}")


if __name__ == "__main__":
    main()
