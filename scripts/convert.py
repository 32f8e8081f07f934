#!/usr/bin/python3
"""Converts files of measuring systems and finite element programs:

  convert.py records FILE -o TABLE.csv
    records over time, from universal files (datasets 58 and 58b) and MATLAB files
  convert.py modes FILE... --track POINT POINT -o MODES.txt
    mode shapes along tracks, from universal files (datasets 55 and 2414), CalculiX (.frd, with .dat for forces of
    sections) and Nastran (.pch with .bdf)

A table is read by every option that names one, such as fit_to_NAME_series; a file of modes by bridge_modes_file.
Without -o the command lists what the files contain.
"""

import argparse
import pathlib
import re
import signal
import sys

import convert_calculix
import convert_matlab
import convert_modes
import convert_nastran
import convert_records
import convert_universal
import numpy as np
import output_files
from input_files import InputError, bytes_of

LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "km": 1e3, "in": 0.0254, "ft": 0.3048}
MASSES = {"kg": 1.0, "t": 1e3, "g": 1e-3, "lb": 0.45359237, "slug": 14.593902937, "lbf.s2/in": 175.12683525}
BEGINNING = 1 << 16  # bytes of a file that show what it is
RECORDS = "a universal file (.unv, .uff) with dataset 58, or a MATLAB file (.mat)"
MODES = "a universal file with dataset 55 or 2414, CalculiX's .frd in ASCII, or a punch file of Nastran"


def number(text, least, most, allowed, known=()):
    """The value of an argument: a known word, or a number between bounds."""
    try:
        value = known[text] if text in known else float(text)
    except ValueError:
        value = -1.0
    if not least <= value <= most:
        raise argparse.ArgumentTypeError(f"'{text}'; allowed: {allowed}")
    return value


def length(text):
    return number(text, 1e-12, 1e12, f"{', '.join(LENGTHS)}, or the length in m of a unit of the model", LENGTHS)


def mass(text):
    return number(text, 1e-12, 1e12, f"{', '.join(MASSES)}, or the mass in kg of a unit of the model", MASSES)


def positive(text):
    return number(text, 1e-50, 1e50, "a number above 0")


def ratio(text):
    return number(text, 0.0, 0.999, "a ratio from 0 to 0.999 of critical damping, not in per cent")


