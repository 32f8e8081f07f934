"""Runs one command for the server: keeper.py FOLDER PROGRAM COMMAND...

The command and all that it starts are in a process group of their own, and see the files of FOLDER only. When the server
closes the standard input of this process, or has ended however that came, the group gets SIGTERM, and SIGKILL if it does
not end.
"""

import contextlib
import os
import pathlib
import select
import signal
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from traverse_serve import confinement  # noqa: E402

PATIENCE = 5.0  # s from SIGTERM to SIGKILL


def send(group, number):
    with contextlib.suppress(ProcessLookupError):
        os.killpg(group, number)


def main():
    folder, program, *command = sys.argv[1:]
    confinement.confine(folder, confinement.own_places(program))
    child = subprocess.Popen(command, stdin=subprocess.DEVNULL, process_group=0)
    ended = os.pidfd_open(child.pid)
    try:
        readable, _, _ = select.select([sys.stdin.buffer, ended], [], [])
        if ended not in readable:
            send(child.pid, signal.SIGTERM)
            select.select([ended], [], [], PATIENCE)
    finally:
        send(child.pid, signal.SIGKILL)  # what is left of the group
    status = child.wait()
    return 128 - status if status < 0 else status


if __name__ == "__main__":
    sys.exit(main())
