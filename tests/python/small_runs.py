"""Small computations in a folder of their own, for tests of what results files hold and of what is made of them."""

import os
import pathlib
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BINARY = pathlib.Path(os.environ.get("TRAVERSE_BINARY", SOURCE / "build/traverse"))

BRIDGE = """
beam: {spans: [20.0, 25.0], EI: 3.0e10, mass: 1.8e4, hinges: [26.0]}
support: {types: [pinned, free, roller]}
foundation: {vertical: {x: [20.0], k: 2.0e9, c: 0.0}}
model: {modes: 4, damping_ratios: 0.01}
scene: {tail: 0.2}
"""
CROSSING = BRIDGE + """
load: {forces: [2.0e5, 1.0e5], positions: [0.0, -3.0], speed: 40.0}
output: {interval: 0.01}
"""


class Computed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.holder.name)
        cls.prepare()

    @classmethod
    def prepare(cls):
        """Computes what all tests of the class read."""

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    @classmethod
    def compute(cls, name, text, *words, status=0):
        """NAME.h5 of a scene's text, whose run ends with this status."""
        (cls.folder / f"{name}.yml").write_text(text, encoding="utf-8")
        run = subprocess.run([BINARY, "-options_file", f"{name}.yml", "-output_file", f"{name}.h5", *words],
                             cwd=cls.folder, capture_output=True, text=True)
        if run.returncode != status:
            raise AssertionError(run.stdout + run.stderr)
