"""The plain C interface of libtraverse.so (include/traverse/traverse.h)."""

import ctypes
import functools
import warnings

import numpy as np
import xarray

from . import places


class Quantity(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("unit", ctypes.c_char_p), ("dimensions", ctypes.c_size_t),
                ("shape", ctypes.c_size_t * 2), ("varies", ctypes.c_int), ("names", ctypes.c_char_p)]


GO_ON = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_double)
NUMBERS = ctypes.POINTER(ctypes.c_double)


@functools.lru_cache(maxsize=None)
def library():
    try:
        loaded = ctypes.CDLL(places.shared_library())
    except OSError as failure:
        raise places.Error(f"libtraverse.so cannot be loaded; build it by cmake --build build ({failure})", 4) from None
    c, handle, text = ctypes, ctypes.c_void_p, ctypes.c_char_p
    made = c.POINTER(handle)
    for name, result, *arguments in (
            ("open", c.c_int, c.c_int, c.POINTER(text), made), ("open_problem", c.c_int, handle, made),
            ("close", None, handle), ("version", text), ("error", text), ("time", c.c_double, handle), ("end", c.c_double, handle),
            ("interval", c.c_double, handle), ("advance", c.c_int, handle, c.c_double),
            ("quantities", c.c_size_t, handle), ("describe", c.c_int, handle, c.c_size_t, c.POINTER(Quantity)),
            ("read", c.c_int, handle, text, NUMBERS, c.c_size_t),
            ("set_body_force", c.c_int, handle, c.c_int, text, c.c_double, c.c_double, c.c_double),
            ("set_beam_force", c.c_int, handle, c.c_double, c.c_double), ("finish", c.c_int, handle, made),
            ("problem_new", c.c_int, text, made), ("problem_read", c.c_int, text, made),
            ("problem_set", c.c_int, handle, text, text),
            ("problem_table", c.c_int, handle, text, c.c_size_t, c.c_size_t, NUMBERS), ("problem_free", None, handle),
            ("simulate", c.c_int, c.c_size_t, made, c.c_int, GO_ON, handle, made),
            ("results_count", c.c_size_t, handle),
            ("results_describe", c.c_int, handle, c.c_size_t, c.POINTER(Quantity)),
            ("results_read", c.c_int, handle, text, NUMBERS, c.c_size_t),
            ("results_text", text, handle, text, c.c_size_t), ("results_free", None, handle)):
        function = getattr(loaded, f"traverse_{name}")
        function.restype, function.argtypes = result, arguments
    return loaded


def check(status, unsaid=""):
    """Raises Error for a status other than 0, with the message of the library; unsaid: a text removed from it."""
    if status != 0:
        raise places.Error(library().traverse_error().decode(errors="replace").replace(unsaid, ""), status)


def results_of(handle):
    """The results of a handle, which is freed, as a Dataset along `run`."""
    try:
        found, quantity = {}, Quantity()
        for i in range(library().traverse_results_count(handle)):
            check(library().traverse_results_describe(handle, i, ctypes.byref(quantity)))
            values = np.empty(tuple(quantity.shape[: quantity.dimensions]))
            check(library().traverse_results_read(handle, quantity.name, values.ctypes.data_as(NUMBERS), values.size))
            found[quantity.name.decode()] = xarray.Variable(tuple(quantity.names.decode().split()), values,
                                                            {"units": quantity.unit.decode()})
        results = xarray.Dataset(found)
        criteria = list(_texts(handle, "criterion"))
        if criteria:
            results = results.assign_coords(criterion=criteria)
        for line in _texts(handle, "unusual"):
            warnings.warn(line, places.UnusualInput, stacklevel=4)
        results.attrs["model"] = next(_texts(handle, "model"), "")
    finally:
        library().traverse_results_free(handle)
    stations = results["probes_x"]
    if results.sizes["run"] > 0 and bool((stations == stations[0]).all()):
        results = results.drop_vars("probes_x").rename_dims(probe="x").assign_coords(
            x=("x", stations.values[0], {"units": "m"}))
    return results


def _texts(handle, what):
    i = 0
    while (text := library().traverse_results_text(handle, what.encode(), i)) is not None:
        yield text.decode()
        i += 1
