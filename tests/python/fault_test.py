"""traverse fault: a report that computes the same elsewhere, and that has nothing private in it."""

import os
import pathlib
import shlex
import socket
import subprocess
import sys
import tempfile
import unittest
import zipfile

import h5py

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from module_scenes import traverse  # noqa: E402
from small_runs import BINARY, SOURCE  # noqa: E402

USER, HIDDEN = "annabelle", "-----BEGIN PRIVATE KEY-----"
SCENE = """# by annabelle, annabelle@bureau.example, from /home/ben.miller/bridges and C:\\Users\\ben\\old files\\x.yml
beam: {spans: 20.0, EI: ../tables/stiffness.csv, mass: FOLDER/tables/mass.csv, elements_per_span: 4}
load: {forces: 1.0e5, speed: 30.0}
model: {axial: false}
ts: {dt: 5.0e-3}
output: {interval: 1.0e-2}
"""


class Fault(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.home = pathlib.Path(holder.name, "people", USER)
        self.project = self.home / "customers" / "secret bridge"
        for name in ("scenes", "tables"):
            (self.project / name).mkdir(parents=True)
        self.scene = self.project / "scenes" / "a.yml"
        self.scene.write_text(SCENE.replace("FOLDER", str(self.project)), encoding="utf-8")
        (self.project / "tables/stiffness.csv").write_text("0, 1.0e10\n20, 1.2e10\n", encoding="utf-8")
        (self.project / "tables/mass.csv").write_text("0, 2.0e4\n20, 2.0e4\n", encoding="utf-8")
        (self.home / ".ssh").mkdir()
        (self.home / ".ssh/key.pem").write_text(HIDDEN, encoding="utf-8")
        self.run_program(self.project, "-options_file", "scenes/a.yml", "-output_file", "a.h5")

    def run_program(self, folder, *words):
        subprocess.run([BINARY, *words], cwd=folder, check=True, capture_output=True)

    def fault(self, *words, status=0, folder=None):
        """What the command prints, or its one line of error."""
        own = {"HOME": str(self.home), "USER": USER, "LOGNAME": USER}
        ended = subprocess.run([SOURCE / "scripts/traverse-fault", "--program", BINARY, *words], cwd=folder or self.project,
                               env=os.environ | own, capture_output=True, text=True)
        self.assertEqual(ended.returncode, status, ended.stdout + ended.stderr)
        if status:
            self.assertEqual(len(ended.stderr.splitlines()), 1, ended.stderr)
        return ended.stderr if status else ended.stdout

    def parts(self, name="fault.zip"):
        """{name: content} of a report, after all of its bytes were searched for what is private."""
        path = self.project / name
        with zipfile.ZipFile(path) as archive:
            self.assertIsNone(archive.testzip())
            parts = {part: archive.read(part) for part in archive.namelist()}
            everything = [*parts.values(), archive.comment, *(part.encode() for part in parts)]
        private = [USER, "ben.miller", "Users", "bureau", "customers", "secret bridge", str(self.home.parents[1]), HIDDEN]
        private += [name for name in [socket.gethostname()] if len(name) > 5]
        for content in everything:
            for word in private:
                self.assertNotIn(word.lower().encode(), content.lower(), word)
        for part in parts:
            self.assertNotIn("..", part)
            self.assertFalse(part.startswith(("/", ".")))
        return parts

    def test_it_computes_the_same_elsewhere(self):
        said = self.fault(str(self.scene), "-load_speed", "40", "--about", "too large, says Annabelle")
        parts = self.parts()
        for name in parts:
            self.assertIn(name, said.split("fault.zip is written")[0])
        self.assertIn("too large, says USER", parts["README.txt"].decode())
        self.assertEqual(parts["versions.txt"].decode().splitlines()[0], f"traverse {traverse.__version__}")
        self.assertRegex(parts["versions.txt"].decode(), r"\nPETSc \d+\.\d+\.\d+\n(.*\n)*.*MPI.*\n(.*\n)*system .*Linux")
        self.assertIn("reached its end", parts["messages.txt"].decode())
        self.assertIn("load_speed = 40", parts["options.txt"].decode())
        with tempfile.TemporaryDirectory() as folder:
            with zipfile.ZipFile(self.project / "fault.zip") as archive:
                archive.extractall(folder)
            given = parts["command.txt"].decode().splitlines()[0]
            self.run_program(pathlib.Path(folder, "input"), "-options_file", *shlex.split(given)[2:], "-output_file", "again.h5")
            self.run_program(self.project, "-options_file", self.scene, "-load_speed", "40", "-output_file", "here.h5")
            there, here = (traverse.open(path) for path in (f"{folder}/input/again.h5", self.project / "here.h5"))
            copy = traverse.open(f"{folder}/results/repeated.h5")
            for name in ("deflection", "moment"):
                self.assertTrue((there[name] == here[name]).all())
                self.assertTrue((copy[name] == here[name]).all())
            self.assertEqual(copy["deflection"].dims, here["deflection"].dims)

    def test_results_files(self):
        self.fault("a.h5", "--most", "0.002", "--describe")
        parts = self.parts()
        self.assertIn("input/scenes/a.yml", parts)
        self.assertIn("input/tables/mass.csv", parts)
        self.assertLess(len(parts["results/a.h5"]), 200_000)
        (self.project / "copy.h5").write_bytes(parts["results/a.h5"])
        with h5py.File(self.project / "copy.h5") as copy, h5py.File(self.project / "a.h5") as file:
            rows = len(copy["time"])
            self.assertTrue(1 <= rows < len(file["time"]))
            self.assertTrue((copy["probes/moment"][()] == file["probes/moment"][:rows]).all())
            self.assertNotIn("input", copy)
        self.fault("a.h5", "--results", "none", "--describe", "--out", "none.zip")
        self.assertNotIn("results/a.h5", self.parts("none.zip"))

    def test_what_is_private_in_results(self):
        with h5py.File(self.project / "a.h5", "a") as file:
            file.attrs["note"] = f"{self.home}/x of ben.miller"
            file["more/annabelle"] = [1.0]
            file["more/texts"] = ["/mnt/customers/Annabelle/x.csv", "file:///home/ben.miller/y.csv", "m/s"]
            file["more/elsewhere"] = h5py.ExternalLink("b.h5", "/x")
        said = self.fault("a.h5", "--describe")
        self.assertIn("parts in other files", said)  # is not opened at all
        with h5py.File(self.project / "a.h5", "a") as file:
            del file["more/elsewhere"]
        self.fault("a.h5", "--describe")
        (self.project / "copy.h5").write_bytes(self.parts()["results/a.h5"])
        with h5py.File(self.project / "copy.h5") as copy:
            self.assertEqual(list(copy["more/texts"].asstr()), ["FOLDER/x.csv", "file://FOLDER/y.csv", "m/s"])
            self.assertEqual(copy["more/USER"][0], 1.0)

    def test_hostile_names_in_results(self):
        with h5py.File(self.project / "a.h5", "a") as file:
            texts = file["input/files"].asstr()[()].tolist()
            del file["input/files"]
            names = ("../" * 9 + "cron.d/x", "/etc/passwd", "a\\..\\..\\b.yml", ".hidden/../..//c\x01.yml", "", "-rf", "con/../.d.yml")
            file["input"].create_dataset("files", data=[*texts, *([name, HIDDEN] for name in names if name != "/etc/passwd"),
                                                        ["/etc/passwd", "as in the file"]], dtype=h5py.string_dtype())
        said = self.fault("a.h5", "--describe", "--results", "none")
        with zipfile.ZipFile(self.project / "fault.zip") as archive:
            for part in archive.namelist():
                self.assertRegex(part, r"^([\w@+ ][\w.@+ -]*/)*[\w@+ ][\w.@+ -]*$")
                self.assertNotIn(b"root:", archive.read(part))
            self.assertIn("input/a.yml", archive.namelist())
        self.assertIn("left out: /etc/passwd: is no ordinary file", said)

    def test_a_scene_that_is_refused(self):
        outside, huge = self.home / "other.csv", self.project / "tables/huge.csv"
        outside.write_text(HIDDEN, encoding="utf-8")
        with open(huge, "wb") as file:
            file.truncate(6_000_000)
        os.mkfifo(self.project / "tables/pipe.csv")
        (self.project / "tables/link.csv").symlink_to(self.home / ".ssh/key.pem")
        names = ("huge", "pipe", "link")
        text = self.scene.read_text() + "".join(f"# ../tables/{name}.csv\n" for name in names)
        hostile = self.project / "scenes" / "b $(touch x);'.yml"
        hostile.write_text(text + f"# {outside} ../../../.ssh/key.pem /etc/passwd\nbeam_span: 3\n", encoding="utf-8")
        said = self.fault(f"scenes/{hostile.name}")
        parts = self.parts()
        self.assertIn("unknown option beam_span", parts["messages.txt"].decode())
        self.assertEqual([name for name in parts if name.startswith("input/tables")],
                         ["input/tables/stiffness.csv", "input/tables/mass.csv"])
        self.assertEqual(sum(name.startswith("input/scenes/") for name in parts), 1)
        for name, why in (("huge", "too large"), ("pipe", "no ordinary file"), ("link", "no ordinary file")):
            self.assertRegex(said, rf"left out: .*{name}\.csv: is {why}")
        self.assertEqual(list(self.project.glob("**/x")), [])

    def test_a_scene_that_reads_elsewhere(self):
        """The program reads a table behind a link, and one of another folder of the home; neither is packed, also from results."""
        (self.home / "others").mkdir()
        (self.home / "others/private.csv").write_text("0, 1.5e10\n20, 1.5e10\n", encoding="utf-8")
        (self.project / "tables/link").symlink_to(self.home / "others")
        for name in ("../tables/link/private.csv", "../../../others/private.csv"):
            self.scene.write_text(SCENE.replace("FOLDER", str(self.project)).replace("../tables/stiffness.csv", name), encoding="utf-8")
            self.run_program(self.project, "-options_file", "scenes/a.yml", "-output_file", "a.h5")
            for words in (("scenes/a.yml",), ("a.h5", "--describe")):
                said = self.fault(*words)
                parts = self.parts()
                self.assertRegex(said, r"left out: .*private\.csv: is no ordinary file in the folders of the scene")
                self.assertIn("input/tables/mass.csv", parts)
                self.assertFalse([part for part, content in parts.items() if b"1.5e10" in content])
        self.fault("customers/secret bridge/scenes/a.yml", "--out", "home.zip", folder=self.home)
        with zipfile.ZipFile(self.home / "home.zip") as archive:
            self.assertEqual([part for part in archive.namelist() if b"1.5e10" in archive.read(part)], [])

    def test_files_of_others_stay(self):
        path = self.project / "fault.zip"
        self.fault("a.h5", "--describe", "--list")
        self.assertFalse(path.exists())
        self.fault("a.h5", "--describe")
        self.fault("a.h5", "--describe")  # its own is replaced
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("mine", "mine")
        before = path.read_bytes()
        self.assertIn("fault.zip is there already", self.fault("a.h5", status=4))
        self.assertEqual(path.read_bytes(), before)
        path.unlink()
        path.symlink_to("elsewhere.zip")
        self.assertIn("is a link", self.fault("a.h5", status=4))
        self.assertIn("allowed: .zip", self.fault("a.h5", "--out", "scenes/a.yml", status=4))
        self.assertIn("missing.yml: there is no such file", self.fault("missing.yml", "--out", "b.zip", status=4))
        self.assertIn("name a scene", self.fault(status=2))
        self.assertIn("--lists: there is no such option", self.fault("a.h5", "--lists", status=2))

    def test_a_damaged_file(self):
        content = (self.project / "a.h5").read_bytes()
        (self.project / "a.h5").write_bytes(content[:len(content) // 2])
        said = self.fault("a.h5")
        self.assertIn("left out: a.h5: is no results file that can be read", said)
        self.assertIn("with status 4", self.parts()["messages.txt"].decode())

    def test_a_run_without_end(self):
        self.fault("scenes/a.yml", "-ts_dt", "1e-7", "--seconds", "1")
        self.assertIn("because its time of 1 s was over", self.parts()["messages.txt"].decode())


if __name__ == "__main__":
    unittest.main()
