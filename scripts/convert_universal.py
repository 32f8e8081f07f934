"""Universal files (.unv, .uff): datasets 15 and 2411 (nodes), 55 and 2414 (mode shapes), 58 and 58b (records), 164
(units).

The Structural Dynamics Research Laboratory of the University of Cincinnati describes the datasets: each is between two
lines -1, and its first line is its number. The fields have the columns of Fortran's formats.
"""

import re
from typing import NamedTuple

import numpy as np
from convert_lines import LARGEST_VALUE, Lines, count, fields, integer, label
from convert_modes import Field, Mode
from convert_records import Channel, known_unit

WANTED = ("15", "55", "58", "58b", "164", "2411", "2414")
TEXT_RECORDS, HEAD_RECORDS = 5, 11  # lines of text of dataset 58; its lines before the data
RESPONSE, TIME, NO_TIME = 1, 17, 18  # function type; types of abscissas: time, frequency (0 is unknown)
# SI unit of a type of ordinates, and the exponents of length and force in it.
QUANTITIES = {2: ("Pa", -2, 1), 8: ("m", 1, 0), 9: ("N", 0, 1), 11: ("m/s", 1, 0), 12: ("m/s2", 1, 0), 13: ("N", 0, 1),
              15: ("Pa", -2, 1)}
FUNCTIONS = {2: "auto spectrum", 3: "cross spectrum", 4: "frequency response function", 6: "coherence",
             7: "auto correlation", 8: "cross correlation", 9: "power spectral density", 12: "spectrum"}
TIMES = {**dict.fromkeys(("", "none", "s", "sec", "second", "seconds"), 1.0), "ms": 1e-3, "min": 60.0}  # units, in s
DIRECTIONS = {1: "+X", 2: "+Y", 3: "+Z", 4: "+RX", 5: "+RY", 6: "+RZ"}
NORMAL, COMPLEX = 2, (3, 7)  # kinds of analyses with modes
SHAPES = {(8, 2): 3, (8, 3): 6}  # displacements, with rotations: (type, characteristic) and numbers at a node
LARGEST_IMAGINARY = 0.1  # of a complex shape turned to be real, relative to its real part


class Dataset(NamedTuple):
    kind: str
    row: int        # of the line with its number
    head: str       # this line
    lines: list
    data: bytes = b""  # of 58b

    def at(self, i):
        """The row of a line."""
        return self.row + 1 + i


class Units(NamedTuple):
    """SI units in units of the file, as dataset 164 has them."""
    length: float = 1.0
    force: float = 1.0


def is_universal(content):
    return re.match(rb"\s*-1\s*\n", content) is not None


def datasets(lines):
    """Yields the datasets that are read; the others are passed over."""
    while (line := lines.take()) is not None:
        if not line.strip():
            continue
        if line.strip() != "-1":
            lines.refuse("expected -1, which begins a dataset")
        head = lines.need("the number of a dataset")
        kind, row, found, data = (head.split() or [""])[0].lower(), lines.row, [], b""
        if kind == "58b":
            size = lines.read(count, head[31:43])
            if lines.read(count, head[19:31]) != HEAD_RECORDS:
                lines.refuse(f"58b with other than {HEAD_RECORDS} lines of text")
            found = [lines.need("a line of the head of 58b") for _ in range(HEAD_RECORDS)]
            data = lines.bytes(size, "the data")
            while not (line := lines.need("-1, which ends the dataset")).strip():
                pass
            if line.strip() != "-1":
                lines.refuse("expected -1, which ends the dataset: its head has another number of bytes than there are")
        else:
            while (line := lines.need(f"-1, which ends the dataset of row {row}")).strip() != "-1":
                if kind in WANTED:
                    found.append(line)
        if kind in WANTED:
            yield Dataset(kind, row, head, found, data)


def need_lines(lines, one, least):
    if len(one.lines) < least:
        lines.refuse(f"dataset {one.kind} has {len(one.lines)} lines; expected at least {least}", one.row)


def units_of(lines, one):
    """The factors of dataset 164, which convert SI units to those of the file."""
    need_lines(lines, one, 2)
    values = lines.numbers([cell for cell in fields(one.lines[1], 25) if cell.strip()], one.at(1))
    if len(values) < 2 or not np.all(values[:2] > 0.0):
        lines.refuse("expected the factors of length and force, above 0", one.at(1))
    return Units(*values[:2])


