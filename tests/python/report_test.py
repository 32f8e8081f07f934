"""scripts/traverse-report on small computations: its numbers against the results files, and its messages."""

import pathlib
import sys
import unittest

import h5py
import numpy as np
import openpyxl

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from reported import COACH, LIMITS, SWEEP, Reported  # noqa: E402
import comfort  # noqa: E402
import fatigue  # noqa: E402
from traverse_report import norm_sheet, page, sheets, source  # noqa: E402


class Norm(Reported):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        (cls.folder / "limits.yml").write_text(
            LIMITS + '- {clause: "rule 5", quantity: lm71_deflection_over_span, value: 1/600}\n'
                     '- {clause: "rule 6", quantity: train_over_lm71, value: 1.0e-3}\n', encoding="utf-8")
        cls.compute("norm", SWEEP + "norm: {load_models: [lm71, sw2], alpha: 1.21}\n", "-limits", "limits.yml")

    def test_the_verdict_of_trains_and_load_models_is_in_the_workbook(self):
        book = self.book_of("norm", "--no-governing-run")
        rows, static = self.columns(book["EN 1991-2"]), self.columns(book["static effects"])
        verdicts = self.columns(book["verdicts"])
        with h5py.File(self.folder / "norm.h5") as file:
            norm = file["norm"]
            self.assertEqual(rows["effect"], ["deflection", "moment", "shear", "reaction", "end rotation"])
            for name in ("train_static", "train_dynamic", "model_with_phi", "train_over_model"):
                np.testing.assert_allclose(rows[name], norm[name][:], rtol=1e-12)
            loads = [load for load, _ in file["static/load"].asstr()[:]]
            self.assertEqual(loads, [f"A{i}" for i in range(1, 11)] + ["LM71", "SW/2", "SW/0"])  # the hinge joins the spans
            np.testing.assert_allclose(static["greatest moment of LM71 (N m)"], file["static/moment"][10, :, 1], rtol=1e-12)
            self.assertEqual(verdicts["found"][4], file["verdicts/value"][4])
            self.assertAlmostEqual(verdicts["found"][5], norm["train_over_model"][:].max(), 12)
        self.assertEqual(verdicts["verdict"][4:], ["kept", "broken"])

    def test_the_page_is_there_where_trains_were_compared(self):
        for name, pages in (("norm", 2), ("sweep", 1)):
            source_of = source.Source(self.folder / f"{name}.h5")
            report = page.Report("", "")
            sheets.front(report, source_of, [], None)
            norm_sheet.sheet(report, source_of)
            self.assertEqual(len(report.pages), pages)
            self.assertEqual(norm_sheet.sentence(source_of) != "", pages == 2)


