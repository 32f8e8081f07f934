"""The command traverse serve: the folder, the server, and its end."""

import argparse
import fcntl
import os
import pathlib
import shutil
import signal
import sys
import tempfile
import threading
import webbrowser

from traverse_check import runs
from traverse_check.rules import CheckError, printable

from .server import Server
from .site import Site

START = "start.html"


def arguments_of(given):
    parser = argparse.ArgumentParser(
        prog="traverse serve", description="A page on this machine: fill in a bridge and a train, compute, and look at the "
        "results. It ends with Ctrl+C.")
    parser.add_argument("--folder", default="results/serve", metavar="FOLDER",
                        help="the only folder that is read and written; default: results/serve")
    parser.add_argument("--port", type=int, default=0, help="default: a free one")
    parser.add_argument("--browser", action="store_true", help="opens the page in the browser")
    parser.add_argument("--program", metavar="FILE", help="the program traverse; default: the one beside this command")
    return parser.parse_args(given)


def prepared(folder):
    """The folder, which nobody else may read, with an empty one for temporary files."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    folder = folder.resolve()
    os.chmod(folder, 0o700)
    scratch = folder / "scratch"
    lock = os.open(folder / "lock", os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)  # until this process ends
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise CheckError(f"--folder {folder}: another traverse serve uses it", 4) from None
    if scratch.is_symlink():
        raise CheckError(f"{scratch} is a link", 4)
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(exist_ok=True)
    tempfile.tempdir = str(scratch)
    return folder


def open_browser(server, folder):
    """Opens a file that leads to the page, so that no list of processes shows the token."""
    place = folder / START
    place.unlink(missing_ok=True)
    with os.fdopen(os.open(place, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
        file.write(f'<meta http-equiv="refresh" content="0; url={server.address}">\n')
    if not webbrowser.open(place.as_uri()):
        print("No browser was found: open the address above in one.", flush=True)


def run(words):
    given = arguments_of(words)
    program = runs.program(given.program)
    folder = prepared(given.folder)
    site = Site(program, folder)
    server = Server(site, given.port)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: threading.Thread(target=server.shutdown).start())
    print(f"Open this address in a browser on this machine: {server.address}\nFiles: {folder}\nCtrl+C ends it.", flush=True)
    if given.browser:
        open_browser(server, folder)
    try:
        server.serve_forever(poll_interval=0.2)
    finally:
        server.server_close()
        site.queue.close()
        (folder / START).unlink(missing_ok=True)
        shutil.rmtree(folder / "scratch", ignore_errors=True)


def main():
    try:
        run(sys.argv[1:])
    except CheckError as error:
        print(f"traverse serve: {error}", file=sys.stderr)
        return error.status
    except (OSError, OverflowError) as error:
        print(f"traverse serve: {printable(getattr(error, 'filename', None) or 'start')}: "
              f"{printable(getattr(error, 'strerror', None) or error)}", file=sys.stderr)
        return 4
    return 0
