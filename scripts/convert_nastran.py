"""Modes of Nastran (MSC, Simcenter, OptiStruct, MYSTRAN): the punch file (.pch) and the GRID entries of the bulk data.

Punch files have cards of 80 columns: heads with $, then values in fields of 18 columns, continued by -CONT-.
"""

import re

import numpy as np
from convert_lines import Lines, count, fields, number
from convert_modes import Field, Mode

SHELL, BAR = ("FX", "FY", "FXY", "MX", "MY", "MXY", "QX", "QY"), ("M1A", "M2A", "M1B", "M2B", "V1", "V2", "AF", "TRQ")
FORCES = {33: ("QUAD4", SHELL), 74: ("TRIA3", SHELL), 34: ("BAR", BAR)}  # by the number of the element type
TITLE = re.compile(r"\$(TITLE|SUBTITLE|LABEL|SUBCASE)\b")


def is_punch(content):
    return re.search(rb"^\$TITLE +=", content, re.MULTILINE) is not None


def read(paths):
    """(numbers of nodes, coordinates, modes) of all files together: each has punched results, GRID entries or both."""
    grid, modes = {}, {}
    for path in paths:
        lines = Lines(path)
        line = lines.take()
        while line is not None:
            if line.startswith("$TITLE"):
                line = read_results(lines, modes)
            elif line.upper().startswith(("GRID", "GRDSET")):
                line = read_grid(lines, line, grid)
            else:
                line = lines.take()
    if not modes:
        lines.refuse_file("the files have no mode shapes; allowed: a punch file with $EIGENVECTOR, DISPLACEMENT(PUNCH)=ALL")
    if not grid:
        lines.refuse_file("the files have no GRID entries; name the bulk data too (.bdf, .dat), and what INCLUDE names")
    return np.array(list(grid), dtype=np.int64), np.array(list(grid.values())), list(modes.values())


def read_grid(lines, line, grid):
    """Adds a GRID entry, and returns the line after it."""
    row, line, following = lines.row, line.partition("$")[0], None
    wide = line[:8].split(",")[0].rstrip().endswith("*")
    if wide:  # two lines with four fields of 16 columns each
        following = lines.take() or ""
        if not following.startswith("*"):
            lines.refuse("expected the second line of GRID*, which begins with *", row)
    if "," in line:
        cells = line.split(",")[1:5 if wide else 9] + (following.split(",")[1:5] if wide else [])
    elif wide:
        cells = [cell[at:at + 16] for cell in (line, following) for at in range(8, 72, 16)]
    else:
        cells = fields(line[:72], 8, 8)
    cells = [cell.strip() for cell in cells] + [""] * 8
    if line.upper().startswith("GRDSET"):
        if any(cells[i] not in ("", "0") for i in (1, 5)):
            lines.refuse("GRDSET with a coordinate system; allowed: the basic one", row)
        return lines.take()
    node = lines.read(count, cells[0], row=row)
    for i, what in ((1, "positions"), (5, "displacements")):
        if cells[i] not in ("", "0", "-1"):
            lines.refuse(f"node {node} has its {what} in the coordinate system {cells[i]}; allowed: the basic one", row)
    if node in grid:
        lines.refuse(f"a second node {node}", row)
    grid[node] = lines.numbers([cell or "0" for cell in cells[2:5]], row)
    return lines.take()


def read_results(lines, modes):
    """Reads the results after $TITLE, and returns the line after them."""
    head = []
    while (line := lines.take()) is not None and line.startswith("$"):
        if not TITLE.match(line):
            head.append((lines.row, line[1:72].rstrip()))
    eigenvector, kind, named = False, None, None
    for row, words in head:
        if words.startswith(("REAL-IMAG", "MAGNITUDE")):
            lines.refuse("complex results; allowed: those of real modes, $REAL OUTPUT", row)
        if words.startswith("POINT ID"):
            lines.refuse("the results are sorted by nodes (SORT2); allowed: SORT1", row)
        eigenvector = eigenvector or words.startswith("EIGENVECTOR")
        if found := re.match(r"ELEMENT TYPE =\s*(\d{1,4})\b", words):
            kind = FORCES.get(int(found[1]))
        if found := re.match(r"EIGENVALUE =\s*(\S+)\s+MODE =\s*(\d{1,6})\b", words):
            named = lines.read(number, found[1], row=row), int(found[2])
    forces = kind and any(words.startswith("ELEMENT FORCES") for _, words in head)
    if named is None or not (eigenvector or forces):
        return line
    eigenvalue, mode = named
    if eigenvalue < 0.0:
        lines.refuse(f"mode {mode} has the eigenvalue {eigenvalue:g}; allowed: not below 0", head[-1][0])
    name, components = kind if forces else ("DISP", ("x", "y", "z", "rx", "ry", "rz"))
    first = head[-1][0]
    ids, values, line = read_values(lines, line, len(components), eigenvector)
    one = modes.setdefault(mode, Mode(mode, np.sqrt(eigenvalue) / (2.0 * np.pi), None, None, f"{lines.path}:{first}", {}))
    if name in one.fields or abs(one.frequency - np.sqrt(eigenvalue) / (2.0 * np.pi)) > 1e-6 * one.frequency:
        lines.refuse(f"a second {name} of mode {mode}; allowed: one subcase of modes", first)
    one.fields[name] = Field(list(components), ids, values)
    return line


def read_values(lines, line, size, nodes):
    """(numbers, values [number, component], the line after them); nodes: a letter stands before the first value."""
    ids, values, first = [], [], lines.row
    while line is not None and not line.startswith("$") and line.strip():
        row = lines.row
        ids.append(lines.read(count, line[:10], row=row))
        words = fields(line[:72], 18, 18)
        point = nodes and line[17:18] == "S"  # a scalar point
        while (line := lines.take()) is not None and line.startswith("-CONT-"):
            words += fields(line[:72], 18, 18)
        if point:
            ids.pop()
        elif len(words) != size:
            lines.refuse(f"{len(words)} values of number {ids[-1]}; expected {size}", row)
        else:
            values.append(lines.numbers(words, row))
    if not ids:
        lines.refuse("expected values", first)
    return np.array(ids, dtype=np.int64), np.array(values), line
