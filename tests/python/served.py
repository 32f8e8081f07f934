"""What tests of scripts/traverse-serve share: a server of its own in a folder of its own, and requests to it."""

import http.client
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

from small_runs import BINARY, SOURCE

SERVE = SOURCE / "scripts/traverse-serve"
# A run that does not end by itself, and whose files are small.
ENDLESS = """
beam: {spans: 20.0, EI: 3.0e10, mass: 1.8e4, elements_per_span: 8}
load: {forces: 1.0e5, speed: 1.0e-3}
ts: {dt: 1.0e-3, max_time: 1.0e6}
output: {interval: 1.0e5}
"""


class Served(unittest.TestCase):
    """Starts one server for the tests of a class. before: words before its command."""
    before = ()

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        cls.addClassCleanup(holder.cleanup)
        cls.outside = pathlib.Path(holder.name)
        cls.folder = cls.outside / "served"
        cls.server = subprocess.Popen(
            [*cls.before, sys.executable, "-B", SERVE, "--folder", cls.folder, "--program", BINARY],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        cls.addClassCleanup(cls.end)
        line = cls.server.stdout.readline()
        if "http://" not in line:
            raise AssertionError(cls.server.stderr.read())
        cls.address = line.split()[-1]
        _, _, cls.host, cls.token, _ = cls.address.split("/")
        cls.port = int(cls.host.split(":")[1])

    @classmethod
    def end(cls):
        cls.server.terminate()
        cls.server.wait(300)
        cls.server.stdout.close()
        cls.server.stderr.close()

    def request(self, method, path, body=None, whole=False, **head):
        """(status, head, content) of a request; whole: the path is as given, without the token before it."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=300)
        try:
            connection.request(method, path if whole else f"/{self.token}/{path}", body,
                               {name.replace("_", "-"): value for name, value in head.items()})
            answer = connection.getresponse()
            return answer.status, dict(answer.getheaders()), answer.read()
        finally:
            connection.close()

    def post(self, path, data, **head):
        """(status, answer) of what a page of the server sends."""
        head = {"Origin": f"http://{self.host}", "Content_Type": "application/json"} | head
        status, _, content = self.request("POST", path, json.dumps(data), **head)
        try:
            return status, json.loads(content)
        except ValueError:
            return status, content.decode()

    def state(self, run):
        return json.loads(self.request("GET", f"en/run/{run}/state")[2])

    def until(self, what, seconds=300.0):
        """Waits until what() is true, which it must become."""
        end = time.monotonic() + seconds
        while not (found := what()):
            self.assertLess(time.monotonic(), end, "it takes too long")
            time.sleep(0.05)
        return found

    def ended(self, run, state="done"):
        self.until(lambda: self.state(run)["state"] in ("done", "failed", "stopped"))
        self.assertEqual(self.state(run)["state"], state, self.state(run))


def processes_in(folder):
    """The command lines of the programs that run in a folder."""
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if pathlib.Path(os.readlink(process / "cwd")).is_relative_to(folder):
                found.append((process / "cmdline").read_bytes())
        except OSError:
            continue
    return found
