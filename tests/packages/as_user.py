"""What an ordinary user does on a machine that has the packages but no sources: /usr/bin/python3 -B as_user.py [TEST...]"""

import http.client
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

DOCUMENTS = pathlib.Path("/usr/share/doc/traverse")
SCENE = ("beam: {spans: 25, EI: 2.8e9, mass: 2303, elements_per_span: 4}\nmodel: {axial: false}\n"
         "load: {forces: 1e5, speed: 20}\nts: {dt: 5e-3, max_time: 0.5}\n")
CHECK = ("--span", "28 m", "--EI", "260 GN.m2", "--mass", "19 t/m", "--type", "prestressed", "--line-speed", "250 km/h")


class Installed(unittest.TestCase):
    """Each test in a folder of its own."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        (self.folder / "scene.yml").write_text(SCENE, encoding="utf-8")

    def succeed(self, *words):
        run = subprocess.run(words, capture_output=True, text=True, cwd=self.folder, stdin=subprocess.DEVNULL)
        self.assertEqual(run.returncode, 0, f"{' '.join(map(str, words))}\n{run.stdout[-2000:]}{run.stderr[-2000:]}")
        return run.stdout


class Program(Installed):
    def test_version_is_that_of_the_package(self):
        said = self.succeed("traverse", "-version").split()[1]
        self.assertTrue(self.succeed("dpkg-query", "-W", "-f", "${Version}", "traverse").startswith(f"{said}-"))

    def test_a_scene_of_the_library(self):
        said = self.succeed("traverse", "-options_file", "options/scenes/three_span_half_car.yml", "-ts_max_steps", "20")
        self.assertTrue((self.folder / "results/three_span_half_car.h5").is_file(), said)

    def test_two_ranks(self):
        import h5py
        found = []
        for name, before in (("one", ()), ("two", ("mpirun", "--oversubscribe", "-n", "2"))):
            self.succeed(*before, "traverse", "-options_file", "scene.yml", "-output_file", f"{name}.h5")
            with h5py.File(self.folder / f"{name}.h5") as results:
                found.append(results["probes/deflection"][()])
        self.assertGreater(abs(found[0]).max(), 0.0)
        self.assertLess(abs(found[1] - found[0]).max(), 1e-9 * abs(found[0]).max())

    def test_check_with_report(self):
        said = self.succeed("traverse", "check", *CHECK, "--folder", "checked")
        self.assertIn("HSLM", said)
        for ending, begin in ((".pdf", b"%PDF"), (".xlsx", b"PK"), (".html", b"<!")):
            found = list((self.folder / "checked").glob(f"*{ending}"))
            self.assertTrue(found, (ending, list((self.folder / "checked").iterdir())))
            self.assertEqual(found[0].read_bytes()[: len(begin)], begin)

    def test_report_and_pictures_of_a_run(self):
        self.succeed("traverse", "-options_file", "scene.yml", "-output_file", "run.h5")
        self.succeed("traverse-report", "run.h5", "-o", "run")
        self.assertTrue((self.folder / "run.pdf").is_file())
        self.succeed("/usr/bin/python3", "/usr/share/traverse/python/picture.py", "run.h5", "run.png")
        self.assertTrue((self.folder / "run.png").is_file())


class Words(Installed):
    def test_manual_page(self):
        self.assertIn("-beam_EI", re.sub(".\b", "", self.succeed("man", "traverse")))
        for name in ("traverse-check", "traverse-report", "traverse-serve"):
            self.assertIn("TRAVERSE", self.succeed("man", name))

    def test_completion(self):
        said = self.succeed("bash", "-c", """
            source /usr/share/bash-completion/bash_completion; _completion_loader traverse
            COMP_WORDS=(traverse -beam_mas) COMP_CWORD=1; _traverse; printf '%s\\n' "${COMPREPLY[@]}" """)
        self.assertIn("-beam_mass", said.split())

    def test_desktop_entries(self):
        entries = list(pathlib.Path("/usr/share/applications").glob("traverse*.desktop"))
        self.assertEqual(len(entries), 2)
        self.assertEqual(self.succeed("desktop-file-validate", *entries), "")
        for entry in entries:
            program = re.search("^Exec=(\\S+)", entry.read_text(encoding="utf-8"), re.MULTILINE)[1]
            self.assertTrue(shutil.which(program), program)

    def test_documents(self):
        for page in ("index.html", "doc/guide.html", "doc/theory.html", "_static/katex/katex.js"):
            self.assertTrue((DOCUMENTS / "html" / page).is_file(), page)


class Page(Installed):
    def test_a_check(self):
        server = subprocess.Popen(["traverse", "serve", "--folder", self.folder / "served"], stdout=subprocess.PIPE, text=True)
        try:
            address = server.stdout.readline().split()[-1]
            _, _, host, token, _ = address.split("/")

            def request(method, path, body=None):
                connection = http.client.HTTPConnection(host, timeout=300)
                connection.request(method, path, body, {"Origin": f"http://{host}", "Content-Type": "application/json"})
                answer = connection.getresponse()
                status, text = answer.status, answer.read()
                connection.close()
                return status, text

            self.assertEqual(request("GET", "/en/")[0], 403)
            status, page = request("GET", f"/{token}/en/check")
            self.assertEqual((status, b"<form" in page), (200, True))
            status, answer = request("POST", f"/{token}/en/check/run", "{}")
            self.assertEqual(status, 200, answer)
            run = f"/{token}/en/run/{json.loads(answer)['run']}"
            while (state := json.loads(request("GET", f"{run}/state")[1]))["state"] in ("waiting", "running"):
                time.sleep(0.2)
            self.assertEqual(state["state"], "done", state)
            self.assertEqual(request("GET", run)[0], 200)
        finally:
            server.send_signal(signal.SIGINT)
            self.assertEqual(server.wait(60), 0)
            server.stdout.close()
        self.assertTrue(list((self.folder / "served").glob("run_*/*.html")))


class Libraries(Installed):
    def test_the_python_module(self):
        said = self.succeed("/usr/bin/python3", "-W", "ignore", "-c", """
