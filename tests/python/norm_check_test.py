"""scripts/traverse-check: units, refusals, the scenes it writes, its verdicts and exit status."""

import contextlib
import functools
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np
import openpyxl
import yaml

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import BINARY, SOURCE  # noqa: E402

SCRIPTS = SOURCE / "scripts"
sys.path.insert(0, str(SCRIPTS))
from traverse_check import flow_chart, main, outcome, question, rules, runs, scene, track_defects, units  # noqa: E402
from traverse_report import assumptions_sheet  # noqa: E402
from traverse_report.source import Source  # noqa: E402

BRIDGE = ("--span", "28", "--EI", "260 GN.m2", "--mass", "19 t/m", "--type", "prestressed", "--line-speed", "250 km/h")
# A short span under HSLM-B, which is computed in half a second; its deck acceleration is far above the limit.
SHORT = ("--span", "6 m", "--EI", "2 GN.m2", "--mass", "12 t/m", "--type", "filler", "--line-speed", "230 km/h",
         "--hslm-b", "12,3.5", "--no-report")
COMPUTED = "  check.yml is being computed\n  check.yml is computed\n"


def ask(*words):
    """The question of BRIDGE; later words replace earlier ones."""
    return question.ask([*BRIDGE, *words])


class Units(unittest.TestCase):
    def test_the_same_stiffness_in_all_spellings(self):
        for text in ("260 GN.m2", "260GN.m2", "260 GN m2", "260 GNm²", "260 GN·m^2", "260000 MN m2", "2.6e11 N.m2",
                     "2.6e11"):
            self.assertEqual(units.values("EI", text), [2.6e11], text)

    def test_other_quantities(self):
        self.assertEqual(units.values("mass", "19 t/m"), [19000.0])
        self.assertEqual(units.values("mass", "19000 kg/m"), [19000.0])
        self.assertEqual(units.values("line-speed", "250 km/h"), [250.0 / 3.6])
        self.assertEqual(units.values("line-speed", "70 m/s"), [70.0])
        self.assertEqual(units.values("line-speed", "250"), [250.0 / 3.6])  # 250 m/s is no line speed
        self.assertEqual(units.values("frequency", "4.1 Hz"), [4.1])

    def test_lists_share_the_unit_of_their_last_value(self):
        self.assertEqual(units.values("span", "25,30,25 m"), [25.0, 30.0, 25.0])
        for text in ("240, 280 GN.m2", "240 280 GN m2", "240 GN.m2, 280 GN.m2", "240 GN m2 280 GN m2"):
            self.assertEqual(units.values("EI", text), [2.4e11, 2.8e11], text)

    def test_a_number_whose_unit_is_in_doubt(self):
        for name, text in (("line-speed", "80"), ("line-speed", "20"), ("EI", "260"), ("mass", "19")):
            with self.assertRaisesRegex(rules.CheckError, "needs its unit"):
                units.values(name, text)

    def test_units_of_another_quantity_and_numbers_without_sense(self):
        for name, text in (("EI", "260 kN"), ("mass", "19 t"), ("span", "28 s"), ("line-speed", "250 mph"),
                           ("EI", "GN.m2"), ("span", "-28 m"), ("span", "0"), ("EI", "1e999 N.m2"), ("span", ""),
                           ("span", "nan")):
            with self.assertRaises(rules.CheckError, msg=text):
                units.values(name, text)


