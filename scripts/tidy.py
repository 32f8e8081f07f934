"""Runs clang-tidy on the files changed last: tidy.py [--most N] [--since REVISION] [FILE ...]

Without files it checks uncommitted files, then those of the latest commits, at most N: a clean checkout has no other
base. With --since it checks all files changed since a revision. In place of a header it checks the source file of the
same name, which includes it. It prints the warnings and fails, or prints one line.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

VERSION = "14"  # the version of .clang-tidy; other versions have other checks
DATABASE = "build-checks"  # made by set_up_checks of scripts/setup.sh
FOLDERS = ("include/", "src/", "tests/", "benchmarks/")


def git(root, *words):
    """The output of git. The checkout may belong to another user, as in a container: it is only read."""
    return subprocess.run(["git", "-c", "safe.directory=*", "-C", str(root), *words], check=True, capture_output=True,
                          text=True).stdout


def source_of(root, name):
    """The file to check in place of a header: the source file of the same name, otherwise the header itself."""
    source = re.sub(r"\.hpp$", ".cpp", re.sub(r"^include/traverse/", "src/", name))
    return source if (root / source).is_file() else name


def changed(root, since=None):
    """Existing changed files without duplicates: uncommitted ones first, then those of the newest commits."""
    names = [line[3:].split(" -> ")[-1] for line in git(root, "status", "--porcelain", "-uall").splitlines()]
    revisions = [f"{since}..HEAD"] if since else ["--max-count=400"]
    names += git(root, "log", "--format=", "--name-only", "--no-renames", *revisions).splitlines()
    files = dict.fromkeys(source_of(root, name) for name in names
                          if name.startswith(FOLDERS) and name.endswith((".cpp", ".hpp")) and (root / name).is_file())
    return list(files)


def findings(root, name):
    """The warnings of clang-tidy for a file; empty if there are none."""
    run = subprocess.run(["clang-tidy", "--quiet", "--warnings-as-errors=*", "-p", DATABASE, name], cwd=root,
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return (run.stdout or run.stderr) if run.returncode != 0 else ""


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--most", type=int, metavar="N", help="check at most so many of the files changed last")
    arguments.add_argument("--since", metavar="REVISION", help="check what has changed since this revision")
    arguments.add_argument("files", nargs="*", metavar="FILE")
    chosen = arguments.parse_args()
    root = pathlib.Path(__file__).resolve().parent.parent
    version = shutil.which("clang-tidy") and subprocess.run(["clang-tidy", "--version"], capture_output=True,
                                                            text=True).stdout
    if not re.search(rf"version {VERSION}\.", version or ""):
        print(f"Names and habits of C++ are not checked: that needs clang-tidy {VERSION}.")
        return
    if not (root / DATABASE / "compile_commands.json").is_file():
        sys.exit(f"There is no {DATABASE}/compile_commands.json: run bash .ci/run, which makes it.")
    if not chosen.files and (not shutil.which("git") or not (root / ".git").exists()):
        print("Names and habits of C++ are not checked: that needs a checkout of git, or the names of files.")
        return
    files = chosen.files or changed(root, chosen.since)[:chosen.most]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [text for text in pool.map(lambda name: findings(root, name), files) if text]
    if found:
        sys.exit("\n".join(found))
    print(f"clang-tidy finds nothing in the {len(files)} files changed last." if not chosen.files else
          f"clang-tidy finds nothing in {len(files)} files.")


if __name__ == "__main__":
    main()
