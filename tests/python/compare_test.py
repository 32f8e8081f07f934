"""scripts/compare.py: several results in common axes, with the numbers of their files."""

import pathlib
import sys
import unittest
from unittest import mock

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from drawn import Drawn, texts, write_run  # noqa: E402
from small_runs import CROSSING, Computed  # noqa: E402
import compare  # noqa: E402
import compare_data  # noqa: E402
import picture_page  # noqa: E402
import picture_table  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402


class CompareTest(Drawn):
    def files(self, *speeds, **changes):
        """One run for each speed in m/s."""
        paths = []
        for i, speed in enumerate(speeds):
            paths.append(self.folder / f"run_{i}.h5")
            write_run(paths[-1], **changes)
            with h5py.File(paths[-1], "a") as file:
                file["options"][0, 1] = speed
                file["probes/deflection"][...] *= 1.0 + i
                file["summary"].attrs.update({"deflection": -1e-3 * (1.0 + i), "amplification": 1.2})
        return paths

    def compared(self, paths, *names):
        """The readable figure of a comparison."""
        cases = compare_data.opened_cases(paths)
        figure = self.figure_of(lambda: compare.draw(cases, "out.png", []))
        for case in cases:
            case.results.file.close()
        return self.assert_readable(figure, *names)

    def test_runs_in_common_axes_with_their_peaks_and_options(self):
        paths = self.files("50", "50")
        with h5py.File(paths[1], "a") as file:
            texts(file, "more", [["-beam_mass", "2e4"]])
            rows = np.concatenate([file["options"][:], file["more"][:]])
            del file["options"]
            file["options"] = rows
        figure = self.compared(paths, "Comparison of 2 results", "beam_mass not given", "beam_mass 20 t/m", "time (s)",
                               "−2 (+100 %)", "1.2 (0 %)", "Options in which the files differ")
        picture_table.write(figure, self.folder / "both.csv")
        with open(self.folder / "both.csv", encoding="utf-8") as file:
            self.assertIn("middle of span 2 (30 m): beam_mass 20 t/m (mm)", file.readline())
        curves = {name: values for ax in figure.axes[:1] for name, _, values, _ in ax.kept_curves}
        for path, name in zip(paths, ("beam_mass not given", "beam_mass 20 t/m")):
            with h5py.File(path) as file:
                greater = file["probes/deflection"][:, 1]
                np.testing.assert_array_equal(curves[name], 1e3 * greater)

    def test_other_speeds_are_drawn_over_the_place(self):
        paths = self.files("50", "60")
        for path in paths:
            with h5py.File(path, "a") as file:
                file["model/train"] = [[0.0, 0.0]]
                texts(file, "model/vehicles/0/names", [["coach", "car"], ["coach", "axle"]])
                file["model/vehicles/0/bodies"] = [[0.0, 1.5, 1e3], [0.0, 0.5, 1e2]]
                file["model/vehicles/0/wheels"] = [[1.0, 0.5, 0.5], [-1.0, 0.5, 0.5]]
                rows = np.concatenate([file["options"][:], [[b"-vehicle_coach_wheels", b"front_wheel,rear_wheel"]]])
                del file["options"]
                file["options"] = rows
        figure = self.compared(paths, "train_speed 180 km/h", "train_speed 216 km/h", "place of the first wheel or force (m)")
        with h5py.File(paths[0]) as file:
            np.testing.assert_allclose(figure.axes[0].kept_curves[0][1], file["vehicles/0/axle/position"][:, 0] + 1.0)

    def test_many_options_leave_the_names_of_the_files(self):
        paths = self.files("50", "60")
        with h5py.File(paths[1], "a") as file:
            rows = np.concatenate([file["options"][:], [[b"-a", b"1"], [b"-b", b"2"], [b"-c", b"3"]]])
            del file["options"]
            file["options"] = rows
        self.compared(paths, "run_0", "run_1")

    def test_eight_files_and_long_values_fit(self):
        paths = self.files(*(f"5{i}" for i in range(8)))
        for i, path in enumerate(paths):
            with h5py.File(path, "a") as file:
                rows = np.concatenate([file["options"][:], [[b"-long", b"0123456789" * (10 + i)]]])
                del file["options"]
                file["options"] = rows
        self.compared(paths, "run_7", "Options in which the files differ")

    def test_rails_and_static_effects(self):
        paths = [self.folder / f"rail_{i}.h5" for i in range(2)]
        for i, path in enumerate(paths):
            with h5py.File(path, "w") as file:
                file["rail_forces/x"] = file["rail_forces/sleeper_x"] = [0.0, 30.0, 60.0]
                file["static/x"] = [0.0, 12.5, 25.0]
                for side, sign in (("least", -1.0), ("greatest", 1.0)):
                    file[f"rail_forces/in_sequence/{side}_stress"] = sign * np.array([0.0, 5e7, 0.0])
                    file[f"rail_forces/in_sequence/{side}_slip"] = sign * np.array([0.0, 2e-3, 0.0])
                file["rail_forces/in_sequence/tension"] = [7.2e7 * (1.0 + 0.1 * i), 0.0, 0.0]
                file["rail_forces/in_sequence/compression"] = [-6.0e7, 0.0, 0.0]
                for name in ("deflection", "moment", "shear"):
                    file[f"static/{name}"] = (1.0 + i) * np.array([[[0.0, 0.0], [-2.0, 1.0], [0.0, 0.0]]] * 2)
        figure = self.compared(paths, "Additional stress of the rails", "79.2 (+10 %)", "−60 (0 %)", "Shear force",
                               "rail_1")
        stress = next(ax for ax in figure.axes if ax.get_ylabel() == "MPa")
        self.assertEqual(list(stress.kept_curves[1][2]), [0.0, 50.0, 0.0])

    def test_refuses_in_one_line(self):
        paths, out = self.files("50", "60"), self.folder / "out.png"
        self.assert_refused(self.run_script("compare.py", paths[0], "-o", out), "2 to 8 results files")
        self.assert_refused(self.run_script("compare.py", paths[0], self.folder / "no.h5", "-o", out), "no.h5")
        with h5py.File(paths[1], "w") as file:
            file["modes/frequency"] = [1.0]
        self.assert_refused(self.run_script("compare.py", *paths, "-o", out), "no quantity in common")
        self.assertFalse(out.exists())


