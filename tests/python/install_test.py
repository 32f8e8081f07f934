"""cmake --install: programs of one's own over what is installed, examples/embed and examples/simulate, by CMake and by pkg-config, and in C;
the program and its scenes from another folder; the Python package; the Debian packages."""

import ast
import fnmatch
import math
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest

import h5py

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BUILD = pathlib.Path(os.environ.get("TRAVERSE_BINARY", SOURCE / "build/traverse")).parent


SCENE = ("beam: {spans: 25, EI: 2.8e9, mass: 2303, elements_per_span: 4}\nmodel: {axial: false}\n"
         "load: {forces: 1e5, speed: 20}\nts: {dt: 5e-3, max_time: 0.5}\n")


MPIRUN = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
          "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}


def succeed(*words, cwd=None, **environment):
    run = subprocess.run(words, capture_output=True, text=True, cwd=cwd, env=os.environ | environment)
    if run.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))}\n{run.stdout[-2000:]}{run.stderr[-2000:]}")
    return run.stdout


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.prefix = cls.folder / "prefix"
        succeed("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.scene = cls.folder / "scene.yml"
        cls.scene.write_text(SCENE, encoding="utf-8")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def runs_scenes(self, program, folder):
        folder.mkdir(exist_ok=True)
        succeed(program, self.scene, cwd=folder)
        largest = []
        for speed in (20, 30, 40):
            with h5py.File(folder / f"embed_{speed}.h5") as results:
                self.assertGreater(results["time"].shape[0], 10)
                largest.append(abs(results["probes/deflection"][()]).max())
        self.assertEqual(len(set(largest)), 3, largest)

    def test_a_program_by_cmake(self):
        build = self.folder / "build"
        succeed("cmake", "-G", "Ninja", "-S", SOURCE / "examples/embed", "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}")
        succeed("cmake", "--build", build)
        self.runs_scenes(build / "embed", self.folder / "by_cmake")
        said = succeed(self.prefix / "bin/traverse-report", self.folder / "by_cmake/embed_20.h5", "-o", self.folder / "installed")
        self.assertIn("installed.pdf", said)

    def test_problems_in_a_program(self):
        """examples/simulate: what each of them prints, against the program and what they are for."""
        build = self.folder / "build_simulate"
        succeed("cmake", "-G", "Ninja", "-S", SOURCE / "examples/simulate", "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}")
        succeed("cmake", "--build", build)

        def numbers(name, *before, **environment):
            said = succeed(*before, build / name, cwd=SOURCE, **environment)
            return [[float(number) for number in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", line)] for line in said.splitlines()]

        lines = numbers("bridge_and_train")
        self.assertEqual([line[0] for line in lines[:3]], [16.0, 52.0, 88.0])
        self.assertEqual(lines[3][0], max(line[1] for line in lines[:3]))
        file = self.folder / "three_spans.h5"
        succeed(self.prefix / "bin/traverse", "-beam_spans", "32,40,32", "-beam_EI", "5.9e10", "-beam_mass", "1.2e4",
                "-beam_damping_ratios", "0.01", "-vehicle_coach_file", "options/vehicles/velaro.yml", "-train_vehicles",
                "coach*8", "-train_speed", "300 km/h", "-accuracy", "1e-2", "-output_file", file, cwd=SOURCE)
        with h5py.File(file) as results:
            self.assertAlmostEqual(1e3 * abs(results["summary"].attrs["deflection"]) / lines[3][0], 1.0, delta=1e-2)
        gains, peaks, free = zip(*numbers("controller"))
        self.assertEqual(gains, (0.0, 50000.0, 200000.0))
        for falling in (peaks, free):
            self.assertEqual(list(falling), sorted(falling, reverse=True))
        self.assertLess(free[2], 0.5 * free[0])
        plain, tyre, profile, damper, force = numbers("own_laws")
        for line in (plain, tyre, profile, damper):
            self.assertLess(line[3], 1e-4)
        self.assertEqual(len({plain[2], tyre[2], profile[2], damper[2]}), 4)
        self.assertGreater(force[0], 1.0)
        alone = numbers("sweep")
        self.assertEqual(alone[0][0], 1000)
        first_frequency = math.pi / 2.0 / 25.0**2 * math.sqrt(2.0e10 / 1.0e4)  # Hz; axles are 18 m apart
        self.assertAlmostEqual(alone[0][3] / (18.0 * first_frequency), 1.0, delta=0.03)
        self.assertEqual(numbers("sweep", "mpirun", "-n", "2", **MPIRUN), alone)

    def test_a_program_by_pkg_config(self):
        path = next(self.prefix.glob("lib*/**/pkgconfig"))
        flags = succeed("pkg-config", "--cflags", "--libs", "traverse",
                        PKG_CONFIG_PATH=f"{path}:{os.environ.get('PKG_CONFIG_PATH', '')}")
        program = self.folder / "by_pkg_config_embed"
        succeed("c++", SOURCE / "examples/embed/embed.cpp", "-o", program, *shlex.split(flags))
        sweep = self.folder / "by_pkg_config_sweep"
        succeed("c++", "-std=c++20", SOURCE / "examples/simulate/sweep.cpp", "-o", sweep, *shlex.split(flags))
        self.assertIn("1000 runs", succeed(sweep))
        self.runs_scenes(program, self.folder / "by_pkg_config")

    def test_the_program_and_its_scenes(self):
        program = self.prefix / "bin/traverse"
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        for place in ("lib/python3/dist-packages/traverse", "share/traverse/python"):
            said = succeed("/usr/bin/python3", "-B", "-c", "import checked_results; print('traverse', checked_results.VERSION)",
                           PYTHONPATH=str(self.prefix / place))
            self.assertEqual(said.splitlines()[0], succeed(program, "-version").splitlines()[0])
        self.assertIn("fault.zip is written", succeed(program, "fault", self.scene, "--describe", cwd=elsewhere))
        said = succeed(program, "-options_file", "options/scenes/three_span_half_car.yml", "-describe", cwd=elsewhere)
        self.assertIn("three_span_half_car: no time steps are computed", said)
        (elsewhere / "options/scenes").mkdir(parents=True)
        shutil.copy(self.scene, elsewhere / "options/scenes/three_span_half_car.yml")  # the nearer one
        said = succeed(program, "-options_file", "options/scenes/three_span_half_car.yml", "-describe", cwd=elsewhere)
        self.assertIn("25 m, 1 span", said)

    def test_the_python_package(self):
        elsewhere = self.folder / "of_python"
        elsewhere.mkdir()
        code = ("import traverse\nresults = traverse.run('scene.yml')\n"
                "with traverse.Passage('scene.yml') as passage:\n    passage.advance(passage.end)\n"
                "    print(traverse.__file__, abs(passage.read('deflection') - results['deflection'].values[-1]).max())\n"
                "with traverse.Passage('options/scenes/three_span_half_car.yml') as installed:\n    print(installed.time)")
        shutil.copy(self.scene, elsewhere)
        without = {name: value for name, value in os.environ.items() if name != "TRAVERSE_BINARY"}
        place = self.prefix / "lib/python3/dist-packages"
        run = subprocess.run(["/usr/bin/python3", "-B", "-c", code], cwd=elsewhere, capture_output=True, text=True,
                             env=without | {"PYTHONPATH": str(place)})
        self.assertEqual(run.stdout, f"{place / 'traverse/__init__.py'} 0.0\n0.0\n")
        self.assertTrue(all(": UnusualInput: " in line for line in run.stderr.splitlines()), run.stderr)

    def test_scripts_find_what_they_import(self):
        installed = self.prefix / "share/traverse/python"
        own = {path.stem for path in (SOURCE / "scripts").iterdir()}
        scripts = [*installed.rglob("*.py"), *(self.prefix / "bin").glob("traverse-*")]
        self.assertGreater(len(scripts), 50)
        for script in scripts:
            for node in ast.walk(ast.parse(script.read_text(encoding="utf-8"))):
                named = [one.name for one in node.names] if isinstance(node, ast.Import) else \
                    [node.module] if isinstance(node, ast.ImportFrom) and node.level == 0 else []
                for name in own.intersection(one.partition(".")[0] for one in named):
                    self.assertTrue((installed / f"{name}.py").is_file() or (installed / name).is_dir(),
                                    f"{script.name} imports {name}, which scripts/install.cmake leaves out")

    def test_a_program_in_c(self):
        source = self.folder / "steps.c"
        source.write_text("""#include <stdio.h>
#include <traverse/traverse.h>
int main(void) {
  const char* words[] = {"-options_file", "scene.yml"};
  traverse_passage* passage = NULL;
  if (traverse_open(2, words, &passage) != 0) return puts(traverse_error()), 1;
  if (traverse_set_beam_force(passage, 30.0, 1.0) != 2) return 2;
  while (traverse_time(passage) < traverse_end(passage))
    if (traverse_advance(passage, traverse_time(passage) + traverse_interval(passage)) != 0) return 3;
  double energy = 0.0;
  if (traverse_read(passage, "/energy/kinetic", &energy, 1) != 0) return 4;
  printf("%s %d\\n", traverse_error(), energy > 0.0);
  traverse_results* results = NULL;
  double peaks[2][1], read = 0.0;
  if (traverse_finish(passage, &results) != 0 || traverse_results_read(results, "peak_deflection", &read, 1) != 0) return 5;
  traverse_results_free(results);
  traverse_close(passage);
  traverse_problem *one = NULL, *other = NULL;
  if (traverse_problem_read("scene.yml", &one) != 0 || traverse_problem_read("scene.yml", &other) != 0) return 6;
  if (traverse_problem_set(other, "beam_EI", "5.6e9") != 0) return 7;
  const traverse_problem* both[] = {one, other};
  if (traverse_simulate(2, both, 0, NULL, NULL, &results) != 0) return puts(traverse_error()), 8;
  if (traverse_results_read(results, "peak_deflection", &peaks[0][0], 2) != 0) return 9;
  if (traverse_results_text(results, "model", 2) != NULL) return 10;
  printf("%d %d\\n", peaks[0][0] > 0.999 * read && peaks[0][0] < 1.001 * read, peaks[1][0] < peaks[0][0]);
  traverse_results_free(results);
  traverse_problem_free(one);
  traverse_problem_free(other);
  return 0;
}
""", encoding="utf-8")
        library = next(self.prefix.glob("lib/**/libtraverse.so"))
        program = self.folder / "steps"
        succeed("cc", "-std=c99", "-pedantic", "-Wall", "-Werror", source, "-o", program, f"-I{self.prefix / 'include'}", library,
                f"-Wl,-rpath,{library.parent}")
        self.assertRegex(succeed(program, cwd=self.folder), r"30.* is not on the beam.* 1\n1 1\n")

    def test_words_about_options(self):
        page = (self.prefix / "share/man/man1/traverse.1").read_text(encoding="utf-8")
        self.assertIn(".B \\-beam_EI", page)
        completion = self.prefix / "share/bash-completion/completions/traverse"
        succeed("bash", "-n", completion)

    def test_packages_divide_what_is_installed(self):
        """Each file is in one package of packaging/debian or in none on purpose. Without scripts/site.sh there are no pages."""
        installed = {str(path.relative_to(self.prefix)) for path in self.prefix.rglob("*") if path.is_file()}
        libraries = str(next(self.prefix.glob("lib/**/libtraverse.so")).parent.relative_to(self.prefix))
        lists = list((SOURCE / "packaging/debian").glob("*.install")) + [SOURCE / "packaging/debian/not-installed"]
        held = []
        for path in lists:
            for line in path.read_text(encoding="utf-8").replace("${env:LIBDIR}", libraries).splitlines():
                pattern = line.removeprefix("usr/")
                found = [name for name in installed if fnmatch.fnmatch(name, pattern) or name.startswith(f"{pattern}/")]
                self.assertTrue(found or re.search("html$|traverse-documents", line), f"{path.name}: nothing is {line}")
                held += found
        self.assertEqual(sorted(held), sorted(installed))


if __name__ == "__main__":
    unittest.main()
