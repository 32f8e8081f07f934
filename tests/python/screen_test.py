"""scene_analysis screen from outside: passages against the program's own sweep, an interrupted screen that goes on,
equal results on any number of ranks, wrong tables, the Dataset of Python, the picture, and fatigue under traffic."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
TRAVERSE = os.environ["TRAVERSE_BINARY"]
sys.path[:0] = [str(SOURCE / "python"), str(SOURCE / "scripts")]
import axle_tables  # noqa: E402
import traverse  # noqa: E402

STOCK = """# two bridges
name, spans, mass, EI, damping, speed
short, 15, 12000, 9.0e9, 0.01, 250 km/h
two spans, 20 24, 14000, 2.4e10, 0.015, 200 km/h
"""
FLEET = """name; speed; spacing; load_t
coaches; 250 km/h; 0; 15
coaches; 250 km/h; 2.5; 15
coaches; 250 km/h; 16.0; 15
coaches; 250 km/h; 2.5; 15
coaches; 250 km/h; 5.4; 15
coaches; 250 km/h; 2.5; 15
coaches; 250 km/h; 16.0; 15
coaches; 250 km/h; 2.5; 15
wagon; 100 km/h; 0; 22
wagon; 100 km/h; 1.8; 22
wagon; 100 km/h; 7.0; 22
wagon; 100 km/h; 1.8; 22
"""
LIMITS = """- {clause: "A", quantity: deck_acceleration, value: 0.5}
- {clause: "B", quantity: deflection_over_span, value: 1/3000}
- {clause: "C", quantity: wheel_unloading, value: 0.6}
"""
MATRICES = ("ratio", "bound", "permitted_speed", "governing_speed", "exceeding_speeds", "decided_by")


class Screen(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write(stock=STOCK, fleet=FLEET)
        (self.folder / "limits.yml").write_text(LIMITS)

    def write(self, **tables):
        for name, text in tables.items():
            (self.folder / f"{name}.csv").write_text(text)

    def start(self, *words, ranks=1):
        """The finished process of a screen."""
        launch = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
        environment = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"} | os.environ
        command = [*launch, TRAVERSE, "-skip_petscrc", "-scene_analysis", "screen", "-screen_stock", "stock.csv",
                   "-screen_fleet", "fleet.csv", "-limits", "limits.yml", "-screen_speeds", "40 km/h,250 km/h,5 km/h",
                   "-output_file", "screen.h5", *words]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, env=environment)

    def screened(self, *words, ranks=1):
        done = self.start(*words, ranks=ranks)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        with h5py.File(self.folder / "screen.h5") as file:
            return {name: file[f"screen/{name}"][()] for name in MATRICES} | {"text": done.stdout}

    def sweep_of_pair(self, **options):
        return traverse.run(self.folder / "pair.yml", beam_elements_per_span=80, sweep_instants=100, **options)

    def assert_equal(self, one, other):
        for name in MATRICES:
            np.testing.assert_array_equal(one[name], other[name], err_msg=name)

    def refused(self, expected, **tables):
        self.write(**tables)
        done = self.start()
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn(expected, done.stderr)
        self.write(stock=STOCK, fleet=FLEET)

    def test_passages_equal_the_programs_own_sweep(self):
        self.assert_equals_sweeps()

    def test_bridges_that_twist(self):
        flat = self.screened()
        self.write(stock="name, spans, mass, EI, damping, speed, eccentricity [m], GJ, polar_inertia\n"
                         "short, 15, 12000, 9.0e9, 0.01, 250 km/h, 2.0, 4.0e9, 60000\n"
                         "two spans, 20 24, 14000, 2.4e10, 0.015, 200 km/h, -2.0, 9.0e9, 80000\n")
        self.assert_equals_sweeps()
        self.write(stock="name, spans, mass, EI, damping, speed, eccentricity [m], torsional_frequency, polar_inertia\n"
                         "short, 15, 12000, 9.0e9, 0.01, 250 km/h, 0, 12, 60000\n"
                         "two spans, 20 24, 14000, 2.4e10, 0.015, 200 km/h, 0, 12, 80000\n")
        (self.folder / "limits.yml").write_text(LIMITS)
        self.assert_equal(flat, self.screened())

    def assert_equals_sweeps(self):
        limits = "- {clause: A, quantity: deck_acceleration, value: 0.01}\n"  # every pair is decided by passages
        (self.folder / "limits.yml").write_text(limits)
        found = self.screened()
        self.assertTrue((found["decided_by"] == 2).all())
        for b, bridge in enumerate(("short", "two spans")):
            for f, formation in enumerate(("coaches", "wagon")):
                with self.subTest(bridge=bridge, formation=formation):
                    scene = self.start("-screen_pair", f"{bridge},{formation}")
                    self.assertEqual(scene.returncode, 0, scene.stderr)
                    (self.folder / "pair.yml").write_text(scene.stdout)
                    sweep = self.sweep_of_pair()
                    peaks = sweep["peak_acceleration"].max([d for d in sweep["peak_acceleration"].dims if d != "speed"])
                    at = float(peaks.idxmax("speed"))
                    self.assertAlmostEqual(at, found["governing_speed"][b, f], places=9)
                    # The sweep has a probe at every hundredth of a span; the peak is beside the best of them.
                    places = sweep["peak_acceleration"].max([d for d in sweep["peak_acceleration"].dims if d != "x"])
                    best = float(places.idxmax("x"))
                    near = self.sweep_of_pair(output_probes=list(np.linspace(best - 0.24, best + 0.24, 73)))
                    peak = float(near["peak_acceleration"].max())
                    self.assertLess(abs(peak / (0.01 * found["ratio"][b, f]) - 1.0), 2e-5)

    def test_an_interrupted_screen_goes_on(self):
        whole = self.screened()
        with h5py.File(self.folder / "screen.h5", "r+") as file:
            for name in MATRICES:
                file[f"screen/{name}"][1] = np.nan
            file["screen/row_digest"][1] = np.nan
        again = self.screened("-screen_resume", "true")
        self.assert_equal(whole, again)
        with h5py.File(self.folder / "screen.h5", "r+") as file:
            file["screen/ratio"][0, 0] = 7.0  # a damaged row is computed again
        self.assert_equal(whole, self.screened("-screen_resume", "true"))
        self.assertEqual(list(self.folder.glob("screen.h5.*")), [])
        done = self.start("-screen_resume", "true", "-screen_modes", "2")
        self.assertIn("contains another screen", done.stderr)
        self.assertNotEqual(done.returncode, 0)

    def test_a_results_file_is_run_again_without_its_tables(self):
        (self.folder / "trains").mkdir()
        for name in ("coaches", "wagon"):
            rows = [line for line in FLEET.splitlines() if line.startswith((name, "name"))]
            (self.folder / "trains" / f"{name}.csv").write_text("\n".join(rows) + "\n")
        whole = self.screened("-screen_fleet", "trains")
        self.assert_equal(whole, self.screened())
        self.screened("-screen_fleet", "trains")
        for table in ("stock.csv", "fleet.csv", "limits.yml", "trains/coaches.csv", "trains/wagon.csv"):
            (self.folder / table).unlink()
        done = subprocess.run([TRAVERSE, "screen.h5"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        with h5py.File(self.folder / "screen_again.h5") as file:
            self.assert_equal(whole, {name: file[f"screen/{name}"][()] for name in MATRICES})

    def test_names_of_files_are_no_options(self):
        (self.folder / "trains").mkdir()
        rows = "load_t, position\n20, 0\n20, 3\n"
        (self.folder / "trains" / "a\nload: {speed: 1.0}\nb.csv").write_text(rows)
        scene = self.start("-screen_fleet", "trains", "-screen_pair", r"short,a\nload: {speed: 1.0}\nb")
        self.assertEqual((scene.returncode, scene.stderr), (0, ""))
        self.assertEqual([line for line in scene.stdout.splitlines() if line.startswith("load:")], ["load:"])

    def test_links_in_a_folder_of_trains(self):
        (self.folder / "trains").mkdir()
        for name, words in (("self.csv", "self.csv"), ("pipe.csv", "pipe.csv")):
            path = self.folder / "trains" / name
            path.symlink_to(name) if name == "self.csv" else os.mkfifo(path)
            done = self.start("-screen_fleet", "trains")
            self.assertEqual((done.returncode in range(1, 127), len(done.stderr.splitlines())), (True, 1), done.stderr)
            self.assertIn(words, done.stderr)
            self.assertNotIn("internal error", done.stderr)
            path.unlink()
        (self.folder / "loop").symlink_to("loop")
        done = self.start("-screen_fleet", "loop")
        self.assertEqual((done.returncode in range(1, 127), len(done.stderr.splitlines())), (True, 1), done.stderr)

    def test_ranks_change_nothing(self):
        self.assert_equal(self.screened(), self.screened(ranks=2))

    def test_verdicts_agree_with_permitted_speeds(self):
        found = self.screened("-screen_audit", "20")
        self.assertIn("0 exceedances missed, 0 verdicts different, 0 bounds below", found["text"])
        exceeded = found["exceeding_speeds"] > 0
        self.assertTrue(exceeded.any() and not exceeded.all())
        np.testing.assert_array_equal(exceeded, found["ratio"] > 1.0)
        self.assertTrue((found["ratio"] <= found["bound"]).all())
        with h5py.File(self.folder / "screen.h5") as file:
            np.testing.assert_array_equal(file["screen/bridge_ratio"][()], found["ratio"].max(axis=1))
            governing = file["screen/governing_bridge"][()].astype(int)
            np.testing.assert_array_equal(governing, found["ratio"].argmax(axis=0))
            self.assertEqual(file["summary"].attrs["pairs_restricted"], exceeded.sum())

    def test_wrong_tables_are_refused_with_file_and_line(self):
        self.refused("stock.csv:1: there is no column 'span'", stock="name, span\na, 3\n")
        self.refused("stock.csv:1: allowed: one of the columns EI and f1", stock="name, spans, mass\na, 10, 1e4\n")
        self.refused("stock.csv:3: spans: '-24'", stock=STOCK.replace("short, 15", "short, -24"))
        self.refused("stock.csv:4: name: 'short'; allowed: a different name", stock=STOCK.replace("two spans", "short"))
        self.refused("stock.csv:3: damping: 0.5", stock=STOCK.replace("0.01,", "0.5,"))
        self.refused("stock.csv:4: 5 cells, expected 6", stock=STOCK.replace(", 200 km/h", ""))
        self.refused("fleet.csv:2: load_t: 'x' is not a possible number", fleet=FLEET.replace("0; 15", "0; x", 1))
        self.refused("fleet.csv:5: speed: differs", fleet=FLEET.replace("250 km/h; 2.5; 15\ncoaches; 250 km/h; 5.4",
                                                                      "90 km/h; 2.5; 15\ncoaches; 250 km/h; 5.4"))
        self.refused("the formation coaches is given twice", fleet=FLEET + FLEET.split("\n")[1] + "\n")
        self.refused("fleet.csv:3: spacing: -2.5", fleet=FLEET.replace("2.5; 15", "-2.5; 15", 1))
        (self.folder / "limits.yml").write_text('- {clause: "C", quantity: wheel_unloading, value: 0.6}\n')
        self.refused("a screen computes deck_acceleration and deflection_over_span")

    def test_numbers_in_other_units_are_noted(self):
        def noted(heading, **tables):
            self.write(**tables)
            text = self.screened()["text"]
            checked = self.start("-describe").stdout
            self.write(stock=STOCK, fleet=FLEET)
            said = [lines.split("\n")[0] for lines in text.split("unusual input\n  ")[1:]]
            self.assertEqual(len(said) == 1, heading != "", text)
            self.assertIn(heading, "".join(said))
            self.assertIn("".join(said), checked)
        noted("")
        noted("short: the first frequency, 0.191 Hz, is below the range of railway bridges of 15 m",
              stock=STOCK.replace("9.0e9", "9.0e6"))
        noted("EI is possibly given in kN m2", stock=STOCK.replace("9.0e9", "9.0e6"))
        noted("(and 1 more bridges)", stock=STOCK.replace("9.0e9", "9.0e6").replace("2.4e10", "2.4e7"))
        noted("mass is possibly given in t/m", stock=STOCK.replace("12000", "12"))
        noted("short: a damping ratio of 0.15 is 15 % of critical damping", stock=STOCK.replace("0.01,", "0.15,"))
        noted("short: speed: 160 m/s is 576 km/h", stock=STOCK.replace("250 km/h", "160"))
        noted("coaches: its heaviest axle has 15 kN", fleet=FLEET.replace("load_t", "load_kN"))

    def test_a_decimal_comma_is_refused(self):
        self.refused("stock.csv:2: commas and semicolons in one row", stock="name; spans; mass; EI; damping\n"
                     "short; 15,5; 12000; 9.0e9; 0.01\n")
        self.refused("fleet.csv:2: 4 cells, expected 3; a comma separates numbers, decimals need a point",
                     fleet="name, spacing, load_t\nwagon, 1,8, 22\n")

    def test_python_returns_a_dataset(self):
        results = traverse.screen("stock.csv", "fleet.csv", "limits.yml", ("40 km/h", "250 km/h", "5 km/h"),
                                  folder=self.folder)
        self.assertEqual(dict(results.sizes) | {"bridge": 2, "formation": 2}, dict(results.sizes))
        found = self.screened()
        ratio = results["ratio"].sel(bridge="two spans", formation="wagon")
        self.assertEqual(float(ratio), found["ratio"][1, 1])
        self.assertEqual(results["permitted_speed"].attrs["units"], "m/s")
        with self.assertRaisesRegex(traverse.Error, "screen_stock"):
            traverse.screen("none.csv", "fleet.csv", "limits.yml", folder=self.folder)

    def test_the_picture_is_a_heat_map(self):
        self.screened()
        done = subprocess.run([sys.executable, "-B", SOURCE / "scripts/picture.py", "screen.h5", "screen.png",
                               "--formats", "png,csv"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.folder / "screen.png").read_bytes()[:4], b"\x89PNG")
        self.assertIn("two spans", (self.folder / "screen.csv").read_text().splitlines()[0])


class Traffic(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "bridge.yml").write_text(
            "beam: {spans: [15.0], EI: 9.0e9, mass: 1.2e4}\nmodel: {modes: 3, damping_ratios: 0.01}\n"
            "output: {interval: 0.002}\nts: {dt: 0.002}\n")
        (self.folder / "fleet.csv").write_text(FLEET)

    def traffic(self, *words):
        return subprocess.run([sys.executable, "-B", SOURCE / "scripts/traffic.py", "bridge.yml", *words, "--of",
                               "/probes/moment[0]", "--factor", "1/0.01", "--line", "slope:3,71e6,2e6", "--csv",
                               "traffic_out.csv"], cwd=self.folder, capture_output=True, text=True)

    def damages(self):
        lines = (self.folder / "traffic_out.csv").read_text().splitlines()[1:]
        return {line.split(",")[1] + "@" + line.split(",")[2]: float(line.split(",")[4]) for line in lines}

    def test_a_mix_sums_the_damage_of_its_passages(self):
        (self.folder / "mix.csv").write_text("name, count, speed\ncoaches, 40, 200 km/h\nwagon, 10, 90 km/h\n")
        done = self.traffic("--mix", "mix.csv", "--fleet", "fleet.csv")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("2 different passages, 50 a day", done.stdout)
        once = self.damages()
        (self.folder / "mix.csv").write_text("name, count, speed\ncoaches, 20, 200 km/h\ncoaches, 60, 200 km/h\n"
                                             "wagon, 10, 90 km/h\n")
        self.assertEqual(self.traffic("--mix", "mix.csv", "--fleet", "fleet.csv").returncode, 0)
        twice = self.damages()
        for name, factor in zip(sorted(once), (2.0, 1.0)):
            self.assertAlmostEqual(twice[name] / once[name], factor, places=12)

    def test_a_weighed_record_equals_the_mix_of_the_same_axles(self):
        (self.folder / "mix.csv").write_text("name, count, speed\nwagon, 0.5, 25\n")
        self.assertEqual(self.traffic("--mix", "mix.csv", "--fleet", "fleet.csv").returncode, 0)
        (of_mix,) = self.damages().values()
        (self.folder / "record.csv").write_text("time; speed; loads_t; spacings\n2024-05-31T14:02:10; 90 km/h; "
                                                "22 22 22 22; 1.8 7.0 1.8\n")
        self.assertEqual(self.traffic("--weighed", "record.csv", "--days", "2").returncode, 0)
        (of_record,) = self.damages().values()
        self.assertAlmostEqual(of_record / of_mix, 1.0, places=9)

    def test_numbers_in_other_units_are_noted(self):
        (self.folder / "mix.csv").write_text("name, count, speed\ncoaches, 40, 140\n")
        done = self.traffic("--mix", "mix.csv", "--fleet", "fleet.csv")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("unusual input\n  coaches: 140 m/s is 504 km/h", done.stdout)
        path = self.folder / "record.csv"
        for row, why in (("0, 80, 60 100, 3.5", "80 m/s is 288 km/h"), ("0, 25, 6 10, 3.5", "an axle of 10 kN"),
                         ("0, 25, 6000 10000, 3.5", "an axle of 1e\\+04 kN"), ("0, 25, 60 100, 3500", "3500 m between")):
            path.write_text(f"time, speed, loads_kN, spacings\n{row}\n")
            said = axle_tables.unusual(axle_tables.weighed(path), axle_tables.FAST_LORRY)
            self.assertEqual(len(said), 1)
            self.assertRegex(said[0], why)
        path.write_text("time, speed, loads_kN, spacings\n0, 25, 60 100, 3.5\n1, 25, 8 6, 2.5\n")
        self.assertEqual(axle_tables.unusual(axle_tables.weighed(path), axle_tables.FAST_LORRY), [])
        path.write_text("time; speed; loads_kN; spacings\n0; 25,5; 60 100; 3,5\n")
        with self.assertRaisesRegex(ValueError, "record.csv:2: commas and semicolons in one row"):
            axle_tables.weighed(path)

    def test_records_are_read_and_refused(self):
        path = self.folder / "record.csv"
        path.write_text("time, speed, loads_kN, spacings\n0, 25, 60 100, 3.5\n172800, 90 km/h, 40,\n")
        first, second = axle_tables.weighed(path)
        self.assertEqual((first.loads, first.distances, first.count), ((6e4, 1e5), (0.0, 3.5), 0.5))
        self.assertEqual((second.loads, second.distances, second.speed), ((4e4,), (0.0,), 25.0))
        for line, why in (("0, 25, 60 100, 3.5 2", "2 loads and 2 spacings"), ("x, 25, 60, ", "time 'x'"),
                          ("0, -3, 60, ", "'-3'"), ("0, 25, 60", "3 cells, expected 4")):
            path.write_text("time, speed, loads_kN, spacings\n" + line + "\n")
            with self.assertRaisesRegex(ValueError, f"record.csv:2: .*{why}"):
                axle_tables.weighed(path)


if __name__ == "__main__":
    unittest.main()