class Questions(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        self.enterContext(contextlib.chdir(self.folder))

    def file(self, text, name="bridge.yml"):
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def refused(self, *words):
        with self.assertRaises(rules.CheckError) as caught:
            question.ask(words)
        self.assertEqual(caught.exception.status, 2)
        self.assertEqual(len(str(caught.exception).splitlines()), 1)
        return str(caught.exception)

    def test_a_file_says_the_same_as_the_command_line(self):
        name = self.file("span: 28\nEI: 260 GN.m2\nmass: 19 t/m\ntype: prestressed\nline-speed: 250 km/h\n"
                         "careful: true\nreport-project: Line 4711\n")
        expected = ask("--careful", "--report-project", "Line 4711", "--folder", "results/bridge")
        self.assertEqual(question.ask([name]), expected)

    def test_the_command_line_replaces_the_file(self):
        name = self.file("span: [25 m, 30 m]\nEI: 260 GN.m2\nmass: 19 t/m\ntype: steel\nline-speed: 250 km/h\n")
        asked = question.ask([name, "--line-speed", "160", "km/h", "--frequency", "4.1", "Hz"])
        self.assertEqual((asked.spans, asked.EI, asked.frequencies), ([25.0, 30.0], [], [4.1]))
        self.assertEqual(asked.line_speed, 160.0 / 3.6)

    def test_words_that_are_missing_or_contradict_each_other(self):
        self.assertIn("--span is missing", self.refused())
        self.assertIn("either --EI or --frequency", self.refused(*BRIDGE, "--frequency", "4 Hz"))
        name = self.file("span: 28\nEI: 260 GN.m2\nfrequency: 4.1 Hz\nmass: 19 t/m\ntype: steel\nline-speed: 250 km/h\n")
        self.assertIn("either --EI or --frequency", self.refused(name))
        self.assertIn("allowed: steel, composite", self.refused(*BRIDGE, "--type", "wood"))
        self.assertIn("lower and the upper bound", self.refused(*BRIDGE, "--EI", "280,240 GN.m2"))
        self.assertIn("--hslm-b", self.refused(*BRIDGE, "--span", "6 m"))
        self.assertIn("leave out --hslm-b", self.refused(*BRIDGE, "--hslm-b", "12,3.5"))
        self.assertIn("belong together", self.refused(*BRIDGE, "--GJ", "90 GN.m2"))
        self.assertIn("one of them", self.refused(*BRIDGE, "--GJ", "90 GN.m2", "--polar-inertia", "160 t.m",
                                                  "--torsional-frequency", "9 Hz"))
        self.assertIn("needs --GJ", self.refused(*BRIDGE, "--eccentricity", "2 m"))
        self.assertIn("needs --eccentricity", self.refused(*BRIDGE, "--tracks", "2"))
        self.assertIn("--spam", self.refused(*BRIDGE, "--spam", "3"))
        self.assertIn("belongs to one mass", self.refused("--span", "28", "--frequency", "4 Hz", "--mass", "18,20 t/m",
                                                          "--type", "steel", "--line-speed", "250 km/h"))

    def test_numbers_of_no_bridge(self):
        for words in (["--mass", "1e30 t/m"], ["--mass", "1e-3 t/m"], ["--EI", "1e30 GN.m2"], ["--span", "1e6 m"],
                      ["--line-speed", "3000 km/h"]):
            self.assertRegex(self.refused(*BRIDGE, *words), rf"{words[0].strip('-')} {words[1]}: no railway bridge has .*; allowed")

    def test_files_that_are_no_question(self):
        for text, said in (("spann: 28", "did you mean span?"), ("[28]", "no YAML file"), ("{a: [", "no YAML file"),
                           ("span: {a: b}", "needs a value"), ("span:", "needs a value"), ("\x00\x01", "no YAML file"),
                           ("span: !!python/object/apply:os.system ['touch bad']", "no YAML file"),
                           ("folder: /etc", "below the working"), ("folder: ../..", "below the working")):
            self.assertIn(said, self.refused(self.file(text)), text)
        self.assertFalse((self.folder / "bad").exists())
        self.assertIn("No such file", self.refused("none.yml"))
        self.assertIn("too large", self.refused(self.file("#" * 200_000)))

    def test_its_own_file_is_never_overwritten(self):
        name = self.file("span: 28\n", "check.yml")
        self.assertIn("might be overwritten", self.refused(name, "--folder", "."))


class Scenes(unittest.TestCase):
    def options(self, asked, train="A"):
        return yaml.safe_load(scene.dynamic_scene(asked, scene.cases(asked, asked.EI)[0], 4, train))

    def test_options_of_the_question(self):
        written = self.options(ask("--careful", "--alpha", "1.21", "--load-spread", "0.6", "--additional-damping"))
        self.assertEqual(written["beam"], {"spans": [28.0], "EI": 2.6e11, "mass": 19000.0})
        self.assertEqual(written["model"], {"modes": 4, "damping_bound": "prestressed", "additional_damping": True})
        self.assertEqual(written["norm"], {"load_models": ["lm71"], "alpha": 1.21, "track": "careful"})
        self.assertEqual(written["load"], {"spread": 0.6})
        self.assertEqual(written["sweep"]["hslm_a"], list(range(1, 11)))
        first, last, step = written["sweep"]["speed"]
        self.assertEqual((first, last), (40.0, 1.2 * (250.0 / 3.6)))
        self.assertAlmostEqual((last - first) / step, round((last - first) / step), 9)

    def test_a_continuous_bridge_and_separate_spans(self):
        self.assertEqual(self.options(ask("--span", "25,30,25"))["norm"]["load_models"], ["lm71", "sw0"])
        separate = self.options(ask("--span", "25,30,25", "--simply-supported"))
        self.assertEqual(separate["beam"]["continuity"], "simply_supported")
        self.assertEqual(separate["norm"]["load_models"], ["lm71"])

    def test_speeds_of_a_slow_line(self):
        first, last, _ = scene.speeds(ask("--line-speed", "100 km/h"))
        self.assertAlmostEqual(last, 120.0 / 3.6, 12)
        self.assertEqual(first, 0.5 * last)

    def test_all_combinations_of_the_bounds(self):
        asked = ask("--EI", "240,280 GN.m2", "--mass", "18,20 t/m")
        self.assertEqual([(case.name, case.EI, case.mass) for case in scene.cases(asked, asked.EI)],
                         [("lower_EI_lower_mass", 2.4e11, 18000.0), ("lower_EI_upper_mass", 2.4e11, 20000.0),
                          ("upper_EI_lower_mass", 2.8e11, 18000.0), ("upper_EI_upper_mass", 2.8e11, 20000.0)])
        one = ask("--mass", "18,20 t/m")
        self.assertEqual([case.words for case in scene.cases(one, one.EI)], ["lower mass", "upper mass"])

    def test_limits_of_the_track(self):
        file = SOURCE / "options/limits/en1991_2.yml"
        texts = [scene.limits_text(ask("--track", track), file, 1.2) for track in ("ballast", "direct")]
        ballast, direct = ({row["quantity"]: float(row["value"]) for row in yaml.safe_load(text)
                            if "/" not in row["value"]} for text in texts)
        self.assertEqual((ballast["deck_acceleration"], direct["deck_acceleration"]), (3.5, 5.0))
        self.assertEqual((ballast["end_rotation"], direct["end_rotation"]), (6.5e-3, 5.0e-3))
        self.assertNotIn("lm71_joint_rotation", ballast)
        factors = {row["quantity"]: row.get("factor") for row in yaml.safe_load(texts[0])}
        self.assertEqual(factors, {"deck_acceleration": "1.2", "end_rotation": "1.2", "deflection_over_span": "1.2",
                                   "lm71_deflection_over_span": None, "lm71_end_rotation": None,
                                   "train_over_lm71": None})
        values = {row["quantity"]: row["value"] for row in yaml.safe_load(texts[0])}
        self.assertEqual(values["deflection_over_span"], values["lm71_deflection_over_span"])
        joints = scene.limits_text(ask("--span", "25,30", "--simply-supported"), file, None)
        self.assertEqual({row["quantity"] for row in yaml.safe_load(joints)},
                         {"lm71_deflection_over_span", "lm71_end_rotation", "lm71_joint_rotation"})

    def test_the_limit_of_the_twist_is_that_of_the_speed(self):
        file = SOURCE / "options/limits/en1991_2.yml"
        for speed, value in (("120 km/h", 4.5e-3), ("121 km/h", 3.0e-3), ("200 km/h", 3.0e-3), ("201 km/h", 1.5e-3)):
            found = scene.limits_text(ask("--line-speed", speed, "--GJ", "90 GN.m2", "--polar-inertia", "160 t.m",
                                          "--eccentricity", "2 m"), file, 1.2)
            self.assertEqual([float(row["value"]) for row in yaml.safe_load(found) if "twist" in row["quantity"]], [value])
        self.assertNotIn("twist", scene.limits_text(ask(), file, 1.2))

    def test_limits_of_the_user(self):
        with tempfile.TemporaryDirectory() as folder:
            own, asked = pathlib.Path(folder, "own.yml"), ask("--track", "direct", "--limits", "own.yml")
            own.write_text('- {clause: "our rule", quantity: deck_acceleration, value: 1/3, factor: 1.3}\n'
                           '- {clause: "ours, too", quantity: train_over_lm71, value: 0.9}\n', encoding="utf-8")
            self.assertEqual(yaml.safe_load(scene.limits_text(asked, own, 1.2)),
                             [{"clause": "our rule", "quantity": "deck_acceleration", "value": "1/3", "factor": "1.3"},
                              {"clause": "ours, too", "quantity": "train_over_lm71", "value": "0.9"}])
            with self.assertRaisesRegex(rules.CheckError, "none of its limits applies"):
                scene.limits_text(asked, own, None)
            for text in ("{a: [", "7", "[7]", "[{value: 3}]"):
                own.write_text(text, encoding="utf-8")
                with self.assertRaisesRegex(rules.CheckError, "no list of limits"):
                    scene.limits_text(asked, own, 1.2)

    def test_the_title_page_is_in_the_language_of_the_report(self):
        title = self.options(ask("--span", "25,30", "--report-language", "de"))["report"]
        self.assertEqual(title["structure"], "Durchlaufträger über 2 Felder von 25 + 30 m, Spannbeton")
        self.assertTrue(title["note"].startswith("Dynamische Berechnung nach EN 1991-2 Bild 6.9 erforderlich: ja"))
        self.assertIn("Not examined", self.options(ask())["report"]["note"])

    def test_texts_remain_texts(self):
        hostile = 'x\n"y": \x1b[31m{ # -options_file /etc/passwd'
        self.assertEqual(self.options(ask("--report-project", hostile))["report"]["project"], hostile)
        self.assertEqual(self.options(ask("--report-note", "a\udcffb"))["report"]["note"], "a?b")

    def test_the_scene_names_drawings_and_the_picture_of_the_cross_section(self):
        report = self.options(ask("--folder", "results/x", "--report-drawings", "B-101, B-102", "--report-cross-section",
                                  "section.png"))["report"]
        self.assertEqual((report["drawings"], report["cross_section"]), ("B-101, B-102", "../../section.png"))


class Commands(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def command(self, *words):
        """The command itself: (exit status, standard output, standard error without the progress of a slow run)."""
        ended = subprocess.run([sys.executable, "-B", SCRIPTS / "traverse-check", *words, "--program", BINARY],
                               cwd=self.folder, capture_output=True, text=True)
        return ended.returncode, ended.stdout, re.sub(r"^ *\d+ %   of the runs\n", "", ended.stderr, flags=re.MULTILINE)

    def inside(self, *words):
        """The same within this process: (exit status, standard output)."""
        out = io.StringIO()
        with contextlib.chdir(self.folder), contextlib.redirect_stdout(out):
            status = main.check([*words, "--program", str(BINARY)])
        return status, out.getvalue()

    def run_again(self, folder, name):
        ended = subprocess.run([BINARY, "-options_file", f"{name}.yml", "-output_file", "again.h5"], cwd=folder,
                               capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return folder / "again.h5"

    def test_a_limit_is_exceeded(self):
        status, said, error = self.command(*SHORT, "--folder", "short")
        self.assertEqual((status, error), (outcome.EXCEEDED, COMPUTED))
        self.assertIn("Result: 1 of 6 limits is EXCEEDED; greatest utilisation", said)
        first, again = self.folder / "short/check.h5", self.run_again(self.folder / "short", "check")
        with h5py.File(first) as one, h5py.File(again) as other:
            acceleration = one["verdicts/value"][0]
            self.assertIn(f"{acceleration:.4g} m/s² of 3.5 m/s²", said)
            self.assertGreater(acceleration, 3.5)
            written = yaml.safe_load((self.folder / "short/check.yml").read_text(encoding="utf-8"))
            options = dict(one["options"].asstr()[:])
            for name, value in (("beam_EI", written["beam"]["EI"]), ("load_hslm_b", written["load"]["hslm_b"]),
                                ("sweep_speed", written["sweep"]["speed"])):
                np.testing.assert_array_equal(np.array(options[name].split(","), dtype=float), value)
            for name in ("sweep/speed", "sweep/peak_deflection", "sweep/judged", "norm/train_over_model"):
                np.testing.assert_array_equal(one[name][:], other[name][:])

    def test_the_progress_of_all_runs_is_told_and_is_no_part_of_what_they_print(self):
        program, told = self.folder / "program", io.StringIO()
        program.write_text("#!/bin/sh\necho modelled\necho ' 10 %   1 of 10 runs   9 s left'\necho ' 60 %   6 of 10 runs   4 s "
                           "left'\necho summary\necho a warning >&2\n", encoding="utf-8")
        program.chmod(0o755)
        progress = main.Progress(["first", "second"])
        progress.begin -= main.SILENT_START
        with contextlib.redirect_stderr(told):
            said = runs.compute(str(program), self.folder, "a.yml", "a.h5",
                                progress=functools.partial(progress.update, "second"))
        self.assertEqual(said, "modelled\nsummary\na warning\n")
        self.assertEqual(told.getvalue(), " 30 %   of the runs\n")

    def test_bounds_make_a_file_for_each_combination(self):
        status, said = self.inside(*SHORT, "--EI", "2,2.2 GN.m2", "--mass", "11,12 t/m", "--line-speed", "150 km/h",
                                   "--always", "--folder", "bounds")
        results = sorted(path.stem for path in (self.folder / "bounds").glob("*.h5"))
        self.assertEqual(results, [f"{i}_EI_{j}_mass" for i in ("lower", "upper") for j in ("lower", "upper")])
        judged = [verdict for name in results for verdict in outcome.verdicts(self.folder / f"bounds/{name}.h5")]
        self.assertEqual(status, outcome.status(judged))
        self.assertEqual(said.count("Verdicts: "), 4)
        for name in results:
            note = yaml.safe_load((self.folder / f"bounds/{name}.yml").read_text(encoding="utf-8"))["report"]["note"]
            self.assertIn(f"figure 6.9: {'no' if 'because of --always' in said else 'yes'},", note)

    def test_without_dynamic_analysis(self):
        folder = 'a; touch pwned $(touch pwned) "x'
        status, said = self.inside("--span", "28", "--frequency", "4.1 Hz", "--mass", "19 t/m", "--type", "prestressed",
                                   "--line-speed", "160 km/h", "--no-report", "--folder", folder)
        self.assertEqual(status, 0, said)
        self.assertIn("n0 = 4.1 Hz", said)
        self.assertIn("no dynamic analysis is necessary", said)
        self.assertNotIn("real trains", said)
        self.assertIn("twist of the deck", said)
        self.assertEqual([path.name for path in self.folder.iterdir()], [folder])
        with h5py.File(self.folder / folder / "check.h5") as file:
            self.assertAlmostEqual(file["norm"].attrs["n0"], 4.1, 9)
            words = file["norm"].attrs["words"]
            low, high = flow_chart.limits_of_n0(28.0)
            self.assertIn(f"{low:.2f} to {high:.2f} Hz of figure 6.10", words)  # the program has the same limits
            self.assertEqual([row[0] for row in file["verdicts/verdict"].asstr()[:]], ["kept", "kept"])
            self.check_report_of_static_effects(self.folder / folder / "check.h5", file)
            options = dict(file["options"].asstr()[:])
            self.assertFalse([value for value in options.values() if os.path.isabs(value)])

    def check_report_of_static_effects(self, path, file):
        """The report of load models alone has their effects, as in the file, and the answer of the flow chart."""
        out = self.folder / "static"
        ended = subprocess.run([sys.executable, "-B", SCRIPTS / "traverse-report", path, "-o", out, "--line-speed",
                                "160 km/h", "--program", BINARY], capture_output=True, text=True)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        book = openpyxl.load_workbook(out.with_suffix(".xlsx"))
        rows = {row[0]: row for row in book["Greatest values"].iter_rows(min_row=2, values_only=True)}
        self.assertAlmostEqual(rows["moment, static"][1], 1e-3 * np.abs(file["static/moment"][:]).max(), 9)
        scope = {row[0].split(" (")[0]: row[2] for row in book["Scope"].iter_rows(min_row=2, values_only=True)}
        self.assertEqual(scope["need for a dynamic analysis"], "no dynamic analysis is necessary")
        self.assertEqual(scope["range of speeds"], "not applicable: no dynamic analysis is necessary")
        self.assertEqual(scope["unrestrained uplift at the bearings"], "no uplift: no load lifts a bearing")

    def test_two_tracks_beside_the_axis(self):
        beside = ("--GJ", "260 GN.m2", "--polar-inertia", "160 t.m", "--eccentricity", "2.25 m")
        effects = {}
        for name, words in (("axis", ()), ("one", beside), ("two", (*beside, "--tracks", "2"))):
            status, said = self.inside("--span", "28", "--EI", "260 GN.m2", "--mass", "19 t/m", "--type", "prestressed",
                                       "--line-speed", "160 km/h", "--no-report", "--folder", name, *words)
            self.assertEqual(status, 0, said)
            with h5py.File(self.folder / name / "check.h5") as file:
                effects[name] = [np.abs(file[f"static/{effect}"][:]).max() for effect in ("deflection", "moment")]
        self.assertGreater(effects["one"][0], 1.02 * effects["axis"][0])
        self.assertAlmostEqual(effects["one"][1] / effects["axis"][1], 1.0, 6)
        np.testing.assert_allclose(effects["two"], 2.0 * np.array(effects["axis"]), rtol=1e-3)
        self.assertIn("twist of a track over 3 m under LM71", said)
        rows = {words: value for words, value, _ in assumptions_sheet.of_bridge(Source(self.folder / "two/check.h5"))}
        given = {"torsional stiffness GJ": "260\u202f000 MN m²", "polar moment of inertia per length": "160 t m",
                 "track beside the axis": "2.25 m", "second track of the load models beside the axis": "−2.25 m"}
        self.assertEqual(rows, rows | given)

    def test_a_limit_that_cannot_be_evaluated(self):
        (self.folder / "own.yml").write_text('- {clause: "EN 1990 A2.4.4.3", quantity: car_acceleration, value: 1.0}\n',
                                             encoding="utf-8")
        status, said = self.inside(*SHORT, "--limits", "own.yml")
        self.assertEqual(status, outcome.NOT_JUDGED)
        self.assertIn("Result: 1 of 2 limits is NOT EVALUATED; ", said)  # 6.4.6.5 is the other one

    def test_one_line_for_what_fails(self):
        for words, status, said in ((BRIDGE[2:], 2, "--span is missing"), ((*BRIDGE, "--alpha", "99"), 2, "norm_alpha"),
                                    ((*BRIDGE, "--span", "1e9 m"), 2, "no railway bridge has"),
                                    ((*BRIDGE, "--EI", "1e6 GN.m2"), 2, "is that of no bridge with L = "),
                                    ((*BRIDGE, "--folder", "file"), 4, "file")):
            (self.folder / "file").write_text("", encoding="utf-8")
            ended, _, error = self.command(*words)
            self.assertEqual((ended, len(error.splitlines())), (status, 1), error)
            self.assertIn(said, error)

    def test_everything_for_a_bridge_of_28_m(self):
        status, said, error = self.command(*BRIDGE, "--report-project", "Line 4711")
        self.assertEqual(status, 0, said)
        self.assertEqual(error, COMPUTED + "  the report, the pictures and the pages of results are being made\n")
        folder = self.folder / "results/check"
        for name in ("report.pdf", "report.xlsx", "check.png", "check.html", "check.yml", "limits.yml", "check.txt",
                     "summary.txt"):
            self.assertGreater((folder / name).stat().st_size, 100, name)
        with h5py.File(folder / "check.h5") as file:
            self.assertEqual(sorted(file["sweep/hslm_a"][:]), list(range(1, 11)))
            self.assertAlmostEqual(file["sweep/speed"][:].max(), 1.2 * 250.0 / 3.6, 9)
            self.assertIn(f"n0 = {file['norm'].attrs['n0']:.4g} Hz", said)
            self.assertIn(f"{file['norm/train_over_model'][:].max():.4g} of 1 ", said)
            speed, norm = file["sweep/speed"][:].max(), file["norm"]
            of_track = track_defects.phi_of_track(norm["determinant_length"][0], norm.attrs["n0"], speed)
            self.assertIn(f"phi'' = {of_track:.3g},", norm.attrs["words"])  # the program has the same formula
            factors = dict(zip(file["verdicts/quantity"].asstr()[:, 0], file["verdicts/factor"][:]))
            self.assertAlmostEqual(factors["deck_acceleration"], 1.0 + of_track, 5)
            self.assertEqual(factors["lm71_end_rotation"], 1.0)
            worst = np.nanmax(file["verdicts/value"][:] / file["verdicts/limit"][:])
        self.assertEqual((folder / "summary.txt").read_text(encoding="utf-8").partition("\n")[2], said)
        self.assertIn(f"Result: all 6 limits are complied with; greatest utilisation {100 * worst:.0f} %", said)


if __name__ == "__main__":
    unittest.main()
