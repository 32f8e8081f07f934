"""The versions of the program, its libraries and the system, and the processor, without a name of the machine."""

import importlib.metadata
import os
import pathlib
import platform
import re
import subprocess

import h5py
from checked_results import VERSION

SECONDS = 60  # for a program that only says what it is
MODULES = ("numpy", "matplotlib", "scipy", "xarray", "openpyxl")
EXTENSIONS = ("avx", "avx2", "fma", "avx512f", "avx512dq", "avx512vl", "avx512bw", "asimd", "sve")  # that kernels are compiled for


def said_by(program, *words):
    """What the program prints; a line on its end if it prints nothing."""
    try:
        ended = subprocess.run([program, *words], capture_output=True, text=True, errors="replace", timeout=SECONDS,
                               stdin=subprocess.DEVNULL)
    except (OSError, subprocess.SubprocessError) as error:
        return f"the program does not start: {type(error).__name__}\n"
    return ended.stdout or f"the program ends with status {ended.returncode}: {ended.stderr.strip()}\n"


def vocabulary(program):
    """The words that Traverse uses in its options and their texts."""
    return set(re.findall(r"[a-z0-9]+", said_by(program, "-help").lower()))


def content_of(path):
    try:
        return pathlib.Path(path).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


def field_of(text, name):
    """The value of the first line `name: value` or `name="value"`."""
    found = re.search(rf'^{name}\s*[:=]\s*"?(.*?)"?$', text, re.MULTILINE)
    return found[1] if found else "unknown"


def system():
    return f"{field_of(content_of('/etc/os-release'), 'PRETTY_NAME')}, Linux {platform.release()}, {platform.machine()}"


def processor():
    about = content_of("/proc/cpuinfo")
    flags = set((field_of(about, "flags") + " " + field_of(about, "Features")).split())
    known = " ".join(one for one in EXTENSIONS if one in flags) or "unknown"
    return f"{field_of(about, 'model name')}, {os.cpu_count()} of which {len(os.sched_getaffinity(0))} may be used, with {known}"


def version_of(module):
    try:
        return importlib.metadata.version(module)
    except importlib.metadata.PackageNotFoundError:
        return "none"


def versions(program):
    """The text of versions.txt."""
    modules = ", ".join(f"{module} {version_of(module)}" for module in MODULES)
    memory = field_of(content_of("/proc/meminfo"), "MemTotal")
    return (f"{said_by(program, '-version')}scripts {VERSION}\nPython {platform.python_version()} with h5py {h5py.__version__}, {modules}\n"
            f"system {system()}\nprocessor {processor()}\nmemory {memory}\n"
            f"language {os.environ.get('LC_ALL') or os.environ.get('LANG') or 'none'}\n")
