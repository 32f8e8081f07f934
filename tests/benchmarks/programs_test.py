"""Every benchmark program, and every script that needs one or a program of others, at its smallest size; built with
TRAVERSE_BENCHMARKS=ON.

CTest runs each case on its own: programs_test.py Programs.test_NAME (benchmarks/CMakeLists.txt).
"""

import importlib.util
import itertools
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest
from unittest import mock

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "python"))
sys.path.insert(0, str(SOURCE / "benchmarks"))
import peers_dolfinx  # noqa: E402
import runs  # noqa: E402
from benchmark_scripts import BUILD, InAFolder, start  # noqa: E402


class Programs(InAFolder):
    def run_program(self, name, *words, ranks=1):
        """What it prints; it ends without a complaint."""
        command = runs.on_ranks(ranks) + [runs.benchmark_program(BUILD, name), *map(str, words)]
        done = subprocess.run(command, capture_output=True, text=True, env=runs.environment())
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def measured(self, name, names, counters, ranks=1):
        """Runs those of a Google Benchmark program whose names fit, shortly; every figure is above 0."""
        file = self.folder / "measured.json"
        self.run_program(name, "--benchmark_min_time=0.01", f"--benchmark_filter={names}",
                         f"--benchmark_out={file}", "--benchmark_out_format=json", ranks=ranks)
        with open(file) as text:
            found = json.load(text)["benchmarks"]
        self.assertGreater(len(found), 0)
        for one in found:
            self.assertNotIn("error_occurred", one, one)
            for figure in ("real_time", "iterations", *counters):
                self.assertGreater(one[figure], 0.0, one)
        return {one["name"]: one for one in found}

    def test_beam_solver_benchmark(self):
        self.run_program("beam_solver_benchmark", self.folder / "times.csv", 20)
        rows = self.table("times.csv", ["unknowns", "solver", "ns_per_unknown", "ratio"])
        names = [row["solver"] for row in rows if row["solver"] != "MUMPS"]  # not every PETSc has MUMPS
        self.assertEqual(names, ["traverse", "kept whole", "PETSc sbaij", "PETSc aij", "LAPACK dpbtrs", "moving it"])
        self.assert_positive(rows, "ns_per_unknown", "ratio")

    def test_machine_benchmark(self):
        for ranks, count in ((1, 1), (2, 7)):
            self.run_program("machine_benchmark", self.folder / "machine.csv", 1, ranks=ranks)
            rows = self.table("machine.csv", ["what", "ranks", "value", "unit"])
            self.assertEqual(len(rows), count)
            self.assertEqual({row["ranks"] for row in rows}, {str(ranks)})
            self.assert_positive(rows, "value")

    def test_multibody_benchmark(self):
        found = self.measured("multibody_benchmark", ".", [])
        self.assertEqual(found["coach_evaluation"]["freedom"], 10)
        self.assertLess(abs(found["coach_evaluation"]["operations"] / 2425 - 1), 0.05)  # counted against the machine
        self.assertEqual(found["four_bar_evaluation"]["freedom"], 1)

    def test_newton_benchmark(self):
        self.measured("newton_benchmark", "train/1/20|quarter_car/20", ["newton", "stage"])

    def test_solve_benchmark(self):
        found = self.measured("solve_benchmark", "shift/100/", ["per_unknown"])
        self.assertEqual({name.split("/")[0] for name in found}, {"solve", "petsc_cholesky", "factor"})
        self.measured("solve_benchmark", "solve.*shift/1000000/1/2/2000", ["per_unknown"], ranks=2)

    def test_step_benchmark(self):
        found = self.measured("step_benchmark", "/1/1/", ["per_unknown", "unknowns"])
        self.assertEqual(len(found), 5)
        self.measured("step_benchmark", "whole_step/1/1/", ["per_step"], ranks=2)

    def test_step_parts_benchmark(self):
        for ranks in (1, 2):
            self.run_program("step_parts_benchmark", self.folder / "parts.csv", 100, 100, 1, ranks=ranks)
            rows = self.table("parts.csv", ["unknowns", "bridge", "ranks", "coaches", "part", "seconds", "per_unknown",
                                            "of_bare_solve"])
            self.assertEqual(len(rows), 3 * 9)  # bridges, parts
            self.assert_positive(rows, "seconds", "per_unknown", "of_bare_solve")

    def test_train_build_benchmark(self):
        found = self.measured("train_build_benchmark", "s300", [])
        self.assertEqual({one["freedom"] for one in found.values()}, {160})


