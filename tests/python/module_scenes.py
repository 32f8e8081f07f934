"""Scenes of which tests of the Python package compute runs and passages, and how these are refused."""

import os
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
sys.path.insert(0, str(SOURCE / "python"))
import traverse  # noqa: E402

BRIDGE = {"spans": [20.0], "EI": 3.0e10, "mass": 1.8e4, "elements_per_span": 8}
FORCES = {
    "beam": BRIDGE,
    "load": {"forces": [2.0e5, 1.0e5], "positions": [0.0, -3.0], "speed": 40.0},
    "ts": {"dt": 1.0e-3, "max_time": 0.3},
    "output": {"interval": 0.01, "probes": [5.0, 10.0]},
}
# A sprung wheel that leaves a bridge at a bump and comes down again.
HOPPING = {
    "beam": {"spans": 20.0, "EI": 8.323e9, "mass": 2303.0, "elements_per_span": 6, "damping_ratios": 0.01},
    "vehicle": {"sprung": {
        "bodies": ["axle", "body"], "joints": ["guide"], "springs": ["suspension"], "drivers": ["level"],
        "wheels": ["wheel"],
        "axle": {"mass": 1000.0, "inertia": 100.0, "position": [0.0, 0.46]},
        "body": {"mass": 5750.0, "inertia": 100.0, "position": [0.0, 1.5]},
        "guide": {"type": "prismatic", "bodies": ["axle", "body"], "point": [0.0, 1.0], "axis": [0.0, 1.0]},
        "suspension": {"bodies": ["axle", "body"], "from": [0.0, 0.46], "to": [0.0, 1.5], "stiffness": 1.595e6,
                       "damping": 2.0e4},
        "level": {"body": "axle", "coordinate": "phi", "value": 0.0},
        "wheel": {"body": "axle", "radius": 0.46, "law": "hertz", "stiffness": 3.64e10}}},
    "train": {"vehicles": "sprung", "positions": 0.0, "speed": 30.0},
    "track": {"profile": "bump", "bump": {"start": 7.5, "length": 2.0, "height": 0.02}},
    "ts": {"dt": 1.0e-3, "max_time": 0.4},
    "output": {"interval": 0.01, "probes": [5.0, 10.0]},
}
# One body that nothing holds, where there is no gravity.
FREE = {
    "vehicle": {"stone": {"bodies": ["rock"], "rock": {"mass": 2.0, "inertia": 0.5, "position": [0.0, 0.0]}}},
    "train": {"vehicles": "stone", "positions": 0.0},
    "gravity": 0.0, "scene": {"start": "given"},
    "ts": {"dt": 0.01, "max_time": 1.0}, "output": {"interval": 0.05},
}


class InFolder(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def refused(self, status, pattern, call, *words, **options):
        with self.assertRaisesRegex(traverse.Error, pattern) as caught:
            call(*words, **options)
        self.assertEqual(caught.exception.status, status)
        self.assertEqual(len(str(caught.exception).splitlines()), 1)
