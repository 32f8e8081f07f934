"""scripts/picture.py on searches and sensitivity analyses: what is written and drawn are the numbers of the file."""

import pathlib
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from drawn import Drawn, texts  # noqa: E402
import picture_data  # noqa: E402
import picture_sensitivity  # noqa: E402
import picture_table  # noqa: E402
from search_answers import parts_of  # noqa: E402
from sensitivity_measures import Analysis  # noqa: E402


def write_study(file, axes):
    """A study of (name, unit, values, law, axis), whose axes have the lengths of the values."""
    lengths = {axis: len(values) for _, _, values, _, axis in axes}
    shape = [lengths[axis] for axis in sorted(lengths)]
    file.attrs.update({"scene": "small", "runs": int(np.prod(shape)), "wall_seconds": 0.5})
    file["study/shape"] = np.array(shape, dtype=float)
    file["study"].attrs.update({"dimensions": ",".join(name for name, *_ in axes), "modes": 3})
    for name, unit, values, law, axis in axes:
        grid = np.broadcast_to(np.reshape(values, [-1 if i == axis else 1 for i in range(len(shape))]), shape)
        file[f"study/{name}"] = grid.ravel()
        file[f"study/{name}"].attrs.update({"axis": axis, "law": law, "unit": unit})
    file["study/finished"] = np.ones(int(np.prod(shape)))
    file["study/peak_deflection"] = np.ones((int(np.prod(shape)), 1))
    file["supports/x"] = [0.0, 25.0]
    file.create_group("summary").attrs.update({"deflection": 1e-3, "deflection_place": 12.5, "deflection_run": 0})