class Numbers(Reported):
    def test_runs_of_a_sweep(self):
        book = self.book_of("sweep", "--no-governing-run")
        runs = self.columns(book["runs"])
        with h5py.File(self.folder / "sweep.h5") as file:
            for name in ("peak_deflection (m)", "peak_acceleration (m/s2)", "peak_moment (N m)"):
                expected = file[f"sweep/{name.split(' ')[0]}"][:].max(axis=2).ravel()
                np.testing.assert_allclose(runs[name], expected, rtol=1e-12)
            np.testing.assert_allclose(runs["speed (m/s)"], np.tile(file["sweep/speed"][:], 10), rtol=1e-12)
            deflection, own = file["sweep/peak_deflection"][:], file["sweep/amplification"][:]
            place = deflection.argmax(axis=2)[..., None]
            np.testing.assert_allclose(runs["amplification (1)"], np.take_along_axis(own, place, 2).ravel(), rtol=1e-12)

    def test_verdicts_of_a_sweep(self):
        rows = self.columns(self.book_of("sweep", "--no-governing-run", "--limits", "limits.yml")["verdicts"])
        with h5py.File(self.folder / "sweep.h5") as file:
            deflection = file["sweep/peak_deflection"][:]
            spans = np.where(file["probes/x"][:] < 20.0, 20.0, 25.0)
            worst = (deflection / spans).max()
            train, speed, _ = np.unravel_index((deflection / spans).argmax(), deflection.shape)
        self.assertAlmostEqual(rows["found"][0], worst, 12)
        self.assertAlmostEqual(rows["margin"][0], 1.0 - worst * 2500.0, 9)
        self.assertEqual(rows["verdict"][0], "broken" if worst > 1 / 2500 else "kept")
        self.assertTrue(rows["run"][0].startswith(f"A{train + 1}, {3.6 * (60 + 5 * speed):g} km/h"), rows["run"][0])
        self.assertEqual(rows["verdict"][1], "kept")
        self.assertEqual(rows["verdict"][2:], ["not judged"] * 2)
        self.assertEqual([rows["found"][i] for i in (2, 3)], [None, None])

    def test_verdicts_that_the_file_holds(self):
        book = self.book_of("judged", "--no-governing-run")
        rows, runs = self.columns(book["verdicts"]), self.columns(book["runs"])
        with h5py.File(self.folder / "judged.h5") as file:
            np.testing.assert_allclose(rows["found"][:3], file["verdicts/value"][:3], rtol=1e-12)
            np.testing.assert_allclose(rows["margin"][:3], file["verdicts/margin"][:3], rtol=1e-9)
            self.assertEqual(rows["verdict"], [row[0] for row in file["verdicts/verdict"].asstr()[:]])
            judged = file["sweep/judged"][:].reshape(-1, 4)
            np.testing.assert_allclose(runs["deck_acceleration (m/s2)"], judged[:, 2], rtol=1e-12)
            self.assertIn(f"broken in {np.count_nonzero(judged[:, 2] > 1e-3)} of 110 runs", rows["where"][2])
            worst = int(judged[:, 2].argmax())
        self.assertEqual(rows["verdict"][2], "broken")
        self.assertTrue(rows["run"][2].startswith(f"A{worst // 11 + 1}, {3.6 * (60 + 5 * (worst % 11)):g} km/h"))

    def test_each_train_has_its_speeds_at_which_a_limit_is_broken(self):
        rows = self.columns(self.book_of("sweep", "--no-governing-run", "--limits", "limits.yml")["cases"])
        with h5py.File(self.folder / "sweep.h5") as file:
            spans = np.where(file["probes/x"][:] < 20.0, 20.0, 25.0)
            values = (file["sweep/peak_deflection"][:] / spans).max(axis=2)
            speed = 3.6 * file["sweep/speed"][:]
        self.assertGreater(np.count_nonzero(values > 1 / 2500), 0, "the test needs a broken limit")
        for i in range(10):
            self.assertEqual(rows["case"][i], f"A{i + 1}")
            self.assertAlmostEqual(rows["greatest"][i], values[i].max(), 12)
            inside = np.zeros(len(speed), dtype=bool)
            for part in filter(None, (rows["broken at speed (km/h)"][i] or "").split("; ")):
                low, high = map(float, part.split(" to "))
                inside |= (speed > low - 1e-3) & (speed < high + 1e-3)
            np.testing.assert_array_equal(inside, values[i] > 1 / 2500)

    def test_the_governing_run_is_that_of_the_table(self):
        book = self.book_of("sweep", "--limits", "limits.yml")
        rows = self.columns(book["verdicts"])
        self.assertEqual(rows["verdict"][2], "broken")  # by its time history alone
        self.assertTrue(rows["run"][2].endswith("alone"), rows["run"][2])
        words = rows["run"][2].split(", ")
        train, speed = int(words[0][1:]) - 1, float(words[1].split(" ")[0])
        with h5py.File(self.folder / "sweep.h5") as file:
            at = int(np.argmin(np.abs(3.6 * file["sweep/speed"][:] - speed)))
            probes, expected = file["probes/x"][:], file["sweep/peak_deflection"][train, at]
            static = file["sweep/static_deflection"][train]
        envelope = self.columns(book["governing envelope"])
        for x, peak, rest in zip(probes, expected, static):
            i = int(np.argmin(np.abs(np.array(envelope["x (m)"]) - x)))
            found = max(-envelope["least deflection (m)"][i], envelope["greatest deflection (m)"][i])
            self.assertLess(abs(found / peak - 1.0), 1e-3)
            # The two look for the train's worst place in other steps (0.3 % apart beside the hinge); other trains are
            # 3 % and more away.
            self.assertLess(abs(envelope["static deflection (m)"][i] / rest - 1.0), 1e-2)

    def test_statistics_of_a_study(self):
        rows = self.columns(self.book_of("study", "--no-governing-run")["statistics"])
        with h5py.File(self.folder / "study.h5") as file:
            mean = file["study/statistics/peak_deflection_mean"][:].max(axis=1)
            values = [value for value, name in zip(rows["mean"], rows["quantity"]) if name == "greatest deflection"]
            np.testing.assert_allclose(values, 1e3 * mean, rtol=1e-12)
            self.assertEqual(len(values), 3)

    def test_the_history_of_a_run(self):
        book = self.book_of("crossing")
        rows = self.columns(book["history"])
        with h5py.File(self.folder / "crossing.h5") as file:
            worst = int(np.abs(file["probes/deflection"][:]).max(axis=0).argmax())
            x = file["probes/x"][worst]
            np.testing.assert_allclose(rows[f"moment at {x:g} m (N m)"], file["probes/moment"][:, worst], rtol=1e-12)
            np.testing.assert_allclose(rows["bearing force at 45 m (N)"], file["supports/reaction"][:, 2, 1], rtol=1e-12)
            verdicts = self.columns(book["verdicts"])
            self.assertEqual(verdicts["verdict"], [row[0] for row in file["verdicts/verdict"].asstr()[:]])
            np.testing.assert_allclose(verdicts["found"][:3], file["verdicts/value"][:3], rtol=1e-12)


