"""scripts/page.py in a real browser: what the page draws, plays and says are the numbers of the results file."""

import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser  # noqa: E402
from small_runs import BINARY, CROSSING, SOURCE, Computed  # noqa: E402

SCRIPTS, SCENES = SOURCE / "scripts", SOURCE / "options/scenes"
sys.path.insert(0, str(SCRIPTS))
import page  # noqa: E402

LIMITS = ("-limits", str(SOURCE / "options/limits/en1990.yml"))
STUDY = CROSSING + "study: {vary: {foundation_vertical_k: [1.0e9, 4.0e9], load_speed: [30.0, 40.0, 50.0, 60.0]}}\n"
SWEEP = CROSSING.replace("load: {forces: [2.0e5, 1.0e5], positions: [0.0, -3.0], speed: 40.0}",
                         "sweep: {speed: [40.0, 80.0, 10.0], hslm_a: [1, 10], refine: 0}")
RAIL = """
scene: {analysis: rail}
beam: {spans: 12.0, EI: 2.0e9, EA: 4.0e9, mass: 3000.0, temperature: {uniform: 30.0, expansion: 1.0e-5}}
support: {types: [roller, roller]}
foundation: {longitudinal: {x: [0.0, 12.0], k: [2.0e8, 1.0e7], limit: [0.0, 2.0e4]}}
track:
  rail: {EI: 1.28e7, EA: 3.2212e9, mass: 120.0, area: 0.0153, ends: held, temperature: 40.0}
  spacing: 0.6
  pad: {k: 1.0e8}
  longitudinal: {k: 6.0e6, limit: 12000.0, loaded_k: 1.8e7, loaded_limit: 36000.0}
  approach: 60.0
uic774: {train_length: 30.0, fronts: [0.0, 12.0, 6.0]}
"""
OVER_TIME = ("forces", "cars", "mechanism", "crane")
HOSTILE = "</script><img src=x onerror=\"document.title='broken'\"><b>'&amp;\u2028{{data}}"


def shown(value):
    """A number as the page shows it, with five digits."""
    return float(f"{value:.5g}")


def with_language(path, out, language):
    """A copy of a results file of a scene with this language of the report."""
    shutil.copy(path, out)
    with h5py.File(out, "a") as file:
        options = [*file["options"].asstr()[:].tolist(), ["-report_language", language]]
        del file["options"]
        file.create_dataset("options", data=np.array(options, dtype=object), dtype=h5py.string_dtype())


