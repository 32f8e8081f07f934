"""A results file as an xarray.Dataset."""

import re

import h5py
import xarray

from . import checked_results, places

# Omitted are the scene itself, and the state at an end between two samples; h5py reads these.
_LEFT_OUT = ("options", "input", "model", "end", "study/shape", "study/row_digest", "screen/row_digest")
_BARE = re.compile(r"^/?(?:probes|sweep|study|fit|screen)/")
_WITHOUT_COORDINATES = b"This is a netCDF dimension but not a netCDF variable."
# The values along a dimension of quantities that no file contains: those of a Passage.
_MEANINGS = {"coordinate": ["x", "y", "angle"], "component": ["fx", "fy", "moment"], "direction": ["x", "y"]}


def name_of(path):
    """The name of the dataset at a path: with "_" for "/", without a leading probes, sweep, study, fit or screen."""
    return _BARE.sub("", path).strip("/").replace("/", "_")


def open_results(path):
    """Reads a results file of a run, a sweep, a study, a screen or modes.

    Returns an xarray.Dataset in memory. Each variable has the unit of the file in attrs["units"]; `time`, `x` and
    similar arrays are coordinates, and so are the varied options of a study. attrs contains the attributes of the file,
    those of its /summary as summary_NAME, and `options`, one line each. Raises Error if the file cannot be read.
    """
    try:
        with checked_results.opened(path) as file:
            return _of_file(file)
    except checked_results.ResultsError as failure:
        raise places.Error(f"{path}: {failure}", 4) from None
    except OSError as failure:
        raise places.Error(f"{path}: {checked_results.UNREADABLE} ({failure})", 4) from None


def _of_file(file):
    samples = len(file["time"]) if "time" in file else None
    variables = {}
    for path, item in _datasets(file):
        scale = item.attrs.get("NAME")
        if scale == _WITHOUT_COORDINATES:
            continue
        variable = _variable(file, item, samples)
        name = name_of(path) if scale is None else scale.decode()
        if scale is None and (name in variables or name in variable.dims):
            name += "_words"  # a table of the things along the dimension of this name
        variables[name] = variable
    results = with_coordinates(variables)
    results.attrs = _attributes(file)
    return in_km_per_hour(_along_axes(results, file["study"]) if "study" in file else results)


def _datasets(group, folder=""):
    """(path, dataset) of all datasets in the group that are not left out, those of the root first."""
    paths = [(f"{folder}{name}", item) for name, item in group.items()]
    paths = [(path, item) for path, item in paths if path not in _LEFT_OUT]
    for path, item in sorted(paths, key=lambda one: isinstance(one[1], h5py.Group)):
        if isinstance(item, h5py.Group):
            yield from _datasets(item, f"{path}/")
        else:
            yield path, item


def _dimensions(file, item):
    if "DIMENSION_LIST" not in item.attrs:
        return (item.attrs["NAME"].decode(),)
    scales = [file[references[0]] for references in item.attrs["DIMENSION_LIST"]]
    names = [scale.attrs["NAME"] for scale in scales]
    return tuple(scale.name.rsplit("/", 1)[-1] if name == _WITHOUT_COORDINATES else name.decode()
                 for scale, name in zip(scales, names))


def _variable(file, item, samples):
    values = item.asstr()[()] if h5py.check_string_dtype(item.dtype) else item[()]
    dimensions = _dimensions(file, item)
    if dimensions[:1] == ("time",):
        values = values[:samples]  # a killed run may have left more rows
    attributes = {key: value for key, value in item.attrs.items()
                  if key not in ("unit", "CLASS", "NAME", "DIMENSION_LIST")}
    return xarray.Variable(dimensions, values, attributes)


def in_km_per_hour(results):
    """Adds to each coordinate in m/s one in km/h: speed_kmh to speed."""
    speeds = {name: results[name] for name in results.coords
              if results[name].ndim == 1 and results[name].attrs.get("units") == "m/s"}
    return results.assign_coords({f"{name}_kmh": (speed.dims, 3.6 * speed.values, {"units": "km/h"})
                                  for name, speed in speeds.items()})


def with_coordinates(variables):
    """The Dataset of the variables by their names: a variable with the name of a dimension is its coordinate."""
    coordinates = {name for variable in variables.values() for name in variable.dims if name in variables}
    results = xarray.Dataset({name: v for name, v in variables.items() if name not in coordinates},
                             {name: variables[name] for name in sorted(coordinates)})
    for name, meaning in _MEANINGS.items():
        if name not in results.coords and results.sizes.get(name) == len(meaning):
            results = results.assign_coords({name: meaning})
    return results


def _attributes(file):
    attributes = dict(file.attrs)
    for group in ("summary", "modes", "sweep", "study", "find", "sensitivity", "screen"):
        if group in file:
            attributes |= {f"{group}_{name}": value for name, value in file[group].attrs.items()}
    if "options" in file:
        attributes["options"] = "\n".join(" ".join(row) for row in file["options"].asstr()[()])
    return attributes


def _along_axes(results, study):
    """The runs of a study along its axes: the only option of an axis is its coordinate."""
    axes = [axis.strip() for axis in str(study.attrs["axes"]).split(",")]
    lengths = [int(length) for length in study["shape"][()]]
    varied = {name: int(study[name].attrs["axis"]) for name in study if "axis" in study[name].attrs}
    stations = results["x"].values
    results = results.drop_vars("x")  # those of the first run
    if (results["probes_x"] == stations).all():
        results = results.drop_vars("probes_x").rename_dims(probe="x").assign_coords(x=("x", stations, {"units": "m"}))
    runs = {}
    for name, variable in results.variables.items():
        if variable.dims[:1] == ("run",):
            shape = (*lengths, *variable.shape[1:])
            runs[name] = xarray.Variable((*axes, *variable.dims[1:]), variable.values.reshape(shape), variable.attrs)
    results = results.drop_vars(runs)
    for name, axis in varied.items():
        first = tuple(slice(None) if i == axis else 0 for i in range(len(axes)))
        runs[name] = xarray.Variable(axes[axis], runs[name].values[first], runs[name].attrs)
    return results.assign({name: v for name, v in runs.items() if name not in varied}).assign_coords(
        {name: runs[name] for name in varied})
