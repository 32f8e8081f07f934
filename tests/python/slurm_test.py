"""The example job for Slurm, with stand-ins for srun, scancel, scontrol and the program: it goes back into the queue when its
time is nearly up, continues from the checkpoint, and ends with the status of the run. scripts/cluster_check.sh has Slurm."""

import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
JOB = SOURCE / "packaging/slurm/traverse.sbatch"
PROGRAM = """#!/usr/bin/env bash
echo "$@" >>words
[ -z "${RUNS_ON:-}" ] || { trap 'echo checkpoint >>words; exit 143' TERM; touch started; for _ in $(seq 600); do sleep 0.1; done; }
exit "${STATUS:-0}"
"""


class Job(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)
        for name, text in (("srun", '#!/usr/bin/env bash\n"$@" &\necho $! >task\nwait $!\n'), ("traverse", PROGRAM),
                           ("scancel", '#!/usr/bin/env bash\n[ "$*" = "--signal=TERM 7" ] && kill "$(<task)"\n'),
                           ("scontrol", '#!/usr/bin/env bash\necho scontrol "$@" >>words\n')):
            (self.folder / name).write_text(text, encoding="utf-8")
            (self.folder / name).chmod(0o755)

    def tearDown(self):
        self.scratch.cleanup()

    def start(self, **environment):
        return subprocess.Popen(["bash", JOB, "scenes/bridge.yml", "-train_speed", "40"], cwd=self.folder,
                                env=os.environ | {"PATH": f"{self.folder}:{os.environ['PATH']}", "SLURM_JOB_ID": "7"} | environment)

    def words(self):
        return (self.folder / "words").read_text(encoding="utf-8").splitlines()

    def test_a_run_that_ends_in_time(self):
        self.assertEqual(self.start().wait(), 0)
        self.assertEqual(self.words(), ["-options_file scenes/bridge.yml -output_file results/bridge.h5 -checkpoint_interval 600 "
                                        "-train_speed 40"])

    def test_a_run_that_fails_stays_out_of_the_queue(self):
        self.assertEqual(self.start(STATUS="3").wait(), 3)
        self.assertEqual(len(self.words()), 1)

    def test_a_job_whose_time_is_up_goes_on_later(self):
        job = self.start(RUNS_ON="1")
        while not (self.folder / "started").exists():
            time.sleep(0.01)
        job.send_signal(signal.SIGUSR1)
        self.assertEqual(job.wait(), 143)
        self.assertEqual(self.words()[1:], ["checkpoint", "scontrol requeue 7"])
        (self.folder / "results").mkdir()
        (self.folder / "results/bridge.h5.checkpoint").touch()
        self.assertEqual(self.start(SLURM_RESTART_COUNT="1").wait(), 0)
        self.assertEqual(self.words()[-1], self.words()[0] + " -restart results/bridge.h5.checkpoint")


if __name__ == "__main__":
    unittest.main()