class ComputedTest(Computed):
    """Runs and studies of the program."""

    @classmethod
    def prepare(cls):
        study = CROSSING + """
study: {vary: {load_speed: {from: 20.0, to: 80.0, step: 10.0}, beam_mass: [1.6e4, 1.8e4, 2.0e4]}}
"""
        for k in (1, 2):
            cls.compute(f"run_{k}", CROSSING, "-model_damping_ratios", f"{0.01 * k}")
            cls.compute(f"study_{k}", study, "-model_damping_ratios", f"{0.01 * k}")

    def cases(self, name):
        found = compare_data.opened_cases(self.folder / f"{name}_{k}.h5" for k in (1, 2))
        self.addCleanup(lambda: [case.results.file.close() for case in found])
        return found

    def kept(self, cases):
        """{title: {curve: values}} of the comparison."""
        figures = []
        with mock.patch.object(picture_page, "save", lambda figure, *others: figures.append(figure)):
            compare.draw(cases, "out.png", [])
        self.addCleanup(plt.close, figures[0])
        return {ax.get_title(loc="left").replace("\n", " "): {name: values for name, _, values, _ in ax.kept_curves}
                for ax in figures[0].axes if hasattr(ax, "kept_curves")}

    def test_peaks_of_runs_are_those_of_the_summary(self):
        cases = self.cases("run")
        first, second = (case.results.file["summary"].attrs["deflection"] for case in cases)
        (words, unit, values, _), *_ = compare_data.peaks(cases)
        self.assertEqual((words, unit, values), ("greatest deflection", "mm", [1e3 * first, 1e3 * second]))
        head, rows = compare.peak_rows(cases)
        self.assertEqual(head[1:], ["model_damping_ratios 0.01", "model_damping_ratios 0.02"])
        self.assertIn(f"({100.0 * (second / first - 1.0):+.3g} %)".replace("-", "−"), rows[0][2])
        places = [case.results.file["summary"].attrs for case in cases]
        with mock.patch.dict(cases[1].results.summary, deflection_place=places[0]["deflection_place"] + 1.0):
            _, (row, *_) = compare.peak_rows(cases)
        self.assertTrue(row[2].endswith(f"(at {places[0]['deflection_place'] + 1.0:.5g} m)"), row)
        curves = next(iter(self.kept(cases).values()))
        deflection = 1e3 * cases[1].results.file["probes/deflection"][:]
        self.assertIn(list(curves["model_damping_ratios 0.02"]), [list(column) for column in deflection.T])

    def test_studies_are_compared_over_the_common_option(self):
        cases = self.cases("study")
        kept = self.kept(cases)
        title = "Greatest deflection, the greatest over all other varied options"
        for case in cases:
            study = case.results.file["study"]
            peaks = np.abs(study["peak_deflection"][:]).max(axis=1).reshape(study["shape"][:].astype(int))
            speeds = str(study.attrs["axes"]).split(",").index("load_speed")
            np.testing.assert_allclose(kept[title][case.name], 1e3 * peaks.max(axis=1 - speeds))

    def test_the_factor_of_judged_values_is_named(self):
        def file(name, factor):
            path = self.folder / f"{name}.h5"
            with h5py.File(path, "w") as out:
                texts(out, "options", [["-beam_EI", name]])
                out["probes/x"] = [10.0]
                out["supports/x"] = [0.0, 20.0]
                out["sweep/speed"], out["sweep/hslm_a"] = [40.0, 50.0], [1.0]
                out["sweep/peak_deflection"] = np.ones((1, 2, 1))
                out["sweep/judged"] = factor * np.array([[[1.0, 1e-3], [2.0, 2e-3]]])
                texts(out, "verdicts/quantity", [["deck_acceleration", "m/s2"], ["deflection_over_span", "1"]])
                texts(out, "verdicts/clause", [["A2", ""]] * 2)
                out["verdicts/limit"], out["verdicts/factor"] = [3.5, 1e-2], [factor, 1.0]
            return path

        title = "Greatest deck acceleration, low-pass filtered"
        for factors in ((1.14, 1.14), (1.14, 1.05)):
            cases = compare_data.opened_cases([file(f"{k + 1}e10", factor) for k, factor in enumerate(factors)])
            self.assertEqual([case.name for case in cases], ["beam_EI 10\u202f000 MN m²", "beam_EI 20\u202f000 MN m²"])
            kept = self.kept(cases)
            if factors[0] == factors[1]:
                self.assertEqual(list(kept[f"{title} × 1.14"]), [case.name for case in cases])
            else:
                self.assertEqual(list(kept[title]), [f"{case.name}, × {f}" for case, f in zip(cases, factors)])
            np.testing.assert_allclose(kept["Deflection over span length"][f"{cases[0].name}"], [1.14, 2.28])
            for case in cases:
                case.results.file.close()

    def test_what_never_occurs_has_no_panel(self):
        cases, worst_over = self.cases("study"), compare_data.worst_over
        with mock.patch.object(compare_data, "worst_over", lambda one, name, label: worst_over(
                one, "peak_moment", label) if name == "longest_loss" else worst_over(one, name, label)):
            self.assertIn("Longest loss of wheel-rail contact", " ".join(self.kept(cases)))
        with mock.patch.object(compare_data, "worst_over", lambda one, name, label: (
                np.arange(2.0), np.zeros(2)) if name == "longest_loss" else worst_over(one, name, label)):
            self.assertNotIn("Longest loss of wheel-rail contact", " ".join(self.kept(cases)))


if __name__ == "__main__":
    unittest.main()
