#!/usr/bin/python3
"""Writes doc/verification.md: the references, the bounds that the tests assert and the errors that they measured.

verification.py                writes the page from the bounds in tests/ and the figures in doc/verification_figures.csv
verification.py --check        writes nothing; fails if the page differs from the one that would be written
verification.py --measure      runs build/tests/verification_tests first and stores the recorded values (--build FOLDER)
verification.py --measure 'Study.*'      runs these tests only; recorded values of the others remain

Each row of verification_rows.py and verification_ways.py names a test and the text of an assertion, with {} in place of
the bound. The script reads the bound from the source of the test. A missing test or assertion, and a measured error
above its bound, are errors.
"""

import argparse
import csv
import fnmatch
import pathlib
import re
import sys

import measured
from verification_rows import EQUATIONS
from verification_ways import WAYS

SECTIONS = EQUATIONS + WAYS
ROOT = pathlib.Path(__file__).resolve().parents[1]
NUMBER = r"([0-9]+(?:\.[0-9]+)?(?:e-?[0-9]+)?)"
TEST = re.compile(r"^TEST(?:_[PF])?\((\w+),\s*(\w+)\)", re.MULTILINE)
HEAD = """# Verification

This page lists the references of the program. Each row has the case, the source of its reference, the bound asserted by
the test, the largest measured error, and the test. Errors are relative to the peak or to the exact value unless they
have a unit. "Asserted only" means that the test does not record the error.

`scripts/verification.py` writes this page. It reads the bounds from the sources of the tests, and the measured errors
from `doc/verification_figures.csv`, which contains the values recorded by the last run of the tests for this page:

    /usr/bin/python3 scripts/verification.py --measure    # after ./test.sh: measures again and writes the page
    /usr/bin/python3 scripts/measured.py build '*R1*'     # prints recorded values of some tests, writes nothing

`./test.sh -R NAME` runs a row, with the name in its last column; for rows of `tests/mpi` use
`mpirun -n 2 build/tests/mpi_tests --gtest_filter='NAME'`. Measured errors near rounding differ between machines.

The references are Fryba's moving force (closed-form series), the beam of Yang and Yau 1997, the example of VBI-2D, the
IVP test set, textbook formulas and independent modal or Runge-Kutta computations. No reference is an earlier output of
this program. [Measured bridges](measured.md) compares scenes with measurements, which are no exact references."""


class Broken(Exception):
    """The page would contradict the sources."""


