"""Modes of CalculiX: results files (.frd, in ASCII) of a step *FREQUENCY, and section forces of its .dat file.

The blocks and columns are those of "Result Format" in the manual of CalculiX GraphiX, and of the program's output.
"""

import re

import numpy as np
from convert_lines import Lines, count, integer, number
from convert_modes import Field, Mode

VALUES = [(13 + 12 * i, 25 + 12 * i) for i in range(6)]  # columns of the values in the format that ccx writes
MODAL, LONG = 2, 1  # kind of analysis; format of the lines
DISPLACEMENTS = {"D1": "x", "D2": "y", "D3": "z"}
SECTION = ("FX", "FY", "FZ", "MX", "MY", "MZ")  # force, and moment about the centre of gravity of the section


def is_frd(content):
    return re.match(rb" {0,4}1C", content) is not None


def block(lines, what, columns, most=None):
    """(numbers of nodes, values) of the lines up to -3."""
    rows, found, first = [], [], lines.row
    while not (line := lines.need(f"-3, which ends the {what} of row {first}")).startswith(" -3"):
        if not line.startswith(" -1"):
            lines.refuse(f"expected a line of the {what}, which begins with -1")
        rows.append(lines.row)
        found.append(line)
    if most is not None and len(found) != most:
        lines.refuse(f"the {what} has {len(found)} lines; by its head there are {most}", first)
    ids = [lines.read(count, line[3:13], row=row) for row, line in zip(rows, found)]
    return np.array(ids, dtype=np.int64), lines.tables(rows, found, columns)


def head_of(lines, line, numbers):
    """(count, format) in the head of a block, whose columns end there."""
    return lines.read(count, line[numbers - 12:numbers]), lines.read(count, line[73:75])


def read_frd(path):
    """(numbers of nodes, coordinates, modes)"""
    lines, ids, points, modes, parameters = Lines(path), None, None, {}, {}
    while (line := lines.take()) is not None and not line.startswith(" 9999"):
        if line.startswith("    1P"):
            words = line[5:].split()
            parameters[words[0]] = words[1] if len(words) > 1 else ""
        elif line.startswith("    2C"):
            total, form = head_of(lines, line, 36)
            if form != LONG or ids is not None:
                lines.refuse("expected one block of nodes in the long ASCII format of ccx")
            ids, points = block(lines, "block of nodes", VALUES[:3], total)
        elif line.startswith("  100C"):
            read_result(lines, line, parameters, modes)
            parameters = {}
    if line is None:
        lines.refuse("the file ends here without 9999: it is cut off")
    if ids is None:
        lines.refuse_file("the file has no block of nodes")
    if not modes:
        lines.refuse_file("the file has no mode shapes; allowed: a step *FREQUENCY with *NODE FILE and U")
    return ids, points, list(modes.values())


def read_result(lines, line, parameters, modes):
    """One block of results; modes receives what belongs to a mode."""
    frequency = lines.read(number, line[12:24])
    total, form = head_of(lines, line, 36)
    kind, mode, head = lines.read(count, line[56:58]), lines.read(count, line[58:63]), lines.row
    if form != LONG:
        lines.refuse("the block is not in the long ASCII format of ccx")
    line = lines.need("-4, the name of the results")
    if not line.startswith(" -4"):
        lines.refuse("expected -4, the name of the results")
    name, components = line[5:13].strip(), []
    for _ in range(lines.read(count, line[13:18])):
        line = lines.need("-5, the name of a component")
        if not line.startswith(" -5"):
            lines.refuse("expected -5, the name of a component")
        if lines.read(count, line[33:38]) == 0:  # 1: is computed from the others, and is not in the file
            components.append(line[5:13].strip())
    if kind != MODAL or not components or len(components) > len(VALUES):
        return  # its lines are passed over
    if lines.read(integer, parameters.get("PHID", "-1")) > 0:
        lines.refuse("modes of cyclic symmetry are not read", head)
    ids, values = block(lines, f"block {name}", VALUES[:len(components)], total)
    mass = lines.read(number, parameters.get("PGM", "0"), row=head) or None
    found = modes.setdefault(mode, Mode(mode, frequency, mass, None, f"{lines.path}:{head}", {}))
    if name in found.fields or found.frequency != frequency:
        lines.refuse(f"a second {name} of mode {mode}; allowed: one step *FREQUENCY", head)
    found.fields[name] = Field([DISPLACEMENTS.get(one, one) for one in components], ids, values)


def add_sections(path, modes):
    """Adds the forces and moments of *SECTION PRINT in a .dat file to the modes, as the field SECTION."""
    lines, mode, found = Lines(path), None, {one.number: {} for one in modes}
    frequencies = {}
    while (line := lines.take()) is not None:
        words = line.split()
        if len(words) == 5 and words[0].isdecimal() and mode is None and "E" in words[1]:
            frequencies[lines.read(count, words[0])] = lines.read(number, words[3])
        elif line.split(" N U M B E R ")[0].strip() == "E I G E N V A L U E":
            mode = lines.read(count, line.split("N U M B E R")[-1])
            if mode not in found:
                lines.refuse(f"eigenvalue {mode} has no mode shape in the results file")
        elif words[:4] == ["statistics", "for", "surface", "set"] and mode is not None:
            name = " ".join(words[4:-3])
            if name in found[mode]:
                lines.refuse(f"a second section {name} of mode {mode}")
            found[mode][name] = section(lines)
    for one in modes:
        if one.number in frequencies and abs(frequencies[one.number] - one.frequency) > 1e-5 * abs(one.frequency):
            lines.refuse_file(f"mode {one.number} has {frequencies[one.number]:g} Hz here, {one.frequency:g} Hz in the "
                              "results file")
        names = list(found[one.number])
        if set(names) != set(found[modes[0].number]):
            lines.refuse_file(f"mode {one.number} has other sections than mode {modes[0].number}: the file is cut off")
        if names:
            one.fields["SECTION"] = Field(list(SECTION), np.array(names), np.array(list(found[one.number].values())))


def section(lines):
    """Force and moment after the line of a surface set."""
    values = []
    for title in ("total surface force", "moment about the center of gravity"):
        while title not in (line := lines.need(f"the {title}")):
            if "statistics" in line or "E I G E N" in line:
                lines.refuse(f"expected the {title}")
        while not (words := lines.need(f"the {title}").split()):
            pass
        if len(words) < 3:
            lines.refuse(f"expected three numbers of the {title}")
        values += list(lines.numbers(words[:3], lines.row))
    return values
