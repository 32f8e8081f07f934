"""The vehicles, trains and loads of options/: the static loads of the program agree with the head of each file."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import h5py

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2])).resolve()
BINARY = os.environ.get("TRAVERSE_BINARY", str(SOURCE / "build/traverse"))
OPTIONS = SOURCE / "options"
sys.path.insert(0, str(SOURCE / "scripts"))

import axle_tables  # noqa: E402

GRAVITY = 9.81  # m/s2
TOLERANCE = 1e-3  # of each load: heads have whole newtons, and bodies turn a little on their springs
BRIDGE = ("-beam_spans", "40", "-beam_EI", "1e13", "-beam_mass", "1e4", "-scene_analysis", "static")


def files(folder):
    return sorted((OPTIONS / folder).glob("*.yml"))


def head(path):
    """{What, Source, Expected: text} of the first three lines."""
    lines = path.read_text(encoding="utf-8").splitlines()[:3]
    return dict(re.fullmatch(r"# (\w+): (.+)", line).groups() for line in lines)


def expected_loads(path):
    """The loads in N that the head states as `static wheel loads of A, B*3 N`; None if it states none."""
    found = re.search(r"static (?:wheel|axle) loads of ([\d.]+(?:\*\d+)?(?:, [\d.]+(?:\*\d+)?)*) N", head(path)["Expected"])
    if found is None:
        return None
    loads = []
    for part in found[1].split(", "):
        load, _, count = part.partition("*")
        loads += [float(load)] * int(count or 1)
    return loads


def text_of(path):
    """The file without comments."""
    return re.sub(r"#.*", "", path.read_text(encoding="utf-8"))


def repeated(path):
    """The repeated parts of a vehicle, and how often they are repeated."""
    found = re.search(r"^repeat: {parts: \[([^\]]*)\], count: (\d+)", text_of(path), re.MULTILINE)
    return (re.findall(r"\w+", found[1]), int(found[2])) if found else ([], 1)


def names(path, kind):
    found = re.search(rf"^{kind}:\s*\[([^\]]*)\]", text_of(path), re.MULTILINE)
    parts, count = repeated(path)
    return [f"{name}{number}" if name in parts else name for name in re.findall(r"\w+", found[1] if found else "")
            for number in range(count if name in parts else 1)]


def mass(path):
    parts, count = repeated(path)
    return sum(float(number) * (count if name in parts else 1)
               for name, number in re.findall(r"^(\w+):.*\bmass: ([\d.e+]+)", text_of(path), re.MULTILINE))


def static(*words):
    """The results of the static equilibrium with these options: {vehicle number: {wheel: N}} and the moving forces."""
    with tempfile.TemporaryDirectory() as folder:
        results = pathlib.Path(folder, "static.h5")
        run = subprocess.run([BINARY, *map(str, words), *BRIDGE, "-output_file", results, "-output_quiet"],
                             capture_output=True, text=True, cwd=folder)
        if run.returncode != 0:
            raise AssertionError(f"{' '.join(map(str, words))}\n{run.stdout}{run.stderr}")
        with h5py.File(results) as file:
            wheels = {int(number): {name: float(part["normal_force"][0]) for name, part in vehicle.items()
                                    if "normal_force" in part} for number, vehicle in file.get("vehicles", {}).items()}
            forces = file["model/forces/load"][()] if "model/forces/load" in file else []
    return wheels, [float(force) for _, force in forces]


def static_vehicle(path):
    """Wheel loads in the order of the file."""
    wheels, _ = static("-vehicle_alone_file", path, "-train_vehicles", "alone", "-train_speed", "10")
    return [wheels[0][name] for name in names(path, "wheels")]


def furthest(loads, expected):
    """The largest relative difference of two lists of loads."""
    if len(loads) != len(expected):
        raise AssertionError(f"{len(loads)} loads, {len(expected)} expected")
    return max((abs(a - b) / b for a, b in zip(loads, expected) if b > 0.0), default=0.0)


class Heads(unittest.TestCase):
    def test_every_file_says_what_it_is_its_source_and_what_to_expect(self):
        for folder in ("vehicles", "trains", "loads"):
            for path in files(folder):
                with self.subTest(path.name):
                    self.assertEqual(list(head(path)), ["What", "Source", "Expected"])


class Vehicles(unittest.TestCase):
    def test_static_loads(self):
        self.assertGreater(len(files("vehicles")), 12)
        for path in files("vehicles"):
            with self.subTest(path.name):
                wheels, expected = names(path, "wheels"), expected_loads(path)
                self.assertEqual(bool(wheels), expected is not None)
                if not wheels:
                    continue  # a mechanism
                if len(expected) == 1:  # on every axle
                    expected *= len(wheels)
                loads = static_vehicle(path)
                self.assertLess(furthest(loads, expected), TOLERANCE, f"{loads}, expected {expected}")
                self.assertLess(abs(sum(expected) / (GRAVITY * mass(path)) - 1.0), TOLERANCE)

    def test_a_wrong_mass_is_noticed(self):
        path = OPTIONS / "vehicles/velaro.yml"
        with tempfile.TemporaryDirectory() as folder:
            heavier = pathlib.Path(folder, path.name)
            text = path.read_text(encoding="utf-8")
            self.assertIn("mass: 47800.0", text)
            heavier.write_text(text.replace("mass: 47800.0", "mass: 48300.0"), encoding="utf-8")
            self.assertGreater(furthest(static_vehicle(heavier), expected_loads(path) * 4), TOLERANCE)


class Trains(unittest.TestCase):
    def test_eurostar(self):
        path = OPTIONS / "trains/eurostar.yml"
        wheels, _ = static("-options_file", path, "-train_speed", "80")
        expected = expected_loads(path)
        loads = [force for _, vehicle in sorted(wheels.items()) for _, force in sorted(vehicle.items())]
        self.assertLess(furthest(loads, expected), TOLERANCE, f"{loads}, expected {expected}")
        vehicles = ["vehicles/eurostar_power_car"] * 2 + ["trains/eurostar_head"] + ["trains/eurostar_coach"] * 7 + [
            "trains/eurostar_tail"]
        total = sum(mass(OPTIONS / f"{name}.yml") for name in vehicles)
        self.assertLess(abs(sum(expected) / (GRAVITY * total) - 1.0), TOLERANCE)


class Loads(unittest.TestCase):
    def test_static_loads(self):
        self.assertGreater(len(files("loads")), 12)
        for path in files("loads"):
            with self.subTest(path.name):
                _, loads = static("-options_file", path)
                expected = expected_loads(path)
                self.assertLess(furthest([load for load in loads if load > 0.0], [load for load in expected if load > 0.0]),
                                TOLERANCE, f"{loads}, expected {expected}")


class Formations(unittest.TestCase):
    def stated(self, path):
        """{name: (axles, N, m)} of the head of a table of formations."""
        found = re.findall(r"^# (.+?): .+, (\d+) axles, ([\d.]+) (kN|t), ([\d.]+) m from the first axle to the last$",
                           path.read_text(encoding="utf-8"), re.MULTILINE)
        return {name: (int(axles), float(weight) * axle_tables.LOADS[f"load_{unit}"], float(length))
                for name, axles, weight, unit, length in found}

    def test_heads_state_axles_weight_and_length_of_each(self):
        tables = sorted((OPTIONS / "loads").glob("*.csv"))
        self.assertGreater(len(tables), 2)
        for path in tables:
            stated, formations = self.stated(path), axle_tables.formations(path)
            self.assertEqual(list(stated), list(formations))
            for name, (loads, distances) in formations.items():
                with self.subTest(f"{path.name}, {name}"):
                    self.assertEqual(len(loads), stated[name][0])
                    self.assertAlmostEqual(sum(loads) / stated[name][1], 1.0, delta=1e-9)
                    self.assertAlmostEqual(distances[-1], stated[name][2], delta=1e-9)
                    self.assertEqual(list(distances), sorted(distances))

    def test_first_fatigue_train_has_the_total_and_the_length_of_a_second_source(self):
        """www.eurocode.us, ENV 1991-3 F.3: 6630 kN, 262.10 m, with 1.4 m before the first axle and 1.8 m behind the last."""
        loads, distances = axle_tables.formations(OPTIONS / "loads/en1991_fatigue_trains.csv")["Type 1"]
        self.assertAlmostEqual(sum(loads), 6630e3, delta=1.0)
        self.assertAlmostEqual(distances[-1] + 1.4 + 1.8, 262.10, delta=1e-6)

    def test_eurostar_has_the_axles_of_its_train(self):
        _, forces = static("-options_file", OPTIONS / "loads/eurostar_axles.yml")
        self.assertLess(furthest(forces, expected_loads(OPTIONS / "trains/eurostar.yml")), TOLERANCE)


class Help(unittest.TestCase):
    def test_lists_every_file_with_its_sentence(self):
        run = subprocess.run([BINARY, "-help", "vehicles"], capture_output=True, text=True, cwd=SOURCE)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        rows = dict(re.findall(r"^  (\S+\.yml) +(.+)$", run.stdout, re.MULTILINE))
        self.assertEqual(rows, {path.name: head(path)["What"] for folder in ("vehicles", "trains", "loads")
                                for path in files(folder)})


if __name__ == "__main__":
    unittest.main()
