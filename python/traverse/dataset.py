"""A results file as an xarray.Dataset."""

import h5py
import xarray

from . import places
from .dimensions import MEANINGS, dimensions_of, name_of

# Omitted are the scene itself, and the state at an end between two samples; h5py reads these.
_LEFT_OUT = ("options", "input/", "model/", "end/", "study/shape", "study/row_digest")


def open_results(path):
    """Reads a results file of a run, a sweep, a study or modes.

    Returns an xarray.Dataset in memory. Each variable has the unit of the file in attrs["units"]; `time`, `x` and
    similar arrays are coordinates, and so are the varied options of a study. attrs contains the attributes of the file,
    those of its /summary as summary_NAME, and `options`, one line each. Raises Error if the file cannot be read.
    """
    try:
        with h5py.File(path, "r", locking=False) as file:
            return _of_file(file)
    except OSError as failure:
        raise places.Error(f"{path}: is no results file that can be read ({failure})", 4) from None


def _of_file(file):
    variables = {}
    samples = len(file["time"]) if "time" in file else None

    def visit(path, item):
        if isinstance(item, h5py.Dataset) and not path.startswith(_LEFT_OUT):
            variables[name_of(path)] = _variable(path, item, samples)

    file.visititems(visit)
    results = with_coordinates(variables)
    results.attrs = _attributes(file)
    return _along_axes(results, file["study"]) if "study" in file else results


def _variable(path, item, samples):
    values = item.asstr()[()] if h5py.check_string_dtype(item.dtype) else item[()]
    dimensions = dimensions_of(path, values.ndim)
    if dimensions[:1] == ("time",):
        values = values[:samples]  # a killed run may have left more rows
    attributes = {"units" if key == "unit" else key: value for key, value in item.attrs.items()}
    return xarray.Variable(dimensions, values, attributes)


def with_coordinates(variables):
    """The Dataset of the variables by their names: a variable with the name of a dimension is its coordinate.

    The first column of a table of words with the name of its rows is the coordinate; NAME_words contains all columns.
    """
    tables = {name: table for name, table in variables.items() if table.ndim > 1 and table.dims[0] == name}
    for name, table in tables.items():
        variables = variables | {name: table[:, 0], f"{name}_words": table}
    coordinates = {name for variable in variables.values() for name in variable.dims if name in variables}
    results = xarray.Dataset({name: v for name, v in variables.items() if name not in coordinates},
                             {name: variables[name] for name in sorted(coordinates)})
    for name, meaning in MEANINGS.items():
        if results.sizes.get(name) == len(meaning):
            results = results.assign_coords({name: meaning})
    return results


def _attributes(file):
    attributes = dict(file.attrs)
    for group in ("summary", "modes", "sweep", "study"):
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
    if (results["probes_x"] == results["x"]).all():
        results = results.drop_vars("probes_x")
    else:  # stations of the first run only
        results = results.drop_vars("x").rename_dims(x="probe")
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
