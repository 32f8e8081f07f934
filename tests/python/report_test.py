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
from engineering_units import shown  # noqa: E402
from traverse_report import checks_sheet, front_sheet, norm_sheet, page, quantities, source  # noqa: E402

MM, KNM, KN = (shown(kind)[1] for kind in ("deflection", "moment", "force"))


class Norm(Reported):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        (cls.folder / "norm_limits.yml").write_text(
            LIMITS + '- {clause: "rule 5", quantity: lm71_deflection_over_span, value: 1/600}\n'
                     '- {clause: "rule 6", quantity: train_over_lm71, value: 1.0e-3}\n', encoding="utf-8")
        cls.compute("norm", SWEEP + "norm: {load_models: [lm71, sw2], alpha: 1.21}\n", "-limits", "norm_limits.yml")

    def test_the_verdict_of_trains_and_load_models_is_in_the_workbook(self):
        book = self.book_of("norm", "--no-governing-run")
        rows, static = self.columns(book["EN 1991-2 6.4.6.5"]), self.columns(book["Static effects"])
        verdicts = self.columns(book["Verdicts"])
        with h5py.File(self.folder / "norm.h5") as file:
            norm = file["norm"]
            self.assertEqual(rows["Effect"], ["deflection", "moment", "shear", "reaction", "end rotation"])
            factors = [quantities.unit_of_si(unit)[1] for _, unit in norm["effect"].asstr()[:]]
            for head, name in (("Train, static", "train_static"), ("Train, with dynamic increment", "train_dynamic"),
                               ("Load model, with α and Φ", "model_with_phi")):
                np.testing.assert_allclose(rows[head], factors * norm[name][:], rtol=1e-12)
            np.testing.assert_allclose(rows["Ratio"], norm["train_over_model"][:], rtol=1e-12)
            loads = [load for load, _ in file["static/load"].asstr()[:]]
            self.assertEqual(loads, [f"A{i}" for i in range(1, 11)]
                             + ["LM71", "SW/2", "SW/0"])  # the hinge joins the spans
            np.testing.assert_allclose(static["LM71: greatest, moment (kN m)"], KNM * file["static/moment"][10, :, 1],
                                       rtol=1e-12)
            # The trains of this slender bridge have a larger deflection than LM71: they are judged.
            effect = list(norm["effect"].asstr()[:, 0]).index("deflection")
            span = 20.0 if norm["train_x"][effect] < 20.0 else 25.0
            self.assertGreater(norm["train_dynamic"][effect] / span, file["verdicts/value"][4])
            self.assertAlmostEqual(verdicts["Value"][4], norm["train_dynamic"][effect] / span, 12)
            self.assertIn(f"{norm['train'].asstr()[effect, 0]} at ", verdicts["Position, time"][4])
            self.assertIn("governs", verdicts["Position, time"][4])
            self.assertAlmostEqual(verdicts["Value"][5], norm["train_over_model"][:].max(), 12)
        self.assertEqual(verdicts["Result"][4:], ["exceeded", "exceeded"])

    def test_the_page_is_there_where_trains_were_compared(self):
        for name, pages in (("norm", 2), ("sweep", 1)):
            source_of = source.Source(self.folder / f"{name}.h5")
            report = page.Report()
            front_sheet.sheet(report, source_of, [], None)
            norm_sheet.sheet(report, source_of)
            self.assertEqual(len(report.pages), pages)
            self.assertEqual(norm_sheet.sentence(source_of) != "", pages == 2)