import traverse
results = traverse.run("scene.yml")
with traverse.Passage("scene.yml") as passage:
    passage.advance(passage.end)
    print(traverse.__file__, abs(passage.read("deflection") - results["deflection"].values[-1]).max())""")
        self.assertEqual(said, "/usr/lib/python3/dist-packages/traverse/__init__.py 0.0\n")

    def test_programs_by_cmake(self):
        self.succeed("cmake", "-S", DOCUMENTS / "examples/simulate", "-B", "build")
        self.succeed("cmake", "--build", "build", "--target", "bridge_and_train")
        self.assertEqual(len(self.succeed(self.folder / "build/bridge_and_train").splitlines()), 4)

    def test_programs_by_pkg_config(self):
        flags = self.succeed("pkg-config", "--cflags", "--libs", "traverse").split()
        self.succeed("c++", DOCUMENTS / "examples/embed/embed.cpp", "-o", "embed", *flags)
        self.succeed(self.folder / "embed", "scene.yml")
        self.assertEqual(len(list(self.folder.glob("embed_*.h5"))), 3)

    def test_a_program_in_c(self):
        (self.folder / "steps.c").write_text("""#include <stdio.h>
#include <traverse/traverse.h>
int main(void) {
  const char* words[] = {"-options_file", "scene.yml"};
  traverse_passage* passage = NULL;
  if (traverse_open(2, words, &passage) != 0) return puts(traverse_error()), 1;
  if (traverse_advance(passage, 0.5) != 0) return puts(traverse_error()), 2;
  printf("%.3f\\n", traverse_time(passage));
  traverse_close(passage);
  return 0;
}
""", encoding="utf-8")
        self.succeed("cc", "steps.c", "-o", "steps", "-ltraverse")
        self.assertEqual(self.succeed(self.folder / "steps"), "0.500\n")

    def test_an_example_in_python(self):
        self.succeed("/usr/bin/python3", DOCUMENTS / "examples/three_span_train.py", self.folder)
        self.assertTrue(list(self.folder.glob("python_*.png")))


if __name__ == "__main__":
    assert os.geteuid() != 0, "this is for an ordinary user"
    unittest.main(verbosity=2, failfast=True)