class PageTest(Computed):
    @classmethod
    def prepare(cls):
        cls.compute("forces", CROSSING)
        cls.compute("study", STUDY, *LIMITS)
        cls.compute("statistics", STUDY, "-study_statistics_over", "foundation_vertical_k")
        cls.compute("sweep", SWEEP, *LIMITS)
        cls.compute("rail", RAIL, "-limits", str(SOURCE / "options/limits/uic774.yml"))
        for name, scene, *words in (
                ("cars", "three_span_half_car", "-ts_dt", "2e-3", "-output_interval", "0.02",
                 "-beam_elements_per_span", "4"),
                ("mechanism", "r9_andrews", "-ts_max_time", "0.01"), ("screen", "screen_line"),
                ("crane", "overhead_crane", "-ts_dt", "5e-3", "-beam_elements_per_span", "4", "-ts_max_time", "4")):
            command = [BINARY, "-options_file", SCENES / f"{scene}.yml", "-output_file", f"{name}.h5", *words]
            run = subprocess.run(command, cwd=cls.folder, capture_output=True, text=True)
            if run.returncode != 0:
                raise AssertionError(run.stdout + run.stderr)
        with_language(cls.folder / "sweep.h5", cls.folder / "german.h5", "de")
        with_language(cls.folder / "cars.h5", cls.folder / "french.h5", "fr")
        for name in (*OVER_TIME, "study", "statistics", "sweep", "rail", "screen", "german", "french"):
            page.write(cls.folder / f"{name}.h5", cls.folder / f"{name}.html")
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def open(self, name, width=1280):
        self.browser.open(self.folder / f"{name}.html", width)
        self.js = self.browser.evaluate

    def results(self, name):
        file = h5py.File(self.folder / f"{name}.h5")
        self.addCleanup(file.close)
        return file

    def middle(self, words):
        """Place on the screen of the middle of an element, after scrolling to it."""
        left, top, width, height = self.box(words)
        return left + 0.5 * width, top + 0.5 * height

    def box(self, words):
        """Left, top, width and height of an element on the screen, after scrolling to it."""
        return self.js(f"(() => {{ const it = {words}; it.scrollIntoView({{block: 'end'}}); const box = "
                       "it.getBoundingClientRect(); return [box.left, box.top, box.width, box.height]; })()")

    def test_pages_open_without_complaint_and_fit(self):
        for name in (*OVER_TIME, "study", "sweep", "rail"):
            with self.subTest(name):
                self.assertLess((self.folder / f"{name}.html").stat().st_size, 3_000_000)
                self.open(name, 390)
                self.assertTrue(self.js("page.all.length > 0 && !byId('stage').hidden"))
                self.js("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
                self.assertEqual(self.js("document.documentElement.scrollWidth"), 390)
                cut = "(one) => one.scrollWidth > one.clientWidth && one.closest('#run, #verdicts')"
                self.assertEqual(self.js(f"[...document.querySelectorAll('.wide')].filter({cut}).length"), 0)
                self.browser.resize(1280)
                self.browser.scheme("dark")
                self.browser.frames()
                self.assertLessEqual(self.js("document.documentElement.scrollWidth"), 1280)
                self.assertEqual(self.js("colour('card')"), "#1d2329")
                self.browser.scheme("light")
                self.assertEqual(self.browser.complaints(), [])

    def test_space_plays_and_arrows_step(self):
        for name in OVER_TIME:
            with self.subTest(name):
                self.open(name)
                self.browser.key(" ")
                self.assertTrue(self.js("page.playing"))
                self.assertEqual(self.js("byId('play').getAttribute('aria-label')"), "Pause")
                for _ in range(300):
                    self.browser.frames(1)
                    if self.js("page.time") > 0.0:
                        break
                self.browser.key(" ")
                self.assertFalse(self.js("page.playing"))
                before = self.js("page.time")
                self.assertGreater(before, 0.0)
                self.browser.key("ArrowRight")
                times = self.results(name)["time"][:]
                self.assertLess(np.abs(times - self.js("page.time")).min(), 1e-6 * times[-1])
                self.assertGreaterEqual(self.js("page.time"), min(before, times[-1]) - 1e-6)

    def go_to(self, time):
        self.js(f"byId('bar').value = {time}; byId('bar').dispatchEvent(new Event('input'))")

    def test_the_time_bar_moves_vehicles_and_lines(self):
        for name in ("cars", "crane", "mechanism"):
            with self.subTest(name):
                self.open(name)
                file = self.results(name)
                time, seen = file["time"][:], set()
                for part in (0.0, 0.31, 0.77):
                    self.go_to(part * time[-1])
                    at = self.js("page.time")
                    self.assertAlmostEqual(at / time[-1], part, 3)
                    seen.add(self.js("byId('drawing').toDataURL()"))
                    for k, bodies in enumerate(self.js("data.stage.vehicles.map((one) => one.bodies)")):
                        for body, name_of_body in enumerate(bodies):
                            drawn = self.js(f"page.stage.drawn[{k}][{body}]")
                            stored = file[f"vehicles/{k}/{name_of_body}/position"][: len(time)]
                            for column in (0, 1):
                                here = np.interp(at, time, stored[:, column])
                                near = 1e-3 * np.ptp(stored[:, column]) + 1e-6
                                self.assertAlmostEqual(drawn[column], here, delta=near)
                    line, plot = self.box("page.cards[0].cursor")[0], self.box("page.cards[0].plot")[0]
                    wanted = self.js(f"page.cards[0].chart.scales.x.getPixelForValue({at})")
                    self.assertAlmostEqual(line - plot, wanted, delta=1.5)
                self.assertEqual(len(seen), 3)

    def test_forces_and_line_are_those_of_the_file(self):
        self.open("forces")
        file = self.results("forces")
        time, x = file["time"][:], file["probes/x"][:]
        row = len(time) // 2
        self.go_to(time[row])
        places = self.js("[0, 1].map((i) => page.stage.mixed(data.stage.forces[0].x, 2, i))")
        np.testing.assert_allclose(places, 40.0 * self.js("page.time") + np.array([0.0, -3.0]), atol=1e-4)
        drawn = [self.js(f"page.stage.deflection({place})") for place in x]
        stored = file["probes/deflection"][row]
        np.testing.assert_allclose(drawn, stored, atol=0.01 * np.abs(file["probes/deflection"][:]).max())

    def test_values_under_the_pointer(self):
        self.open("cars")
        file = self.results("cars")
        time, deflection = file["time"][:], 1e3 * file["probes/deflection"][: len(file["time"])]
        self.browser.mouse("mouseMoved", *self.middle("page.cards[0].plot"))
        self.browser.frames()
        points = self.js("page.cards[0].chart.tooltip.dataPoints.map((one, i) => "
                         "[one.parsed.x, page.cards[0].chart.tooltip.body[i].lines[0]])")
        self.assertTrue(points)
        for at, words in points:
            row = int(np.abs(time - at).argmin())
            self.assertAlmostEqual(at, time[row], 5)
            self.assertIn(" mm", words)
            value = float(words.rsplit(": ", 1)[1].split(" ")[0])
            self.assertIn(value, [shown(stored) for stored in deflection[row]])

    def test_drag_zooms_all_charts_and_names_hide_curves(self):
        self.open("cars")
        x, y = self.middle("page.cards[0].plot")
        for kind, place in (("mouseMoved", x), ("mousePressed", x), ("mouseReleased", x + 90)):
            self.browser.mouse(kind, place, y)
        low, high = self.js("[page.cards[1].chart.scales.x.min, page.cards[1].chart.scales.x.max]")
        self.assertGreater(low, 0.0)
        self.assertLess(high, self.js("page.end"))
        self.js("byId('reset').click()")
        self.assertEqual(self.js("page.cards[1].chart.scales.x.min"), self.js("page.start"))
        self.js("page.cards[0].legend.querySelector('button').click()")
        self.assertFalse(self.js("page.cards[0].chart.isDatasetVisible(0)"))

    def choose(self, line, index):
        """Clicks a point of the first chart of the runs; returns the text of the row of its run."""
        left, top, _, _ = self.box("page.runs.charts[0].plot")
        px, py = self.js(f"(({{x, y}}) => [x, y])(page.runs.charts[0].chart.getDatasetMeta({line}).data[{index}])")
        self.browser.click(left + px, top + py)
        return self.js("byId('run').innerText")

    def test_a_click_in_a_sweep_shows_the_run(self):
        self.open("sweep")
        file = self.results("sweep")
        speed = file["sweep/speed"][:]
        for train, run in ((0, 1), (1, len(speed) - 1)):
            row = self.choose(train, run)
            self.assertIn(f"A{file['sweep/hslm_a'][train]:.0f}, {3.6 * speed[run]:.4g} km/h", row)
            for name, factor, unit in (("peak_deflection", 1e3, "mm"), ("peak_moment", 1e-3, "kN m"),
                                       ("peak_acceleration", 1.0, "m/s²")):
                largest = factor * np.abs(file[f"sweep/{name}"][train, run]).max()
                number = format(shown(largest), ",g" if largest >= 1e4 else "g").replace(",", "\u202f")
                self.assertIn(f"{number} {unit}", row)
            quantities = list(file["verdicts/quantity"].asstr()[:, 0])
            value = file["sweep/judged"][train, run, quantities.index("deck_acceleration")]
            limit = file["verdicts/limit"][quantities.index("deck_acceleration")]
            word = "exceeded" if value > limit else "complied with"
            self.assertRegex(row, rf"{word}\s+[^\n]*acceleration[^\n]*\s+{shown(value):g}")

    def test_the_train_of_the_chosen_run_passes_at_its_speed(self):
        self.open("sweep")
        file = self.results("sweep")
        for train, run in ((0, 1), (1, 2)):
            self.choose(train, run)
            speed, start = file["sweep/speed"][run], file[f"model/forces/A{file['sweep/hslm_a'][train]:.0f}"][:, 0]
            self.assertAlmostEqual(self.js("page.end"), (45.0 - start.min()) / speed, 4)
            for part in (0.2, 0.7):
                self.go_to(part * self.js("page.end"))
                drawn = self.js("data.stage.forces[page.stage.train].sizes.reduce((found, _, i, all) => [...found, "
                                "page.stage.mixed(data.stage.forces[page.stage.train].x, all.length, i)], [])")
                np.testing.assert_allclose(list(drawn.values()) if isinstance(drawn, dict) else drawn,
                                           start + speed * self.js("page.time"), atol=1e-3)
        before = self.js("page.time")
        self.browser.key(" ")
        for _ in range(300):
            self.browser.frames(1)
            if self.js("page.time") > before:
                break
        self.browser.key(" ")
        self.assertGreater(self.js("page.time"), before)

    def test_a_train_without_a_constant_speed_stays(self):
        shutil.copy(self.folder / "sweep.h5", self.folder / "tabled.h5")
        with_language(self.folder / "sweep.h5", self.folder / "tabled.h5", "en")
        with h5py.File(self.folder / "tabled.h5", "a") as file:
            texts = file["options"][:]
            texts[-1] = ["-load_speed_file", "speed.csv"]
            file["options"][...] = texts
        page.write(self.folder / "tabled.h5", self.folder / "tabled.html")
        self.open("tabled")
        self.assertEqual(self.js("data.stage.frames"), 1)
        self.assertTrue(self.js("byId('controls').hidden"))

    def test_verdicts_have_the_words_and_the_utilisation_of_the_report(self):
        for name, words in (("sweep", ("complied with", "exceeded", "not evaluated", "utilisation", "Only the limits")),
                            ("german", ("eingehalten", "überschritten", "nicht ausgewertet", "Ausnutzung", "Nur die"))):
            self.open(name)
            group = self.results(name)["verdicts"]
            kinds = ("kept", "broken", "not judged")
            found = [words[kinds.index(word)] for word in group["verdict"].asstr()[:, 0]]
            drawn = self.js("[...document.querySelectorAll('#verdicts tbody tr')].map((row) => "
                            "[...row.cells].map((cell) => cell.innerText))")
            self.assertEqual([row[0] for row in drawn], found)
            for row, margin in zip(drawn, group["margin"][:]):
                percent = f"{100.0 * (1.0 - margin):.1f} %" if np.isfinite(margin) else ""
                self.assertEqual(row[5], percent if name == "sweep" else percent.replace(".", ","))
            self.assertIn(words[3], self.js("byId('verdicts').innerText"))
            self.assertIn(words[4], self.js("byId('caveat').innerText"))
            self.assertEqual(self.js("document.documentElement.lang"), "en" if name == "sweep" else "de")

    def test_the_headline_and_the_scale_are_in_the_language_of_the_page(self):
        found = {}
        for name in ("german", "cars", "french"):
            self.open(name)
            found[name] = self.js("['said', 'drawn'].map((one) => byId(one).textContent)")
        self.assertRegex(found["german"][0], r"^Größte Durchbiegung \d+,\d mm, Feld 2, bei 27,5 m unter Zug A10 bei "
                                             r"288 km/h; das \d,\d\d-Fache der statischen$")
        self.open("german")
        labels = self.js("page.all.flatMap((card) => card.chart.scales.y.ticks.map((one) => one.label))")
        self.assertEqual([one for one in labels if "." in str(one)], [])
        self.assertTrue(any("," in str(one) for one in labels), labels)
        self.assertRegex(found["cars"][0], r"^Greatest deflection \d+\.\d mm, middle of span 2 \(40 m\); ")
        self.assertRegex(found["cars"][1], r"^Vertical displacements of bridge and vehicles are drawn 100 times too large, ")
        self.assertRegex(found["french"][0], r"^Flèche maximale \d+,\d mm, milieu de la travée 2 \(40 m\) ; ")
        self.assertRegex(found["french"][1], r"^Les déplacements verticaux du pont et des véhicules sont amplifiés 100 fois, ")

    def test_a_limit_far_above_is_named_at_the_edge(self):
        self.open("sweep")
        group = self.results("sweep")["verdicts"]
        limit = float(group["limit"][list(group["quantity"].asstr()[:, 0]).index("end_rotation")])
        chart = "page.runs.charts[data.runs.quantities.findIndex((one) => one.name === 'end_rotation')]"
        greatest = self.js(f"Math.max(...{chart}.spec.curves.flatMap((one) => [...one.columns[0]]))")
        self.assertGreater(1e3 * limit, 2.5 * greatest)
        self.assertLess(self.js(f"{chart}.chart.scales.y.max"), 1.5 * greatest)
        self.assertIn(f"{shown(1e3 * limit):g} mrad", self.js(f"{chart}.root.querySelector('.edge').textContent"))

    def test_a_click_in_a_study_shows_the_run(self):
        self.open("study")
        file = self.results("study")
        row = self.choose(1, 2)
        number = list(zip(file["study/foundation_vertical_k"][:], file["study/load_speed"][:])).index((4e9, 50.0))
        self.assertIn("180 km/h", row)
        self.assertIn(f"{shown(1e3 * np.abs(file['study/peak_deflection'][number]).max()):g} mm", row)
        self.assertEqual(self.js("page.runs.limitsOf({name: 'deck_acceleration'}).length"), 1)
        said, where = self.js("byId('verdicts').innerText"), file["verdicts/verdict"].asstr()[0, 1]
        stiffness, speed = (float(re.search(f"{name} ([-+.e0-9]+)", where)[1]) for name in
                            ("foundation_vertical_k", "load_speed"))
        self.assertIn(f"stiffness of the vertical springs {1e-6 * stiffness:.0f} MN/m", said)
        self.assertIn(f"{3.6 * speed:.4g} km/h", said)
        self.assertNotIn("load_speed", said)

    def test_statistics_are_those_of_the_file(self):
        self.open("statistics")
        rows = [row for row in self.js("data.tables.find((one) => one.title === 'Statistics').rows")
                if row[1] == "greatest deflection (mm)"]
        means = 1e3 * self.results("statistics")["study/statistics/peak_deflection_mean"][:].max(axis=1)
        self.assertEqual([float(row[3]) for row in rows], [float(f"{mean:.4g}") for mean in means])

    def test_rail_stresses_are_those_of_the_file(self):
        self.open("rail")
        file = self.results("rail")
        np.testing.assert_allclose(self.js("Array.from(data.along[0].curves.at(-1).columns[1])"),
                                   1e-6 * file["rail_forces/at_once/greatest_stress"][:], rtol=1e-6, atol=1e-6)
        self.assertEqual(self.js("data.along[0].limits.map((one) => one[1])"), [72, -92])
        said = self.js("byId('verdicts').innerText")
        for value in file["verdicts/value"][:2]:
            self.assertIn(f"{shown(1e-6 * value):g}", said)

    def test_a_heat_map_has_the_ratios_of_the_file_in_the_colours_of_its_scale(self):
        self.open("screen")
        self.browser.frames()
        ratio = self.results("screen")["screen/ratio"][:]
        colours = self.js("getComputedStyle(document.querySelector('.colour-scale')).backgroundImage.match(/rgb[^)]*\\)/g)")
        self.assertEqual(colours, self.js("[0, 0.5, 1, 1.5, 2].map((ratio) => shade(ratio).replaceAll(',', ', '))"))
        self.assertEqual(self.js("document.querySelector('.colour-scale-values').textContent"), "00.511.5≥ 2")
        left, top, _, _ = self.box("page.heat.canvas")
        cell = self.js("[page.heat.left + 1.5 * page.heat.width, page.heat.top + 0.5 * page.heat.height]")
        self.browser.mouse("mouseMoved", left + cell[0], top + cell[1])
        self.browser.frames()
        value = float(self.js("page.heat.said.textContent").rsplit(" ", 1)[1])
        self.assertLess(np.abs(ratio - value).min(), 1e-4 * value)
        drawn = self.js(f"[...page.heat.canvas.getContext('2d').getImageData(devicePixelRatio * {cell[0]}, "
                        f"devicePixelRatio * {cell[1]}, 1, 1).data].slice(0, 3).join(',')")
        self.assertEqual(self.js(f"shade({value})"), f"rgb({drawn})")
        self.assertEqual(self.browser.complaints(), [])

    def test_hostile_texts_are_texts(self):
        path = self.folder / "hostile.h5"
        shutil.copy(self.folder / "sweep.h5", path)
        with h5py.File(path, "a") as file:
            file.attrs["scene"] = HOSTILE.replace("/", "|")
            for name in ("options", "model/notes", "verdicts/clause", "verdicts/verdict"):
                texts = file[name][:]
                texts[-1] = [HOSTILE, HOSTILE]
                file[name][...] = texts
            file["summary"].attrs["ended"] = HOSTILE
        page.write(path, self.folder / "hostile.html")
        self.open("hostile")
        self.assertEqual(self.browser.complaints(), [])
        self.assertNotEqual(self.js("document.title"), "broken")
        self.assertEqual(self.js("document.querySelectorAll('img, main b').length"), 0)
        self.assertEqual(self.js("data.notes.at(-1)"), HOSTILE)
        self.assertIn(HOSTILE, self.js("byId('tables').textContent"))

    def test_bad_files_end_with_one_line(self):
        (self.folder / "text.h5").write_text("no results")
        h5py.File(self.folder / "empty.h5", "w").close()
        for name in ("missing", "text", "empty"):
            run = subprocess.run([sys.executable, "-B", SCRIPTS / "page.py", f"{name}.h5", "out.html"], cwd=self.folder,
                                 capture_output=True, text=True)
            self.assertEqual(run.returncode, 1)
            self.assertRegex(run.stderr, rf"\Apage.py: {name}.h5: [^\n]+\n\Z")
            self.assertFalse((self.folder / "out.html").exists())

    def test_a_missing_library_is_named(self):
        with self.assertRaisesRegex(ValueError, "libjs-chart.js"):
            page.chart_library(())


if __name__ == "__main__":
    unittest.main()
