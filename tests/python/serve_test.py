"""scripts/traverse-serve without a browser: who may ask, what is refused, the queue, and the end of its runs."""

import ctypes
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from served import ENDLESS, SERVE, Served, processes_in  # noqa: E402
from small_runs import BINARY, CROSSING, SOURCE  # noqa: E402

sys.path.insert(0, str(SOURCE / "scripts"))
from traverse_check import main, question, scene, track_defects  # noqa: E402
from traverse_serve import fields, forms, inputs, jobs, options, scenes  # noqa: E402

HOSTILE = ("/etc/passwd", "[1, /etc/passwd]", '"\\x2fetc/passwd"', '"a,/etc/passwd"', "../secret.csv", "x/../../secret.csv",
           "~/secret.csv", "{file: /etc/passwd}", "..", "a\\\\b")
FORMS = ("check", "sweep", "find", "rough", "crane")


class Requests(Served):
    def test_only_with_the_token(self):
        good = self.token
        for path in ("/", "/en/", f"/{good[:-1]}/en/", f"/{good}x/en/", f"/{good.swapcase()}/en/", "/asset/serve.js",
                     f"http://{self.host}/{good}/en/", "*"):
            with self.subTest(path):
                status, _, content = self.request("GET", path, whole=True)
                self.assertEqual(status, 403)
                self.assertNotIn(good.encode(), content)
        self.assertEqual(self.request("GET", "en/")[0], 200)
        self.assertEqual(self.request("GET", "", Accept_Language="fr-CH, de;q=0.5")[1]["Location"], f"/{good}/fr/")

    def test_only_on_this_machine(self):
        with self.assertRaises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.2", self.port), 5)
        for host in ("evil.example", f"evil.example:{self.port}", "127.0.0.1", f"127.0.0.1:{self.port + 1}", ""):
            with self.subTest(host):
                self.assertEqual(self.request("GET", "en/", Host=host)[0], 421)
        self.assertEqual(self.request("GET", "en/", Host=f"localhost:{self.port}")[0], 200)

    def test_only_pages_of_the_server_may_send(self):
        before = self.request("GET", "en/runs")[2]
        for origin in ("http://evil.example", "null", f"http://{self.host}.evil.example", f"https://{self.host}", ""):
            with self.subTest(origin):
                self.assertEqual(self.post("en/sweep/run", {}, Origin=origin)[0], 403)
        for kind in ("text/plain", "application/x-www-form-urlencoded", ""):
            self.assertEqual(self.post("en/sweep/run", {}, Content_Type=kind)[0], 415)
        self.assertEqual(self.request("GET", "en/runs")[2], before)
        self.assertEqual(self.request("GET", "en/sweep/run")[0], 404)

    def test_sizes(self):
        head = {"Origin": f"http://{self.host}", "Content_Type": "application/json"}
        self.assertEqual(self.request("POST", "en/scene/draft", None, Content_Length="1000000000000", **head)[0], 413)
        for length in ({"Content_Length": "-1"}, {"Content_Length": "1e3"}, {"Transfer_Encoding": "chunked"}):
            self.assertEqual(self.request("POST", "en/scene/draft", None, **length, **head)[0], 411)
        for content in ("[]", "{", "[" * 100_000):
            self.assertEqual(self.request("POST", "en/scene/draft", content, **head)[0], 400)
        answer = self.post("en/sweep/draft", {"beam_EI": "1" * 1000})[1]
        self.assertIn("at most 200", answer["errors"]["beam_EI"])
        answer = self.post("en/scene/draft", {"text": "a: 1", "files": {f"{i}.csv": "1" for i in range(30)}})[1]
        self.assertIn("at most 20 files", answer["errors"]["files"])

    def test_no_file_elsewhere(self):
        status, answer = self.post("en/scene/run", {"text": CROSSING, "files": {}})
        self.assertEqual(status, 200)
        run = answer["run"]
        self.ended(run)
        secret = self.outside / "secret.csv"
        secret.write_text("secret")
        os.symlink(secret, self.folder / f"run_{run}/link.csv")
        for name in ("link.csv", "../../secret.csv", "..%2f..%2fsecret.csv", "%2e%2e/secret.csv", "/etc/passwd", "nothing.csv",
                     ".traverse_choices", "results.h5/", "..", ""):
            with self.subTest(name):
                status, _, content = self.request("GET", f"en/run/{run}/file/{name}")
                self.assertEqual(status, 404)
                self.assertNotIn(b"secret", content.replace(b"secret.csv", b""))
        for path in ("asset/../main.py", "asset/main.py", "asset/%2e%2e", "en/run/0", "en/run/9999", "en/example/..", "xx/"):
            self.assertEqual(self.request("GET", path)[0], 404)
        status, head, content = self.request("GET", f"en/run/{run}/file/results.html")
        self.assertEqual((status, head["Content-Security-Policy"].split(";")[0]), (200, "sandbox allow-scripts"))
        self.assertEqual(self.folder.stat().st_mode & 0o777, 0o700)

    def test_scenes_that_name_files_elsewhere(self):
        before = sorted(self.folder.iterdir())
        for value in HOSTILE:
            for text in (f"track_profile: {value}\n", f"{CROSSING}vehicle: {{a: {value}}}\n", f"? {value}\n: 1\n",
                         f"{CROSSING}output_file: {value}\n"):
                with self.subTest(text[-60:]):
                    status, answer = self.post("en/scene/run", {"text": text, "files": {}})
                    self.assertEqual(status, 422)
                    self.assertIn("allowed", answer["errors"]["text"])
                    with self.assertRaises(inputs.InputError):
                        inputs.checked({"scene.yml": "options_file: more.yml\n", "more.yml": text})
        for name in ("../x.csv", "x.csv/../../y.csv", "/x.csv", ".petscrc", "x.h5", "x.sh", "a b.csv"):
            status, answer = self.post("en/scene/run", {"text": CROSSING, "files": {name: "1"}})
            self.assertEqual((status, "files" in answer["errors"]), (422, True))
        classic = {"text": "options_file: x.txt", "files": {"x.txt": "-track_profile /etc/passwd"}}
        self.assertIn("table of numbers", self.post("en/scene/run", classic)[1]["errors"]["files"])
        self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_fields_are_no_way_around(self):
        for form, values in (("check", {"limits": "/etc/passwd"}), ("check", {"report-logo": "x.png"}),
                             ("sweep", {"output_file": "/var/x.h5"}), ("sweep", {"train_vehicles": "../x"})):
            status, answer = self.post(f"en/{form}/run", values)
            self.assertEqual(status, 422, answer)
        form = forms.forms()["check"].fields
        with self.assertRaises(inputs.InputError):
            fields.read(form, {"span": "--program"}, numbers=False)
        written = scenes.check_file(fields.read(form, {"report-project": '"}, limits: x'}, numbers=False), "en")
        self.assertIn('report-project: "\\"}, limits: x"\n', written)
        self.assertEqual(self.post("en/check/run", {"report-project": "a\nlimits: /etc/passwd"})[0], 422)

    def test_messages_are_beside_their_fields(self):
        for form, values, field in (("check", {"span": "28 x"}, "span"), ("check", {"span": ""}, "span"),
                                    ("check", {"mass": "14,25"}, "mass"), ("check", {"mass": "1", "mass:unit": "kg/m"}, "mass"),
                                    ("check", {"EI": "", "frequency": "4, x"}, "frequency"),
                                    ("sweep", {"beam_EI": "-1"}, "beam_EI"),
                                    ("sweep", {"sweep_speed.from": "400"}, "sweep_speed.from"),
                                    ("find", {"find_between.from": "600"}, "find_between.from"),
                                    ("sweep", {"sweep_speed.step": "0"}, "sweep_speed.step"),
                                    ("crane", {"train_speed_file.way": "1"}, "train_speed_file.way"),
                                    ("crane", {"train_speed_file.way": "17"}, "train_speed_file.way"),
                                    ("crane", {"train_positions": "0"}, "train_positions"),
                                    ("check", {"span": "5"}, "hslm-b"), ("check", {"frequency": "4"}, "EI"),
                                    ("rough", {"beam_mass": "x"}, "beam_mass"),
                                    ("rough", {"study_vary_track_seed": "1.5"}, "study_vary_track_seed"),
                                    ("rough", {"train_vehicles.count": "0"}, "train_vehicles.count"),
                                    ("scene", {"text": "beam_span: 3"}, "text")):
            with self.subTest(values):
                answer = self.post(f"en/{form}/draft", values)[1]
                self.assertEqual((list(answer["errors"]), answer["general"]), ([field], ""))

    def test_messages_have_the_unit_and_the_language_of_the_page(self):
        for language, form, values, message in (
                ("en", "sweep", {"beam_EI": "-9"}, "−9 GN m² is not possible here; allowed: above 0 GN m²"),
                ("de", "sweep", {"beam_mass": "-3", "beam_mass:unit": "kg/m"},
                 "−3 kg/m ist hier nicht möglich; erlaubt: über 0 kg/m"),
                ("fr", "sweep", {"sweep_speed.to": "900"},
                 "900 km/h n'est pas possible ici ; admis : plus de 0 km/h, au maximum 720 km/h"),
                ("de", "check", {"line-speed": "5000"}, "5000 km/h ist hier nicht möglich; erlaubt: von 3,6 km/h bis 720 km/h"),
                ("fr", "crane", {"beam_damping_ratios": "300"}, "300 % n'est pas possible ici ; admis : de 0 % à 99,9 %"),
                ("de", "find", {"find_between.from": "600"}, "erlaubt: unter dem größten EI der Suche")):
            with self.subTest(message):
                field = next(name for name in values if ":" not in name)
                self.assertEqual(self.post(f"{language}/{form}/draft", values)[1]["errors"], {field: message})
        unusual = self.post("de/sweep/draft", {"sweep_speed.to": "500"})[1]["unusual"]
        self.assertIn("500 km/h ist schneller als jeder Zug im Betrieb", unusual)

    def test_drafts_draw_and_warn(self):
        for form in FORMS:
            with self.subTest(form):
                answer = self.post(f"de/{form}/draft", {})[1]
                self.assertEqual((answer["errors"], answer["general"]), ({}, ""))
                self.assertGreater(answer["stage"]["high"], 20.0)
        facts = self.post("en/check/draft", {"line-speed": "150"})[1]["facts"]
        self.assertIn(["Need for a dynamic analysis", "no"], facts)
        facts = self.post("en/check/draft", {"line-speed": "150", "always": "true"})[1]["facts"]
        self.assertIn(["Need for a dynamic analysis", "no; the analysis runs because it was asked for: 144 to 180 km/h"], facts)
        facts = dict(self.post("en/check/draft", {"EI": "260; 300", "line-speed": "160"})[1]["facts"])
        self.assertEqual(facts["Need for a dynamic analysis"], "yes: 144 to 192 km/h")  # only of the greater EI
        self.assertEqual(facts["Bending stiffness EI"], "300000 MN m²")
        unusual = self.post("en/sweep/draft", {"beam_mass": "40", "beam_mass:unit": "kg/m"})[1]["unusual"]
        self.assertTrue(any("beam_mass" in line for line in unusual), unusual)


    def test_the_factor_for_track_defects_is_that_of_the_check(self):
        given = fields.read(forms.forms()["sweep"].fields, {"sweep_speed.to": "300"})
        asked = question.ask("--span 28 --EI 260GN.m2 --mass 19t/m --type prestressed --line-speed 250km/h".split())
        parts = main.parts_of(asked, scene.cases(asked, asked.EI)[0], BINARY)
        factor = track_defects.factor(parts, scene.speeds(asked)[1], False)
        self.assertAlmostEqual(scenes.factor_for_track(given, BINARY), factor, places=12)
        rows = yaml.safe_load(scenes.scene_files("sweep", given, "en", factor)["limits.yml"])
        self.assertEqual({row["quantity"]: row.get("factor") for row in rows},
                         dict.fromkeys(("deck_acceleration", "deflection_over_span", "end_rotation"), f"{factor:.6g}"))
        searched = fields.read(forms.forms()["find"].fields, {})
        self.assertGreater(scenes.factor_for_track(searched, BINARY), factor)
        facts = dict(self.post("en/sweep/draft", {})[1]["facts"])
        self.assertEqual(facts["1 + φ″, EN 1991-2 6.4.6.4⁰"], "1.112 at 300 km/h")
        self.assertNotIn("1 + φ″, EN 1991-2 6.4.6.4⁰", dict(self.post("en/rough/draft", {})[1]["facts"]))


