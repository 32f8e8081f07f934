"""cmake --install: a program of one's own over what is installed, examples/embed, by CMake and by pkg-config, and one in C;
the program and its scenes from another folder; the Python package; the Debian packages."""

import ast
import os
import pathlib
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

    def test_a_contact_law_from_outside(self):
        build = self.folder / "build_law"
        succeed("cmake", "-G", "Ninja", "-S", SOURCE / "examples/contact_law", "-B", build,
                f"-DCMAKE_PREFIX_PATH={self.prefix}")
        succeed("cmake", "--build", build)
        scene = ("-options_file", SOURCE / "options/scenes/wheel_over_a_bump.yml", "-output_quiet")
        forces = {}
        for name, program in (("hertz", self.prefix / "bin/traverse"), ("tyre", build / "contact_law")):
            file = self.folder / f"{name}.h5"
            succeed(program, *scene, "-output_file", file)
            with h5py.File(file) as results:
                summary = results["summary"].attrs
                self.assertLess(summary["energy_residual"], 1e-5 * summary["energy_scale"])
                forces[name] = results["vehicles/0/wheel/normal_force"][()], results["vehicles/0/wheel/penetration"][()]
        normal, penetration = forces["tyre"]
        self.assertGreater(abs(normal - forces["hertz"][0]).max(), 1e4)
        touching = normal > 1.0
        law = 1.5e6 * penetration + 4.0e9 * penetration**3
        self.assertLess(abs(normal - law)[touching].max(), 1e-6 * normal.max())
        refused = subprocess.run([build / "contact_law", *scene, "-study_vary_train_speed", "20,30"],
                                 capture_output=True, text=True, cwd=self.folder)
        self.assertIn("without contact laws of the program", refused.stderr)

    def test_a_program_by_pkg_config(self):
        path = next(self.prefix.glob("lib*/**/pkgconfig"))
        flags = succeed("pkg-config", "--cflags", "--libs", "traverse",
                        PKG_CONFIG_PATH=f"{path}:{os.environ.get('PKG_CONFIG_PATH', '')}")
        program = self.folder / "by_pkg_config_embed"
        succeed("c++", SOURCE / "examples/embed/embed.cpp", "-o", program, *shlex.split(flags))
        self.runs_scenes(program, self.folder / "by_pkg_config")

    def test_the_program_and_its_scenes(self):
        program = self.prefix / "bin/traverse"
        self.assertIn("traverse", succeed(program, "-version"))
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        said = succeed(program, "-options_file", "options/scenes/three_span_half_car.yml", "-check", cwd=elsewhere)
        self.assertIn("three_span_half_car: no time steps are computed", said)
        (elsewhere / "options/scenes").mkdir(parents=True)
        shutil.copy(self.scene, elsewhere / "options/scenes/three_span_half_car.yml")  # the nearer one
        said = succeed(program, "-options_file", "options/scenes/three_span_half_car.yml", "-check", cwd=elsewhere)
        self.assertIn("25 m, 1 span", said)

    def test_the_python_package(self):
        elsewhere = self.folder / "of_python"
        elsewhere.mkdir()
        code = ("import traverse\nresults = traverse.run('scene.yml')\n"
                "with traverse.Passage('scene.yml') as passage:\n    passage.advance(passage.end)\n"
                "    print(traverse.__file__, abs(passage.read('deflection') - results['deflection'].values[-1]).max())")
        shutil.copy(self.scene, elsewhere)
        without = {name: value for name, value in os.environ.items() if name != "TRAVERSE_BINARY"}
        place = self.prefix / "lib/python3/dist-packages"
        run = subprocess.run(["/usr/bin/python3", "-B", "-c", code], cwd=elsewhere, capture_output=True, text=True,
                             env=without | {"PYTHONPATH": str(place)})
        self.assertEqual(run.stdout, f"{place / 'traverse/__init__.py'} 0.0\n")
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
  traverse_close(passage);
  return 0;
}
""", encoding="utf-8")
        library = next(self.prefix.glob("lib/**/libtraverse.so"))
        program = self.folder / "steps"
        succeed("cc", "-std=c99", "-pedantic", "-Wall", "-Werror", source, "-o", program, f"-I{self.prefix / 'include'}", library,
                f"-Wl,-rpath,{library.parent}")
        self.assertRegex(succeed(program, cwd=self.folder), r"30.* is not on the beam.* 1\n")

    def test_words_about_options(self):
        page = (self.prefix / "share/man/man1/traverse.1").read_text(encoding="utf-8")
        self.assertIn(".B \\-beam_EI", page)
        completion = self.prefix / "share/bash-completion/completions/traverse"
        succeed("bash", "-n", completion)

    @unittest.skipUnless(shutil.which("dpkg-shlibdeps") and shutil.which("file"), "dpkg-dev and file are not installed")
    def test_debian_packages(self):
        folder = self.folder / "packages"
        succeed("cpack", "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B", folder)
        program, library = next(folder.glob("traverse_*.deb")), next(folder.glob("libtraverse-dev_*.deb"))
        needed = succeed("dpkg-deb", "-f", program, "Depends")
        for name in ("libpetsc", "libslepc", "libhdf5-openmpi", "libopenmpi", "libyaml-cpp", "libfmt", "libc6"):
            self.assertIn(name, needed)
        self.assertIn("python3-xarray", succeed("dpkg-deb", "-f", program, "Recommends"))
        held = succeed("dpkg-deb", "-c", program)
        for name in ("usr/bin/traverse\n", "usr/bin/traverse-report\n", "usr/share/traverse/options/scenes/three_span_train.yml\n",
                     "usr/share/traverse/python/picture.py\n", "usr/share/doc/traverse/copyright\n",
                     "usr/share/man/man1/traverse.1\n", "/libtraverse.so\n",
                     "usr/lib/python3/dist-packages/traverse/passage.py\n"):
            self.assertIn(name, held)
        self.assertNotIn("usr/include", held)
        for name in ("usr/include/traverse/app/run.hpp\n", "usr/include/traverse/traverse.h\n", "/pkgconfig/traverse.pc\n", "/traverse-config.cmake\n"):
            self.assertIn(name, succeed("dpkg-deb", "-c", library))


if __name__ == "__main__":
    unittest.main()
