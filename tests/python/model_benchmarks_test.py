"""benchmarks/work_precision.py, fidelity.py and promises.py on few, coarse runs."""

import os
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BUILD = pathlib.Path(os.environ["TRAVERSE_BINARY"]).parent
sys.path.insert(0, str(SOURCE / "benchmarks"))
import fidelity  # noqa: E402
import promises  # noqa: E402
import scene_texts  # noqa: E402
import work_precision  # noqa: E402
import work_precision_scenes as wp  # noqa: E402


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name


class WorkPrecision(InAFolder):
    def test_scenes_leave_mesh_and_step_open(self):
        for scene in wp.SCENES:
            with open(wp.opened(scene.file, self.folder)) as file:
                text = file.read()
            for word in ("elements_per_span:", " dt:", " interval:", "accuracy:"):
                self.assertNotIn(word, text, scene.file)

    def test_a_small_scene(self):
        scene = wp.Scene("R3", "r3_sprung_mass", 0.04, 3, [4, 8], wanted=[1e-2])
        case = work_precision.Case(BUILD, self.folder, scene, quick=False, longest=float("inf"))
        case.find_reference()
        # REAL_CASES R3, converged.
        self.assertAlmostEqual(case.reference["deflection"] / 4.18626809e-4, 1.0, delta=2e-4)  # steps of 2.5 ms
        case.try_all()
        row, = case.rows()
        self.assertEqual(set(row), set(work_precision.HEADER))
        self.assertIn("acceleration", row["not promised"])  # no damping
        self.assertLessEqual(row["error over accuracy"], 1.0)
        self.assertGreater(row["ms over its"], 0.0)
        way, mesh, step, run = case.sure[1e-2]
        self.assertIn((way, mesh, step, run), case.candidates(1e-2))
        for speed, reference in zip(case.beside, case.references_beside):
            peaks = case.at(speed, mesh, step, way).peaks
            for quantity in case.promised(1e-2):
                self.assertLess(abs(peaks[quantity] / reference[quantity] - 1.0), 1e-2)
        seconds, errors = zip(*work_precision.front(case.points, ["deflection"], case.shown))
        self.assertEqual(list(seconds), sorted(seconds))
        self.assertEqual(list(errors), sorted(errors, reverse=True))
        self.assertLess(errors[-1], 1e-3)


    def test_options_of_a_scene_come_after_its_file(self):
        scene = wp.Scene("two coaches", "three_span_train", 0.02, 0, [4], wanted=[],
                         options=wp.TWO_COACHES | {"verbose": "true"})
        case = work_precision.Case(BUILD, self.folder, scene, quick=True)
        point = work_precision.Point(BUILD, self.folder, case.setting(4, 0.02, "genalpha"))
        self.assertIn("vehicles 2,", point.text)


class Promises(unittest.TestCase):
    def test_a_scene(self):
        row, = promises.judge(str(BUILD), "truck", promises.SCENES["truck"], [1e-2], longest=float("inf"))
        self.assertLessEqual(row["worst"], 1.0)
        self.assertEqual(row["judged"], 4)
        self.assertEqual(row["not promised"], [])
        self.assertGreater(row["trials"], 0.0)

    def test_a_late_scene(self):
        name = "stop on a rough track"
        row, = promises.judge(str(BUILD), name, promises.LATE[name], [1e-2], longest=float("inf"))
        self.assertEqual(row["not promised"], [])
        self.assertLessEqual(row["worst"], 1.0)

    def test_drawn_scenes_are_always_the_same(self):
        self.assertEqual(scene_texts.drawn(3), scene_texts.drawn(3))
        self.assertNotEqual(scene_texts.drawn(3)[1], scene_texts.drawn(4)[1])


class Fidelity(InAFolder):
    def test_models_weigh_the_same(self):
        passages = fidelity.Passages(BUILD, self.folder, step=4e-3, elements=4)
        found = {(m, "none", 0.05, 60.0): passages.fixed(m, 60.0, 0.05, "none") for m in fidelity.MODELS}
        errors = fidelity.errors_of(found)
        self.assertEqual(len(errors), 4)
        for key, error in errors.items():
            self.assertLess(abs(error["deflection"]), 0.05, key)  # of a bridge twenty times as heavy as the train

    def test_limits(self):
        errors = {("forces", "none", r, 60.0): {"deflection": e} for r, e in ((0.1, -0.01), (0.2, 0.06), (0.4, 0.0))}
        of = ["forces", "none", ["deflection"], 0.05]
        self.assertEqual(fidelity.limit(errors, *of, [0.1, 0.2, 0.4], [60.0]), 0.1)
        self.assertIsNone(fidelity.limit(errors, *of, [0.2, 0.4], [60.0]))


if __name__ == "__main__":
    unittest.main()