class Numbers(Reported):
    def test_runs_of_a_sweep(self):
        book = self.book_of("sweep", "--no-governing-run")
        runs = self.columns(book["Runs"])
        with h5py.File(self.folder / "sweep.h5") as file:
            for head, name, factor in (("Greatest deflection (mm)", "peak_deflection", MM),
                                       ("Greatest deck acceleration, unfiltered (m/s²)", "peak_acceleration", 1.0),
                                       ("Greatest bending moment (kN m)", "peak_moment", KNM)):
                expected = factor * file[f"sweep/{name}"][:].max(axis=2).ravel()
                np.testing.assert_allclose(runs[head], expected, rtol=1e-12)
            np.testing.assert_allclose(runs["Speed (km/h)"], np.tile(3.6 * file["sweep/speed"][:], 10), rtol=1e-12)
            deflection, own = file["sweep/peak_deflection"][:], file["sweep/amplification"][:]
            place = deflection.argmax(axis=2)[..., None]
            np.testing.assert_allclose(runs["Dynamic amplification of the greatest deflection"],
                                       np.take_along_axis(own, place, 2).ravel(), rtol=1e-12)

    def test_curves_and_envelopes_have_charts_of_their_columns(self):
        book = self.book_of("judged", "--no-governing-run")
        curves, envelope = book["Curves 1"], book["Envelopes"]
        self.assertEqual([len(sheet._charts) for sheet in (curves, envelope)], [1, 3])
        self.assertEqual([cell.value for cell in curves[1]], ["Speed (km/h)"] + [f"A{i} (mm)" for i in range(1, 11)])
        with h5py.File(self.folder / "judged.h5") as file:
            peaks, order = MM * file["sweep/peak_deflection"][:], np.argsort(file["probes/x"][:])
            np.testing.assert_allclose(self.columns(curves)["A7 (mm)"], peaks[6].max(axis=1), rtol=1e-12)
            np.testing.assert_allclose(self.columns(envelope)["Greatest deflection, A7 (mm)"],
                                       peaks[6].max(axis=0)[order], rtol=1e-12)
        references = [series.yVal.numRef.f for series in curves._charts[0].series]
        self.assertEqual(references, [f"'Curves 1'!${letter}$2:${letter}$12" for letter in "BCDEFGHIJK"])
        self.assertEqual(curves.freeze_panes, "B2")
        self.assertEqual(curves["B2"].number_format, "0.000")

    def test_verdicts_of_a_sweep(self):
        rows = self.columns(self.book_of("sweep", "--no-governing-run", "--limits", "limits.yml")["Verdicts"])
        with h5py.File(self.folder / "sweep.h5") as file:
            deflection = file["sweep/peak_deflection"][:]
            spans = np.where(file["probes/x"][:] < 20.0, 20.0, 25.0)
            worst = (deflection / spans).max()
            train, speed, _ = np.unravel_index((deflection / spans).argmax(), deflection.shape)
        self.assertAlmostEqual(rows["Value"][0], worst, 12)
        self.assertAlmostEqual(rows["Margin (%)"][0], 1.0 - worst * 2500.0, 9)
        self.assertAlmostEqual(rows["Utilisation (%)"][0], worst * 2500.0, 9)
        self.assertEqual(rows["Result"][0], "exceeded" if worst > 1 / 2500 else "complied with")
        self.assertTrue(rows["Run"][0].startswith(f"A{train + 1}, {3.6 * (60 + 5 * speed):g} km/h"), rows["Run"][0])
        self.assertEqual(rows["Result"][1], "complied with")
        self.assertEqual(rows["Result"][2:], ["not evaluated"] * 2)
        self.assertEqual([rows["Value"][i] for i in (2, 3)], [None, None])

    def test_verdicts_that_the_file_holds(self):
        book = self.book_of("judged", "--no-governing-run")
        rows, runs = self.columns(book["Verdicts"]), self.columns(book["Runs"])
        words = {"kept": "complied with", "broken": "exceeded", "not judged": "not evaluated"}
        with h5py.File(self.folder / "judged.h5") as file:
            np.testing.assert_allclose(rows["Value"][:3], file["verdicts/value"][:3], rtol=1e-12)
            np.testing.assert_allclose(rows["Margin (%)"][:3], file["verdicts/margin"][:3], rtol=1e-9)
            self.assertEqual(rows["Result"], [words[row[0]] for row in file["verdicts/verdict"].asstr()[:]])
            judged = file["sweep/judged"][:].reshape(-1, 4)
            np.testing.assert_allclose(runs["Greatest deck acceleration, low-pass filtered (m/s²)"], judged[:, 2],
                                       rtol=1e-12)
            self.assertIn(f"exceeded in {np.count_nonzero(judged[:, 2] > 1e-3)} of 110 runs", rows["Position, time"][2])
            worst = int(judged[:, 2].argmax())
        self.assertEqual(rows["Result"][2], "exceeded")
        self.assertTrue(rows["Run"][2].startswith(f"A{worst // 11 + 1}, {3.6 * (60 + 5 * (worst % 11)):g} km/h"))

    def test_each_train_has_its_speeds_at_which_a_limit_is_exceeded(self):
        rows = self.columns(self.book_of("sweep", "--no-governing-run", "--limits", "limits.yml")["Cases"])
        with h5py.File(self.folder / "sweep.h5") as file:
            spans = np.where(file["probes/x"][:] < 20.0, 20.0, 25.0)
            values = (file["sweep/peak_deflection"][:] / spans).max(axis=2)
            speed = 3.6 * file["sweep/speed"][:]
        self.assertGreater(np.count_nonzero(values > 1 / 2500), 0, "the test needs an exceeded limit")
        for i in range(10):
            self.assertEqual(rows["Case"][i], f"A{i + 1}")
            self.assertAlmostEqual(rows["Greatest"][i], values[i].max(), 12)
            inside = np.zeros(len(speed), dtype=bool)
            for part in filter(None, (rows["Exceeded at: speed (km/h)"][i] or "").split("; ")):
                low, high = map(float, part.split(" – "))
                inside |= (speed > low - 1e-3) & (speed < high + 1e-3)
            np.testing.assert_array_equal(inside, values[i] > 1 / 2500)

    def test_the_governing_run_is_that_of_the_table(self):
        book = self.book_of("sweep", "--limits", "limits.yml")
        rows = self.columns(book["Verdicts"])
        self.assertEqual(rows["Result"][2], "exceeded")  # by its time history alone
        self.assertTrue(rows["Run"][2].endswith("governing run only"), rows["Run"][2])
        words = rows["Run"][2].split(", ")
        train, speed = int(words[0][1:]) - 1, float(words[1].split(" ")[0])
        with h5py.File(self.folder / "sweep.h5") as file:
            at = int(np.argmin(np.abs(3.6 * file["sweep/speed"][:] - speed)))
            probes, expected = file["probes/x"][:], MM * file["sweep/peak_deflection"][train, at]
            static = MM * file["sweep/static_deflection"][train]
        envelope = self.columns(book["Governing run envelopes"])
        for x, peak, rest in zip(probes, expected, static):
            i = int(np.argmin(np.abs(np.array(envelope["x (m)"]) - x)))
            found = max(-envelope["Deflection, least (mm)"][i], envelope["Deflection, greatest (mm)"][i])
            self.assertLess(abs(found / peak - 1.0), 1e-3)
            # The two look for the train's worst place in other steps (0.3 % apart beside the hinge); other trains are
            # 3 % and more away.
            self.assertLess(abs(envelope["Greatest static deflection (mm)"][i] / rest - 1.0), 1e-2)

    def test_statistics_of_a_study(self):
        rows = self.columns(self.book_of("study", "--no-governing-run")["Statistics"])
        with h5py.File(self.folder / "study.h5") as file:
            mean = file["study/statistics/peak_deflection_mean"][:].max(axis=1)
            values = [value for value, name in zip(rows["Mean"], rows["Quantity"]) if name == "greatest deflection"]
            np.testing.assert_allclose(values, MM * mean, rtol=1e-12)
            self.assertEqual(len(values), 3)

    def test_the_history_of_a_run(self):
        book = self.book_of("crossing")
        rows = self.columns(book["Time history"])
        with h5py.File(self.folder / "crossing.h5") as file:
            worst = int(np.abs(file["probes/deflection"][:]).max(axis=0).argmax())
            x = file["probes/x"][worst]
            np.testing.assert_allclose(rows[f"Moment, x = {x:g} m (kN m)"], KNM * file["probes/moment"][:, worst],
                                       rtol=1e-12)
            np.testing.assert_allclose(rows["Bearing force, x = 45 m (kN)"], KN * file["supports/reaction"][:, 2, 1],
                                       rtol=1e-12)
            verdicts = self.columns(book["Verdicts"])
            np.testing.assert_allclose(verdicts["Value"][:3], file["verdicts/value"][:3], rtol=1e-12)


