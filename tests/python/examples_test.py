"""The examples of the guide: each page says what its script prints, quotes its code, and names no other numbers."""

import functools
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2])).resolve()
NUMBER = r"(?<![\w.])-?\d+(?:\.\d+)?(?![\d.]*\.\d)"
NORMS = r"EN \d+(?:-\d+)*|\b\d+(?:\.\d+){2,}"  # and their clauses


def page(name):
    return (SOURCE / f"doc/guide/example_{name}.md").read_text(encoding="utf-8")


def script(name):
    return (SOURCE / f"examples/{name}.py").read_text(encoding="utf-8")


def blocks(text, language):
    """The lines of all fenced blocks in a language, one after the other."""
    return "".join(re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)).splitlines()


def differences(printed, written):
    """Pairs of lines whose words differ, or whose numbers differ by more than one unit of the last digit."""
    wrong = [("", f"{len(printed)} lines are printed, {len(written)} are on the page")] * (len(printed) != len(written))
    for line, on_page in zip(printed, written):
        pairs = list(zip(re.findall(NUMBER, line), re.findall(NUMBER, on_page)))
        near = all(abs(float(a) - float(b)) <= 1.01 * 10.0 ** -len(a.partition(".")[2]) for a, b in pairs)
        if re.sub(NUMBER, "#", line) != re.sub(NUMBER, "#", on_page) or not near:
            wrong.append((line, on_page))
    return wrong


def invented(text, sources):
    """Numbers in the sentences of a page that no source contains, also not as percent."""
    prose = re.sub(r"^```.*?^```$|`[^`]*`|\]\([^)]*\)", "", text, flags=re.MULTILINE | re.DOTALL)
    known = {abs(float(number)) for number in re.findall(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?", sources)}
    return [number for number in re.findall(NUMBER, re.sub(NORMS, "", prose))
            if abs(float(number)) not in known and round(abs(float(number)) / 100.0, 6) not in known]


@functools.cache
def printed(name):
    """What the script prints at its reduced size."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.pathsep.join([str(SOURCE / "python"), str(SOURCE / "scripts")])
        run = subprocess.run(["/usr/bin/python3", "-B", f"examples/{name}.py", folder, "--quick"], cwd=SOURCE, text=True,
                             capture_output=True, env=os.environ | {"PYTHONPATH": path, "MPLBACKEND": "Agg"})
    if run.returncode != 0:
        raise AssertionError(run.stdout + run.stderr)
    return run.stdout.splitlines()


class Pages:
    """The tests of one example; `scene` is the file that its script reads."""

    scene = None

    def test_says_what_the_script_prints(self):
        self.assertEqual(differences(printed(self.name), blocks(page(self.name), "text")), [])

    def test_quotes_the_script(self):
        lines = {line.strip() for line in script(self.name).splitlines()} | {"...", ""}
        self.assertEqual([line for line in blocks(page(self.name), "python") if line.strip() not in lines], [])

    def test_names_no_other_numbers(self):
        scene = (SOURCE / self.scene).read_text(encoding="utf-8") if self.scene else ""
        sources = "\n".join([*printed(self.name), script(self.name), scene])
        self.assertEqual(invented(page(self.name), sources), [])


class EnCheck(Pages, unittest.TestCase):
    name = "en_check"


class RideComfort(Pages, unittest.TestCase):
    name = "ride_comfort"


class CraneGirder(Pages, unittest.TestCase):
    name = "crane_girder"
    scene = "options/scenes/overhead_crane.yml"


class TheTest(unittest.TestCase):
    def test_sees_what_is_stale(self):
        self.assertEqual(differences(["f1 3.89 Hz"], ["f1 3.90 Hz"]), [])
        self.assertNotEqual(differences(["f1 3.89 Hz"], ["f1 3.92 Hz"]), [])
        self.assertNotEqual(differences(["f1 3.89 Hz"], ["f1 3.89 s"]), [])
        self.assertNotEqual(differences(["one", "two"], ["one"]), [])
        self.assertNotEqual(differences([], ["one"]), [])
        self.assertEqual(invented("EN 1991-2 6.4.6.5: A10 at 98 %, 7.5 m, [here](x_12.md) `13`", "0.98 7.50"), [])
        self.assertEqual(invented("the span is 28 m", "29.0"), ["28"])


if __name__ == "__main__":
    unittest.main()
