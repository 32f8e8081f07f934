"""cmake --install, and a program of one's own built over what is installed: examples/embed."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import h5py

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BUILD = pathlib.Path(os.environ.get("TRAVERSE_BINARY", SOURCE / "build/traverse")).parent


def succeed(*words, cwd=None):
    run = subprocess.run(words, capture_output=True, text=True, cwd=cwd)
    if run.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))}\n{run.stdout[-2000:]}{run.stderr[-2000:]}")
    return run.stdout


class Install(unittest.TestCase):
    def test_a_program_over_what_is_installed(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            succeed("cmake", "--install", BUILD, "--prefix", folder / "prefix")
            succeed("cmake", "-G", "Ninja", "-S", SOURCE / "examples/embed", "-B", folder / "build",
                    f"-DCMAKE_PREFIX_PATH={folder / 'prefix'}")
            succeed("cmake", "--build", folder / "build")
            scene = folder / "scene.yml"
            scene.write_text("beam: {spans: 25, EI: 2.8e9, mass: 2303, elements_per_span: 4}\nmodel: {axial: false}\n"
                             "load: {forces: 1e5, speed: 20}\nts: {dt: 5e-3, max_time: 0.5}\n", encoding="utf-8")
            succeed(folder / "build/embed", scene, cwd=folder)
            largest = []
            for speed in (20, 30, 40):
                with h5py.File(folder / f"embed_{speed}.h5") as results:
                    self.assertGreater(results["time"].shape[0], 10)
                    largest.append(abs(results["probes/deflection"][()]).max())
            self.assertEqual(len(set(largest)), 3, largest)

            program = folder / "prefix/bin/traverse"
            self.assertIn("traverse", succeed(program, "-version"))
            said = succeed(folder / "prefix/bin/traverse-report", folder / "embed_20.h5", "-o", folder / "installed")
            self.assertIn("installed.pdf", said)


if __name__ == "__main__":
    unittest.main()