class ComfortAndCycles(Reported):
    def test_comfort_of_a_coach(self):
        rows = self.columns(self.book_of("coach")["Comfort"])
        self.assertEqual(rows["From its centre (m)"], [-8.6875, 0.0, 8.6875])  # the secondary springs
        with h5py.File(self.folder / "coach.h5") as file:
            a = file["vehicles/0/car/acceleration"][:]
        for i, x in enumerate(rows["From its centre (m)"]):
            felt = comfort.comfort(a[:, 1] + x * a[:, 2], 0.005)
            self.assertAlmostEqual(rows["Wb (m/s²)"][i], felt.weighted, places=12)
            self.assertAlmostEqual(rows["Sperling Wz"][i], felt.sperling, places=12)
        self.assertLess(rows["Rms (m/s²)"][1], min(rows["Rms (m/s²)"][0], rows["Rms (m/s²)"][2]))

    def test_cycles_of_the_moments(self):
        book = self.book_of("coach", "--factor", "1/0.35", "--line", "slope:5,71e6,2e6", "--passages", "60")
        rows = self.columns(book["Cycles"])
        with h5py.File(self.folder / "coach.h5") as file:
            probes, moments = list(file["probes/x"][:]), file["probes/moment"][:]
        self.assertIn(20.0, rows["x (m)"])
        for p, x in enumerate(rows["x (m)"]):
            moment = moments[:, probes.index(x)]
            cycles = fatigue.rainflow(moment)
            self.assertAlmostEqual(rows["Largest range (kN m)"][p] / (KNM * np.ptp(moment)), 1.0, places=12)
            wanted = sum(c.count * c.range ** 5 for c in cycles) ** 0.2
            self.assertAlmostEqual(rows["Equivalent range, m = 5 (kN m)"][p] / (KNM * wanted), 1.0, places=12)
            damage = (wanted / 0.35 / 71e6) ** 5 / 2e6
            self.assertAlmostEqual(rows["Damage of a passage"][p] / damage, 1.0, places=10)

    def test_of_the_governing_run(self):
        book = self.book_of("judged")
        self.assertIn("Governing run cycles", book.sheetnames)
        self.assertNotIn("Governing run comfort", book.sheetnames)  # forces alone

    def test_a_series_too_coarse_is_said(self):
        self.compute("coarse", COACH, "-output_interval", "0.02")
        book = self.book_of("coarse")
        self.assertNotIn("Comfort", book.sheetnames)
        for name, expected in (("coach", "computed, without a limit"), ("coarse", "not verified: no limit given")):
            rows = checks_sheet.rows_of(source.Source(self.folder / f"{name}.h5"), [])
            said, = (results[0][0] for requirement, _, results in rows if requirement.startswith("passenger comfort"))
            self.assertEqual(said, expected)


