"""The program run again for a while, in the working directory of the user but with its results in a folder of its own."""

import os
import pathlib
import signal
import subprocess
import time

MOST_TEXT = 100_000  # bytes of the beginning and of the end of the messages
PATIENCE = 10        # s from the request to end to the kill


def messages(path):
    """The text of a file, without the middle of a long one."""
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size
        begin = file.read(MOST_TEXT)
        rest = size - len(begin)
        file.seek(max(size - MOST_TEXT, len(begin)))
        end = file.read(MOST_TEXT)
    gap = f"\n[... {rest - len(end):,} bytes are left out ...]\n".encode() if rest > len(end) else b""
    return (begin + gap + end).decode("utf-8", errors="replace")


def end(process):
    """Ends a process and what it has started."""
    for number, patience in ((signal.SIGTERM, PATIENCE), (signal.SIGKILL, None)):
        os.killpg(process.pid, number)
        try:
            return process.wait(patience)
        except subprocess.TimeoutExpired:
            pass


def run(program, words, scratch, seconds, ranks=1):
    """(what was run, text of its messages and its end) of a run that writes repeated.h5 in the folder `scratch`."""
    command = [*(("mpirun", "-n", str(ranks)) if ranks > 1 else ()), program, *words,
               "-output_file", str(pathlib.Path(scratch, "repeated.h5")), "-checkpoint_file", "none"]
    printed, begin = pathlib.Path(scratch, "messages"), time.monotonic()
    with open(printed, "wb") as file:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT,
                                   start_new_session=True)
        try:
            status = process.wait(seconds)
            ended = f"by signal {-status}" if status < 0 else f"with status {status}"
        except subprocess.TimeoutExpired:
            end(process)
            ended = f"because its time of {seconds:g} s was over"
        except BaseException:
            end(process)
            raise
    return command, f"{messages(printed)}\n[It ended {ended} after {time.monotonic() - begin:.1f} s.]\n"
