"""Words, numbers and places of names in pictures."""

import pathlib
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import drawn  # noqa: E402, F401: makes the scripts known
import picture_axes  # noqa: E402
import picture_data  # noqa: E402
import picture_words  # noqa: E402


class WordsTest(unittest.TestCase):
    def test_small_values_have_small_units(self):
        self.assertEqual(picture_axes.legible("mm", [np.array([0.004, -0.005])]), ("µm", 1e3))
        self.assertEqual(picture_axes.legible("mm", [np.array([0.004, -0.5])]), ("mm", 1.0))
        self.assertEqual(picture_axes.legible("kN", [np.zeros(3)]), ("kN", 1.0))
        self.assertEqual(picture_words.millimetres(-5.09e-6), "5.09 µm")

    def test_modes_left_out_are_said(self):
        self.assertEqual(picture_words.modes_in_words(np.ones(10), np.ones((10, 5))), "drawn: the first 6 of 10 modes")
        self.assertEqual(picture_words.modes_in_words(np.ones(3), np.ones((3, 5))), "")

    def test_places(self):
        supports = np.array([0.0, 25.0, 55.0])
        self.assertEqual(picture_data.place_in_words(12.5, supports), "middle of span 1 (12.5 m)")
        self.assertEqual(picture_data.place_in_words(47.5, supports), "three quarters of span 2 (47.5 m)")
        self.assertEqual(picture_data.place_in_words(55.0, supports), "right end of span 2 (55 m)")
        self.assertEqual(picture_data.place_in_words(30.0, supports), "span 2, at 30 m")
        self.assertEqual(picture_data.place_in_words(10.0, np.array([0.0, 20.0])), "middle of the span (10 m)")
        self.assertEqual(picture_data.place_in_words(3.0, None), "at 3 m")

    def test_an_amplification_of_weights_is_said_to_be_one(self):
        with h5py.File("run.h5", "w", driver="core", backing_store=False) as file:
            file.create_group("summary").attrs["amplification"] = 1.01
            results = picture_data.Results(file)
            self.assertEqual(picture_words.summary_in_words(results), ["1.01 times the static one"])
            results.options["beam_self_weight"] = "true"
            self.assertEqual(picture_words.summary_in_words(results),
                             ["1.01 times the static one, both with the weight of the bridge"])

    def test_labels_do_not_overlap(self):
        for wanted in ([0.5] * 6, [0.99, 0.98, 0.02], [0.1, 0.9]):
            placed = np.sort(picture_data.spread(wanted, 0.1, 0.03, 0.97))
            self.assertTrue(np.all(np.diff(placed) > 0.099), placed)
            self.assertTrue(placed[0] >= 0.03 - 1e-3 and placed[-1] <= 0.97 + 1e-3, placed)

    def test_thinning_keeps_peaks(self):
        time = np.linspace(0.0, 1.0, 100001)
        values = np.sin(40 * time)
        values[77777] = 9.0
        t, v = picture_data.thin(time, values)
        self.assertLess(len(t), 10000)
        self.assertEqual(v.max(), 9.0)
        self.assertTrue(np.all(np.diff(t) > 0))


if __name__ == "__main__":
    unittest.main()
