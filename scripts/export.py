#!/usr/bin/python3
"""Converts a results file for other programs: export.py RESULTS.h5 [--series NAME...] [-o FOLDER]

The script writes a CSV file for each name: a time series such as probes/deflection, a group of them such as vehicles/0,
sweep, study, sensitivity, rail_forces/stress, or another table listed by --list. Without names it writes all of them. The heads
contain names and units; the first column is the time, or the position along the rails. --xdmf writes the bridge and
the vehicles over time for ParaView, the envelopes along the rails, or sweeps, studies, searches, screens and fits as
points, surfaces and lines: NAME.xdmf, with its data in NAME.xdmf.h5.
"""

import argparse
import pathlib
import signal
import sys

import export_tables
import export_xdmf_tables
import h5py
import output_files
from checked_results import in_one_line, opened
from export_xdmf import data_file, write_rail_xdmf, write_xdmf
from picture_data import Results


def listed(file):
    """Yields a line for each name: series with shape and unit, and the other tables."""
    for name in export_tables.names(file):
        dataset = file.get(name)
        if isinstance(dataset, h5py.Dataset):
            yield f"{name:44}{' x '.join(map(str, dataset.shape)):>14}  {dataset.attrs.get('unit', '')}"
        else:
            yield name


def all_names(file):
    """The names of all tables: one per group, and one for each vehicle."""
    series = export_tables.series_names(file)
    groups = ["/".join(name.split("/")[:2 if name.startswith("vehicles/") else 1]) for name in series]
    others = [name for name in export_tables.names(file) if name not in series]
    return list(dict.fromkeys(groups)) + others


def csv_file(folder, name):
    return folder / f"{name.strip('/').replace('/', '_')}.csv"


def xdmf(file, path, given):
    """Writes the motion of a run, or all that has no time history."""
    if "rail_forces" in file:
        return write_rail_xdmf(file, path)
    if "time" not in file and (grids := export_xdmf_tables.grids_of(file)):
        return export_xdmf_tables.write_tables(grids, path)
    return write_xdmf(Results(file), path, given.exaggeration, given.every)


def export(given):
    """Writes the requested files and returns their paths, or the lines of --list."""
    with opened(given.results) as file:
        if given.list:
            return list(listed(file))
        folder = pathlib.Path(given.o or ".")
        wanted = given.series if given.series or given.xdmf else all_names(file)
        if not wanted and not given.xdmf:
            raise ValueError("holds no series over time and no table")
        folder.mkdir(parents=True, exist_ok=True)
        inputs, path = [given.results], folder / f"{pathlib.Path(given.results).stem}.xdmf"
        tables = {csv_file(folder, name): export_tables.table_of(file, name) for name in wanted}
        for one, table in tables.items():
            output_files.check(one, "csv", inputs, table.heads)
        for one, kind in ((path, "xdmf"), (data_file(path), "exported")) if given.xdmf else ():
            output_files.check(one, kind, inputs)
        for one, table in tables.items():
            output_files.write_table(one, table.heads, table.rows())
        written = list(tables)
        if given.xdmf:
            written += xdmf(file, path, given)
        return written


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="RESULTS.h5")
    parser.add_argument("--series", nargs="+", default=[], metavar="NAME", help="what to write; left out: all")
    parser.add_argument("-o", metavar="FOLDER", help="left out: the current one")
    parser.add_argument("--list", action="store_true", help="names what there is and writes nothing")
    parser.add_argument("--xdmf", action="store_true", help="writes NAME.xdmf, for ParaView")
    parser.add_argument("--exaggeration", type=float, default=1.0, metavar="X",
                        help="of vertical displacements in --xdmf; left out: 1")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="of the samples in --xdmf every N-th")
    given = parser.parse_args()
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # ends without a message if the reader of a pipe ends, such as head
    try:
        print(*export(given), sep="\n")
    except output_files.OutputError as error:
        print(f"export.py: {error}", file=sys.stderr)
        return 2
    except Exception as error:
        print(f"export.py: {given.results}: {in_one_line(error)}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    output_files.run(main)
