"""The pages of the first hour: their commands exist, the program knows their options, and those without a time in their comment
print the lines that the page quotes below them."""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from guide_commands_test import PROGRAM, SOURCE, missing_in  # noqa: E402
from project_copy import copy_project  # noqa: E402

PAGES = sorted((SOURCE / "doc/first_hour").glob("*.md"))
SLOW = re.compile(r"#.*\b(seconds|minutes?)\b")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?")
RELATIVE = 2e-3  # two runs, each with the accuracy of 1e-3 by default


def commands_of(block):
    """Each command with its comment: those that go on in the next line are one."""
    found, ahead = [], ""
    for line in block.replace("\\\n", " ").splitlines():
        ahead += line + "\n"
        try:
            shlex.split(ahead, comments=True)
        except ValueError:  # a quotation goes on
            continue
        found.append(ahead)
        ahead = ""
    return found


def steps(page):
    """Each block of commands with the lines that are quoted below it."""
    found = []
    for kind, text in re.findall(r"^```(sh|text)\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL):
        if kind == "sh":
            found.append((commands_of(text), []))
        else:
            found[-1][1].extend(text.splitlines())
    return found


def begins_with(printed, quoted):
    """Whether a printed line begins with a quoted one: the same words, and the same numbers within the accuracy of runs."""
    words, numbers = NUMBER.split(quoted.strip()), [float(number) for number in NUMBER.findall(quoted)]
    there = [float(number) for number in NUMBER.findall(printed)][:len(numbers)]
    same = [" ".join(word.split()) for word in NUMBER.split(printed.strip())][:len(words)]
    wanted = [" ".join(word.split()) for word in words]
    return (same[:-1] == wanted[:-1] and len(same) == len(wanted) and same[-1].startswith(wanted[-1])
            and len(there) == len(numbers) and all(abs(a - b) <= RELATIVE * abs(b) for a, b in zip(there, numbers)))


class FirstHour(unittest.TestCase):
    def test_what_the_commands_name_exists(self):
        self.assertEqual(len(PAGES), 5)
        for page in PAGES:
            made = set()
            for commands, _ in steps(page):
                for command in commands:
                    for words in (shlex.split(part, comments=True) for part in command.split("&&")):
                        with self.subTest(page.name, command=command):
                            self.assertEqual(missing_in([word for word in words if "=" not in word], made), [])
                            if (SOURCE / words[0]).is_file():
                                self.assertTrue(os.access(SOURCE / words[0], os.X_OK))

    def test_the_program_knows_the_options(self):
        checked = 0
        for page in PAGES:
            for command in (command for commands, _ in steps(page) for command in commands):
                words = shlex.split(command, comments=True)
                if words[:2] != ["build/traverse", "-options_file"]:
                    continue
                checked += 1
                with self.subTest(page.name, command=command), tempfile.TemporaryDirectory() as folder:
                    ended = subprocess.run([PROGRAM, *words[1:], "-describe", "-output_file", f"{folder}/results.h5"], cwd=SOURCE,
                                           capture_output=True, text=True)
                    self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertGreater(checked, 15)

    def test_quick_commands_print_what_is_quoted(self):
        """In a copy of the project, with results of its own."""
        environment = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        compared = 0
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            copy_project(root)
            (root / "build/traverse").symlink_to(pathlib.Path(PROGRAM).resolve())
            for page, commands, quoted in ((page, *step) for page in PAGES for step in steps(page)):
                if not quoted or any(SLOW.search(command) for command in commands):
                    continue
                ended = subprocess.run(["bash", "-c", "".join(commands)], cwd=root, env=environment, capture_output=True, text=True)
                printed = (ended.stdout + ended.stderr).splitlines()
                for line in quoted:
                    compared += 1
                    with self.subTest(page.name, quoted=line):
                        self.assertTrue(any(begins_with(other, line) for other in printed), "\n".join(printed[-40:]))
        self.assertGreater(compared, 12)

    def test_the_comparison_sees_what_differs(self):
        self.assertTrue(begins_with("  peak deflection       -0.7219 mm        at x = 10 m", "  peak deflection  -0.722 mm"))
        for other in ("  peak deflection  -0.725 mm", "  peak moment  -0.7219 mm", "  peak deflection  -0.7219 m at"):
            self.assertFalse(begins_with("  peak deflection       -0.7219 mm        at x = 10 m", other), other)


if __name__ == "__main__":
    unittest.main()
