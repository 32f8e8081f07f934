"""-help by groups, the manual page and bash's completion: each holds every option of the one table."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BINARY = os.environ.get("TRAVERSE_BINARY", str(SOURCE / "build/traverse"))


def asked(*words):
    run = subprocess.run([BINARY, "-help", *words], capture_output=True, text=True)
    if run.returncode != 0:
        raise AssertionError(run.stderr)
    return run.stdout


def refused(*words):
    run = subprocess.run([BINARY, *words, "-output_file", "none"], capture_output=True, text=True, cwd=SOURCE)
    return run.returncode, run.stderr.strip()


def options_in(text):
    return re.findall(r"^  -(\w+)", text, re.MULTILINE)


def completed(line):
    """What bash offers for the last word of a line."""
    words = line.split(" ")
    with tempfile.TemporaryDirectory() as folder:
        script = pathlib.Path(folder, "completion")
        script.write_text(asked("bash"), encoding="utf-8")
        (pathlib.Path(folder) / "scene.yml").touch()
        quoted = " ".join(f"'{word}'" for word in words)
        run = subprocess.run(["bash", "-euc", f"source {script}; COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; "
                              '_traverse || true; printf "%s\\n" "${COMPREPLY[@]}"'],
                             capture_output=True, text=True, cwd=folder)
    if run.returncode != 0 or run.stderr:
        raise AssertionError(run.stderr)
    return run.stdout.split()


class Verbs(unittest.TestCase):
    """traverse VERB SCENE.yml."""

    def test_describe_and_run(self):
        scene = "options/scenes/r3_sprung_mass.yml"
        words = [BINARY, "describe", scene, "-output_file", "none"]
        described = subprocess.run(words, capture_output=True, text=True, cwd=SOURCE, check=True).stdout
        self.assertIn("r3_sprung_mass: no time steps are computed", described)
        self.assertEqual(refused("run", scene, "-ts_max_steps", "2"), (0, ""))

    def test_what_a_scene_does_not_ask_for(self):
        status, said = refused("study", "options/scenes/r3_sprung_mass.yml")
        self.assertEqual(status, 2)
        self.assertIn("is not a study or a sweep (study_vary, find_option, sweep_speed) but one run; traverse run computes it", said)
        self.assertEqual(refused("run", "options/scenes/hslm_sweep.yml")[0], 2)
        self.assertEqual(refused("fit")[0], 2)
        self.assertIn("there is no such file", refused("run", "not_there.yml")[1])


class Help(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.all = asked()
        cls.options = options_in(cls.all)
        cls.groups = re.findall(r"\(-help (\w+)\)$", cls.all, re.MULTILINE)

    def test_every_option_stands_in_one_group(self):
        self.assertGreater(len(self.options), 200)
        self.assertEqual(sorted(self.options), sorted(o for group in self.groups for o in options_in(asked(group))))

    def test_groups_have_headings(self):
        for group in ("beam", "support", "foundation", "train", "load", "track", "output", "sweep", "study", "vehicle", "wheel"):
            self.assertIn(group, self.groups)
        self.assertTrue(asked("beam").startswith("Bridge (-help beam)\n"))
        self.assertNotIn("-train_speed", asked("beam"))

    def test_one_option(self):
        self.assertEqual(options_in(asked("beam_EI")), ["beam_EI"])
        self.assertEqual(options_in(asked("flat_length")), ["vehicle_NAME_PART_flat_length"])
        self.assertIn("-beam_EI", asked("-beam_EI".lstrip("-")))

    def test_integrators(self):
        self.assertIn("esdirk4", asked("integrators"))
        self.assertIn("esdirk4", asked())

    def test_nothing_of_that_name(self):
        run = subprocess.run([BINARY, "-help", "beem"], capture_output=True, text=True)
        self.assertNotEqual(run.returncode, 0)
        self.assertEqual(run.stdout, "")
        self.assertIn("beam", run.stderr)

    def test_the_manual_holds_every_option(self):
        page = asked("man")
        named = [line[3:].replace("\\-", "-") for line in page.split("\n") if line.startswith(".B \\-")]
        self.assertEqual(sorted("-" + o for o in self.options), sorted(named))
        self.assertIn("esdirk4", page)
        for tool in ("man", "groff"):
            if shutil.which(tool) is None:
                continue
            command = ["man", "--warnings", "-l", "-"] if tool == "man" else ["groff", "-man", "-Tascii", "-ww"]
            run = subprocess.run(command, input=page, capture_output=True, text=True)
            self.assertEqual((run.returncode, run.stderr), (0, ""))

    def test_completion_holds_every_option(self):
        offered = set(completed("traverse -"))
        fixed = {"-" + o for o in self.options if "NAME" not in o}
        self.assertEqual(fixed - offered, set())
        for before, ending in (("-vehicle_coach_", "vehicle_NAME_"), ("-vehicle_coach_front_wheel_", "vehicle_NAME_PART_"),
                               ("-train_hook_", "train_NAME_")):
            wanted = {o.replace(ending, before) for o in self.options if o.startswith(ending) and "NAME" not in o[len(ending):]
                      and not o[len(ending):].startswith("PART")}
            self.assertEqual(wanted - set(completed("traverse " + before)), set())

    def test_values_that_are_words(self):
        self.assertEqual(completed("traverse -support_types p"), ["pinned"])
        self.assertEqual(sorted(completed("traverse -beam_self_weight ")), ["false", "true"])
        self.assertIn("esdirk4", completed("traverse -ts_type "))
        self.assertEqual(completed("traverse -vehicle_coach_wheel_law h"), ["hertz"])
        self.assertEqual(completed("traverse -options_file sce"), ["scene.yml"])
        self.assertEqual(completed("traverse -options_file other"), [])
        self.assertNotIn("<(", asked("bash"))  # that takes /dev/fd, which a container may lack
        self.assertIn("beam", completed("traverse -help be"))
        self.assertIn("-vehicle_a_b_flat_length", completed("traverse -vehicle_a_b_flat_l"))


if __name__ == "__main__":
    unittest.main()
