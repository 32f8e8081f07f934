"""Fits from outside: measurements that another program made, the Python function, the picture."""

import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
PROGRAM = os.environ.get("TRAVERSE_BINARY", str(SOURCE / "build" / "traverse"))
sys.path[:0] = [str(SOURCE / "benchmarks"), str(SOURCE / "scripts"), str(SOURCE / "python")]
import checked_results  # noqa: E402
import fit_draws  # noqa: E402
import picture  # noqa: E402
import traverse  # noqa: E402
import yaml  # noqa: E402

TRUE = (1.1e10, 8.4e3, 0.014)
NAMES = ["beam_EI", "beam_mass", "model_damping_ratios", "midspan_shift"]


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def record(self, noise, shift=0.3, seed=5):
        t, values, sd = fit_draws.measurement(*TRUE, shift, noise, seed)
        fit_draws.write_series(self.folder / "measured.csv", t, values)
        return sd


class Fits(InFolder):
    def test_recovery_without_noise(self):
        self.record(0.0)
        found, error, _ = fit_draws.fit(PROGRAM, self.folder, fit_draws.SCENE.replace(", sd: SD", ""))
        for name, true in zip(NAMES, (*TRUE, 0.3)):
            self.assertAlmostEqual(found[name] / true, 1.0, delta=1e-4)

    def test_standard_errors_cover_the_noise(self):
        """The squares of 18 standardised errors of independent draws: chi-squared with 18 degrees of freedom."""
        total = 0.0
        for number in range(6):
            row = fit_draws.draw(PROGRAM, self.folder, 100 + number)
            # The three estimates of a draw are correlated, but their sum of squares has the same mean of 3.
            total += sum(float(row[f"{name} error"]) ** 2 for name in NAMES[:3])
        self.assertGreater(total, 2.0)   # exceeded with probability 0.99 even for a single common error of each draw
        self.assertLess(total, 3.0 * 22.5)  # 0.999 of chi-squared with 6 degrees of freedom, for three equal errors

    def test_several_minima_are_counted(self):
        """With the stiffness known, other masses meet the oscillation a period early or late."""
        self.record(0.01, shift=0.0)
        scene = yaml.safe_load(fit_draws.SCENE.replace(", sd: SD", "").replace("align: true", "align: false"))
        scene["beam"]["EI"], scene["model"]["damping_ratios"] = TRUE[0], TRUE[2]
        scene["fit"] |= {"vary": {"beam_mass": [1.0e3, 9.0e4]}, "starts": 12}
        results = traverse.fit(scene, folder=self.folder)
        misfits = results["starts_misfit"].values
        self.assertAlmostEqual(results["estimate"].sel(unknown="beam_mass") / TRUE[1], 1.0, delta=1e-3)
        self.assertGreater(results.attrs["summary_minima"], 2)
        self.assertGreater(np.sort(misfits)[-1], 10.0 * misfits.min())
        self.assertAlmostEqual(misfits.min(), results.attrs["summary_misfit"], delta=1e-9 * misfits.min())


class Module(InFolder):
    def test_measurements_of_a_dictionary(self):
        scene = {"beam": {"spans": 30.0, "EI": 1.0e10, "mass": 9.0e3}}
        f1 = np.pi / 2.0 * np.sqrt(1.2e10 / 9.0e3) / 30.0**2
        results = traverse.fit(scene, {"beam_EI": [5e9, 2e10]}, {"first": {"frequency": 1, "value": f1, "sd": 0.01}})
        self.assertAlmostEqual(results["estimate"].sel(unknown="beam_EI") / 1.2e10, 1.0, delta=2e-3)
        self.assertEqual(results["frequencies_measured"].values.tolist(), [f1])
        self.assertAlmostEqual(results["frequencies_computed"].sel(measured_frequency="first") / f1, 1.0, delta=1e-5)
        with self.assertRaisesRegex(traverse.Error, "fit_to is missing"):
            traverse.fit(scene, {"beam_EI": [5e9, 2e10]})

    def test_any_dataset_over_time(self):
        """The record is a run with another mass: number 5 in the rows of the reactions is fy of the second support."""
        scene = {"beam": {"spans": 30.0, "EI": 1.0e10, "mass": 9.0e3}, "load": {"forces": 1.0e5, "speed": 30.0},
                 "model": {"modes": 3}, "output": {"interval": 0.01}}
        run = traverse.run(scene, beam_mass=1.0e4)
        fit_draws.write_series(self.folder / "r.csv", run["time"].values, run["supports_reaction"].values[:, 1, 1])
        found = traverse.fit(scene, {"beam_mass": [5e3, 2e4]}, {"right": {
            "series": "r.csv", "dataset": "supports/reaction", "component": 5, "offset": True}}, folder=self.folder)
        self.assertAlmostEqual(found["estimate"].sel(unknown="beam_mass") / 1.0e4, 1.0, delta=1e-4)
        self.assertEqual(found["series_right_measured"].attrs["units"], "N")

    def test_example_and_its_picture(self):
        results = traverse.fit(SOURCE / "options" / "studies" / "fit_to_a_passage.yml", output=self.folder / "fit.h5")
        for name, true in zip(NAMES, (1.08e10, 8.7e3, 0.018, 0.25)):
            one = results.sel(unknown=name)
            self.assertLess(abs(one["estimate"] - true), 3.0 * one["standard_error"])
        self.assertEqual(results["series_midspan_measured"].dims, ("series_midspan_time",))
        self.assertTrue(np.all(np.linalg.eigvalsh(results["correlation"].values) > 0.0))
        out = self.folder / "fit.png"
        with contextlib.redirect_stdout(io.StringIO()), checked_results.opened(self.folder / "fit.h5") as file:
            picture.draw(picture.Results(file), out, formats=["png", "csv"])
        self.assertGreater(out.stat().st_size, 20000)
        self.assertIn("midspan: deflection at 13 m: measured (mm)", out.with_suffix(".csv").read_text().splitlines()[0])


if __name__ == "__main__":
    unittest.main()
