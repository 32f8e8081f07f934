"""xarray reads what the program writes, group by group and as a whole, with every kind of dataset in some scene."""

import subprocess
import sys
import tempfile
import unittest
import pathlib
import warnings

import h5py
import numpy as np
import xarray

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from module_scenes import SOURCE, traverse  # noqa: E402
from small_runs import BINARY  # noqa: E402

# Scenes that together have all groups of doc/results_file.md, with options that make them short.
SHORT = ["-accuracy", "0.1", "-ts_max_steps", "20", "-output_quiet"]
SCENES = {
    "scenes/three_span_train": SHORT, "scenes/articulated_train": SHORT, "scenes/ballasted_viaduct": SHORT,
    "scenes/transition_zone": SHORT, "scenes/train_with_sensors": ["-output_passages", "20", *SHORT],
    "scenes/prop_with_gap": [], "scenes/wheel_over_a_bump": [], "scenes/launcher": [],
    "scenes/shaken_bridge": SHORT, "scenes/slab_with_torsion": SHORT, "scenes/r9_andrews": SHORT,
    "scenes/rail_on_pads": SHORT, "scenes/tapered_jib": ["-scene_analysis", "modes"],
    "scenes/hslm_two_spans": [], "scenes/line_class_d2": [], "scenes/bridge_as_found": SHORT,
    "studies/en1991_bridge": ["-sweep_hslm_a", "1,2", "-sweep_speed", "60,70,5"],
    "studies/bearing_stiffness": [], "scenes/uic774_e13": ["-limits", SOURCE / "options/limits/uic774.yml"],
    "scenes/footbridge_walker": ["-study_vary_load_frequency", "1.9,2,2.1", "-study_vary_load_speed", "1.4,1.5",
                                 "-study_statistics_over", "load_frequency"],
}
WITHOUT_SCALES = ("model", "input")


def datasets(file):
    """{path: dataset}, with every link."""
    found = {}

    def take(group, folder):
        for name, item in group.items():
            if isinstance(item, h5py.Group):
                take(item, f"{folder}{name}/")
            else:
                found[f"{folder}{name}"] = item

    take(file, "")
    return found


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.files = {}
        for scene, words in SCENES.items():
            file = pathlib.Path(holder.name, scene.replace("/", "_") + ".h5")
            done = subprocess.run([BINARY, "-options_file", SOURCE / f"options/{scene}.yml", *words, "-output_file", file],
                                  capture_output=True, text=True, cwd=SOURCE)
            if not file.exists():
                raise AssertionError(f"{scene}: {done.stdout[-500:]}{done.stderr}")
            cls.files[scene] = file

    def test_every_dataset_has_dimensions_of_its_shape(self):
        for scene, path in self.files.items():
            with h5py.File(path) as file:
                for name, item in datasets(file).items():
                    if name.split("/")[0] in WITHOUT_SCALES or "CLASS" in item.attrs:
                        continue
                    with self.subTest(scene=scene, dataset=name):
                        self.assertTrue(item.attrs["units"] == item.attrs["unit"] and item.attrs["long_name"])
                        scales = [file[reference[0]] for reference in item.attrs["DIMENSION_LIST"]]
                        self.assertEqual([len(scale) for scale in scales], list(item.shape))

    def test_each_group_opens(self):
        for scene, path in self.files.items():
            with h5py.File(path) as file:
                groups = {name.rsplit("/", 1)[0] if "/" in name else "/" for name in datasets(file)}
            for group in groups:
                if group.split("/")[0] in WITHOUT_SCALES:
                    continue
                with self.subTest(scene=scene, group=group), warnings.catch_warnings():
                    warnings.simplefilter("error")
                    with xarray.open_dataset(path, group=group, engine="h5netcdf") as found, h5py.File(path) as file:
                        for name, variable in found.variables.items():
                            if variable.dtype.kind == "f":
                                np.testing.assert_array_equal(variable.values, file[group][name][()])
                        if "time" in found.dims:
                            self.assertIn("time", found.coords)

    def test_the_netcdf_library_reads_them_too(self):
        for scene in ("scenes/three_span_train", "studies/en1991_bridge", "studies/bearing_stiffness"):
            with h5py.File(self.files[scene]) as file:
                groups = [name for name in ("probes", "envelope", "sweep", "study", "verdicts") if name in file]
            for group in groups:
                with self.subTest(scene=scene, group=group), warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # of the library's own build
                    with xarray.open_dataset(self.files[scene], group=group, engine="netcdf4") as found, \
                            xarray.open_dataset(self.files[scene], group=group, engine="h5netcdf") as other:
                        xarray.testing.assert_equal(found.load(), other.load())

    def test_the_module_opens_all(self):
        for scene, path in self.files.items():
            with self.subTest(scene=scene):
                results = traverse.open(path)
                with h5py.File(path) as file:
                    if "probes/deflection" in file and "study" not in file:
                        np.testing.assert_array_equal(results["deflection"], file["probes/deflection"][:len(file["time"])])

    def test_verdicts_and_speeds_by_name(self):
        results = traverse.open(self.files["studies/en1991_bridge"])
        with h5py.File(self.files["studies/en1991_bridge"]) as file:
            found = results["verdicts_value"].sel(criterion="deck_acceleration").item()
            self.assertEqual(found, file["verdicts/value"][0])
            np.testing.assert_allclose(results["speed_kmh"], 3.6 * file["sweep/speed"][:])
            judged = results["judged"].sel(criterion="deck_acceleration", hslm_a=2, speed=65.0).item()
            self.assertEqual(judged, file["sweep/judged"][1, list(file["sweep/speed"]).index(65.0), 0])

    def test_without_xarray_the_module_says_what_to_install(self):
        code = "import sys; sys.modules['xarray'] = None; import traverse"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=SOURCE / "python")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("python3-xarray", done.stderr.splitlines()[-1])


if __name__ == "__main__":
    unittest.main()
