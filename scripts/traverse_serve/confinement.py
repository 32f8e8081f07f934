"""Takes from this process, and from all that it starts, every file but those that a run needs: Landlock of the Linux
kernel, where it has it. A second wall: the texts of scenes are examined before (inputs.py)."""

import ctypes
import os
import pathlib
import struct
import sys

CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446  # system calls, alike on all processors
VERSION_OF_KERNEL, BENEATH, NO_NEW_PRIVILEGES = 1, 1, 38
EXECUTE, WRITE, READ, READ_FOLDER = 1 << 0, 1 << 1, 1 << 2, 1 << 3
OF_FILES = EXECUTE | WRITE | READ | 1 << 14
ALL = {1: (1 << 13) - 1, 2: (1 << 14) - 1, 3: (1 << 15) - 1}  # rights that a version of Landlock knows
# What programs, libraries, fonts and Open MPI read of a system, in addition to the files of /etc that everybody may read.
SYSTEM = ("/usr", "/lib", "/lib64", "/bin", "/opt", "/proc", "/sys", "/dev", "/etc/alternatives", "/etc/fonts", "/etc/openmpi",
          "/etc/pmix", "/etc/prte", "/etc/python3", f"/etc/python3.{sys.version_info.minor}")
DEVICES = ("/dev/null", "/dev/shm")


def call(library, number, *words):
    found = library.syscall(number, *words)
    if found < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    return found


def allow(library, rules, path, rights):
    """Allows these rights beneath a path; nothing if there is none."""
    try:
        place = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    try:
        given = struct.pack("=Qi", rights if os.path.isdir(path) else rights & OF_FILES, place)
        call(library, ADD_RULE, rules, BENEATH, given, 0)
    finally:
        os.close(place)


def settings():
    """The files of /etc itself that everybody may read."""
    with os.scandir("/etc") as entries:
        return [entry.path for entry in entries if entry.is_file() and entry.stat().st_mode & 0o004]


def confine(folder, readable):
    """Allows writing in the folder only, reading in it, in the named places and in the system. Returns whether the
    kernel does so."""
    library = ctypes.CDLL(None, use_errno=True)
    version = library.syscall(CREATE_RULESET, None, 0, VERSION_OF_KERNEL)
    if version < 1:
        return False
    rights = ALL[min(version, 3)]
    try:
        rules = call(library, CREATE_RULESET, struct.pack("=Q", rights), 8, 0)
        for path in (*SYSTEM, *settings(), *readable):
            allow(library, rules, path, EXECUTE | READ | READ_FOLDER)
        for path in (folder, *DEVICES):
            allow(library, rules, path, rights)
        library.prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0)
        call(library, RESTRICT_SELF, rules, 0)
        os.close(rules)
    except OSError:
        return False
    return True


def own_places(program):
    """What is of Traverse and of Python: to be read, outside of the system."""
    scripts = pathlib.Path(__file__).resolve().parents[1]
    places = (pathlib.Path(program).parent, scripts, scripts.parent / "options", scripts.parent / "CMakeLists.txt",  # the version
              sys.prefix, sys.base_prefix)
    return [str(place) for place in places]
