"""The least stiffness of the page of traverse serve: the answer belongs to its own factor for track defects, and holds at all
speeds."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import yaml

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import BINARY, SOURCE  # noqa: E402

sys.path.insert(0, str(SOURCE / "scripts"))
from traverse_check import outcome  # noqa: E402
from traverse_serve import fields, forms, least, scenes  # noqa: E402

VALUES = {"beam_spans": "23.7", "beam_mass": "15.5", "find_between.from": "100", "find_between.to": "250",
          "sweep_speed.from": "280", "sweep_speed.to": "300"}
# The limit is exceeded in a resonance of each EI.
SHARP = {"beam_spans": "18", "beam_mass": "9", "find_between.from": "39", "find_between.to": "46", "sweep_speed.from": "220",
         "sweep_speed.to": "236"}


class Least(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def given(self, values):
        return fields.read(forms.forms()["find"].fields, values)

    def intervals(self, values):
        """Of EI, N m2, that the command finds."""
        done = subprocess.run([sys.executable, "-B", SOURCE / "scripts/traverse_serve/least.py", BINARY, "en", json.dumps(values)],
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        with h5py.File(self.folder / "results.h5") as file:
            return file["find/interval"][:].tolist()

    def ratio(self, given, stiffness):
        """The greatest acceleration over its limit, with the factor of this EI, to 0.1 % over the speed."""
        bridge = given | {"beam_EI": stiffness, "train_vehicles": "hslm_a"}
        files = scenes.scene_files("sweep", bridge, "en", scenes.factor_for_track(bridge, BINARY))
        (self.folder / "sweep").mkdir(exist_ok=True)
        results = least.compute(BINARY, self.folder / "sweep", files, "-sweep_refine", "1e-3", output=subprocess.DEVNULL)
        return max(one.utilisation for one in outcome.verdicts(results) if one.limit.quantity == "deck_acceleration")

    def test_the_factor_is_that_of_the_answer(self):
        given, found = self.given(VALUES), self.intervals(VALUES | {"sweep_speed.step": "4"})
        self.assertEqual(len(found), 1)
        self.assertAlmostEqual(self.ratio(given, found[0][0]), 1.0, delta=2.0 * least.CLOSE)
        self.assertGreater(self.ratio(given, 0.97 * found[0][0]), 1.0)
        factor = {row["factor"] for row in yaml.safe_load((self.folder / "limits.yml").read_text(encoding="utf-8"))}
        self.assertEqual(factor, {f"{scenes.factor_for_track(given | {'find_between.to': found[0][1]}, BINARY):.6g}"})

    def test_a_peak_between_two_speeds_is_no_answer(self):
        """By steps of 8 km/h the bridge seems to keep the limit at some EI, whose resonance is between two of the speeds."""
        coarse, given = SHARP | {"sweep_speed.step": "8"}, self.given(SHARP)
        files = scenes.scene_files("find", self.given(coarse), "en", scenes.factor_for_track(given, BINARY))
        with h5py.File(least.compute(BINARY, self.folder, files, output=subprocess.DEVNULL)) as file:
            seeming = file["find/interval"][:, 0]
        self.assertGreater(len(seeming), 0)
        self.assertGreater(self.ratio(given, seeming[0]), 1.1)
        self.assertEqual(self.intervals(coarse), [])


if __name__ == "__main__":
    unittest.main()
