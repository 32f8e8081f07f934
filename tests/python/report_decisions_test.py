"""Requirements that scripts/traverse-report decides without a limit, and its annex: against the results files."""

import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from reported import BINARY, FACTOR, SIMPLE, TRAINS, Reported  # noqa: E402
from traverse_check import flow_chart  # noqa: E402
from traverse_report import (  # noqa: E402
    annex_sheet, assumptions_sheet, checks_sheet, comparison_sheet, decisions, fatigue_sheet, governing, language,
    larger_effect, limits, main, norm_sheet, page, run_sheet, source, title_sheet, uplift)

SEPARATE = SIMPLE.replace("[20.0]", "[20.0, 20.0, 20.0]").replace("1.8e4", "1.8e4, continuity: simply_supported") \
    .replace("modes: 3", "modes: 9")


class Computations(Reported):
    """Sweeps over a simple and a continuous bridge, and a run with the weight of the bridge."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        if (cls.folder / "simple.h5").exists():
            return
        (cls.folder / "factor.yml").write_text(FACTOR, encoding="utf-8")
        cls.compute("simple", SIMPLE + TRAINS)
        cls.compute("separate", SEPARATE + TRAINS)
        cls.compute("continuous", SIMPLE.replace("[20.0]", "[20.0, 20.0]") + TRAINS)
        cls.compute("heavy", SIMPLE.replace("mass: 1.8e4", "mass: 1.8e4, self_weight: true")
                    + "load: {forces: [2.0e5], speed: 40.0}\noutput: {interval: 0.01}\n")


class Decisions(Computations):
    def test_the_need_for_a_dynamic_analysis(self):
        one = self.source("simple", flow_chart.Line(200.0 / 3.6))
        part = flow_chart.Part(20.0, one.file["norm"].attrs["n0"], True)
        self.assertEqual(decisions.need_for_analysis(one), flow_chart.answer(part, one.line))
        self.assertIn("--line-speed", decisions.need(self.source("simple")).words)
        hinged = self.source("sweep", flow_chart.Line(60.0))  # neither simple spans nor continuous
        self.assertIsNone(decisions.need_for_analysis(hinged))

    def test_clauses_of_the_need_are_in_the_language(self):
        for name, word in (("de", "Bild 6.9"), ("fr", "figure 6.9"), ("en", "figure 6.9")):
            language.choose(name)
            found = decisions.need_for_analysis(self.source("simple", flow_chart.Line(200.0 / 3.6)))
            self.assertTrue(found.steps[0][0].startswith(f"EN 1991-2 {word}"), found.steps)
            self.assertEqual({"figure" in clause for clause, _ in found.steps}, {name != "de"})

    def test_the_range_of_speeds(self):
        for line_speed, colour in ((60.0, page.GREEN), (80.0 / 1.2, page.GREEN), (70.0, page.RED)):
            found = decisions.speeds(self.source("simple", flow_chart.Line(line_speed)))
            self.assertEqual(found.colour, colour)
            self.assertIn("computed up to 288 km/h", found.words)

    def test_factors_of_track_defects(self):
        self.assertTrue(decisions.defects(self.source("simple")).words.endswith(": 1.25"))
        self.assertIn("do not contain it", decisions.defects(self.source("judged")).words)
        self.assertIsNone(decisions.defects(self.source("heavy")))

    def test_verdicts_contain_the_factor(self):
        one = self.source("simple")
        without = limits.Limit("rule 7", "deck_acceleration", 3.5, "")
        with_it, = limits.judge(one, limits.limits_of(one, None, None))
        other, = limits.judge(one, [without])
        self.assertEqual(with_it.value, np.nanmax(one.file["sweep/judged"]))
        self.assertAlmostEqual(other.value, with_it.value / 1.25, 12)
        self.assertEqual(with_it.limit.words, "greatest deck acceleration, low-pass filtered × 1.25")

    def test_uplift_of_a_simple_bridge(self):
        one = self.source("simple")
        np.testing.assert_allclose(uplift.permanent_forces(one), 1.8e4 * 9.81 * 10.0, 1e-9)
        self.assertIn("no load lifts a bearing", decisions.uplift(one).words)
        one.governing = self.source("heavy")
        self.assertEqual(decisions.dynamic_uplift(one)[0].value,
                         one.governing.file["supports/reaction"][:, :, 1].min())

    def test_the_least_bearing_force_is_that_of_all_runs(self):
        one, repeated = self.source("simple"), []
        bounds = uplift.inertia_bounds(one).min(axis=(1, 2))
        self.assertEqual(len(bounds), 18)
        order = np.argsort(bounds)

        def repeat(run):
            path, trouble = governing.repeat(one, run, [], BINARY, ".", self.folder, name=f"bearing_{run}")
            self.assertEqual(trouble, "")
            repeated.append(run)
            return source.Source(path)

        found = uplift.least_of_runs(one, repeat)
        least = {run: uplift.least_over_time(source.Source(self.folder / f"bearing_{run}_1.h5"), "") for run in repeated}
        for run in repeated:
            self.assertGreaterEqual(least[run].value, bounds[run])
        self.assertEqual(repeated, list(order[:len(repeated)]))
        if len(repeated) < uplift.MOST_REPEATED:  # no other run can have less
            self.assertEqual(found.value, min(force.value for force in least.values()))
            self.assertGreaterEqual(bounds[order[len(repeated)]], found.value)
        else:
            self.assertLessEqual(found.value, min(force.value for force in least.values()))
        one.least_bearing = found
        self.assertEqual(decisions.dynamic_uplift(one), [found])

    def test_uplift_of_separate_spans_is_that_of_one_of_them(self):
        bounds, forces = {}, {}
        for name in ("simple", "separate"):
            one, bounds[name] = self.source(name), uplift.inertia_bounds(self.source(name))
            run = int(bounds[name].min(axis=(1, 2)).argmin())
            path, trouble = governing.repeat(one, run, [], BINARY, ".", self.folder, name=f"{name}_{run}")
            self.assertEqual(trouble, "")
            forces[name] = uplift.forces_of_deck_ends(source.Source(path)).min(axis=0)
            one.least_bearing = uplift.least_over_time(source.Source(path), "")
            self.assertEqual(one.least_bearing.value, forces[name].min())
            self.assertIn(one.least_bearing.x, one.model.span_ends)
            np.testing.assert_allclose(uplift.permanent_forces(one), 1.8e4 * 9.81 * 10.0, 1e-9)
            self.assertEqual(decisions.uplift(one).colour, page.GREEN)
            one.least_bearing = one.least_bearing._replace(own=-0.9 * one.least_bearing.value)  # of a lighter bridge
            self.assertEqual(decisions.uplift(one).colour, page.RED)
            one.least_bearing = one.least_bearing._replace(is_bound=True)
            self.assertEqual(decisions.uplift(one).colour, page.AMBER)
        self.assertEqual(forces["separate"].shape, (3, 2))
        for one in (bounds, forces):  # the instants of the stored values differ between the decks
            np.testing.assert_allclose(one["separate"], np.broadcast_to(one["simple"], one["separate"].shape), 0.05)

    def test_uplift_of_a_run_needs_a_station_at_each_joint(self):
        self.compute("crossed", SEPARATE + "load: {forces: [2.0e5], speed: 40.0}\n"
                                           "output: {interval: 0.01, probes: [10.0, 20.0]}\n")
        found = decisions.uplift(self.source("crossed"))
        self.assertEqual((found.colour, "needs a station" in found.words), (page.AMBER, True))

    def test_what_is_not_satisfied_without_a_limit_is_on_the_title_page(self):
        for line_speed, colour, count in ((60.0, page.GREEN, 2), (70.0, page.AMBER, 3)):
            one = self.source("simple", flow_chart.Line(line_speed))
            kept = limits.judge(one, [limits.Limit("clause", "deck_acceleration", 1e3, "")])
            lines, found = comparison_sheet.headline([(one, kept)])
            self.assertEqual((found, len(lines) - 1), (colour, count))
        self.assertTrue(lines[2].startswith("Range of speeds, EN 1991-2 6.4.6.2: computed up to 288 km/h"), lines)

    def test_bounds_may_be_in_several_files(self):
        several = [self.source("simple"), self.source("simple")]
        several[1].options["beam_EI"] = "7.0e10"
        for one in several:
            self.assertFalse(checks_sheet.varied(one, "beam_EI"))
            one.compared = several
            self.assertTrue(checks_sheet.varied(one, "beam_EI"))
            self.assertFalse(checks_sheet.varied(one, "beam_mass"))

    def test_uplift_of_a_continuous_bridge_lacks_the_permanent_load(self):
        one = self.source("continuous")
        found = decisions.uplift(one)
        self.assertEqual(found.colour, page.AMBER)
        norm, static = one.file["norm"], one.file["static"]
        dynamic = (norm["train_dynamic"][:] / norm["train_static"][:]).max()
        factors = [norm["phi"][0] if load.startswith("LM") or load.startswith("SW") else dynamic
                   for load, _ in static["load"].asstr()[:]]
        least = min(factor * values[:, 0].min() for factor, values in zip(factors, static["reaction"][:]))
        self.assertLess(least, -1e3)
        self.assertIn(language.num(1e-3 * least), found.words)

    def test_uplift_of_a_run_with_the_weight_of_the_bridge(self):
        one = self.source("heavy")
        found = decisions.uplift(one)
        self.assertEqual(found.colour, page.GREEN)
        self.assertIn(language.num(1e-3 * one.file["supports/reaction"][:, :, 1].min()), found.words)

    def test_uplift_of_runs_with_the_weight_of_the_bridge_counts_it_once(self):
        one = self.source("simple")
        one.options["beam_self_weight"] = "true"
        self.assertFalse(decisions.has_least_bearing_of_runs(one))
        one.least_bearing = uplift.Bearing(-2.0e4, "a run", 20.0)  # less than the weight, which it contains
        found = decisions.uplift(one)
        self.assertEqual(found.colour, page.RED)
        self.assertIn(f"with the mass of the bridge {language.num(-20.0)} kN", found.words)
        one.least_bearing = uplift.Bearing(2.0e4, "a run", 20.0)
        self.assertIn("no load lifts a bearing", decisions.uplift(one).words)


class Words(Computations):
    def test_headings_of_the_verdict_of_the_norm_are_whole_words(self):
        for name, words in (("en", {"Ratio", "Governs"}), ("de", {"Verhältnis", "Maßgebend"}),
                            ("fr", {"Rapport", "Déterminant"})):
            language.choose(name)
            report = page.Report()
            norm_sheet.sheet(report, self.source("simple"))
            self.assertLessEqual(words, {text.get_text() for text in report.pages[0].paper.texts})
        language.choose("en")

    def test_french_has_a_space_before_colons_and_semicolons(self):
        one = self.source("simple")
        for name, colon, semicolon in (("en", ": ", "; "), ("de", ": ", "; "), ("fr", " : ", " ; ")):
            language.choose(name)
            rows = limits.judge(one, [limits.Limit("c", quantity, 1.0, "")
                                      for quantity in ("lm71_end_rotation", "end_rotation")])
            judged = [verdict._replace(word="kept") for verdict in rows]
            said = {found for *_, results in checks_sheet.rows_of(one, judged) for found, *_ in results}
            for limit in rows:
                self.assertIn(language.t("complied with") + colon + limit.limit.words, said)
            self.assertIn(f"{language.t('not in this program')}{semicolon}{language.t('the model has no horizontal deflection')}", said)
            self.assertTrue(decisions.defects(one).words.endswith(f"{colon}{language.num(1.25)}"))
        language.choose("en")


class LargerEffect(Computations):
    def test_trains_govern_only_where_they_are_larger(self):
        file = self.source("simple").file
        norm = file["norm"]
        row = list(norm["effect"].asstr()[:, 0]).index("end_rotation")
        of_trains = float(norm["train_dynamic"][row])
        for value, factor, expected in ((1.1 * of_trains, 1.0, 1.1 * of_trains), (0.9 * of_trains, 1.0, of_trains),
                                        (1.1 * of_trains, 1.2, 1.2 * of_trains)):
            found, place = larger_effect.larger(file, "lm71_end_rotation", value, factor, "LM71, x = 0 m")
            self.assertEqual(found, expected)
            self.assertEqual("load models govern" in place, expected == value)
        self.assertEqual(larger_effect.larger(file, "deck_acceleration", 1.0, 1.0, "A1"), (1.0, "A1"))

    def test_spans_at_supports_are_the_shorter_ones(self):
        found = larger_effect.spans_at(np.array([0.0, 20.0, 45.0]), np.array([0.0, 20.0, 20.1, 45.0]))
        np.testing.assert_array_equal(found, [20.0, 20.0, 25.0, 25.0])

    def test_places_are_in_the_language(self):
        language.choose("de")
        self.assertEqual(larger_effect.place_of("A1 at 66.705 m/s (240.1 km/h), x = 16.8 m"),
                         "A1 bei 240,1 km/h, x = 16,8 m")
        self.assertEqual(larger_effect.place_of("LM71 with alpha = 1.21 and Phi3 = 1.154, x = 14 m"),
                         "LM71, α = 1,21, Φ₃ = 1,154, x = 14 m")
        self.assertEqual(larger_effect.place_of("moment of A3 at 265.9 km/h, x = 0 m"),
                         "Biegemoment, A3 bei 265,9 km/h, x = 0 m")
        language.choose("en")


class Annex(Computations):
    def whole(self, names):
        entries, arguments = self.entries_of(names)
        report = main.report_of([[entry] for entry in entries], title_sheet.Title(structure="S", date="2026"), ["line"], page.GREEN,
                                fatigue_sheet.Asked(), BINARY)
        report.fill_references()
        return entries, report

    def test_errors_come_from_the_repeated_run_with_a_finer_model(self):
        (one, _, _, governing), = self.entries_of(["simple"])[0]
        rows = {words: (error, why) for words, error, why in annex_sheet.estimates(one, governing)}
        run, finer = governing.source.summary["moment"], governing.finer.summary["moment"]
        self.assertNotEqual(run, finer)
        self.assertEqual(rows["bending moment"][0], annex_sheet.percent_of_error(abs(run / finer - 1.0)))
        self.assertEqual(governing.finer.options["model_modes"], "6")
        self.assertIn("twice", rows["bending moment"][1])
        alone = {words: why for words, _, why in annex_sheet.estimates(one, None)}
        self.assertIn("model_modes = 3 is given", alone["bending moment"])

    def test_filtered_accelerations_of_the_repeated_run_are_drawn(self):
        (_, rows, _, governing), = self.entries_of(["simple"])[0]
        values = governing.source.file["probes/acceleration_lowpass"][:]
        least, greatest = run_sheet.envelope_of(governing.source, "acceleration_lowpass")
        np.testing.assert_array_equal([least, greatest], [values.min(axis=0), values.max(axis=0)])
        self.assertEqual(run_sheet.deck_limits(rows, "acceleration_lowpass"),
                         [(3.5 / 1.25, "limit 3.5 m/s² / 1.25")])
        self.assertEqual(run_sheet.deck_limits([rows[0]._replace(factor=1.0)], "acceleration_lowpass"),
                         [(3.5, "limit 3.5 m/s²")])
        entries, report = self.whole(["simple"])
        for heading in ("Results along the bridge", "Time histories"):
            texts = [text.get_text() for one in report.pages if heading in one.headings
                     for ax in one.figure.axes for text in ax.texts]
            self.assertIn("limit 3.5 m/s² / 1.25", texts, heading)
        titles = [title for title, *_ in run_sheet.deck_panels(governing.source, rows)]
        self.assertTrue(any("low-pass filtered" in title for title in titles), titles)

    def test_notes_of_all_files_are_listed_once(self):
        entries, report = self.whole(["simple", "continuous"])
        rows = annex_sheet.notes_of_all(entries)
        notes = {name: set(one.model.notes) for name, one in (("simple.h5", entries[0][0]),
                                                              ("continuous.h5", entries[1][0]))}
        for note in notes["simple.h5"] & notes["continuous.h5"]:
            self.assertEqual([run for run, said in rows if said == note], ["all files"])
        own = notes["continuous.h5"] - notes["simple.h5"]
        self.assertGreater(len(own), 0)
        for note in own:
            self.assertIn(("continuous.h5, first run", note), rows)
        self.assertEqual([heading for _, heading, _ in report.contents].count("Notes of the program (in English)"), 1)

    def test_options_have_units_and_origins(self):
        rows = {name: rest for name, *rest in annex_sheet.option_rows(self.source("simple"), BINARY)}
        self.assertEqual(rows["beam_EI"], ["6.0e10", "N m2", "simple.yml, line 2"])
        self.assertEqual(rows["sweep_speed"][1], "m/s")
        self.assertEqual(annex_sheet.units_of_options("/bin/false"), {})

    def test_marks_are_explained_on_every_page_that_has_them(self):
        _, report = self.whole(["simple"])
        marked = [one for one in report.pages
                  if any(re.search(r"[0-9)][⁰¹]$", text.get_text()) for text in one.paper.texts)]
        self.assertGreater(len(marked), 0)
        for one in marked:
            self.assertIn("⁰: no public source", one.foot_note)
        self.assertEqual(report.pages[0].foot_note, "")

    def test_greek_letters_can_be_searched(self):
        status, _, error = self.command("simple.h5", "--no-governing-run", "--line-speed", "200 km/h")
        self.assertEqual((status, error), (0, ""))
        self.assertNotIn(b"/Type3", (self.folder / "simple.pdf").read_bytes())
        if shutil.which("pdftotext"):
            said = subprocess.run(["pdftotext", self.folder / "simple.pdf", "-"], capture_output=True, text=True).stdout
            for text in ("φ′dyn", "Φ₃", "α", "Flow chart of EN 1991-2 figure 6.9 for a line speed of 200 km/h"):
                self.assertIn(text, said)

    def test_the_accuracy_over_the_speed_is_stated(self):
        one = self.source("simple")
        one.options["sweep_refine"] = "0.01"
        one.summary.update(peak_uncertainty=0.004, peak_uncertainty_of="end rotation of A8", speeds_added=7)
        rows = {words: (value, place) for words, value, place in assumptions_sheet.of_accuracy(one)}
        self.assertEqual(rows["relative error of the peaks over the speed, requested"][0], "1.0 %")
        self.assertEqual(rows["relative error of the peaks over the speed, achieved"][0],
                         "0.4 % (greatest rotation of the deck ends of A8); 7 speeds added")

    def test_an_error_over_the_speed_is_stated_only_if_it_is_determined(self):
        for name, added in (("simple", None), ("separate", 2)):
            one = self.source(name)
            one.summary.update({"peak_uncertainty": 0.0, "peak_uncertainty_of": "", "speeds_added": added} if added else {})
            said = "not determined; 2 speeds added near limits" if added else \
                "not determined between the speeds, which are as given"
            rows = {words: value for words, value, _ in (*assumptions_sheet.of_accuracy(one), *annex_sheet.model_rows(one))}
            self.assertEqual(rows["relative error of the peaks over the speed, requested"], "none requested")
            self.assertEqual(rows["relative error of the peaks over the speed, achieved"], said)
            self.assertEqual(rows["peaks over the speed, possible excess"], said)

    def test_beam_elements_are_those_of_all_spans(self):
        for name, spans in (("simple", 1), ("separate", 3), ("continuous", 2)):
            one = self.source(name)
            count = str(spans * one.file["sweep"].attrs["elements_per_span"])
            self.assertIn(f", {count} elements,", " ".join(one.model.notes))
            self.assertIn(f"{count} beam elements", assumptions_sheet.method_of(one))
            self.assertIn(("beam elements", count), [row[:2] for row in annex_sheet.model_rows(one)])

    def test_dates_are_those_of_the_language(self):
        for name, expected in (("en", "2026-11-27"), ("de", "27.11.2026"), ("fr", "27/11/2026")):
            language.choose(name)
            self.assertEqual(title_sheet.local("2026-11-27"), expected)
            self.assertEqual(title_sheet.local("November 2026"), "November 2026")
        language.choose("en")

    def test_speeds_that_are_no_line_speed(self):
        for words in (("--line-speed", "fast"), ("--line-speed", "80"), ("--line-speed", "200 km/h",
                                                                         "--torsional-frequency", "-1 Hz")):
            status, _, error = self.command("simple.h5", *words)
            self.assertEqual((status, len(error.strip().splitlines())), (1, 1), error)
            self.assertIn(words[-2], error)


if __name__ == "__main__":
    unittest.main()
