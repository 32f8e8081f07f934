"""XDMF of sweeps, studies, searches, screens, fits, natural modes and static effects for ParaView.

Runs of a study are points, peaks of a sweep, ratios of a search and pairs of a screen are surfaces, series of a fit and
values along the bridge are lines. Lengths along the bridge are coordinates in m; all others are scaled to 0 to 1, because
their units differ. The points have the true numbers, with the names and units of the tables. Texts are not part of it: rows
of bridges and formations are numbers from 0, in the order of their tables.
"""

import xml.etree.ElementTree as tree
from typing import NamedTuple, Optional

import export_tables
import numpy as np
import picture_screen
from export_xdmf import add_grid, data_file, domain_of, files, in_space

ALONG = ("static/effects", "modes/shapes", "envelope")  # tables whose first column is a position along the bridge
RELIEF = 0.5  # height of the largest value of a surface


class Grid(NamedTuple):
    """Points with values. shape: rows and columns of a surface; None: a line or points."""
    topology: str
    points: np.ndarray  # [n, 3]
    values: dict        # name with unit: [n]
    shape: Optional[tuple] = None


def scaled(values, low=None):
    """Values from 0 to 1, where the least one is 0, or the given one; those that are not finite are 0."""
    known = np.isfinite(values)
    if not known.any():
        return np.zeros(len(values))
    low = values[known].min() if low is None else low
    width = values[known].max() - low
    return np.where(known, (values - low) / width, 0.0) if width > 0.0 else np.zeros(len(values))


def points_of(x, y, z=0.0):
    points = in_space(x, y)
    points[:, 2] = z
    return points


def surface(values, shape, x, y, height):
    """A surface of rows and columns with the height of each point, or a line over its only row or column."""
    if min(shape) < 2:
        return Grid("Polyline", points_of(x if shape[1] > 1 else y, np.broadcast_to(height, x.shape)), values)
    return Grid("Quadrilateral", points_of(x, y, height), values, shape)


def numbers_of(file, name):
    """The columns of a table that are numbers."""
    table = export_tables.table_of(file, name)
    columns = ((head, np.asarray(column)) for head, column in zip(table.heads, table.columns))
    return {head: column.astype(float) for head, column in columns if column.dtype.kind in "fiu"}


def of_study(file):
    """The runs, at their first three varied options."""
    names = str(file["study"].attrs["dimensions"]).split(",")
    varied = [file[f"study/{name}"][:] for name in names if len(np.unique(file[f"study/{name}"][:])) > 1][:3]
    count = len(file["study/finished"])
    points = np.zeros((count, 3))
    for i, column in enumerate(varied):
        points[:, i] = scaled(column)
    return {"runs": Grid("Polyvertex", points, numbers_of(file, "study"))}


def of_sweep(file):
    """For each train a surface of its peaks over place and speed, above one another."""
    group, x = file["sweep"], file["probes/x"][:]
    speed, trains = group["speed"][:], group["hslm_a"][:] if "hslm_a" in group else np.ones(1)
    whole, reach = (len(trains), len(speed), len(x)), np.ptp(x) or 1.0
    known = {name: data for name, data in group.items()
             if name.startswith(("peak_", "amplification")) and data.shape == whole}
    grids = {}
    for i, train in enumerate(trains):
        own = {"place (m)": np.tile(x, len(speed)), "speed (m/s)": np.repeat(speed, len(x))}
        own |= {f"{name} ({data.attrs['unit']})": data[i].ravel() for name, data in known.items()}
        level = float(i) / max(len(trains) - 1, 1)
        grids[f"A{train:.0f}" if "hslm_a" in group else "train"] = surface(
            own, whole[1:], own["place (m)"], reach * scaled(own["speed (m/s)"]), reach * level)
    return grids


def of_find(file):
    """The ratio to the bound over the searched values, a row for each answer."""
    group, value = file["find"], file["find/value"][:]
    answers = len(group["ratio"])
    values = {f"{group.attrs['option']} ({group['value'].attrs['unit']})": np.tile(value, answers),
              "answer": np.repeat(np.arange(answers, dtype=float), len(value)),
              **{name: group[name][:].ravel() for name in ("ratio", "run", "limit")}}
    return {"ratios": surface(values, (answers, len(value)), np.tile(scaled(value), answers), scaled(values["answer"]),
                              RELIEF * scaled(values["ratio"], 0.0))}


def of_screen(file):
    """The ratio of each pair, with the worst bridges and formations first."""
    ratio = file["screen/ratio"][:]
    bridges, formations = picture_screen.order_of(ratio)
    rows, columns = (one.ravel() for one in np.meshgrid(bridges, formations, indexing="ij"))
    pairs = numbers_of(file, "screen")
    values = {"bridge": rows.astype(float), "formation": columns.astype(float),
              **{name: column[rows * ratio.shape[1] + columns] for name, column in pairs.items()}}
    y, x = (one.ravel() for one in np.meshgrid(*(np.linspace(0.0, 1.0, n) for n in ratio.shape), indexing="ij"))
    return {"pairs": surface(values, ratio.shape, x, y, RELIEF * scaled(values["ratio (1)"], 0.0))}


def of_fit(file):
    """Measured and computed values of each series over the time, one series above the other."""
    grids = {}
    for i, name in enumerate(file["fit/series"]):
        values = numbers_of(file, f"fit/series/{name}")
        time, measured, computed = values.values()
        both = scaled(np.concatenate([measured, computed])) + 1.2 * i
        for kind, y in zip(("measured", "computed"), np.split(both, 2)):
            grids[f"{name} {kind}"] = Grid("Polyline", points_of(scaled(time), y), values)
    return grids


def along_bridge(file, name):
    """A line along the bridge with the columns of a table."""
    values = numbers_of(file, name)
    x = next(iter(values.values()))
    return {name.replace("/", " "): Grid("Polyline", points_of(x, np.zeros(len(x))), values)}


def grids_of(file):
    """{name: Grid} of everything in the file that is no time history; empty if there is nothing."""
    grids = {}
    for dataset, make in (("study/finished", of_study), ("sweep/speed", of_sweep), ("find/ratio", of_find),
                          ("screen/ratio", of_screen), ("fit/series", of_fit)):
        grids |= make(file) if dataset in file else {}
    for name in ALONG:
        grids |= along_bridge(file, name) if name in export_tables.names(file) else {}
    return grids


def cells_of(shape):
    """The corners of the quadrilaterals of a surface."""
    first = np.arange(shape[0] * shape[1]).reshape(shape)[:-1, :-1].ravel()
    return np.stack([first, first + 1, first + shape[1] + 1, first + shape[1]], axis=1)


def write_tables(grids, path):
    """Writes grids to PATH, with their data in PATH.h5, and returns both paths."""
    root = tree.Element("Xdmf", Version="3.0")
    whole = tree.SubElement(domain_of(root), "Grid", Name=path.stem, GridType="Collection", CollectionType="Spatial")
    with files(root, path) as out:
        for name, grid in grids.items():
            data = {"points": grid.points[None], **{what: values[None] for what, values in grid.values.items()}}
            add_grid(whole, name, grid.topology, data, out, 0, None if grid.shape is None else cells_of(grid.shape))
    return [path, data_file(path)]