class Runs(Served):
    def begin(self):
        return self.post("en/scene/run", {"text": ENDLESS, "files": {}})

    def test_one_queue_with_a_limit(self):
        started = []
        while (answer := self.begin())[0] == 200:
            started.append(answer[1]["run"])
            self.assertLess(len(started), 30)
            self.until(lambda: self.state(started[0])["state"] == "running")
        self.assertEqual((answer[0], len(started)), (429, jobs.MOST_WAITING + 1))
        self.assertIn("stop one", answer[1]["general"])
        self.assertEqual([self.state(run)["state"] for run in started], ["running"] + ["waiting"] * jobs.MOST_WAITING)
        self.until(lambda: processes_in(self.folder / f"run_{started[0]}"))
        for run in reversed(started):
            self.assertEqual(self.post(f"en/run/{run}/stop", {})[0], 200)
        for run in started:
            self.ended(run, "stopped")
        self.until(lambda: not processes_in(self.folder / f"run_{started[0]}"))
        self.assertEqual(self.request("GET", f"en/run/{started[0]}")[0], 200)

    def test_texts_stay_texts(self):
        text = f"# </textarea><script>alert(1)</script>{{{{data}}}}\n{ENDLESS}scene: {{name: '<b>x'}}\n"
        run = self.post("en/scene/run", {"text": text, "files": {}})[1]["run"]
        self.until(lambda: self.state(run)["state"] == "running")
        self.post(f"en/run/{run}/stop", {})
        self.ended(run, "stopped")
        for path in (f"en/scene?from={run}", f"en/run/{run}", "en/runs"):
            page = self.request("GET", path)[2].decode()
            self.assertNotIn("<script>alert", page)
            self.assertNotIn("<b>x", page)
        self.assertIn("&lt;/textarea&gt;&lt;script&gt;alert(1)&lt;/script&gt;{{data}}",
                      self.request("GET", f"en/scene?from={run}")[2].decode())

    def test_folders_of_others_are_refused(self):
        shared, file = self.outside / "shared", self.outside / "file"
        shared.mkdir()
        shared.chmod(0o777)
        file.write_text("")
        for folder, why in ((self.folder, "another traverse serve"), (shared, "other users"), (file, "is a file")):
            ended = subprocess.run([sys.executable, "-B", SERVE, "--folder", folder, "--program", BINARY], timeout=300,
                                   capture_output=True, text=True)
            self.assertEqual((ended.returncode, len(ended.stderr.splitlines())), (4, 1))
            self.assertIn(why, ended.stderr)


