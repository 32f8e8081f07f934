"""Opens results files of any origin: damaged ones end neither a script nor its reader without a message.

HDF5 may end by a signal in a damaged file, and it opens the other files that a file names. Therefore a process of its
own, with limits of time and memory, reads the file first: its structure, its texts, and the ends of its numbers. After
that, this process opens it.
"""

import os
import pathlib
import re
import resource
import signal
import stat

import h5py

SECONDS, SECONDS_A_BYTE = 5.0, 1e-7   # processor time
MEMORY, MEMORY_A_BYTE = 1 << 30, 64    # in addition to that of this process; data may be compressed
UNREADABLE = "is no results file that can be read"
WHOLE, DAMAGED, ELSEWHERE = 0, 10, 11  # exit status of the process


def own_version():
    """The version that cmake --install has put beside this file, otherwise that of the checkout around it."""
    here = pathlib.Path(__file__).resolve()
    if here.with_name("version.txt").is_file():
        return here.with_name("version.txt").read_text(encoding="utf-8").strip()
    lists = next(path for path in (folder / "CMakeLists.txt" for folder in here.parents) if path.is_file())
    return re.search(r"^project\(traverse VERSION ([\d.]+)", lists.read_text(encoding="utf-8"), re.MULTILINE)[1]


VERSION = own_version()


class ResultsError(ValueError):
    """A file that cannot be read, in one line without its name."""


class PartsElsewhere(Exception):
    """A file with parts in other files."""


def read_block(dataset, most):
    """Reads a dataset's texts, or the index of its chunks and the ends of its numbers; ValueError if it has more bytes
    than its file can contain."""
    if dataset.external or dataset.is_virtual:
        raise PartsElsewhere
    if dataset.size is None or dataset.size == 0:
        return
    if dataset.size * dataset.dtype.itemsize > most:
        raise ValueError
    if dataset.dtype.kind not in "fiu":
        dataset[()]
        return
    if dataset.chunks:
        dataset.id.get_num_chunks()
    for row in {0, dataset.shape[0] - 1} if dataset.shape else [()]:
        dataset[row]


def read_group(group, most, known):
    """Reads all objects of a group, each once; PartsElsewhere, or any exception of h5py."""
    dict(group.attrs)
    for name in group:
        link = group.get(name, getlink=True)
        if isinstance(link, h5py.ExternalLink):
            raise PartsElsewhere
        if isinstance(link, h5py.SoftLink):
            continue
        item = group[name]
        place = h5py.h5o.get_info(item.id).addr
        if place in known:
            continue
        known.add(place)
        if isinstance(item, h5py.Group):
            read_group(item, most, known)
        else:
            dict(item.attrs)
        if isinstance(item, h5py.Dataset):
            read_block(item, most)


def pages_of_this_process():
    try:
        return int(pathlib.Path("/proc/self/statm").read_text().split()[0])
    except OSError:
        return 0


def limit(kind, most):
    lowest = min([most] + [one for one in resource.getrlimit(kind) if one != resource.RLIM_INFINITY])
    resource.setrlimit(kind, (int(lowest), int(lowest)))


def read_whole(path):
    """Reads an HDF5 file to its ends."""
    with h5py.File(path, "r", locking=False) as file:
        read_group(file, MEMORY + MEMORY_A_BYTE * os.path.getsize(path), set())


def read_and_leave(path, size, read):
    """Of the process that reads first: ends it with WHOLE, DAMAGED or ELSEWHERE."""
    status = DAMAGED
    try:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        for number in (signal.SIGSEGV, signal.SIGBUS, signal.SIGABRT, signal.SIGFPE, signal.SIGXCPU, signal.SIGINT):
            signal.signal(number, signal.SIG_DFL)
        limit(resource.RLIMIT_CORE, 0)
        limit(resource.RLIMIT_CPU, os.times().user + os.times().system + SECONDS + SECONDS_A_BYTE * size)
        limit(resource.RLIMIT_AS, pages_of_this_process() * resource.getpagesize() + MEMORY + MEMORY_A_BYTE * size)
        read(path)
        status = WHOLE
    except PartsElsewhere:
        status = ELSEWHERE
    finally:
        os._exit(status)


def check(path, read=read_whole):
    """ResultsError unless a file is a whole HDF5 file with all of its parts, or one that `read` reads without an exception."""
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        raise ResultsError(UNREADABLE) from None
    if not stat.S_ISREG(found.st_mode):
        raise ResultsError(UNREADABLE)
    child = os.fork()
    if child == 0:
        read_and_leave(path, found.st_size, read)
    _, ended = os.waitpid(child, 0)
    status = os.waitstatus_to_exitcode(ended)
    if status == ELSEWHERE:
        raise ResultsError("has parts in other files, which are not looked for")
    if status != WHOLE:
        raise ResultsError(UNREADABLE)


def major(version):
    """The first number of a version; 0 for any other text."""
    found = re.match(r"\d+", str(version))
    return int(found[0]) if found else 0


def opened(path):
    """Opens a results file, also while a run writes it; ResultsError if it cannot be read, or if a newer major version of
    Traverse has written it."""
    check(path)
    try:
        file = h5py.File(path, "r", locking=False)
    except OSError:
        raise ResultsError(UNREADABLE) from None
    version = file.attrs.get("version", "")
    if file.attrs.get("program") == "traverse" and major(version) > major(VERSION):
        file.close()
        raise ResultsError(f"was written by version {version} of Traverse, whose files version {VERSION} cannot read")
    return file


def in_one_line(error):
    """The words for any exception of a script that reads results: a damaged file can raise every kind."""
    text = " ".join(str(error).split())
    if isinstance(error, (OSError, ValueError)) and text:
        return text
    return f"is damaged or no results file of this program: {text or type(error).__name__}"
