"""XDMF of a run for ParaView: the bridge as a polyline and the bodies of vehicles as points, over time."""

import contextlib
import io
import pathlib
import re
import xml.etree.ElementTree as tree

import checked_results
import h5py
import numpy as np
import output_files
from picture_motion import Motion

OF_BRIDGE = ("deflection", "velocity", "acceleration", "moment", "shear")  # series at stations


def in_space(x, y):
    """Points [..., 3] with z = 0."""
    return np.stack([x, y, np.zeros_like(y)], axis=-1)


def bridge_of(motion, rows, exaggeration):
    """Datasets of the bridge at its stations: points, displacement as a vector, and each series with its unit."""
    probes = motion.results.file["probes"]
    deflection = motion.at_stations[rows]
    x = np.broadcast_to(motion.stations, deflection.shape)
    data = {"points": in_space(x, exaggeration * deflection), "displacement (m)": in_space(0.0 * x, deflection)}
    for name in OF_BRIDGE:
        if name in probes:
            data[f"{name} ({probes[name].attrs.get('unit', '')})"] = motion.results.over_time(probes[name])[rows]
    return data


def vehicles_of(motion, rows, exaggeration):
    """Datasets of all bodies; empty if there are none."""
    if not motion.bodies:
        return {}
    position = np.stack([body.position[rows] for body in motion.bodies], axis=1)
    sway = position[..., 1] - [body.height for body in motion.bodies]
    data = {"points": in_space(position[..., 0], position[..., 1] + (exaggeration - 1.0) * sway),
            "displacement (m)": in_space(0.0 * sway, sway), "angle (rad)": position[..., 2],
            "vehicle": np.broadcast_to([float(body.vehicle) for body in motion.bodies], sway.shape)}
    groups = [motion.results.vehicles[body.vehicle][body.name] for body in motion.bodies]
    if all("velocity" in group for group in groups):
        velocity = np.stack([motion.results.over_time(group["velocity"])[rows] for group in groups], axis=1)
        data["body velocity (m/s)"] = in_space(velocity[..., 0], velocity[..., 1])
    return data


def add_item(parent, file, place, values):
    """Writes a dataset to the open file at this path and adds its reference to the parent."""
    if place not in file:
        file[place] = values
    kind = "Int" if values.dtype.kind == "i" else "Float"
    item = tree.SubElement(parent, "DataItem", Format="HDF", NumberType=kind, Precision="8",
                           Dimensions=" ".join(map(str, values.shape)))
    item.text = f"{file.attrs['name']}:/{place}"


def add_grid(parent, name, topology, data, file, row, cells=None):
    """Adds the points of one instant with their data, in separate datasets, because some readers read no parts. cells: of a
    surface, the points of each."""
    grid = tree.SubElement(parent, "Grid", Name=name, GridType="Uniform")
    count = data["points"].shape[1]
    if cells is None:
        cells = np.arange(count).reshape((1, count) if topology == "Polyline" else (count, 1))
    item = tree.SubElement(grid, "Topology", TopologyType=topology, NumberOfElements=str(cells.shape[0]),
                           NodesPerElement=str(cells.shape[1]))
    add_item(item, file, f"{name}/cells", cells)
    add_item(tree.SubElement(grid, "Geometry", GeometryType="XYZ"), file, f"{name}/{row}/points", data["points"][row])
    for number, (what, values) in enumerate(data.items()):
        if what != "points":
            kind = "Vector" if values.ndim == 3 else "Scalar"
            attribute = tree.SubElement(grid, "Attribute", Name=what, AttributeType=kind, Center="Node")
            place = f"{name}/{row}/{path_of(what)}"
            add_item(attribute, file, f"{place} {number}" if place in file else place, values[row])


def path_of(what):
    """The name of a dataset without its unit, and without characters that separate parts of a path."""
    return re.sub(r"[^\w -]", "_", what.split(" (")[0])


def along_rail(group, at, quantity):
    """Datasets of the least and greatest values of every case along the track."""
    x = group[at][:]
    data = {"points": in_space(x, np.zeros_like(x))[None]}
    for case in (name for name in group if isinstance(group[name], h5py.Group)):
        for side in ("least", "greatest"):
            values = group[case][f"{side}_{quantity}"]
            data[f"{case} {side} {quantity} ({values.attrs.get('unit', '')})"] = values[:][None]
    return data


def data_file(path):
    return pathlib.Path(f"{path}.h5")


def domain_of(root):
    """The domain of a new XDMF file, which names the program."""
    domain = tree.SubElement(root, "Domain")
    tree.SubElement(domain, "Information", Name="program", Value=output_files.WRITER)
    return domain


@contextlib.contextmanager
def files(root, path):
    """Gives the HDF5 file of the data; writes it and the tree. Their names are those in the tree. The file is made in
    memory, because h5py may end with a segmentation fault if a disk becomes full."""
    with output_files.written(data_file(path), "exported") as temporary, io.BytesIO() as content:
        with h5py.File(content, "w") as out:
            out.attrs["program"], out.attrs["name"] = output_files.RESULTS["exported"], data_file(path).name
            out.attrs["version"] = checked_results.VERSION
            yield out
        temporary.write_bytes(content.getbuffer())
    tree.indent(root)
    with output_files.written(path, "xdmf") as temporary:
        tree.ElementTree(root).write(temporary, encoding="utf-8", xml_declaration=True)


def write_rail_xdmf(results, path):
    """Writes the envelopes of scene_analysis rail to PATH and PATH.h5, and returns both paths."""
    group = results["rail_forces"]
    root = tree.Element("Xdmf", Version="3.0")
    whole = tree.SubElement(domain_of(root), "Grid", Name="rail_forces", GridType="Collection",
                            CollectionType="Spatial")
    with files(root, path) as out:
        add_grid(whole, "rails", "Polyline", along_rail(group, "x", "stress"), out, 0)
        add_grid(whole, "sleepers", "Polyvertex", along_rail(group, "sleeper_x", "slip"), out, 0)
    return [path, data_file(path)]


def write_xdmf(results, path, exaggeration=1.0, every=1):
    """Writes a run to PATH, with the data in PATH.h5, and returns both paths."""
    if every < 1 or not np.isfinite(exaggeration):
        raise ValueError("--every: a number of samples from 1; --exaggeration: a number")
    motion = Motion(results)
    rows = slice(None, None, every)
    parts = {"bridge": ("Polyline", bridge_of(motion, rows, exaggeration)),
             "vehicles": ("Polyvertex", vehicles_of(motion, rows, exaggeration))}
    parts = {name: part for name, part in parts.items() if part[1]}
    root = tree.Element("Xdmf", Version="3.0")
    steps = tree.SubElement(domain_of(root), "Grid", Name=results.scene(), GridType="Collection",
                            CollectionType="Temporal")
    with files(root, path) as out:
        for row, time in enumerate(motion.time[rows]):
            step = tree.SubElement(steps, "Grid", Name=f"{time:.9g} s", GridType="Collection", CollectionType="Spatial")
            tree.SubElement(step, "Time", Value=repr(float(time)))
            for name, (topology, data) in parts.items():
                add_grid(step, name, topology, data, out, row)
    return [path, data_file(path)]
