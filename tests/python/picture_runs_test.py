"""scripts/picture.py on sweeps and studies: each frame has no more curves than a reader can name, and their numbers are
those of the results file."""

import pathlib
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from drawn import Drawn, texts  # noqa: E402
import picture_data  # noqa: E402
import picture_runs  # noqa: E402
import picture_speeds  # noqa: E402
import picture_table  # noqa: E402
import picture_words  # noqa: E402
from matplotlib.collections import QuadMesh  # noqa: E402


class SweepTest(Drawn):
    def write_sweep(self, trains, missing=(), limit=None):
        """Trains with a peak each, at rising speeds, over 31 speeds of 30 to 90 m/s."""
        speed, middle = np.linspace(30.0, 90.0, 31), np.linspace(35.0, 80.0, trains)[:, None]
        peaks = 1e-3 * (1.0 + np.linspace(1.0, 3.0, trains)[:, None] / (1.0 + ((speed - middle) / 2.0) ** 2))
        for train, at in missing:
            peaks[train, at] = np.nan
        with h5py.File(self.file, "w") as file:
            file.attrs.update({"scene": "trains", "runs": trains * 31, "wall_seconds": 0.5})
            file["sweep/speed"] = speed
            file["sweep/peak_deflection"] = np.stack([peaks, 0.5 * peaks], axis=-1)
            file["sweep/hslm_a"] = np.arange(1.0, trains + 1)
            file["sweep"].attrs.update({"modes": 3, "elements_per_span": 10})
            file["supports/x"] = [0.0, 25.0]
            file.create_group("summary").attrs.update({
                "deflection": 0.0675, "deflection_place": 12.5, "deflection_speed": 95.5555556, "deflection_train": 10,
                "amplification": 8.15, "greatest_amplification": 9.9, "runs": trains * 31})
            if limit:
                texts(file, "verdicts/quantity", [["deflection_over_span", "1"], ["deck_acceleration", "m/s2"]])
                texts(file, "verdicts/clause", [["EN 1990", "deflection"], ["EN 1990", "acceleration"]])
                file["verdicts/limit"] = [limit, 3.5]
                file["sweep/judged"] = np.stack([peaks / 25.0, 2000.0 * peaks], axis=-1)
        return peaks

    def test_ten_trains_can_be_told_apart(self):
        peaks = self.write_sweep(10)
        figure = self.assert_readable(self.figure(), *(f"A{i}:" for i in range(1, 11)))
        ax, = figure.axes
        named = {text.get_text() for text in ax.texts}
        self.assertLessEqual({f"A{i}" for i in range(1, 11)}, named)  # each at its peak
        coloured = [line.get_color() for line in ax.get_lines() if line.get_color() in picture_speeds.COLOURS]
        self.assertEqual(len(coloured), picture_speeds.MOST_NAMED)
        self.assertEqual(len(set(coloured)), len(coloured))
        curves = {name: values for name, _, values, _ in ax.kept_curves}
        for i in range(10):
            np.testing.assert_array_equal(curves[f"A{i + 1}"], 1e3 * peaks[i])

    def test_limits_and_where_they_are_exceeded(self):
        peaks = self.write_sweep(10, limit=1e-4)
        figure = self.assert_readable(self.figure(), "limit L/10\u202f000 (EN 1990)", "limit 3.5 m/s² (EN 1990)")
        deflection, acceleration = figure.axes
        speed = 3.6 * np.linspace(30.0, 90.0, 31)
        for ax, values in ((deflection, peaks / 25.0 / 1e-4), (acceleration, 2000.0 * peaks / 3.5)):
            said, = (" ".join(text.get_text().split()) for text in ax.texts if text.get_text().startswith("above limit"))
            of_trains = dict(f"{part}: ".split(": ")[:2] for part in said.split(": ", 1)[1].split("; "))
            broken = np.flatnonzero((values > 1.0).any(axis=1))
            named = sorted(broken, key=lambda i: -values[i].max())[:picture_speeds.MOST_NAMED]
            self.assertEqual(len(of_trains) - (len(broken) > len(named)), len(named))
            for i in named:
                first, *_, last = np.append(speed[values[i] > 1.0], speed[values[i] > 1.0][-1])
                self.assertTrue(of_trains[f"A{i + 1}"].startswith(picture_runs.digits(first)), of_trains)
                self.assertIn(picture_runs.digits(last), of_trains[f"A{i + 1}"])
        curves = {name: values for name, _, values, _ in acceleration.kept_curves}
        np.testing.assert_array_equal(curves["A10"], 2000.0 * peaks[9])
        self.assertEqual(set(curves["limit 3.5 m/s² (EN 1990)"]), {3.5})

    def test_a_factor_of_neglected_effects_is_named_and_acts_on_the_limit(self):
        peaks = self.write_sweep(2, limit=1e-4)
        with h5py.File(self.file, "a") as file:
            file["verdicts/factor"] = [1.1, 1.25]
            file["sweep/judged"][...] = file["sweep/judged"][:] * [1.1, 1.25]
        deflection, acceleration = self.assert_readable(self.figure(), "low-pass filtered × 1.25", "limit 3.5 m/s² (EN 1990)",
                                                        "limit L/10\u202f000 of 1.1 times the value").axes
        kept = [{name: values for name, _, values, _ in ax.kept_curves} for ax in (deflection, acceleration)]
        np.testing.assert_allclose(kept[0]["A2"], 1e3 * peaks[1])
        np.testing.assert_allclose(kept[0]["limit L/10\u202f000 of 1.1 times the value (EN 1990)"], 2.5 / 1.1)
        np.testing.assert_allclose(kept[1]["A2"], 1.25 * 2000.0 * peaks[1])
        self.assertEqual(set(kept[1]["limit 3.5 m/s² (EN 1990)"]), {3.5})

    def test_a_limit_far_above_is_named(self):
        self.write_sweep(3, limit=1.0 / 600.0)
        self.assert_drawn("far above: limit L/600 (EN 1990)")

    def test_what_is_missing_is_said(self):
        self.write_sweep(20, missing=[(0, 0), (3, 12)])
        self.assert_drawn("(2 of 620 runs are missing)", "and 6 more, at most")
        self.write_sweep(1, missing=[(0, i) for i in range(31)])
        self.assert_refused(self.run_script("picture.py", self.file, self.folder / "out.png"), "nothing")

    def test_resonances_of_a_single_train(self):
        self.write_sweep(1)
        with h5py.File(self.file, "a") as file:
            del file["sweep/hslm_a"]
            file["resonances/mode"], file["resonances/order"] = [1.0, 1.0, 2.0], [1.0, 2.0, 1.0]
            file["resonances/speed"] = [80.0, 40.0, 60.0]
        self.assert_drawn("i = 1", "i = 2", "i: predicted resonance, v = f1 d/i")

    def test_in_words(self):
        self.write_sweep(10)
        with h5py.File(self.file) as file:
            results = picture_data.Results(file)
            said = "; ".join(picture_words.summary_in_words(results))
            self.assertEqual(picture_words.method_in_words(results), "by 3 modes")
            self.assertEqual(picture_words.sweep_in_words(results), "10 trains, 31 speeds from 108 to 324 km/h")
        self.assertEqual(said, "greatest deflection 67.5 mm, middle of the span (12.5 m) by train A10 at 344 km/h; "
                               "8.15 times the static one")


