"""Records in MATLAB files: versions 5 to 7.2 by SciPy; 7.3, which is HDF5, by h5py. Only numbers count, no objects.

A process with limits of time and memory reads the file first, as it does with results files (checked_results.py).
"""

import warnings

import checked_results
import h5py
import numpy as np
from convert_records import Channel
from input_files import InputError

HDF5 = b"\x89HDF\r\n\x1a\n"
HEADS = (b"MATLAB 5.0", b"MATLAB 7.3")
DEEPEST = 8  # structures in each other
TIMES = ("t", "time", "zeit", "temps", "timestamp")  # the last part of a name of times


def is_matlab(content):
    return content.startswith(HEADS) or content.startswith(HDF5)


def columns_of(name, values):
    """{name: vector} of a matrix: the samples are along its longer side."""
    if values.dtype.kind not in "fiu" or values.ndim != 2 or values.size < 2:
        return {}
    values = values if values.shape[0] >= values.shape[1] else values.T
    if values.shape[1] == 1:
        return {name: values[:, 0].astype(float)}
    return {f"{name}_{i + 1}": values[:, i].astype(float) for i in range(values.shape[1])}


def of_scipy(path):
    """{name: vector} of the numbers in a file of a version up to 7.2, also in structures."""
    from scipy.io import loadmat
    found = {}

    def add(name, value, depth):
        if type(value) is not np.ndarray:  # an object or a function of MATLAB
            return
        if value.dtype.names:
            for part in value.dtype.names if value.size == 1 and depth < DEEPEST else ():
                add(f"{name}.{part}", value[part].flat[0], depth + 1)
        else:
            found.update(columns_of(name, value))

    with open(path, "rb") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        content = loadmat(file)
    for name, value in content.items():
        if not name.startswith("__"):
            add(name, value, 0)
    return found


def of_hdf5(path):
    """{name: vector} of the numbers in a file of version 7.3, also in structures; dimensions are reversed in it."""
    found = {}

    def add(group, name, depth):
        for part in group:
            item = group.get(part) if isinstance(group.get(part, getlink=True), h5py.HardLink) else None
            inner = f"{name}.{part}" if name else part
            if isinstance(item, h5py.Group) and not part.startswith("#") and depth < DEEPEST:
                add(item, inner, depth + 1)
            elif isinstance(item, h5py.Dataset) and item.dtype.kind in "fiu" and item.ndim == 2:
                found.update(columns_of(inner, item[()].T))

    with h5py.File(path, "r", locking=False) as file:
        add(file, "", 0)
    return found


def vectors_of(path):
    """{name: vector} of a file, which another process has read before."""
    with open(path, "rb") as file:
        is_hdf5 = file.read(10) != HEADS[0]
    if not is_hdf5:
        try:
            import scipy.io  # noqa: F401
        except ImportError:
            raise InputError(f"{path}: needs SciPy, of the package python3-scipy") from None
    read = of_hdf5 if is_hdf5 else of_scipy
    try:
        if is_hdf5:
            checked_results.check(path)
        checked_results.check(path, read)
        return read(path)
    except checked_results.ResultsError as error:
        words = str(error).replace("results file", "MATLAB file")
    except Exception as error:
        words = f"is no MATLAB file that can be read: {type(error).__name__}"
    raise InputError(f"{path}: {words}")


def is_time(name):
    return name.rpartition(".")[2].lower() in TIMES


def read_records(path, time=None, rate=None):
    """(channels, what is not read). time: the name of the times; rate: samples a second instead."""
    vectors = vectors_of(path)
    listed = ", ".join(f"{name} ({len(values)})" for name, values in list(vectors.items())[:20]) or "no vectors of numbers"
    if rate is None:
        found = [time] if time else [name for name in vectors if is_time(name)]
        if len(found) != 1 or found[0] not in vectors:
            words = f"no vector {time}" if time else f"{len(found)} vectors of times"
            raise InputError(f"{path}: has {words}; name it by --time, or give the samples a second by --rate; there are "
                             f"{listed}")
        times = vectors.pop(found[0])
        if not (np.all(np.isfinite(times)) and np.all(np.diff(times) > 0.0)):
            raise InputError(f"{path}: the times {found[0]} do not increase, or have NaN; they are in s")
    else:
        times = np.arange(max(map(len, vectors.values()), default=0)) / rate
    channels, passed = [], []
    for name, values in vectors.items():
        if len(values) != len(times):
            passed.append(f"{name} has {len(values)} values for {len(times)} times")
        else:
            channels.append(Channel(name, "", times, values, name))
    if not channels:
        raise InputError(f"{path}: no vector has as many values as there are times; there are {listed}")
    return channels, passed


