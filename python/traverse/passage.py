"""A scene step by step, through the plain C interface of libtraverse.so (include/traverse/traverse.h)."""

import ctypes
import operator

import numpy as np
import xarray

from . import places
from .dataset import name_of, with_coordinates
from .shared_library import NUMBERS, Quantity, check, library, results_of
from .problem import Problem, within

_MOST_C_INT = 2**31 - 1


class Passage:
    """One scene, computed from sample to sample in this process.

    scene, folder and options are those of `traverse.run`; scene may be a Problem. Samples are at the multiples of output_interval, at which
    steps end exactly; quantities are read and forces change there. Vehicles are mechanisms unless model_vehicles is
    set. Without a set force, the values are bit-identical to those of `run` with model_vehicles="full".
    """

    def __init__(self, scene, *, folder=None, **options):
        self._handle = None
        self._library = library()
        problem = scene.with_options(**options) if isinstance(scene, Problem) else \
            Problem(scene, folder=folder, **options)
        handle = ctypes.c_void_p()
        with within(problem.folder), problem.handle() as described:
            check(self._library.traverse_open_problem(described, ctypes.byref(handle)))
        self._handle = handle.value
        self._quantities = dict(self._described())

    def _described(self):
        quantity = Quantity()
        for i in range(self._library.traverse_quantities(self._handle)):
            check(self._library.traverse_describe(self._handle, i, ctypes.byref(quantity)))
            path = quantity.name.decode()
            shape = tuple(quantity.shape[: quantity.dimensions])
            dimensions = tuple(quantity.names.decode().split())
            yield name_of(path), (quantity.name, dimensions, shape, {"units": quantity.unit.decode()})

    def _open(self):
        if self._handle is None:
            raise places.Error("the passage is closed", 2)
        return self._handle

    @property
    def time(self):
        """The time of the current sample, s."""
        return self._library.traverse_time(self._open())

    @property
    def end(self):
        """The end of the scene, s."""
        return self._library.traverse_end(self._open())

    @property
    def interval(self):
        """The time between samples, s."""
        return self._library.traverse_interval(self._open())

    @property
    def names(self):
        """The names of all quantities, the same as in `traverse.run`."""
        return list(self._quantities)

    def advance(self, time=None):
        """Computes up to the first sample at or after `time` (s), or up to the next one. Returns its time, s."""
        if time is None:
            time = min(self.time + self.interval, self.end)
        check(self._library.traverse_advance(self._open(), time))
        return self.time

    def read(self, name=None):
        """A quantity at the current sample, a number or an array; without a name all quantities as a Dataset."""
        if name is not None:
            if name not in self._quantities:
                raise places.Error(f"there is no quantity {name}; names has those there are", 2)
            return self._values(name)[()]
        now = {key: xarray.Variable(dims, self._values(key), attrs)
               for key, (_, dims, _, attrs) in self._quantities.items()}
        now["time"] = xarray.Variable((), self.time, {"units": "s"})
        return with_coordinates(now).set_coords("time")

    def _values(self, name):
        path, _, shape, _ = self._quantities[name]
        values = np.empty(shape)
        check(self._library.traverse_read(self._open(), path, values.ctypes.data_as(NUMBERS),
                                             values.size))
        return values

    def set_force(self, *, vehicle=0, body=None, x=None, fx=0.0, fy=0.0, moment=0.0):
        """Sets a constant force from the current sample on, which replaces the last one there; 0 removes it.

        On a body of a vehicle (vehicles are numbered from 0): fx and fy (N) at its centre of mass and a moment (N m).
        At the station x (m) of the beam: only fy, upward.
        """
        if (body is None) == (x is None):
            raise places.Error("set_force: wanted: a body or a station x", 2)
        if body is not None:
            vehicle = operator.index(vehicle)
            if not 0 <= vehicle <= _MOST_C_INT:  # ctypes truncates larger numbers
                raise places.Error(f"set_force: there is no vehicle {vehicle}: they count from 0", 2)
            check(self._library.traverse_set_body_force(self._open(), vehicle, body.encode(), fx, fy, moment))
            return
        if fx != 0.0 or moment != 0.0:
            raise places.Error("set_force: at a station of the beam only fy acts", 2)
        check(self._library.traverse_set_beam_force(self._open(), x, fy))

    def results(self):
        """The greatest results up to the current sample, as of `simulate`; once, after which only `close` is possible."""
        made = ctypes.c_void_p()
        check(self._library.traverse_finish(self._open(), ctypes.byref(made)))
        return results_of(made)

    def close(self):
        """Frees the memory; the passage cannot be used afterwards."""
        handle, self._handle = self._handle, None
        if handle is not None:
            self._library.traverse_close(handle)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        self.close()