def arguments(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(dest="what", required=True)
    records = kinds.add_parser("records", help="records over time")
    records.add_argument("files", metavar="FILE", nargs=1)
    records.add_argument("-o", metavar="TABLE.csv", help="channels with other times go to TABLE_2.csv, ...")
    records.add_argument("--channels", nargs="+", default=[], metavar="NAME", help="left out: all")
    records.add_argument("--time", metavar="NAME", help="of a MATLAB file: the times in s; left out: t or time")
    records.add_argument("--rate", type=positive, metavar="HZ", help="of a MATLAB file without times: samples a second")
    modes = kinds.add_parser("modes", help="mode shapes along tracks")
    modes.add_argument("files", metavar="FILE", nargs="+")
    modes.add_argument("-o", metavar="MODES.txt")
    modes.add_argument("--track", nargs="+", action="append", type=str.strip, default=[], metavar="POINT",
                       help="points x,y,z of the model or numbers of nodes, from the left end of the bridge; for each track")
    modes.add_argument("--up", default="z", type=str.strip, choices=["x", "y", "z", "-x", "-y", "-z"], help="left out: z")
    modes.add_argument("--within", type=positive, metavar="D", help="distance of nodes to a track; left out: 0.05 to 0.2 of it")
    modes.add_argument("--supported-ends", action="store_true", help="the shapes are 0 at the ends of the tracks")
    modes.add_argument("--modes", type=int, nargs="+", default=[], metavar="N", help="their numbers; left out: all")
    modes.add_argument("--damping", type=ratio, nargs="+", metavar="RATIO", help="one for all modes, or one for each")
    modes.add_argument("--modal-mass", type=positive, nargs="+", metavar="M", help="one for all modes, or one for each")
    modes.add_argument("--length", type=length, metavar="UNIT", help="of the model: m, mm, in, ...; left out: m")
    modes.add_argument("--mass", type=mass, metavar="UNIT", help="of the model: kg, t, ...; left out: kg")
    modes.add_argument("--output", action="append", default=[], metavar="NAME=FIELD:COMPONENT@NUMBER[:UNIT]",
                       help="a result of a node, element or section")
    # A point such as -1,2,0 and the direction -z are no options.
    return parser.parse_args([" " + word if re.match(r"-([\d.]+,|[xyz]$)", word) else word for word in words])


def read_records(given):
    path = given.files[0]
    content = bytes_of(path, BEGINNING, whole=False)
    if convert_universal.is_universal(content):
        return convert_universal.read_records(path)
    if convert_matlab.is_matlab(content):
        return convert_matlab.read_records(path, given.time, given.rate)
    raise InputError(f"{path}: is no file of records; allowed: {RECORDS}. A table of numbers needs no conversion")


def records(given):
    """Converts records, and yields what is said."""
    channels, passed = read_records(given)
    tables = convert_records.tables_of(convert_records.chosen(channels, given.channels))
    if given.o:
        output_files.kind_of(given.o, ["csv"])
        first = pathlib.Path(given.o)
        paths = [first if i == 0 else first.with_name(f"{first.stem}_{i + 1}.csv") for i in range(len(tables))]
        for path, table in zip(paths, tables):
            output_files.check(path, "csv", given.files, table.head)
        for path, table in zip(paths, tables):
            output_files.write_table(path, table.head, convert_records.rows_of(table), given.files)
    for i, table in enumerate(tables):
        times = table.channels[0].times
        yield f"{paths[i] if given.o else f'table {i + 1}'}: {len(times)} rows from {times[0]:g} to {times[-1]:g} s"
        for column, (one, head) in enumerate(zip(table.channels, table.head[1:]), 2):
            yield f"  column {column}: {head}{'' if one.unit else ', without a unit'}; {one.about}"
    for one in passed:
        yield f"not read: {one}"


def kind_of(path):
    """The function that reads a file of modes; None: a file that belongs to another one."""
    content = bytes_of(path, BEGINNING, whole=False)
    known = {convert_universal.read_modes: convert_universal.is_universal, convert_calculix.read_frd: convert_calculix.is_frd,
             convert_nastran.read: convert_nastran.is_punch}
    return next((read for read, fits in known.items() if fits(content)), None)


def read_modes(given):
    """(model, what is not read)"""
    kinds = {path: kind_of(path) for path in given.files}
    first = next((path for path in given.files if kinds[path]), None)
    if first is None:
        raise InputError(f"{given.files[0]}: is no file of modes; allowed: {MODES}")
    others, units, passed = [path for path in given.files if path != first], None, []
    if kinds[first] is convert_nastran.read:
        ids, points, modes = convert_nastran.read(given.files)
    elif len(others) > (kinds[first] is convert_calculix.read_frd) or any(kinds[path] for path in others):
        raise InputError(f"{others[-1]}: one file too many; allowed: {MODES}, with .dat of CalculiX or .bdf of Nastran")
    elif kinds[first] is convert_calculix.read_frd:
        ids, points, modes = convert_calculix.read_frd(first)
        for path in others:
            convert_calculix.add_sections(path, modes)
    else:
        ids, points, modes, units, passed = convert_universal.read_modes(first)
    length = given.length or (1.0 / units.length if units else 1.0)
    mass = given.mass or (units.length / units.force if units else 1.0)
    known = {one.number: one for one in modes}
    for number in given.modes:
        if number not in known:
            raise InputError(f"{first}: has no mode {number}; it has {', '.join(map(str, list(known)[:20]))}")
    modes = [known[number] for number in dict.fromkeys(given.modes or known)]
    return convert_modes.model_of(ids, points, modes, length, mass), passed


def for_each(given, modes, what, option, attribute):
    """The numbers of an option for the modes, or those of the file."""
    values = given * len(modes) if given and len(given) == 1 else given
    values = values or [getattr(one, attribute) for one in modes]
    if len(values) != len(modes):
        raise InputError(f"{option} has {len(values)} numbers for {len(modes)} modes; allowed: one, or one for each mode")
    for one, value in zip(modes, values):
        if value is None or value < 0.0:
            raise InputError(f"{one.place}: the file does not have the {what} of mode {one.number}; give {option}"
                             + (", which is 1 for shapes normalised by the mass matrix" if attribute == "mass" else ""))
    return values


def units_of(model):
    return f"a unit of length is {model.length:g} m, one of mass {model.mass:g} kg (--length, --mass)"


def listed(model, tracks):
    """The lines about modes and tracks."""
    yield f"{len(model.modes)} modes at {len(model.ids)} nodes: {convert_modes.box_of(model)}"
    yield units_of(model)
    for i, track in enumerate(tracks, 1):
        yield f"track {i}: {model.length * track.x[-1]:g} m, {track.words}"
    heads = "".join(f"{f'track {i}':>10}" for i in range(1, len(tracks) + 1))
    yield f"{'mode':>6} {'Hz':>10} {'mass':>10} {'damping':>10}{heads}"
    for i, one in enumerate(model.modes):
        known = " ".join(f"{'-' if value is None else f'{value:.5g}':>10}" for value in (one.frequency, one.mass, one.ratio))
        yield f"{one.number:6d} {known}" + "".join(f"{np.abs(track.shapes[:, i]).max():10.3g}" for track in tracks)
        for number, track in enumerate(tracks, 1):
            waves = convert_modes.half_waves(track.shapes[:, i], np.abs(model.shapes[:, :, i]).max())
            if len(track.x) - 1 < convert_modes.ENOUGH * waves:
                yield (f"       {waves} half waves on track {number}, {len(track.x)} stations: fewer than "
                       f"{convert_modes.ENOUGH} in each")


def write_modes(given, model, tracks):
    """Writes the file of modes."""
    if not tracks:
        raise InputError("-o needs --track, with points of the model or numbers of nodes")
    if not any(np.any(track.shapes) for track in tracks):
        raise InputError("no mode deflects along the tracks; see --up")
    masses = for_each(given.modal_mass, model.modes, "modal mass", "--modal-mass", "mass")
    ratios = for_each(given.damping, model.modes, "damping ratio", "--damping", "ratio")
    outputs = [convert_modes.output_of(text, model) for text in given.output]
    names = ", ".join(" ".join(pathlib.Path(path).name.split()) for path in given.files)
    about = [f"Modes of {names}; up is {given.up}; {units_of(model)}",
             *(f"Track {i}: {' '.join(words)}; {track.words}" for i, (words, track) in enumerate(zip(given.track, tracks), 1))]
    output_files.check(given.o, output_files.kind_of(given.o, ["txt"]), given.files)
    masses = [model.mass * one for one in masses]
    output_files.write_text(given.o, convert_modes.text_of(model, tracks, ratios, masses, outputs, about))


def modes(given):
    """Converts modes, and yields what is said."""
    model, passed = read_modes(given)
    up = "xyz".index(given.up[-1]), -1.0 if given.up[0] == "-" else 1.0
    tracks = [convert_modes.track_of(words, model, up, given.within, given.supported_ends) for words in given.track]
    yield from listed(model, tracks)
    for one in passed:
        yield f"not read: {one}"
    if given.o:
        write_modes(given, model, tracks)
        yield given.o


def printable(line):
    """A line without the signs of a file that control a terminal."""
    return "".join(one if one.isprintable() else "?" for one in line)


def main(words=None):
    given = arguments(sys.argv[1:] if words is None else words)
    try:
        with np.errstate(all="ignore"):
            for line in (records if given.what == "records" else modes)(given):
                print(printable(line))
    except (InputError, output_files.OutputError) as error:
        print(printable(f"convert.py: {error}"), file=sys.stderr)
        return 2
    except MemoryError:
        print(f"convert.py: {given.files[0]}: needs more memory than there is", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # ends without a message if the reader of a pipe ends, such as head
    output_files.run(main)