class Scripts(InAFolder):
    def test_step_parts(self):
        text = self.run_smallest("step_parts")
        self.assertIn("stage over bare solve", text)
        rows = self.table("step_parts.csv", ["unknowns", "bridge", "ranks", "coaches", "part", "seconds", "per_unknown",
                                             "of_bare_solve"])
        self.assertEqual({row["bridge"] for row in rows}, {"continuous", "simply supported", "layered track"})
        self.assert_positive(rows, "seconds", "per_unknown", "of_bare_solve")
        self.assert_picture("step_parts.png")

    def test_ranks(self):
        self.run_smallest("ranks")
        rows = self.table("ranks.csv", ["part", "1 rank, s", "2 ranks, s", "faster by"])
        self.assertEqual(len(rows), 7)
        self.assert_positive(rows, "1 rank, s", "2 ranks, s", "faster by")
        self.assert_picture("ranks.png")

    def test_scaling(self):
        (self.folder / "step_parts.csv").write_text(
            "unknowns,bridge,ranks,coaches,part,seconds,per_unknown,of_bare_solve\n")
        done = self.start_smallest("scaling")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("no line of 10,000 unknowns; remove it", done.stderr)
        for file in self.folder.iterdir():
            file.unlink()
        done = self.start_smallest("scaling")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        rows = self.table("scaling.csv", ["case", "messages", "ranks", "step, s", "faster by", "efficiency", "beam, s",
                                          "separators, s", "vehicles, s", "messages, s"])
        self.assertEqual(len(rows), 3 * 2 * 11)  # cases, networks, numbers of ranks
        self.assert_positive(rows, "step, s", "faster by", "efficiency", "beam, s")
        for row in rows:
            parts = sum(float(row[part + ", s"]) for part in ("beam", "separators", "vehicles", "messages"))
            self.assertAlmostEqual(parts / float(row["step, s"]), 1.0, places=9)
            if row["ranks"] == "1":
                self.assertEqual(float(row["faster by"]), 1.0)
        self.assert_picture("scaling.png")

    @unittest.skipUnless(shutil.which("ccx"), "ccx is not installed (Debian's calculix-ccx)")
    def test_solid_bridge(self):
        self.run_smallest("solid_bridge")
        rows = self.table("solid_bridge.csv", ["case", "quantity", "unit", "fine mesh", "coarse mesh"])
        self.assertEqual({row["case"] for row in rows}, {
            "one span", "one span without Poisson's ratio", "53.2 m/s", "88.1 m/s", "two trains", "two spans", "skew slab",
            "girder"})
        by_beams = self.table("solid_bridge_beams.csv", ["case", "quantity", "unit", "body", "beam", "difference",
                                                        "with warping", "its difference"])
        first = [row for row in by_beams if row["quantity"].startswith("frequency") and row["quantity"].endswith(" 1")]
        self.assertEqual(len(first), 8)
        self.assert_errors(first, "its difference", 5e-3)  # of the coarse mesh, too
        columns = [f"{what} of {place}" for what in ("deflection", "acceleration")
                   for place in ("the left track", "the axis", "the right edge")]
        self.assertEqual(len(self.table("solid_bridge_trains.csv", ["passage", "t", *columns])), 90)

    @unittest.skipUnless(shutil.which("ccx"), "ccx is not installed (Debian's calculix-ccx)")
    def test_peers_calculix(self):
        self.run_smallest("peers_calculix")
        forces, mass, modes = self.of_peers("peers_calculix", {"deflection": 3, "frequency": 5})
        self.assertEqual((len(forces), len(mass), len(modes)), (2, 1, 5))
        self.assert_errors(forces + mass + modes, "difference", 2e-3)
        self.assert_errors(forces + mass, "over_time", 1e-2)

    @unittest.skipUnless(importlib.util.find_spec("dolfinx"), "dolfinx is not installed (Debian's python3-dolfinx)")
    def test_peers_dolfinx(self):
        self.run_smallest("peers_dolfinx")
        force, modes = self.of_peers("peers_dolfinx", {"deflection": 3, "frequency": 5})
        self.assertEqual((len(force), len(modes)), (3, 5))
        self.assert_errors(force, "difference", 2e-2)
        self.assert_errors(modes, "difference", 2e-5)
        self.assert_errors(force, "over_time", 3e-2)

    def of_peers(self, name, quantities):
        """The rows of a peers' table by scene; quantities: how many rows are of each."""
        rows = self.table(name + ".csv", ["scene", "quantity", "unit", "theirs", "ours", "their_seconds", "our_seconds",
                                          "over_time", "difference"])
        self.assert_positive(rows, "their_seconds", "our_seconds")
        for quantity, count in quantities.items():
            self.assertEqual(sum(quantity in row["quantity"] for row in rows), count)
        return [list(group) for _, group in itertools.groupby(rows, lambda row: row["scene"])]

    def test_programs_that_are_missing_are_named(self):
        for name in ("solid_bridge", "peers_calculix"):
            done = start(name, BUILD, self.folder, "--smallest", more={"PATH": str(self.folder)})  # where no ccx is
            self.assertEqual(done.stderr, f"{name}.py: ccx is missing; install it with: apt-get install calculix-ccx\n")
        with mock.patch("importlib.util.find_spec", return_value=None), self.assertRaises(SystemExit) as ended:
            peers_dolfinx.dolfinx_modules(self.folder)
        self.assertEqual(ended.exception.code,
                         "peers_dolfinx.py: dolfinx is missing; install it with: apt-get install python3-dolfinx")


if __name__ == "__main__":
    unittest.main()
