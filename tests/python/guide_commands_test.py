"""The first commands of every page of the guide work after ./run.sh alone: what they name exists and can be started, Python
needs only what run.sh installs, and the program accepts the scene."""

import ast
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2])).resolve()
PROGRAM = os.environ.get("TRAVERSE_BINARY", SOURCE / "build" / "traverse")
PAGES = sorted((SOURCE / "doc/guide").glob("*.md"))
MODULES = {"python3-h5py": ["h5py", "numpy"], "python3-openpyxl": ["openpyxl"], "python3-scipy": ["scipy"],
           "python3-matplotlib": ["matplotlib", "mpl_toolkits", "PIL"], "python3-xarray": ["xarray", "pandas"], "python3-yaml": ["yaml"]}
PLACES = ("scripts", "python", "examples", "benchmarks")  # of the repository's own modules


def first_commands(page):
    """The words of each command of the first block."""
    block = re.search(r"^```sh\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[1]
    lines = block.replace("\\\n", " ").replace("&&", "\n").splitlines()
    return [words for line in lines if (words := shlex.split(line, comments=True))]


def missing_in(words, made):
    """What a command names that does not exist before it, after the commands that wrote `made`."""
    outputs = {words[i + 1] for i, word in enumerate(words[:-1]) if word in ("-o", "-output_file", "--prefix", "--folder")}
    inputs = [word for word in words if re.fullmatch(r"[\w./-]+\.(yml|csv|h5|py|checkpoint)|(options|scripts|examples)/\S+", word)]
    made.update(outputs)
    return [word for word in inputs if not word.startswith(("results/", "-")) and word not in made
            and not (SOURCE / word).exists()]


def imported(path, seen):
    """The names of the modules that a script imports, itself and by modules of the repository."""
    if path in seen:
        return set()
    seen.add(path)
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            names.update([node.module] if node.module and not node.level else [])
            if node.level:
                names.update(f"{path.parent.name}.{alias.name}" for alias in node.names)
                names.add(f"{path.parent.name}.{node.module}")
    found = set()
    for name in names:
        parts = name.split(".")
        own = [file for place in PLACES for file in ((SOURCE / place).joinpath(*parts).with_suffix(".py"),
                                                     (SOURCE / place).joinpath(*parts, "__init__.py")) if file.exists()]
        found |= imported(own[0], seen) if own else {parts[0]}
    return found


class GuideCommands(unittest.TestCase):
    def installed(self):
        """The modules of the packages that run.sh installs, and those of Python."""
        setup = (SOURCE / "scripts/setup.sh").read_text(encoding="utf-8")
        packages = re.search(r"^program_packages=\((.*?)\)", setup, re.MULTILINE | re.DOTALL)[1].split()
        self.assertLessEqual({name for name in packages if name.startswith("python3-")}, set(MODULES))
        return {module for name in packages for module in MODULES.get(name, ())} | set(sys.stdlib_module_names)

    def test_what_they_name_exists(self):
        self.assertGreater(len(PAGES), 40)
        for page in PAGES:
            made = set()
            for words in first_commands(page):
                with self.subTest(page.name, command=" ".join(words)):
                    self.assertEqual(missing_in(words, made), [])
                    if (SOURCE / words[0]).is_file() and not words[0].startswith(("/", "build/")):
                        self.assertTrue(os.access(SOURCE / words[0], os.X_OK), f"{words[0]} is not executable")

    def test_the_library_is_built_before_it_is_installed(self):
        for page in PAGES:
            commands = [" ".join(words[:3]) for words in first_commands(page)]
            if "cmake --install build" in commands:
                self.assertIn("cmake --build build", commands[:commands.index("cmake --install build")], page.name)

    def test_scripts_need_only_what_is_installed(self):
        known = self.installed() | {path.stem for place in PLACES for path in (SOURCE / place).iterdir()}
        for page in PAGES:
            for words in first_commands(page):
                for word in words[:2]:
                    path = SOURCE / word
                    if path.is_file() and path.read_bytes()[:64].startswith((b"#!/usr/bin/python3", b'"""')):
                        with self.subTest(page.name, script=word):
                            self.assertEqual(imported(path, set()) - known, set())

    def test_the_program_accepts_the_scene_of_the_first_one(self):
        checked = 0
        for page in PAGES:
            words = first_commands(page)[0]
            if words[:2] != ["build/traverse", "-options_file"]:
                continue
            checked += 1
            with self.subTest(page.name), tempfile.TemporaryDirectory() as folder:
                ended = subprocess.run([PROGRAM, *words[1:], "-describe", "-output_file", f"{folder}/results.h5"], cwd=SOURCE,
                                       capture_output=True, text=True)
                self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertGreater(checked, 30)


if __name__ == "__main__":
    unittest.main()