def channel_of(lines, one, units):
    """The record of a dataset 58, or the reason why it is none."""
    need_lines(lines, one, HEAD_RECORDS)
    texts = [label(line) for line in one.lines[:TEXT_RECORDS]]
    dof, form, abscissa, ordinate = one.lines[5:9]
    function = lines.read(integer, dof[:5], row=one.at(5))
    kind_of_x = lines.read(integer, abscissa[:10], row=one.at(7))
    where = f"row {one.row}, '{texts[0]}'"
    if function not in (0, RESPONSE) or kind_of_x >= NO_TIME or (function == 0 and kind_of_x != TIME):
        return f"{where}: {FUNCTIONS.get(function, f'function type {function}')} is no record over time"
    words = form.split()
    words = words if len(words) == 6 else [form[:10], form[10:20], form[20:30], *fields(form, 13, 30)]
    kind, total, even = (lines.read(count, word, row=one.at(6)) for word in words[:3])
    if kind not in (2, 4) or even not in (0, 1) or total < 2:
        lines.refuse(f"ordinates of type {kind}, {total} values, spacing {even}; allowed: types 2 and 4 (real), at least "
                     "2 values, spacing 0 or 1", one.at(6))
    first, step = lines.numbers(words[3:5], one.at(6)) if len(words) >= 5 else (0.0, 0.0)
    values = data_of(lines, one, kind, total, even)
    times = first + step * np.arange(total) if even else values[::2]
    if not np.all(np.diff(times) > 0.0):
        lines.refuse("the times do not increase", one.at(6))
    name, unit, factor = axis_of(lines, one, ordinate, units)
    place = lines.read(integer, dof[41:51], row=one.at(5)), lines.read(integer, dof[51:55], row=one.at(5))
    return Channel(name_of(label(dof[31:41]), *place, name, texts[0]), unit, times * time_factor(lines, one, abscissa),
                   factor * (values if even else values[1::2]), where)


def name_of(entity, node, direction, axis, text):
    """A name by what the head says: entity, node and direction of the response, or else its axis, or its first line."""
    signs = DIRECTIONS.get(abs(direction), "")
    signs = signs.replace("+", "-") if direction < 0 else signs
    words = [one for one in (entity, axis, text) if one and one.upper() != "NONE"][:1] or ["record"]
    return " ".join([*words, *([str(node)] if node and str(node) not in words[0] else []),
                     *([signs] if signs and signs not in words[0] else [])])


def data_of(lines, one, kind, total, even):
    """The numbers of the data: ordinates, or abscissas and ordinates in turns."""
    if one.kind == "58b":
        return binary_of(lines, one, kind, total, even)
    wanted, text = total * (1 if even else 2), one.lines[HEAD_RECORDS:]
    parts = [line.split() for line in text]
    if sum(map(len, parts)) != wanted:  # fields without blanks between them
        widths = (13,) if kind == 2 else (20,) if even else (13, 20)
        parts = [columns_of(line, widths) for line in text]
    words = [word for part in parts for word in part]
    if len(words) != wanted:
        lines.refuse(f"{len(words)} numbers; by its head the dataset has {wanted}", one.row)
    return lines.numbers(words, [one.at(HEAD_RECORDS + i) for i, part in enumerate(parts) for _ in part])


