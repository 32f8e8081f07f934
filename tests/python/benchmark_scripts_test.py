"""Every benchmark script that needs the program alone, at its smallest size: its tables, pictures and errors."""

import contextlib
import importlib
import io
import os
import pathlib
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from benchmark_scripts import BUILD, SOURCE, InAFolder, start  # noqa: E402

sys.path.insert(0, str(SOURCE / "benchmarks"))

# Those that need a benchmark program are tested by tests/benchmarks/programs_test.py.
WITH_PROGRAMS = {"step_parts": "step_parts_benchmark", "ranks": "step_parts_benchmark",
                 "scaling": "step_parts_benchmark"}
WITH_PACKAGES = {"solid_bridge", "peers_calculix", "peers_dolfinx"}  # of others; tested there, too
OF_OTHERS = {"peers_here"}  # runs no program of ours
# Imported by the others, or draws a table that is given.
PARTS = {"runs", "scene_texts", "work_precision_scenes", "beam_solver_picture", "mutated_files", "peers_rows", "peers_strip",
         "solid_beams", "solid_cases", "solid_ccx", "solid_mesh", "solid_section", "solid_train", "solid_traverse"}


class Scripts(InAFolder):
    def test_peers(self):
        with open(self.folder / "peers_here.csv", "w") as file:
            file.write("case,peer,seconds of the loop,seconds in all,instants\n"
                       '"R8, ballasted bridge",TTB-2D,12.5,20.25,3962\n')
        done = self.start_smallest("peers")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        text = done.stdout
        rows = self.table("peers.csv", ["case", "peer", "peer's seconds", "peer's error", "kind", "how", "unknowns",
                                        "steps", "seconds", "factor", "error", "processor seconds",
                                        "factor of the whole", "the peer's machine"])
        for row in rows:
            here = row["case"].startswith("R8")
            self.assertEqual(row["the peer's machine"], "this machine" if here else "another machine")
            if here:
                self.assertAlmostEqual(float(row["factor"]) * float(row["seconds"]), 12.5, places=9)
                self.assertAlmostEqual(float(row["factor of the whole"]) * float(row["processor seconds"]), 20.25)
            else:
                self.assertEqual(row["factor of the whole"], "")
        self.assertNotIn("none of the grid is right", text)
        self.assert_positive(rows, "unknowns", "steps", "seconds", "factor", "processor seconds")
        equal = [row for row in rows if row["kind"] == "equal error"]
        same = [row for row in rows if row["kind"] == "same size and steps"]
        self.assertEqual((len(same), len(equal)), (8, 5))
        for row in equal:
            self.assert_errors([row], "error", float(row["peer's error"]))
        self.assert_errors(same, "error", 5e-4)
        modal = [row for row in same if row["how"].endswith("modes")]
        # One step more ends where the wheel leaves the bridge.
        self.assertEqual({(int(row["unknowns"]), int(row["steps"])) for row in modal}, {(16 + 1, 1001)})
        sizes = {row["case"]: (int(row["unknowns"]), int(row["steps"])) for row in same if row not in modal}
        # The peers' own: VBI-2D with 60 elements, TTB-2D with 1,918 unknowns (a joint less), ROSE with 100 elements.
        self.assertEqual(sizes, {"R3, 60 elements": (2 * 61 + 1, 1001), "R8, ballasted bridge": (1920, 3961),
                                 "R7, 100 elements": (2 * 101 + 2, 2000)})
        self.assert_picture("peers.png")

    def test_peers_here(self):
        """An Octave that shows what it was asked for, and peers' folders with no more than the calls of their loops."""
        calls = {"VBI/A02_Calculations.m": "[Sol] = B49_Coup_solver(Calc,Veh,Beam);\n",
                 "TTB/B00_Calculations.m": "B67_PlotModel(x);\n[M] = B55_ModelBC(M,Beam,Track);\n"
                                           "[Sol] = B65_DynamicCalcCoupledFaster(Veh);\n"}
        for name, lines in calls.items():
            (self.folder / name).parent.mkdir()
            (self.folder / name).write_text(lines)
        octave = self.folder / "octave-cli"
        octave.write_text(f"#!/bin/sh\nfor file; do :; done\ncat \"$file\" >>{self.folder}/asked\n"
                          "echo our seconds 1.5 2.25 1001\n")
        octave.chmod(0o755)
        path = {"PATH": f"{self.folder}:{os.environ['PATH']}"}
        done = start("peers_here", self.folder / "VBI", self.folder / "TTB", self.folder, "1", more=path)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        rows = self.table("peers_here.csv", ["case", "peer", "seconds of the loop", "seconds in all", "instants"])
        self.assertEqual([list(row.values())[1:] for row in rows],
                         [["VBI-2D", "1.5", "2.25", "1001"]] * 2 + [["TTB-2D", "1.5", "2.25", "1001"]])
        asked = (self.folder / "asked").read_text()
        self.assertEqual(asked.count("our_loop = cputime();\n[Sol] = B49_Coup_solver(Calc,Veh,Beam);\nour_loop = cputime() -"), 2)
        self.assertIn("Track.Rail.BC.DOF_fixed = zeros(1, 0);\n[M] = B55_ModelBC", asked)
        self.assertNotIn("B67_Plot", asked)
        self.assertEqual(start("peers_here", self.folder, self.folder / "TTB").stderr,
                         f"peers_here.py: {self.folder} holds no A02_Calculations.m: it is not the peer's folder\n")

    def test_check_estimates(self):
        self.assertIn("of 1\n", self.run_smallest("check_estimates"))
        row, = self.table("check_estimates.csv", ["scene", "estimate, s", "taken, s"])
        self.assertEqual(row["scene"], "r3_sprung_mass")
        self.assert_positive([row], "estimate, s", "taken, s")

    def test_simulate(self):
        self.assertIn("quarter car", self.run_smallest("simulate"))
        rows = self.table("simulate.csv", ["case", "runs", "seconds by simulate", "seconds by study", "ratio", "difference"])
        self.assertEqual([(row["case"], row["runs"], float(row["difference"])) for row in rows],
                         [("force", "20", 0.0), ("quarter car", "20", 0.0)])
        self.assert_positive(rows, "seconds by simulate", "seconds by study", "ratio")

    def test_promises(self):
        text = self.run_smallest("promises")
        self.assertIn("kept in 2 of 2 runs", text)
        truck, undamped = self.table("promises.csv", [
            "scene", "accuracy", "worst", "of", "judged", "not promised", "in doubt", "small", "small but refused",
            "trials", "loop", "process", "chosen", "deflection", "acceleration", "moment", "wheel force", "low-passed"])
        self.assert_positive([truck, undamped], "trials", "loop", "process")
        self.assertEqual([truck["judged"], undamped["judged"]], ["4", "4"])
        for row, accelerations in ((truck, "acceleration"), (undamped, "low-passed")):
            for quantity in ("deflection", "moment", "wheel force", accelerations):
                self.assert_errors([row], quantity, 1e-2)

    def test_sweep_promises(self):
        text = self.run_smallest("sweep_promises")
        self.assertRegex(text, "([1-9][0-9]*) of \\1 peaks of single runs")
        row, = self.table("sweep_promises.csv", [
            "scene", "accuracy", "worst", "of", "speed", "judged", "broken", "not promised", "chosen"])
        self.assert_positive([row], "worst", "speed", "judged")
        self.assertEqual(row["broken"], "0")

    def test_fidelity(self):
        text = self.run_smallest("fidelity")
        self.assertIn("ms of the time loop a passage", text)
        rows = self.table("fidelity.csv", [
            "model", "track", "mass ratio", "speed", "peak deflection", "peak moment", "peak acceleration",
            "error of deflection", "error of moment", "error of acceleration", "steps", "seconds"])
        self.assertEqual(len(rows), 5 * 3 * 2)  # models, tracks, speeds
        self.assert_positive(rows, "peak deflection", "peak moment", "peak acceleration", "steps", "seconds")
        smooth = [row for row in rows if row["track"] == "smooth" and row["model"] != "coaches"]
        self.assert_errors(smooth, "error of deflection", 0.03)
        limits = self.table("fidelity_limits.csv", [
            "model", "track", "deflection and moment within 5 %", "deflection and moment within 10 %",
            "deflection and moment within 20 %", "acceleration within 10 %", "acceleration within 20 %",
            "at most too small by, mass ratio up to 0.2: deflection and moment", "acceleration"])
        self.assertEqual(len(limits), 3 * 3)
        self.assert_picture("fidelity.png")

    def test_work_precision(self):
        text = self.run_smallest("work_precision")
        self.assertRegex(text, r"error over the accuracy: median 0\.\d+ over 1, worst 0\.")
        rows = self.table("work_precision.csv", [
            "scene", "way", "elements", "step", "unknowns", "steps", "seconds", "process seconds",
            "error of deflection", "error of acceleration", "error of moment", "error of wheel force"])
        self.assertEqual(len({row["way"] for row in rows}), 9)
        self.assert_positive(rows, "elements", "step", "unknowns", "steps", "seconds", "process seconds")
        self.assert_errors(rows, "error of deflection", 0.2)
        best = [row for row in rows if row["way"] == "esdirk4" and row["elements"] == "8"]
        self.assert_errors([min(best, key=lambda row: float(row["step"]))], "error of deflection", 1e-3)
        row, = self.table("work_precision_accuracy.csv", [
            "scene", "accuracy", "elements", "step", "error over accuracy", "worst", "ms", "process ms", "cheapest",
            "its elements", "its step", "its ms", "its process ms", "ms over its", "process over its", "surely",
            "sure elements", "sure step", "sure ms", "ms over sure", "process over sure", "not promised", "unsettled"])
        self.assertLessEqual(float(row["error over accuracy"]), 1.0)
        self.assert_positive([row], "ms", "process ms", "its ms", "its process ms", "ms over its", "process over its",
                             "sure ms", "ms over sure", "process over sure")
        self.assert_picture("work_precision.png")

    def test_hslm_sweep(self):
        self.run_smallest("hslm_sweep")
        rows = self.table("hslm_sweep.csv", [
            "case", "ranks", "passages", "passages per second", "ms each", "CPU ms each",
            "deflection against the list", "acceleration against the list"])
        self.assert_positive(rows, "passages", "passages per second", "ms each", "CPU ms each")
        self.assertEqual([row["ranks"] for row in rows], ["1", "2"] * 4)
        self.assertEqual([row["passages"] for row in rows[::2]], ["1310", "140", "2", "2"])
        self.assert_errors(rows, "deflection against the list", 3e-4)
        self.assert_errors(rows, "acceleration against the list", 3e-2)  # the list has all stations, this run midspan
        self.assert_picture("hslm_sweep.png")

    def test_screen(self):
        self.run_smallest("screen")
        found = {row["quantity"]: float(row["value"]) for row in self.table("screen.csv", ["quantity", "value"])}
        self.assertEqual((found["exceedances missed"], found["verdicts different"], found["bounds below the value"]),
                         (0, 0, 0))
        self.assertGreater(found["pairs checked"], 0)
        self.assertAlmostEqual(found["decided by the bound"] + found["decided by passages"], 1.0)
        self.assertGreaterEqual(found["median of bound over value"], 1.0)

    def test_lanes(self):
        self.run_smallest("lanes")
        rows = self.table("lanes.csv", ["scene", "runs", "passages", "ms each", "error of deflection",
                                        "error of acceleration", "error of moment", "error of wheel force"])
        together = ["1 side by side", "4 side by side", "8 side by side", "8, two ranks"]
        self.assertEqual([row["runs"] for row in rows], together * 2 + (["one by one"] + together)
                         + ["one by one", "8 side by side", "8, two ranks"] + (["one by one"] + together))
        self.assertEqual([row["passages"] for row in rows], ["22"] * 8 + ["2"] * 13)
        self.assert_positive(rows, "ms each")
        self.assert_errors(rows, "error of deflection", 1e-3)
        self.assert_errors(rows[:8], "error of acceleration", 5e-3)
        self.assert_errors(rows, "error of moment", 1e-2)
        self.assert_errors(rows[8:], "error of wheel force", 5e-2)

    def test_fit_draws(self):
        self.assertIn("2 of 2 true values", self.run_smallest("fit_draws"))
        names = ["beam_EI", "beam_mass", "model_damping_ratios", "midspan_shift"]
        rows = self.table("fit_draws.csv", ["draw", "seconds", *(f"{name}{what}" for name in names
                                                                for what in ("", " estimate", " error"))])
        self.assert_positive(rows, "seconds")
        for row in rows:
            self.assert_errors([{"error": float(row[f"{name} estimate"]) / float(row[name]) - 1.0} for name in names[:2]],
                               "error", 0.03)

    def test_questions(self):
        self.run_smallest("questions")
        rows = self.table("questions.csv", ["question", "runs", "seconds", "answer", "uncertainty"])
        self.assertEqual([row["question"] for row in rows], ["least EI", "Sobol' indices"])
        self.assert_positive(rows, "seconds")
        self.assert_errors(rows[:1], "uncertainty", 1e-3)

    def test_gradient(self):
        self.run_smallest("gradient")
        rows = self.table("gradient.csv", ["scene", "passage", "in_lanes", "single", "passages", "passages_single",
                                           "largest_error"])
        self.assertEqual([row["scene"] for row in rows], ["quarter car"])
        self.assert_positive(rows, "passage", "in_lanes", "single", "passages", "passages_single")
        self.assert_errors(rows, "largest_error", 1e-2)
        names = ["beam_EI", "beam_damping_ratios", "foundation_vertical_k", "vehicle_car_box_mass"]
        lanes, single = self.table("gradient_fit.csv", ["lanes", "runs", "seconds", *names])
        for name in names:
            self.assertAlmostEqual(float(lanes[name]) / float(single[name]), 1.0, delta=1e-3)

    def test_long_bridge(self):
        self.run_smallest("long_bridge")
        rows = self.table("long_bridge.csv", ["bridge", "method", "times real time, 1 rank", "2 ranks",
                                              "peaks wrong by"])
        self.assertEqual(len(rows), 4 * 2)
        self.assert_positive(rows, "times real time, 1 rank", "2 ranks")
        self.assert_errors(rows, "peaks wrong by", 1e-2)
        self.assert_picture("long_bridge.png")

    def test_line(self):
        self.run_smallest("line")
        rows = self.table("line.csv", ["ranks", "seconds", "greatest MB of a rank", "trains", "s of a train and step"])
        self.assertEqual([row["ranks"] for row in rows], ["2", "1"])
        self.assert_positive(rows, "seconds", "greatest MB of a rank", "trains", "s of a train and step")

    def test_same_on_ranks(self):
        self.run_smallest("same_on_ranks")
        rows = self.table("same_on_ranks.csv", ["scene", "ranks", "deflections differ by", "all series differ by"])
        self.assertEqual([row["ranks"] for row in rows], ["2", "4", "8"] * 2)
        self.assert_errors(rows, "deflections differ by", 1e-11)
        self.assert_errors(rows, "all series differ by", 1e-6)

    def test_kills(self):
        self.run_smallest("kills")
        rows = self.table("kills.csv", ["vehicles", "kills", "restarts", "series"])
        self.assertEqual([row["kills"] for row in rows], ["2", "2"])
        self.assert_positive(rows, "series")

    def test_mutations(self):
        self.assertIn("24 of 24 mutants", self.run_smallest("mutations"))
        mutations = importlib.import_module("mutations")
        for status, said, no_number, is_wrong in ((0, b"", False, False), (1, b"traverse: x = 1: no\n", True, False),
                                                  (0, b"", True, True), (1, b"", False, True), (1, b"a\nb\n", False, True),
                                                  (-11, b"traverse: no\n", False, True)):
            run = mock.Mock(returncode=status, stderr=said)
            self.assertEqual(mutations.wrong(run, no_number) != "", is_wrong, (status, said))

    def test_beam_solver_picture(self):
        table = self.folder / "times.csv"
        lines = [f"{n},{name},{ns},1" for n in (20, 200, 2000) for name, ns in (("traverse", 1.4), ("moving it", 0.4))]
        table.write_text("unknowns,solver,ns_per_unknown,ratio\n" + "\n".join(lines) + "\n")
        done = start("beam_solver_picture", table)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assert_picture("times.png")