class Killed(Served):
    def test_runs_end_with_the_server(self):
        run = self.post("en/scene/run", {"text": ENDLESS, "files": {}})[1]["run"]
        self.until(lambda: any(b"scene.yml" in words for words in processes_in(self.folder / f"run_{run}")))
        self.server.send_signal(signal.SIGKILL)
        self.until(lambda: not processes_in(self.folder / f"run_{run}"))


class FullDisk(Served):
    before = ("prlimit", "--fsize=150000")

    def test_is_said_and_ends_nothing(self):
        run = self.post("en/sweep/run", {})[1]["run"]
        self.ended(run, "failed")
        self.assertRegex(self.state(run)["words"], "failed. .*results.h5")
        status, answer = self.post("en/scene/run", {"text": "# " + "x" * 200_000, "files": {}})
        self.assertEqual(status, 500)
        self.assertIn("File too large", answer)
        self.assertEqual(self.request("GET", "en/")[0], 200)


class Confined(unittest.TestCase):
    def test_a_run_sees_its_folder_only(self):
        if ctypes.CDLL(None).syscall(444, None, 0, 1) < 1:
            self.skipTest("this kernel has no Landlock")
        with tempfile.TemporaryDirectory() as place:
            inside, outside = pathlib.Path(place, "inside"), pathlib.Path(place, "outside")
            for folder in (inside, outside):
                folder.mkdir()
                (folder / "read.csv").write_text("1")
            keeper = SOURCE / "scripts/traverse_serve/keeper.py"
            for folder, may in ((inside, True), (outside, False)):
                for words in (["cat", folder / "read.csv"], ["touch", folder / "written.csv"], ["ls", folder]):
                    process = subprocess.Popen([sys.executable, "-B", keeper, inside, BINARY, *words], stdin=subprocess.PIPE,
                                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                    with process:
                        self.assertEqual(process.wait(300) == 0, may, words)
            self.assertEqual([(inside / "written.csv").exists(), (outside / "written.csv").exists()], [True, False])


class Tables(unittest.TestCase):
    def test_every_option_of_a_form_is_one_of_the_program(self):
        table = options.table(BINARY)
        own = {name for name in table if "NAME" not in name and "PART" not in name}
        for name in FORMS[1:]:
            for field in forms.forms()[name].fields:
                known = field.option in own or field.option.startswith(("study_vary_", "vehicle_trolley_"))
                self.assertTrue(known, field.name)
                unit = table[field.option].unit if field.option in own else ""
                if unit and field.units:
                    self.assertEqual(fields.factors()[unit.split(",")[-1].strip()] if unit in fields.factors() else 1.0, 1.0)

    def test_units(self):
        form = forms.forms()["sweep"].fields
        given = fields.read(form, {"beam_EI": "2.6e5", "beam_EI:unit": "MN m2", "beam_spans": "20; 25 30", "sweep_speed.to": "90",
                                   "sweep_speed.to:unit": "m/s"})
        self.assertEqual((given["beam_EI"], given["beam_spans"], given["sweep_speed.to"]), (2.6e11, [20.0, 25.0, 30.0], 90.0))
        self.assertAlmostEqual(given["sweep_speed.from"], 150.0 / 3.6, places=9)
        self.assertEqual(fields.read(forms.forms()["crane"].fields, {})["vehicle_trolley_load_mass"], 10000.0)
        self.assertEqual(fields.read(form, {"beam_EI": "1,5"})["beam_EI"], 1.5e9)
        for wrong in ("", "1 5", "1,5,5", "0x10", "1e999", "nan", "1_0", "١"):
            with self.assertRaises(inputs.InputError) as caught:
                fields.read(form, {"beam_EI": wrong})
            self.assertEqual(caught.exception.field, "beam_EI")

    def test_the_highest_speed_is_computed(self):
        form = forms.forms()["find"].fields
        for last, step, count in (("276", "10", 18), ("300", "5", 40), ("100", "5", 0)):
            given = fields.read(form, {"sweep_speed.from": "100", "sweep_speed.to": last, "sweep_speed.step": step})
            first, last, step = map(float, scenes.speeds(given)[0].partition("[")[2].strip("]").split(","))
            self.assertAlmostEqual((last - first) / step, count, places=9)

    def test_commas(self):
        form = forms.forms()["check"].fields
        for written, read in (("28.5", "28.5"), ("28, 35, 28", "28, 35, 28"), ("25,30,25", "25, 30, 25"), ("28;35", "28, 35"),
                              ("28,5; 35,5", "28.5, 35.5"), ("28,5 35,5 28", "28.5, 35.5, 28"), ("28.5 , 35", "28.5, 35")):
            self.assertEqual(fields.read(form, {"span": written}, numbers=False)["span"], f"{read} m")
        for wrong in ("28,5", "1.500,5", "28, 35,28", "28 m", "28,5, 35,5"):
            with self.subTest(wrong), self.assertRaises(inputs.InputError):
                fields.read(form, {"span": wrong}, numbers=False)

    def test_scenes_of_the_library_are_complete_in_one_folder(self):
        complete = 0
        for name in forms.examples():
            files = {}
            text = (inputs.OPTIONS / "scenes" / f"{name}.yml").read_text(encoding="utf-8")
            text = inputs.with_library(text, "scene.yml", files, inputs.OPTIONS / "scenes")
            try:
                inputs.checked({"scene.yml": text, **files})
                complete += 1
            except inputs.InputError:
                self.assertEqual(name, "screen_line")  # names a folder of many formations
        self.assertGreater(complete, 40)


if __name__ == "__main__":
    unittest.main()