def columns_of(line, widths):
    """The fields of a line, whose widths alternate."""
    ends = np.cumsum(np.resize(widths, len(line.rstrip()) // min(widths) + 1))
    return [cell for first, end in zip([0, *ends], ends) if (cell := line[first:end]).strip()]


def binary_of(lines, one, kind, total, even):
    """The numbers of a dataset 58b: as in the text, with single precision or both for the abscissas."""
    order, form = (lines.read(count, one.head[at:at + 6], row=one.row) for at in (7, 13))
    if order not in (1, 2) or form != 2:
        lines.refuse(f"byte order {order}, format {form}; allowed: 1 or 2, and 2 (IEEE)", one.row)
    sign, value = "<>"[order - 1], "f4" if kind == 2 else "f8"
    allowed = [np.dtype(sign + value)] if even else [np.dtype([("x", sign + x), ("y", sign + value)])
                                                     for x in dict.fromkeys(("f4", value))]
    for dtype in allowed:
        if dtype.itemsize * total == len(one.data):
            found = np.frombuffer(one.data, dtype)
            found = found if even else np.column_stack([found["x"].astype(float), found["y"].astype(float)]).ravel()
            if not np.all(np.abs(found) <= LARGEST_VALUE):
                lines.refuse("the data have a value that is no finite number", one.row)
            return found.astype(float)
    expected = " or ".join(f"{dtype.itemsize * total:,}" for dtype in allowed)
    lines.refuse(f"{len(one.data):,} bytes of data; {total:,} values have {expected}", one.row)


def axis_of(lines, one, text, units):
    """(name, unit, factor) of the ordinates: by the label of their unit, or else in SI by type and dataset 164."""
    name, unit = label(text[26:46]), label(text[47:67])
    if known_unit(unit) or units is None:
        return name, known_unit(unit) or ("" if unit.upper() == "NONE" else unit), 1.0
    kind, length, force = (lines.read(integer, text[a:b], row=one.at(8)) for a, b in ((0, 10), (10, 15), (15, 20)))
    si, length, force = QUANTITIES.get(kind, ("", length, force))
    if max(abs(length), abs(force)) > 4:
        lines.refuse("expected exponents of length and force from -4 to 4", one.at(8))
    return name, si or unit, units.length**-length * units.force**-force


def time_factor(lines, one, text):
    unit = label(text[47:67]).lower()
    if unit not in TIMES:
        lines.refuse(f"the abscissa has the unit {unit}; allowed: s, ms, min", one.at(7))
    return TIMES[unit]


def read_records(path):
    """(channels, what is not read)"""
    lines, units = Lines(path), None
    sets = list(datasets(lines))
    for one in sets:
        if one.kind == "164":
            units = units_of(lines, one)
    found = [channel_of(lines, one, units) for one in sets if one.kind in ("58", "58b")]
    channels = [one for one in found if isinstance(one, Channel)]
    if not channels:
        lines.refuse_file("the file has no dataset 58 of a record over time" + "".join(f"; {one}" for one in found[:1]))
    return channels, [one for one in found if not isinstance(one, Channel)]


def nodes_of(lines, one, nodes):
    """Adds the nodes of a dataset 15 or 2411."""
    step = 2 if one.kind == "2411" else 1
    if len(one.lines) % step:
        lines.refuse("the last node has no coordinates", one.at(len(one.lines) - 1))
    for i in range(0, len(one.lines), step):
        head = one.lines[i]
        node, system, moved = (lines.read(count, head[at:at + 10], row=one.at(i)) for at in (0, 10, 20))
        if system > 1 or moved > 1:
            lines.refuse(f"node {node} is in the coordinate system {max(system, moved)}; allowed: the global one, 0 or 1",
                         one.at(i))
        words = one.lines[i + 1].split() if step == 2 else head[40:].split()
        if len(words) != 3:
            words = fields(one.lines[i + 1], 25) if step == 2 else fields(head, 13, 40)
        if node in nodes or len(words) != 3:
            lines.refuse(f"node {node} {'is given twice' if node in nodes else 'has no three coordinates'}", one.at(i))
        nodes[node] = lines.numbers(words, one.at(i + step - 1))


def mode_of(lines, one, modes):
    """Adds the shape of a dataset 55 or 2414; returns what it has if these are no displacements of a mode at nodes."""
    newer = one.kind == "2414"
    line = 8 if newer else 5  # that of the kinds of the data
    need_lines(lines, one, line + 5)
    _, analysis, characteristic, quantity, kind, size = lines.read(
        lambda text: [integer(text[at:at + 10]) for at in range(0, 60, 10)], one.lines[line], row=one.at(line))
    at_nodes = not newer or lines.read(integer, one.lines[2], row=one.at(2)) == 1
    if not at_nodes or analysis not in (NORMAL, *COMPLEX) or (quantity, characteristic) not in SHAPES:
        return f"row {one.row}: analysis {analysis}, characteristic {characteristic}, data {quantity} is no shape at nodes"
    if kind not in (2, 4, 5, 6) or size != SHAPES[quantity, characteristic]:
        lines.refuse(f"data type {kind} with {size} values; allowed: 2 or 5, and 3 or 6 values", one.at(line))
    number, frequency, mass, viscous, hysteretic, eigenvalue = modal_of(lines, one, newer, analysis)
    ratio = viscous or 0.5 * hysteretic
    if analysis != NORMAL:
        frequency, mass = abs(eigenvalue) / (2.0 * np.pi), 0.0
        ratio = max(-eigenvalue.real / abs(eigenvalue), 0.0) if eigenvalue else 0.0
    complex_ = kind in (5, 6)
    ids, values = shape_of(lines, one, size * (2 if complex_ else 1), 13 if newer else 8)
    if complex_:
        values = real_shape(lines, one, values[:, ::2] + 1j * values[:, 1::2])
    number = max(modes) + 1 if number in modes else number
    modes[number] = Mode(number, frequency, mass or None, ratio or None, f"{lines.path}:{one.row}",
                         {"DISP": Field(["x", "y", "z", "rx", "ry", "rz"][:values.shape[1]], ids, values)})
    return None


def modal_of(lines, one, newer, analysis):
    """(number, frequency, mass, viscous damping ratio, hysteretic one, eigenvalue) in the head of a mode."""
    def reals(i, least):
        found = lines.numbers(spaced(one.lines[i], 13), one.at(i))
        if len(found) < least:
            lines.refuse(f"{len(found)} numbers about the mode; expected {least}", one.at(i))
        return found

    place = (9, 50) if newer else (6, 30)
    number = lines.read(integer, one.lines[place[0]][place[1]:place[1] + 10], row=one.at(place[0]))
    if newer:
        values, pair = reals(11, 6), reals(12, 2)
        return number, values[1], *values[3:6], complex(*pair[:2])
    if analysis == NORMAL:
        return number, *reals(7, 4)[:4], 0j
    return number, 0.0, 0.0, 0.0, 0.0, complex(*reals(7, 2)[:2])


def spaced(line, width):
    """The fields of a line, with or without blanks between them."""
    words, cut = line.split(), [cell for cell in fields(line, width) if cell.strip()]
    return words if len(words) >= len(cut) else cut


def shape_of(lines, one, size, i):
    """(numbers of nodes, values) in the lines from i on."""
    ids, words, rows = [], [], []
    while i < len(one.lines):
        ids.append(lines.read(count, one.lines[i], row=one.at(i)))
        first, found = i, []
        while len(found) < size and i + 1 < len(one.lines):
            i += 1
            found += spaced(one.lines[i], 13)
        if len(found) != size:
            lines.refuse(f"node {ids[-1]} has {len(found)} values; expected {size}", one.at(first))
        words += found
        rows += [one.at(first + 1)] * size
        i += 1
    return np.array(ids, dtype=np.int64), lines.numbers(words, rows).reshape(len(ids), size)


def real_shape(lines, one, shape):
    """A complex shape turned so that its imaginary part is least; refused if this part remains."""
    angle = 0.5 * np.angle(np.sum(shape**2))
    shape = shape * np.exp(-1j * angle)
    rest, whole = np.linalg.norm(shape.imag), np.linalg.norm(shape.real)
    if not rest <= LARGEST_IMAGINARY * whole:
        lines.refuse(f"the shape is complex: its imaginary part is {rest / whole if whole else np.inf:.2g} of the real part; "
                     f"allowed: up to {LARGEST_IMAGINARY}, modes of proportional damping", one.row)
    return shape.real


def read_modes(path):
    """(numbers of nodes, coordinates, modes, units, what is not read)"""
    lines, nodes, modes, units, passed = Lines(path), {}, {}, None, []
    for one in datasets(lines):
        if one.kind == "164":
            units = units_of(lines, one)
        elif one.kind in ("15", "2411"):
            nodes_of(lines, one, nodes)
        elif one.kind in ("55", "2414"):
            passed.append(mode_of(lines, one, modes))
    passed = [one for one in passed if one]
    if not modes or not nodes:
        missing = "15 or 2411 with nodes" if modes else "55 or 2414 with shapes of modes"
        lines.refuse_file(f"the file has no dataset {missing}" + "".join(f"; {one}" for one in passed[:1]))
    return np.array(list(nodes), dtype=np.int64), np.array(list(nodes.values())), list(modes.values()), units, passed