class ScalingModel(unittest.TestCase):
    def test_a_coach_never_takes_less_than_nothing(self):
        scaling = importlib.import_module("scaling")
        machine = [{}, {"message of 8 B": 1e-6, "bandwidth of 8 MB messages": 1e9, "memory of each rank": 1e10}]
        for laden, coach in ((5e-3, 5e-4), (0.9e-3, 0.0)):
            seconds = {"bare solve": 1e-5, "esdirk4 step without vehicles": 1e-3, "esdirk4 step": laden}
            parts = [{"bridge": "continuous", "unknowns": "10002", "coaches": "8", "part": part, "seconds": str(s)}
                     for part, s in seconds.items()]
            model = scaling.Model(parts, machine)
            self.assertAlmostEqual(model.coach, coach)
            for ranks in (1, 2, 1000):
                self.assertGreater(sum(model.step(10_000, "continuous", 8, ranks).values()), 0.0)


class Arguments(InAFolder):
    def test_every_script_has_its_test(self):
        scripts = {path.stem for path in (SOURCE / "benchmarks").glob("*.py")} - PARTS - set(WITH_PROGRAMS) - WITH_PACKAGES
        tested = {name.removeprefix("test_") for name in dir(Scripts) if name.startswith("test_")} - PARTS
        self.assertEqual(scripts, tested)

    def complaint(self, name, *words):
        """What the script ends with, within this process."""
        script = importlib.import_module(name)
        output = io.StringIO()
        with (mock.patch("sys.argv", [name + ".py", *map(str, words)]), contextlib.redirect_stdout(output),
              self.assertRaises(SystemExit) as ended):
            script.main()
        return ended.exception.code or output.getvalue()

    def test_programs_that_are_not_built_are_named(self):
        for name, program in WITH_PROGRAMS.items():
            path = self.folder / "benchmarks" / program
            self.assertEqual(self.complaint(name, self.folder, self.folder),
                             f"{name}.py: {path} is missing; build it with: cmake -B build -DTRAVERSE_BENCHMARKS=ON && "
                             "cmake --build build")
        self.assertEqual(self.complaint("peers", self.folder, self.folder),
                         f"peers.py: {self.folder}/traverse is missing; build it with: cmake -B build && "
                         "cmake --build build")

    def test_scripts_say_what_they_take(self):
        for path in (SOURCE / "benchmarks").glob("*.py"):
            if path.stem not in PARTS | OF_OTHERS:
                text = self.complaint(path.stem, "--help")
                for word in (path.name, "BUILD_FOLDER", "OUT_FOLDER", "--smallest"):
                    self.assertIn(word, text)

    def test_a_scene_that_is_not_there_is_refused(self):
        self.assertRegex(self.complaint("work_precision", BUILD, self.folder, "--quick", "r99"),
                         "^work_precision.py: r99: no such scene; allowed: r1_moving_force, ")


if __name__ == "__main__":
    unittest.main()
