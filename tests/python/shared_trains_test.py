"""Trains on separate spans that ranks share give what one rank gives."""

import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from small_runs import BINARY, SOURCE  # noqa: E402

SCENE = f"""
beam: {{spans: 32.0*60, elements_per_span: 6, EI: 3.795e11, mass: 3.0e4, continuity: simply_supported, damping_ratios: 0.02}}
support: {{types: roller}}
vehicle: {{coach: {{file: {SOURCE}/options/vehicles/s300.yml}}}}
model: {{vehicles: linear}}
trains: [fast, slow, oncoming, last]
fast: {{vehicles: coach*3, positions: 400.0, spacing: 25.0, speed: 83.0}}
slow: {{vehicles: coach*2, positions: 640.0, spacing: 25.0, speed: 20.0}}
oncoming: {{vehicles: coach*2, positions: 1000.0, spacing: 25.0, speed: -60.0}}
last: {{vehicles: coach*1, positions: -60.0, speed: 70.0}}
step_kinks: false
ts: {{dt: 0.01, max_time: 6.0}}
output: {{interval: 0.1, probes: [464.0, 720.0, 784.0, 1488.0]}}
"""
EXACT = {"probes/deflection", "probes/moment", "energy/dissipated"}
# Of the work done.
OWN = {"wall_seconds", "solves", "factorisations"}
# Sums that cancel: compared with their terms.
REMAINDERS = {"energy/residual": "energy/dissipated", "balance/residual": "balance/inertia"}


def series(file):
    found = {}

    def take(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and item.size and not name.startswith(("input", "option")):
            found[name] = item[()]

    with h5py.File(file) as results:
        results.visititems(take)
        found.update({"summary/" + name: np.array(value) for name, value in results["summary"].attrs.items()
                      if name not in OWN and np.asarray(value).dtype.kind == "f"})
    return found


class SharedTrains(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        (self.folder / "line.yml").write_text(SCENE)

    def command(self, ranks, file, *options):
        ahead = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
        return [*ahead, str(BINARY), "-options_file", "line.yml", "-output_file", file, *options]

    def results(self, ranks, *options):
        file = f"{ranks}.h5"
        done = subprocess.run(self.command(ranks, file, *options), cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        if ranks > 1:
            self.assertIn(f"ranks: {ranks} share the 4 trains", done.stdout)
        return series(self.folder / file)

    def assert_same(self, one, other):
        """Accelerations of wheels come from differences of large forces."""
        self.assertEqual(one.keys(), other.keys())
        for name, values in one.items():
            tolerance = 1e-11 if name in EXACT else 1e-8 if name.endswith("normal_force") else 1e-6
            scale = np.nanmax(np.abs(one[REMAINDERS.get(name, name)]), initial=0.0)
            np.testing.assert_allclose(other[name], values, rtol=0.0, atol=tolerance * scale, err_msg=name)

    def test_same_on_any_number_of_ranks(self):
        """Trains overtake and meet each other, so that they change ranks."""
        one = self.results(1)
        for ranks in (2, 3, 6):
            with self.subTest(ranks=ranks):
                self.assert_same(one, self.results(ranks))

    def test_changing_speeds(self):
        """A train that brakes while another one starts from rest."""
        (self.folder / "brakes.csv").write_text("0, 83\n2, 83\n6, 75\n")
        (self.folder / "starts.csv").write_text("0, 0\n6, 6\n")
        scene = SCENE.replace("speed: 83.0", "speed_file: brakes.csv").replace("speed: 20.0", "speed_file: starts.csv")
        (self.folder / "line.yml").write_text(scene)
        self.assert_same(self.results(1), self.results(2))

    def test_goes_on(self):
        """The archive of one number of ranks on another one."""
        one = self.results(1)
        subprocess.run(self.command(2, "parts.h5", "-ts_max_steps", "333"), cwd=self.folder, capture_output=True, check=True)
        for ranks in (1, 3):
            with self.subTest(ranks=ranks):
                subprocess.run(self.command(ranks, f"on_{ranks}.h5", "-restart", "parts.h5.checkpoint"), cwd=self.folder,
                               capture_output=True, check=True)
                self.assert_same(one, series(self.folder / f"on_{ranks}.h5"))

    def test_no_step_is_repeated(self):
        """At a joint of spans the penetration has a kink: that the cubic over a step opens there is no loss of contact."""
        meeting = (SCENE.replace("[fast, slow, oncoming, last]", "[fast, oncoming]")
                   .replace("positions: 400.0, spacing: 25.0, speed: 83.0", "positions: 700.0, spacing: 25.0, speed: 97.0")
                   .replace("positions: 1000.0, spacing: 25.0, speed: -60.0", "positions: 1100.0, spacing: 25.0, speed: -97.0")
                   .replace("coach*3", "coach*8").replace("coach*2", "coach*8").replace("dt: 0.01", "dt: 0.02"))
        (self.folder / "line.yml").write_text("".join(
            line for line in meeting.splitlines(True) if not line.startswith(("slow:", "last:"))))
        subprocess.run(self.command(1, "meeting.h5"), cwd=self.folder, capture_output=True, check=True)
        with h5py.File(self.folder / "meeting.h5") as results:
            summary = results["summary"].attrs
            self.assertEqual(summary["contact_losses"], 0)
            self.assertLess(summary["solves"] / summary["steps"], 37)

    def test_ends_in_order(self):
        """After a signal to the ranks."""
        run = subprocess.Popen(self.command(2, "ended.h5", "-ts_dt", "1e-4"), cwd=self.folder, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
        while not (self.folder / "ended.h5").exists():
            self.assertIsNone(run.poll())
            time.sleep(0.05)
        run.send_signal(signal.SIGTERM)
        self.assertNotEqual(run.wait(), 0)
        self.assertIn("signal", self.ended(self.folder / "ended.h5"))

    def ended(self, path):
        """How a run has ended, once its processes have: mpirun of Open MPI 5 does not wait for them."""
        last = time.monotonic() + 300.0
        while True:
            try:
                with h5py.File(path) as results:
                    return str(results["summary"].attrs["ended"])
            except BlockingIOError:
                self.assertLess(time.monotonic(), last)
                time.sleep(0.05)


if __name__ == "__main__":
    unittest.main()