class StudyTest(Drawn):
    def write_study(self, *axes):
        """A full grid. axes: (option, unit, values, law). The greatest deflection of a run is its number plus 1, mm."""
        shape = [len(values) for _, _, values, _ in axes]
        peaks = 1e-3 * (1.0 + np.arange(np.prod(shape), dtype=float))
        with h5py.File(self.file, "w") as file:
            file.attrs["scene"] = "study"
            file["study/shape"] = np.array(shape, dtype=float)
            file["study"].attrs["dimensions"] = file["study"].attrs["axes"] = ",".join(name for name, *_ in axes)
            for number, (name, unit, values, law) in enumerate(axes):
                grid = np.broadcast_to(np.reshape(values, [-1 if i == number else 1 for i in range(len(axes))]), shape)
                file[f"study/{name}"] = grid.ravel()
                file[f"study/{name}"].attrs.update({"axis": number, "law": law, "unit": unit})
            file["study/finished"] = np.ones(len(peaks))
            file["study/peak_deflection"] = np.stack([peaks, -0.5 * peaks], axis=-1)
            file["supports/x"] = [0.0, 25.0]
            file.create_group("summary").attrs.update({"deflection": peaks[-1], "deflection_place": 12.5,
                                                       "deflection_run": len(peaks) - 1})
        return 1e3 * peaks.reshape(shape)

    SPEED = ("train_speed", "m/s", np.linspace(20.0, 80.0, 13), "list")

    def kept(self, ax):
        return {name: values for name, _, values, _ in ax.kept_curves}

    def test_one_option_is_a_curve(self):
        peaks = self.write_study(("foundation_vertical_k", "N/m", [1e7, 1e8, 1e9], "list"))
        figure = self.assert_readable(self.figure(), "stiffness of the vertical springs (MN/m)",
                                      "in the run with stiffness of the vertical springs 1000 MN/m")
        ax, = figure.axes
        np.testing.assert_allclose(ax.kept_curves[0][1], [10.0, 100.0, 1000.0])
        np.testing.assert_array_equal(ax.kept_curves[0][2], peaks)
        self.assertEqual(ax.get_xscale(), "log")

    def test_options_in_any_order_and_together(self):
        peaks = self.write_study(("beam_mass", "kg/m", [2e4, 1e4, 3e4], "list"))
        with h5py.File(self.file, "a") as file:
            file["study/beam_EI"] = [3.0e10, 2.0e10, 2.0e10]
            file["study/beam_EI"].attrs.update({"axis": 0, "law": "list", "unit": "N m2"})
            file["study"].attrs["dimensions"] = "beam_mass,beam_EI"
        ax, = self.assert_readable(self.figure(), "mass per length with bending stiffness EI (t/m)").axes
        np.testing.assert_array_equal(ax.kept_curves[0][2], peaks[[1, 0, 2]])
        with h5py.File(self.file, "a") as file:
            file["study/beam_mass"][...] = [1e4, 1e4, 3e4]  # is no abscissa
        ax, = self.assert_readable(self.figure(), "row with mass per length with bending stiffness EI").axes
        np.testing.assert_array_equal(ax.kept_curves[0][2], peaks)

    def test_a_few_values_of_the_second_option_are_curves(self):
        peaks = self.write_study(("beam_mass", "kg/m", [1e4, 2e4, 3e4], "list"), self.SPEED)
        ax, = self.assert_readable(self.figure(), "10 t/m:", "speed (km/h)").axes
        np.testing.assert_array_equal(self.kept(ax)["20 t/m"], peaks[1])

    def test_many_values_of_two_options_are_a_heat_map_with_its_numbers(self):
        peaks = self.write_study(("beam_mass", "kg/m", np.linspace(1e4, 3e4, 11), "list"), self.SPEED)
        ax, = self.assert_readable(self.figure(), "mass per length (t/m)").axes
        mesh, = (one for one in ax.collections if isinstance(one, QuadMesh))
        np.testing.assert_array_equal(mesh.get_array().reshape(peaks.shape), peaks)
        self.assertEqual([text.get_text() for text in ax.texts], [f"{value:.3g}" for value in peaks.ravel()])
        np.testing.assert_array_equal(self.kept(ax)["12 t/m"], peaks[1])

    def test_three_options_are_frames(self):
        stiffness = ("foundation_vertical_k", "N/m", [1e8, 1e9], "list")
        for masses in ([1e4, 2e4, 3e4], np.linspace(1e4, 3e4, 11)):
            peaks = self.write_study(("beam_mass", "kg/m", masses, "list"), stiffness, self.SPEED)
            ax, = self.assert_readable(self.figure(), "100 MN/m", "1000 MN/m").axes[:1]
            frames = [one for one in ax.child_axes if hasattr(one, "kept_curves")]
            drawn = sorted((tuple(values) for one in frames for values in self.kept(one).values()))
            self.assertEqual(drawn, sorted(map(tuple, peaks.reshape(-1, 13) if len(masses) > 2 else peaks)))
            self.assertTrue(all(len(one.get_lines()) <= picture_speeds.MOST_LINES for one in frames))

    def test_more_options_are_said_to_be_left_out(self):
        peaks = self.write_study(("beam_mass", "kg/m", [1e4, 2e4, 3e4], "list"),
                                 ("beam_EI", "N m2", [1e10, 2e10], "list"),
                                 ("foundation_vertical_k", "N/m", [1e8, 1e9, 1e10], "list"), self.SPEED)
        ax = self.assert_readable(self.figure(), "(greatest over all values of bending stiffness EI)").axes[0]
        drawn = sorted(tuple(values) for one in ax.child_axes for values in self.kept(one).values())
        self.assertEqual(drawn, sorted(map(tuple, peaks.max(axis=1).reshape(-1, 13))))

    def test_random_draws_have_median_quantiles_and_greatest_value(self):
        peaks = self.write_study(self.SPEED, ("track_seed", "1", np.arange(1.0, 22.0), "list"))
        ax, = self.assert_readable(self.figure(), "median", "band: 5 to 95 % of the draws", "greatest of 21 draws").axes
        kept = self.kept(ax)
        np.testing.assert_allclose(kept["median"], np.median(peaks, axis=1))
        np.testing.assert_allclose(kept["5 % quantile"], np.quantile(peaks, 0.05, axis=1))
        np.testing.assert_allclose(kept["95 % quantile"], np.quantile(peaks, 0.95, axis=1))
        np.testing.assert_array_equal(kept["greatest"], peaks.max(axis=1))

    def test_draws_alone_are_a_distribution(self):
        peaks = self.write_study(("beam_mass", "kg/m", np.linspace(1e4, 2e4, 50), "normal"))
        ax, = self.assert_readable(self.figure(), "50 draws of mass per length", "median:  25.5 mm", "greatest:  50 mm").axes
        np.testing.assert_array_equal(ax.kept_curves[0][1], peaks)

    def test_draws_of_three_options_and_a_single_run(self):
        peaks = self.write_study(("beam_mass", "kg/m", [1e4, 2e4, 3e4], "list"),
                                 ("beam_EI", "N m2", [1e10, 2e10], "list"),
                                 self.SPEED, ("track_seed", "1", np.arange(1.0, 22.0), "list"))
        ax = self.assert_readable(self.figure(), "(greatest over all values of bending stiffness EI)").axes[0]
        drawn = sorted(tuple(self.kept(one)["greatest"]) for one in ax.child_axes)
        self.assertEqual(drawn, sorted(map(tuple, peaks.max(axis=(1, 3)))))
        self.write_study(("beam_mass", "kg/m", [1e4], "list"))
        self.assert_drawn("the only run", "1 mm")

    def test_draws_over_two_options_are_frames(self):
        self.write_study(("beam_mass", "kg/m", [1e4, 2e4, 3e4], "list"), self.SPEED,
                         ("track_seed", "1", np.arange(1.0, 22.0), "uniform"))
        self.assert_drawn("30 t/m", "thick: median")

    def test_a_killed_study_draws_what_it_has(self):
        self.write_study(("beam_mass", "kg/m", np.linspace(1e4, 3e4, 11), "list"), self.SPEED)
        with h5py.File(self.file, "a") as file:
            file["study/peak_deflection"][70:] = np.nan
        self.assert_drawn("(73 of 143 runs are missing)")

    def test_the_table_of_a_heat_map(self):
        peaks = self.write_study(("beam_mass", "kg/m", np.linspace(1e4, 3e4, 11), "list"), self.SPEED)
        picture_table.write(self.figure(), self.folder / "study.csv")
        table = self.table(self.folder / "study.csv")
        self.assertEqual(table["Greatest deflection: 30 t/m (mm)"], list(peaks[-1]))
        np.testing.assert_allclose(table["Greatest deflection: speed (km/h)"], 3.6 * self.SPEED[2])


if __name__ == "__main__":
    unittest.main()