class SearchTest(Drawn):
    def write_search(self, option, unit, values, ratios, intervals, trains=(), options=(("-find_keep", "limits"),)):
        """ratios: one row for each train and one for all; intervals: (answer, first, last, at both ends)."""
        with h5py.File(self.file, "w") as file:
            write_study(file, [("load_hslm_a", "1", list(trains) or [1.0], "list", 0), (option, unit, values, "list", 1)])
            texts(file, "options", [list(row) for row in options])
            texts(file, "criterion", ["deck_acceleration", "end_rotation"])
            names = [f"load_hslm_a {train:g}" for train in trains] + ["all"]
            texts(file, "answer", names)
            file["find/value"] = values
            file["find/value"].attrs["unit"] = unit
            file["find/ratio"] = ratios
            every = np.arange(len(values))
            worst = np.argmax(np.nan_to_num(ratios[:len(trains) or 1]), axis=0)  # the train with the greatest ratio
            trains_of = [*np.repeat(np.arange(len(trains))[:, None], len(values), axis=1), worst]
            file["find/run"] = np.array([train * len(values) + every for train in trains_of], dtype=float)
            file["find/limit"] = np.ones(np.shape(ratios))
            file["find/interval"] = np.reshape([row[1:3] for row in intervals], (-1, 2))
            file["find/interval_answer"] = np.array([row[0] for row in intervals], dtype=float)
            file["find/interval_at_end"] = np.reshape([row[3] for row in intervals], (-1, 2)).astype(float)
            file["find"].attrs.update({"option": option, "condition": "all limits are kept", "accuracy": 1e-3})

    SPEEDS = np.linspace(40.0, 80.0, 9)

    def test_permitted_speeds_by_train(self):
        first = np.array([0.2, 0.3, 0.5, 1.0, 2.0, 1.0, 0.5, 0.3, 0.2])
        second = np.full(9, 0.4)
        self.write_search("load_speed", "m/s", self.SPEEDS, [first, second, np.maximum(first, second)],
                          [(0, 40.0, 55.0, (1, 0)), (0, 65.0, 80.0, (0, 1)), (1, 40.0, 80.0, (1, 1)),
                           (2, 40.0, 55.0, (1, 0)), (2, 65.0, 80.0, (0, 1))], trains=(3.0, 7.0))
        figure = self.assert_readable(
            self.figure(), "small: speed that keeps all limits", "A3: up to 198; from 234 km/h", "A7: all from 144 to 288 km/h",
            "all runs: up to 198; from 234 km/h", "between 198 and 234:", "(A3)", "searched from 144 to 288 km/h")
        curves, bars = figure.axes
        kept = {name: (x, values) for name, x, values, _ in curves.kept_curves}
        np.testing.assert_allclose(kept["A3"][0], 3.6 * self.SPEEDS)
        np.testing.assert_array_equal(kept["A3"][1], first)
        np.testing.assert_array_equal(kept["A7"][1], second)
        self.assertEqual(set(kept["the bound"][1]), {1.0})
        drawn = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in bars.patches]
        np.testing.assert_allclose(drawn, 3.6 * np.array([[40, 55], [65, 80], [40, 80], [40, 55], [65, 80]]))
        picture_table.write(figure, self.folder / "find.csv")
        self.assertEqual(self.table(self.folder / "find.csv")[
            "Values within the bound, searched from 144 to 288 km/h: A3: ratio at the ends of interval 2"], [1.0, 0.2])

    def test_a_stiffness_with_what_governs_below_it(self):
        values, ratio = np.geomspace(1e10, 1e11, 5), np.array([3.0, 2.0, 1.0, 0.8, 0.7])
        self.write_search("beam_EI", "N m2", values, [ratio], [(0, values[2], values[-1], (0, 1))],
                          options=[["-find_keep", "end_rotation"]])
        figure = self.assert_readable(
            self.figure(), "bending stiffness EI that keeps the limit (rotation of the deck",
            "all runs: from 31\u202f623 MN m²", "below 31\u202f623: rotation of the deck ends")
        self.assertEqual([ax.get_xscale() for ax in figure.axes], ["log", "log"])

    def test_no_value_within_the_bound(self):
        self.write_search("load_speed", "m/s", self.SPEEDS, [np.linspace(3.0, 1.5, 9)], [], options=[
            ["-find_quantity", "peak_deflection"], ["-find_equals", "0.02"]])
        self.assert_drawn("speed with deflection up to 20 mm", "all runs: none",
                          "closest at 288 km/h, 1.5 times the bound")

    def test_unknown_ratios_are_said(self):
        ratio = np.array([0.5, 0.6, np.nan, np.nan, 0.5, 0.5, 0.5, 0.5, 0.5])
        self.write_search("load_speed", "m/s", self.SPEEDS, [ratio], [(0, 40.0, 45.0, (1, 0)), (0, 60.0, 80.0, (0, 1))])
        self.assert_drawn("between 162 and 216: not every run")

    def test_many_answers(self):
        trains = tuple(np.arange(1.0, 31.0))
        self.write_search("load_speed", "m/s", self.SPEEDS, np.full((31, 9), 0.5),
                          [(answer, 40.0, 80.0, (1, 1)) for answer in range(31)], trains=trains)
        self.assert_drawn("(15 answers\nare not drawn)", "A15:", "all runs: all from 144 to 288 km/h")

    def test_a_damaged_file_is_refused_in_one_line(self):
        self.write_search("load_speed", "m/s", self.SPEEDS, [np.full(9, 0.5)], [(0, 40.0, 80.0, (1, 1))])
        with h5py.File(self.file, "a") as file:
            del file["find/limit"]
        self.assert_refused(self.run_script("picture.py", self.file, self.folder / "out.png"), "damaged")

    def test_names_of_answers(self):
        self.assertEqual(parts_of("load_hslm_a 3, beam_mass 2e+04"), [("load_hslm_a", 3.0), ("beam_mass", 2e4)])
        self.assertEqual(parts_of("all"), [])