class Sources:
    """The sources of the test programs in `root`/tests."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.tests = {}  # name: (path, the test's text, the file's text)
        for path in sorted((self.root / "tests").glob("*/*_test.cpp")):
            text = path.read_text()
            found = list(TEST.finditer(text))
            for start, after in zip(found, found[1:] + [None]):
                body = text[start.start():after.start() if after else len(text)]
                one_line = body.split("\n", 1)[0].endswith("}")
                body = body[:body.index("\n" if one_line else "\n}")]
                self.tests[f"{start[1]}.{start[2]}"] = (path, body, text)

    def named(self, pattern):
        names = [name for name in self.tests if fnmatch.fnmatchcase(name, pattern)]
        if not names:
            raise Broken(f"no test is named {pattern}")
        return names

    def bound(self, test, assertion, other_file=None):
        """The number at {} in the assertion, as text: from the test, otherwise from its file, or from another file."""
        path, body, text = self.tests[test]
        places = [(self.root / other_file).read_text()] if other_file else [body, text]
        words = r"\s+".join(re.escape(word) for word in assertion.split())
        pattern = re.compile(words.replace(re.escape("{}"), NUMBER))
        for place in places:
            found = set(match.groups() for match in pattern.finditer(place))
            if len(found) > 1:
                raise Broken(f"{test}: '{assertion}' is asserted with several bounds: {sorted(found)}")
            if found:
                groups = found.pop()
                return groups[0] if groups else None
        raise Broken(f"{test} ({path.name}) no longer asserts '{assertion}'")


def instances(figures, pattern):
    """Recorded values of a test, one dictionary for each parameter."""
    return {name: values for name, values in figures.items() if fnmatch.fnmatchcase(name.split("/")[0], pattern)}


def values_of(check, found):
    """(name of the instance, value) of every recorded value that a check uses."""
    result = []
    for name, figures in found.items():
        if check.instance and not re.search(check.instance, name):
            continue
        if callable(check.figure):
            value = check.figure(figures)
            result += [] if value is None else [(name, value)]
        else:
            result += [(name, abs(float(value))) for figure, value in figures.items()
                       if re.fullmatch(check.figure, figure)]
    return result


def in_words(value):
    if value == 0.0:
        return "0"
    return f"{value:.1e}".replace("e-0", "e-") if value < 0.1 else f"{value:.2g}"


def asserted_and_measured(sources, figures, test, check):
    bound = sources.bound(sources.named(test)[0], check.assertion, check.file)
    asserted = f"{check.what}: " if check.what else ""
    asserted += check.bound.format(bound) if check.bound else f"{bound} {check.unit}".rstrip()
    if check.figure is None:
        return asserted, ""
    values = values_of(check, instances(figures, test))
    if not values:
        raise Broken(f"{test} has recorded nothing for '{check.what or check.assertion}': run with --measure")
    if check.each:
        shown = ", ".join(f"{name.split('/')[-1].replace('_', ' ')} {value:.2f}" for name, value in values)
        return asserted, shown
    worst = max(value for _, value in values)
    if bound is not None and check.below and worst > float(bound) * (1 + 1e-9):
        raise Broken(f"{test}: measured {worst:g}, asserted {bound}")
    return asserted, (f"{check.what}: " if check.what else "") + f"{in_words(worst)} {check.unit}".rstrip()


def page(root, figures):
    sources = Sources(root)
    lines = HEAD.splitlines()
    for title, rows in SECTIONS:
        lines += ["", f"## {title}", "", "| case | reference | asserted | measured | test |",
                  "| --- | --- | --- | --- | --- |"]
        for row in rows:
            pairs = [asserted_and_measured(sources, figures, row.test, check) for check in row.checks]
            asserted = "; ".join(pair[0] for pair in pairs)
            shown = "; ".join(pair[1] for pair in pairs if pair[1]) or "asserted only"
            path = sources.tests[sources.named(row.test)[0]][0].relative_to(sources.root)
            lines.append(f"| {row.case} | {row.reference} | {asserted} | {shown} | [`{row.test}`](../{path}) |")
    return "\n".join(lines) + "\n"


def used(figures):
    """The recorded values of the tests on the page."""
    patterns = [row.test for _, rows in SECTIONS for row in rows]
    return {name: values for name, values in figures.items()
            if any(fnmatch.fnmatchcase(name.split("/")[0], pattern) for pattern in patterns)}


def rounded(text):
    """A number with twelve digits, enough for a difference from 1; other texts unchanged."""
    try:
        return f"{float(text):.12g}"
    except ValueError:
        return text


def store(path, figures):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["test", "figure", "value"])
        for test, values in used(figures).items():
            for name, value in values.items():
                if name != "wall_seconds":
                    writer.writerow([test, name, rounded(value)])


def load(path):
    figures = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            figures.setdefault(row["test"], {})[row["figure"]] = row["value"]
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing, compare")
    parser.add_argument("--measure", nargs="?", const="*", metavar="TESTS",
                        help="run the tests first, or those that GoogleTest knows by these names")
    parser.add_argument("--build", default=str(ROOT / "build"), help="where the tests are built")
    parser.add_argument("--root", default=str(ROOT), help="the source tree")
    arguments = parser.parse_args()
    folder = pathlib.Path(arguments.root) / "doc"
    stored, out = folder / "verification_figures.csv", folder / "verification.md"
    try:
        if arguments.measure:
            figures, status = measured.run_tests(arguments.build, arguments.measure)
            if status != 0:
                raise Broken("verification tests failed: nothing is stored")
            store(stored, figures if arguments.measure == "*" else load(stored) | figures)
        text = page(arguments.root, load(stored))
        if not arguments.check:
            out.write_text(text)
        elif not out.exists() or out.read_text() != text:
            raise Broken(f"{out} is not what the tests say: run scripts/verification.py")
    except (Broken, OSError) as error:
        print(f"verification.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