class ComfortAndCycles(Reported):
    def test_comfort_of_a_coach(self):
        rows = self.columns(self.book_of("coach")["comfort"])
        self.assertEqual(rows["from its centre (m)"], [-8.6875, 0.0, 8.6875])  # the secondary springs
        with h5py.File(self.folder / "coach.h5") as file:
            a = file["vehicles/0/car/acceleration"][:]
        for i, x in enumerate(rows["from its centre (m)"]):
            felt = comfort.comfort(a[:, 1] + x * a[:, 2], 0.005)
            self.assertAlmostEqual(rows["Wb (m/s2)"][i], felt.weighted, places=12)
            self.assertAlmostEqual(rows["Sperling"][i], felt.sperling, places=12)
        self.assertLess(rows["rms (m/s2)"][1], min(rows["rms (m/s2)"][0], rows["rms (m/s2)"][2]))

    def test_cycles_of_the_moments(self):
        book = self.book_of("coach", "--factor", "1/0.35", "--line", "slope:5,71e6,2e6", "--passages", "60")
        rows = self.columns(book["cycles"])
        with h5py.File(self.folder / "coach.h5") as file:
            probes, moments = list(file["probes/x"][:]), file["probes/moment"][:]
        self.assertIn(20.0, rows["probe (m)"])
        for p, x in enumerate(rows["probe (m)"]):
            moment = moments[:, probes.index(x)]
            cycles = fatigue.rainflow(moment)
            self.assertAlmostEqual(rows["largest range (N m)"][p] / np.ptp(moment), 1.0, places=12)
            wanted = sum(c.count * c.range ** 5 for c in cycles) ** 0.2
            self.assertAlmostEqual(rows["equivalent range, slope 5 (N m)"][p] / wanted, 1.0, places=12)
            damage = (wanted / 0.35 / 71e6) ** 5 / 2e6
            self.assertAlmostEqual(rows["damage of a passage"][p] / damage, 1.0, places=10)

    def test_of_the_governing_run(self):
        book = self.book_of("judged")
        self.assertIn("governing cycles", book.sheetnames)
        self.assertNotIn("governing comfort", book.sheetnames)  # forces alone

    def test_a_series_too_coarse_is_said(self):
        self.compute("coarse", COACH, "-output_interval", "0.02")
        book = self.book_of("coarse")
        self.assertNotIn("comfort", book.sheetnames)


class BadInput(Reported):
    def refused(self, *words):
        run = self.report(*words)
        self.assertEqual(run.returncode, 1, run.stdout)
        self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)
        return run.stderr

    def test_one_clear_line(self):
        (self.folder / "text.h5").write_text("no file", encoding="utf-8")
        (self.folder / "bad.yml").write_text("- {clause: a, value: 1}\n", encoding="utf-8")
        with h5py.File(self.folder / "other.h5", "w") as file:
            file["x"] = [1.0]
        self.assertIn("text.h5 is no results file", self.refused("text.h5"))
        self.assertIn("missing.h5 is no results file", self.refused("missing.h5"))
        self.assertIn("no results file of traverse", self.refused("other.h5"))
        self.assertIn("bad.yml", self.refused("crossing.h5", "--limits", "bad.yml"))
        self.assertIn("none.yml", self.refused("crossing.h5", "--limits", "none.yml"))
        self.assertIn("nowhere", self.refused("crossing.h5", "-o", "nowhere/report"))

    def test_words_of_fatigue_that_cannot_be_meant(self):
        for words, said in ((("--line", "en1993:-1"), "allowed: en1993:CATEGORY"), (("--passages", "0"), "above 0"),
                            (("--factor", "a"), "allowed: a number")):
            run = self.report("crossing.h5", *words)
            self.assertEqual(run.returncode, 2)
            self.assertIn(said, run.stderr)

    def test_a_governing_run_that_fails_is_said(self):
        run = self.report("sweep.h5", "--program", "/bin/false", "-o", "failed", "--limits", "limits.yml")
        self.assertEqual(run.returncode, 0, run.stderr)
        verdicts = self.columns(openpyxl.load_workbook(self.folder / "failed.xlsx")["verdicts"])
        self.assertEqual(verdicts["verdict"][2], "not judged")
        self.assertIn("could not be repeated", run.stdout)


if __name__ == "__main__":
    unittest.main()
