"""The command traverse serve: the folder, the server, and its end."""

import argparse
import fcntl
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import webbrowser

from traverse_check import runs
from traverse_check.rules import CheckError, printable

from .server import Server
from .site import Site

LOCK = ".traverse_serve.lock"


def port(text):
    if not 0 <= int(text) <= 65535:
        raise ValueError
    return int(text)


def arguments_of(given):
    parser = argparse.ArgumentParser(
        prog="traverse serve", description="A page on this machine: fill in a bridge and a train, compute, and look at the "
        "results. It ends with Ctrl+C.")
    parser.add_argument("--folder", default="results/serve", metavar="FOLDER",
                        help="the only folder that is read and written; default: results/serve")
    parser.add_argument("--port", type=port, default=0, help="up to 65535; default: a free one")
    parser.add_argument("--browser", action="store_true", help="opens the page in the browser")
    parser.add_argument("--program", metavar="FILE", help="the program traverse; default: the one beside this command")
    return parser.parse_args(given)


def prepared(folder):
    """(folder, a new one in it for temporary files): of this user alone, and of this server alone until it ends."""
    folder = pathlib.Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    except FileExistsError:
        raise CheckError(f"--folder {folder}: is a file; allowed: a folder of your own", 4) from None
    folder = folder.resolve()
    if folder.stat().st_mode & 0o022:
        raise CheckError(f"--folder {folder}: other users may write in it; allowed: a folder of your own", 4)
    lock = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)  # until this process ends
    except BlockingIOError:
        raise CheckError(f"--folder {folder}: another traverse serve uses it", 4) from None
    tempfile.tempdir = tempfile.mkdtemp(prefix=".traverse_serve_", dir=folder)
    return folder, pathlib.Path(tempfile.tempdir)


def open_browser(server, scratch):
    """Opens a file that leads to the page, so that no list of processes shows the token."""
    place = scratch / "start.html"
    place.write_text(f'<meta http-equiv="refresh" content="0; url={server.address}">\n')
    if not webbrowser.open(place.as_uri()):
        print("No browser was found: open the address above in one.", flush=True)


def run(words):
    given = arguments_of(words)
    program = runs.program(given.program)
    folder, scratch = prepared(given.folder)
    try:
        serve(Site(program, folder, scratch), given)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def serve(site, given):
    """Answers until a signal ends it."""
    try:
        server = Server(site, given.port)
    except OSError as error:
        raise CheckError(f"--port {given.port}: {error.strerror}", 4) from None
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: threading.Thread(target=server.shutdown).start())
    print(f"Open this address in a browser on this machine: {server.address}\nFiles: {site.folder}\nCtrl+C ends it.", flush=True)
    if given.browser:
        open_browser(server, site.queue.scratch)
    try:
        server.serve_forever(poll_interval=0.2)
    finally:
        server.server_close()
        site.queue.close()


def main():
    try:
        run(sys.argv[1:])
    except CheckError as error:
        print(f"traverse serve: {error}", file=sys.stderr)
        return error.status
    except subprocess.SubprocessError:
        print("traverse serve: the program traverse does not answer to -help", file=sys.stderr)
        return 4
    except OSError as error:
        print(f"traverse serve: {printable(error.filename or 'start')}: {printable(error.strerror or error)}", file=sys.stderr)
        return 4
    return 0