class SensitivityTest(Drawn):
    FACTORS = ["beam_EI", "beam_mass", "beam_damping_ratios"]

    def write_analysis(self, method, quantities, **measures):
        """quantities: {name: unit}; measures: numbers [quantities][factors]."""
        with h5py.File(self.file, "w") as file:
            write_study(file, [(name, unit, np.arange(1.0, 11.0), "normal", 0)
                               for name, unit in zip(self.FACTORS, ("N m2", "kg/m", "1"))])
            texts(file, "options", [["-study_sensitivity", method]])
            texts(file, "factor", self.FACTORS)
            texts(file, "quantity", list(quantities))
            texts(file, "sensitivity/units", [list(row) for row in quantities.items()])
            for name, numbers in measures.items():
                file[f"sensitivity/{name}"] = np.array(numbers, dtype=float)
            file["sensitivity"].attrs.update({"method": method, "base_samples": 64, "confidence": 0.95})

    def bars(self, ax):
        """{name: numbers from top to bottom} as the table has them."""
        return {name: list(values) for name, _, values, _ in ax.kept_curves}

    def test_indices_of_sobol_are_sorted_by_the_total_index(self):
        total, first = [[0.2, 0.7, 0.001]], [[0.1, 0.6, -0.01]]
        shift = np.array(total)
        self.write_analysis("sobol", {"peak_deflection": "m"}, total=total, total_low=shift - 0.05, total_high=shift + 0.1,
                            first=first, first_low=np.array(first) - 0.02, first_high=np.array(first) + 0.02)
        figure = self.assert_readable(self.figure(), "small, a sensitivity analysis", "whiskers: 95 % confidence",
                                      "mass per length", "0.700 [0.650, 0.800]; alone 0.600", "part of the variance")
        ax, = figure.axes
        kept = self.bars(ax)
        main = picture_sensitivity.MAIN["sobol"]
        self.assertEqual(kept[main], [0.7, 0.2, 0.001])
        np.testing.assert_allclose(kept[f"{main}, high"], [0.8, 0.3, 0.101])
        self.assertEqual(kept[picture_sensitivity.SECOND["sobol"]], [0.6, 0.1, -0.01])
        picture_table.write(figure, self.folder / "bars.csv")
        rows = (self.folder / "bars.csv").read_text(encoding="utf-8").splitlines()
        self.assertTrue(rows[1].startswith("beam_mass,0.7,"), rows)

    def test_effects_of_morris_have_units(self):
        self.write_analysis("morris", {"peak_deflection": "m", "peak_moment": "N m"},
                            mean_effect=[[1e-3, -2e-3, 0.0], [1e3, 2e3, 3e3]], effect_deviation=np.full((2, 3), 5e-4),
                            effect_magnitude=[[1e-3, 2e-3, 5e-4], [1e3, 2e3, 3e3]],
                            effect_magnitude_low=[[5e-4, 1e-3, 1e-4], [9e2, 1e3, 2e3]],
                            effect_magnitude_high=[[2e-3, 3e-3, 6e-4], [2e3, 3e3, 4e3]])
        figure = self.assert_readable(self.figure(), "2 [1, 3] mm; deviation 0.5", "3 [2, 4] kN m", "64 trajectories")
        self.assertEqual(self.bars(figure.axes[1])[picture_sensitivity.MAIN["morris"]], [3.0, 2.0, 1.0])

    def test_changes_for_one_deviation_have_signs(self):
        self.write_analysis("local", {"peak_deflection": "m"}, derivative=[[-1e-12, 2e-7, 0.0]],
                            derivative_error=[[1e-13, 0.0, 1.0]], elasticity=[[1.0, 1.0, 0.0]],
                            effect_of_deviation=[[-4e-3, 1e-3, 0.0]])
        figure = self.assert_readable(self.figure(), "−4 ± 0.4 mm", "1 ± 0 mm", "central differences")
        kept, main = self.bars(figure.axes[0]), picture_sensitivity.MAIN["local"]
        self.assertEqual(kept[main], [-4.0, 1.0, 0.0])
        np.testing.assert_allclose(kept[f"{main}, low"], [-4.4, 1.0, 0.0])

    def test_at_most_four_quantities_and_those_of_limits_first(self):
        names = ["peak_deflection", "peak_acceleration", "peak_moment", "amplification", "deck_acceleration"]
        ones = np.ones((5, 3))
        self.write_analysis("morris", dict.fromkeys(names, "1"), mean_effect=ones, effect_deviation=ones,
                            effect_magnitude=ones, effect_magnitude_low=ones, effect_magnitude_high=ones)
        with h5py.File(self.file, "a") as file:
            texts(file, "criterion", ["deck_acceleration"])
            analysis = Analysis(picture_data.Results(file))
            self.assertEqual(picture_sensitivity.shown_quantities(analysis, ["moment"]),
                             ["deck_acceleration", "peak_moment", "peak_deflection", "peak_acceleration"])
        self.assertEqual(len(self.figure().axes), 4)


if __name__ == "__main__":
    unittest.main()