class WorkbookAlone(Reported):
    def test_there_is_no_pdf(self):
        (self.folder / "alone.pdf").write_text("of somebody else", encoding="utf-8")
        status, said, error = self.command("judged.h5", "-o", "alone", "--no-pdf", "--no-governing-run")
        self.assertEqual((status, said, error), (0, "report  alone.xlsx\n", ""))
        self.assertEqual((self.folder / "alone.pdf").read_text(encoding="utf-8"), "of somebody else")
        whole = self.book_of("judged", "--no-governing-run")
        self.assertEqual(openpyxl.load_workbook(self.folder / "alone.xlsx").sheetnames, whole.sheetnames)


class BadInput(Reported):
    def refused(self, *words):
        status, said, error = self.command(*words)
        self.assertEqual(status, 1, said)
        self.assertEqual(len(error.strip().splitlines()), 1, error)
        return error

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
            status, _, error = self.command("crossing.h5", *words)
            self.assertEqual(status, 2)
            self.assertIn(said, error)

    def test_a_governing_run_that_fails_is_said(self):
        status, said, error = self.command("sweep.h5", "--program", "/bin/false", "-o", "failed", "--limits",
                                           "limits.yml")
        self.assertEqual(status, 0, error)
        verdicts = self.columns(openpyxl.load_workbook(self.folder / "failed.xlsx")["Verdicts"])
        self.assertEqual(verdicts["Result"][2], "not evaluated")
        self.assertIn("could not be repeated", said)


if __name__ == "__main__":
    unittest.main()
