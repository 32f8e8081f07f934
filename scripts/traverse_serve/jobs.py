"""The queue of runs: one at a time, a limited number waits; each is stopped on request and ends with the server."""

import collections
import contextlib
import os
import pathlib
import subprocess
import sys
import threading
import time
from typing import NamedTuple

from traverse_check.runs import PERCENT

MOST_WAITING, MOST_KEPT = 8, 200
LINES, LONGEST = 400, 2000  # of the output that are kept; characters of one
JUDGED = {0: "", 5: "exceeded", 6: "not evaluated"}  # exit statuses with results
KEEPER = pathlib.Path(__file__).with_name("keeper.py")
TAKEN_OVER = ("PATH", "HOME", "LANG", "LC_ALL", "LC_CTYPE", "OMP_NUM_THREADS", "LD_LIBRARY_PATH", "SOURCE_DATE_EPOCH")


class QueueFull(Exception):
    """So many runs wait already."""


class Step(NamedTuple):
    words: list  # of the command
    what: str    # English text: what it does
    judged: bool = False  # whether its exit status is a verdict


def environment(scratch):
    """Of the processes of a run: nothing of the user's own settings, temporary files in the folder of the server."""
    kept = {name: value for name, value in os.environ.items() if name in TAKEN_OVER or name.startswith(("OMPI_", "PRTE_"))}
    return kept | {"TMPDIR": str(scratch), "MPLCONFIGDIR": str(scratch), "PYTHONDONTWRITEBYTECODE": "1",
                   "PYTHONUNBUFFERED": "1"}


def kept_process(folder, allowed, program, scratch, words):
    """Starts a command under its keeper; closing its standard input ends it."""
    return subprocess.Popen([sys.executable, "-B", str(KEEPER), str(allowed), str(program), *map(str, words)], cwd=folder,
                            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment(scratch),
                            start_new_session=True)  # so that Ctrl+C in a terminal reaches the server only


class Job:
    """One run of a form, or the report of one. state: waiting, running, done, failed, stopped."""

    def __init__(self, form, values, folder, steps, files=(), of=None):
        self.form, self.values, self.folder, self.steps, self.files, self.of = form, values, folder, steps, files, of
        self.number, self.state, self.what, self.percent, self.verdict = 0, "waiting", "", None, ""
        self.lines = collections.deque(maxlen=LINES)
        self.added, self.started, self.ended, self.process = time.time(), None, None, None

    def line(self, text):
        """Takes a line of the output of its process."""
        text = "".join(sign if sign.isprintable() else " " for sign in text[:LONGEST]).rstrip()
        if found := PERCENT.match(text):
            self.percent = min(int(found[1]), 100)
        if text.strip():
            self.lines.append(text)

    def message(self):
        """The line that says why it failed."""
        return self.lines[-1].removeprefix("traverse: ") if self.lines else ""

    def seconds(self):
        return (self.ended or time.time()) - self.started if self.started else 0.0


class Queue:
    """program: traverse. folder: the only one that is written. scratch: one in it, for temporary files."""

    def __init__(self, program, folder, scratch):
        self.program, self.folder, self.scratch = program, folder, scratch
        self.jobs, self.count, self.closed = collections.OrderedDict(), 0, False
        self.changed = threading.Condition()
        self.worker = threading.Thread(target=self.work, daemon=True)
        self.worker.start()

    def next_number(self):
        """The number of the next run, whose folder does not exist yet; QueueFull if too many wait."""
        with self.changed:
            if sum(job.state == "waiting" for job in self.jobs.values()) >= MOST_WAITING:
                raise QueueFull
            self.count += 1
            while (self.folder / f"run_{self.count}").exists():
                self.count += 1
            return self.count

    def add(self, job, number=None):
        with self.changed:
            job.number = number or self.next_number()
            self.jobs[job.number] = job
            for old in [key for key, one in self.jobs.items() if one.ended][:max(len(self.jobs) - MOST_KEPT, 0)]:
                del self.jobs[old]
            self.changed.notify_all()
        return job

    def all(self):
        with self.changed:
            return list(self.jobs.values())

    def before(self, job):
        """How many runs are computed before this one."""
        return sum(one.state in ("waiting", "running") and one.number < job.number for one in self.all())

    def work(self):
        while True:
            with self.changed:
                self.changed.wait_for(lambda: self.closed or any(job.state == "waiting" for job in self.jobs.values()))
                if self.closed:
                    return
                job = next(job for job in self.jobs.values() if job.state == "waiting")
                job.state, job.started = "running", time.time()
            try:
                state = self.compute(job)
            except OSError as error:
                job.line(f"{error.filename or 'the run'}: {error.strerror}")
                state = "failed"
            with self.changed:
                job.ended = time.time()
                job.state = "stopped" if job.state == "stopping" else state
                self.changed.notify_all()

    def compute(self, job):
        """Runs the steps of a job; its state at the end."""
        for step in job.steps:
            with self.changed:
                if job.state != "running":
                    return "stopped"
                job.what, job.percent = step.what, None
                job.process = kept_process(job.folder, self.folder, self.program, self.scratch, step.words)
            with job.process:
                while line := job.process.stdout.readline(LONGEST):
                    job.line(line.decode("utf-8", "replace"))
                status = job.process.wait()
            if step.judged and status in JUDGED:
                job.verdict = JUDGED[status]
            elif status != 0:
                return "failed"
        return "done"

    def stop(self, job):
        """Ends a job: one that waits at once, one that runs as soon as its process has ended."""
        with self.changed:
            if job.state == "waiting":
                job.state, job.ended = "stopped", time.time()
            elif job.state == "running":
                job.state = "stopping"
                if job.process is not None:
                    with contextlib.suppress(OSError):
                        job.process.stdin.close()
            self.changed.notify_all()

    def close(self):
        """Ends everything."""
        with self.changed:
            self.closed = True
            self.changed.notify_all()
        for job in self.all():
            self.stop(job)
        self.worker.join(10.0)
