"""Tables of a results file for export.py: columns with the names and units of the file as heads."""

import export_answers
import h5py
import numpy as np

OVER_TIME = ("probes", "vehicles", "couplers", "supports", "foundation", "rail", "balance", "energy", "outputs")
OVER_RUNS = {"study": "study/finished", "study/statistics": None, "separations": None, "passages": None, "resonances": None,
             "cancellations": None, "envelope": "probes/x", "shape": "shape/x"}
ALONG_RAIL = {"stress": ("x", ("least_stress", "greatest_stress")), "slip": ("sleeper_x", ("least_slip", "greatest_slip")),
              "bearings": ("bearing_x", ("bearing",)), "devices": ("device_x", ("opening",))}  # tables of /rail_forces
RAIL_PEAKS = ("tension", "compression", "slip", "end")
PLACES = ("x", "gap")  # datasets with the positions of columns
IN_PLANE, FORCES = ("x", "y", "angle"), ("fx", "fy", "moment")
SIDES = ("least", "greatest")


class Table:
    """Columns of equal length, each with its name and its unit."""

    def __init__(self):
        self.heads, self.columns = [], []

    def add(self, name, unit, values):
        self.heads.append(f"{name} ({unit})" if unit not in ("", "text") else name)
        self.columns.append(values)

    def rows(self):
        return zip(*self.columns)


def datasets(file, name):
    """Names of the dataset, or of all datasets in the group; statistics of a study are a separate group."""
    if name not in file:
        return []
    if isinstance(file[name], h5py.Dataset):
        return [name]
    found = []
    file[name].visititems(lambda part, item: found.append(f"{name}/{part}") if isinstance(item, h5py.Dataset) else None)
    return [one for one in found if name == "study/statistics" or not one.startswith("study/statistics/")]


def series_names(file):
    """Names of all time series."""
    if "time" not in file:
        return []
    return [name for group in OVER_TIME for name in datasets(file, group) if name.rsplit("/", 1)[-1] not in PLACES]


def names(file):
    """Names of all time series and of the other tables."""
    others = ["sweep", *OVER_RUNS]
    return (series_names(file) + [name for name in others if datasets(file, name)] + profile_names(file) +
            rail_names(file) + list(export_answers.tables(file)))


def profile_names(file):
    """Names of the running surfaces of output_profile."""
    of_trains = [f"track/profile_of/{train}" for train in file.get("track/profile_of", ())]
    return [name for name in ["track/profile", *of_trains] if name in file]


def rail_names(file):
    """Names of the tables of scene_analysis rail."""
    if "rail_forces" not in file:
        return []
    along = [name for name, (at, _) in ALONG_RAIL.items() if at in file["rail_forces"]]
    return [f"rail_forces/{name}" for name in [*along, "peaks"]]


def units(dataset):
    """The unit of a dataset, or one unit for each index of its last axis."""
    return str(dataset.attrs.get("unit", "")).split(", ")


def places(file, name, count):
    """The positions of columns as text, for the axis after the time."""
    group = name.rsplit("/", 1)[0]
    if f"{group}/gap" in file:
        return [f"behind vehicle {int(gap)}" for gap in file[f"{group}/gap"][:]]
    if group.endswith("_bed"):
        return [f"on span {i + 1}" for i in range(count)]
    if group in ("separations", "passages"):
        return ["vehicle", "name"]
    stations = file[f"{group}/x"] if f"{group}/x" in file else file.get("probes/x", ())
    if len(stations) == count and group != "study":
        return [f"at {x:.10g} m" for x in stations[:]]
    return [f"at probe {i + 1}" for i in range(count)]


def across(file, name, shape):
    """(text, unit, index) of every column of a dataset with rows of this shape."""
    dataset = file[name]
    given, last = units(dataset), name.rsplit("/", 1)[-1]
    if not shape:
        return [("", given[0], ())]
    if shape[-1] == len(given) > 1:  # components
        words = IN_PLANE if last in ("position", "velocity", "acceleration") or len(given) == 2 else FORCES
        before = places(file, name, shape[0]) if len(shape) == 2 else [""]
        return [(f" {words[k]} {before[index[0]] if len(shape) == 2 else ''}".rstrip(), given[k], (*index, k))
                for index in np.ndindex(shape[:-1]) for k in range(shape[-1])]
    if name.startswith("envelope/") and shape == (2,):
        return [(f" {side}", given[0], (k,)) for k, side in enumerate(SIDES)]
    if "judged" in last and "verdicts/quantity" in file:
        judged = [f"limit {i + 1} {quantity} by {clause}" for i, ((quantity, _), (clause, _)) in enumerate(zip(
            file["verdicts/quantity"].asstr()[:], file["verdicts/clause"].asstr()[:]))]
        of_limits = file["verdicts/quantity"].asstr()[:, 1] if not last.startswith("judged_x") else ["m"] * shape[0]
        return [(f" {judged[index[0]]}{deeper_words(index[1:])}", of_limits[index[0]], index)
                for index in np.ndindex(shape)]
    where = places(file, name, shape[0])
    unit = given[0] if len(set(given)) == 1 else ""
    return [(f" {where[index[0]]}{deeper_words(index[1:])}", unit, index) for index in np.ndindex(shape)]


def deeper_words(index):
    """The indices of further axes as text, from 0."""
    return " [" + ",".join(map(str, index)) + "]" if index else ""


def add_dataset(table, file, name, values):
    """Adds the columns of a dataset; values[rows, ...]."""
    for words, unit, index in across(file, name, values.shape[1:]):
        table.add(name + words, unit, values[(slice(None), *index)])


def read(dataset):
    return dataset.asstr()[()] if h5py.check_string_dtype(dataset.dtype) else dataset[()]


def over_time(file, chosen):
    table, rows = Table(), len(file["time"])
    table.add("time", *units(file["time"]), file["time"][:])
    for name in chosen:
        add_dataset(table, file, name, file[name][:rows])
    return table


def of_sweep(file):
    """A table with a row for every train and speed; values that are common to all speeds of a train are repeated."""
    speed = file["sweep/speed"][:]
    trains = file["sweep/peak_deflection"].shape[0] if "sweep/peak_deflection" in file else 1
    numbers = file["sweep/hslm_a"][:] if "sweep/hslm_a" in file else np.arange(trains) + 1
    table = Table()
    table.add("train", "", np.repeat(numbers, len(speed)).astype(int))
    table.add("sweep/speed", *units(file["sweep/speed"]), np.tile(speed, trains))
    for name in datasets(file, "sweep"):
        if name.rsplit("/", 1)[-1] in ("speed", "hslm_a", *PLACES):
            continue
        values = file[name][()]
        if values.ndim == 1:
            values = np.tile(values, (trains, 1))
        elif name == "sweep/static_deflection":
            values = np.repeat(values[:, None], len(speed), axis=1)
        add_dataset(table, file, name, values.reshape(trains * len(speed), *values.shape[2:]))
    return table


def over_runs(file, group):
    """A table with a row for each run, station or event of the group."""
    found, first = datasets(file, group), OVER_RUNS[group]
    lengths = [file[name].shape[0] for name in found if file[name].ndim]
    rows = len(file[first]) if first else max(lengths, key=lengths.count)
    table = Table()
    if first and first not in found:
        table.add(first, *units(file[first]), file[first][:])
    for name in found:
        if file[name].ndim and file[name].shape[0] == rows and name != "study/shape":
            add_dataset(table, file, name, read(file[name]))
    return table


def of_profile(file, name):
    """A table that track_profile can read."""
    table = Table()
    for column in ("x", "height"):
        table.add(column, *units(file[name][column]), file[name][column][:])
    return table


def of_rail(file, name):
    """A table of all cases along the track, or of the peaks: one row per case, with position and front of the train."""
    group, table = file["rail_forces"], Table()
    cases = [case for case in group if isinstance(group[case], h5py.Group)]
    if name == "rail_forces/peaks":
        table.add("case", "text", cases)
        for peak in RAIL_PEAKS:
            for i, (words, unit) in enumerate(zip(("", ", x", ", train's front"), units(group[cases[0]][peak]))):
                table.add(peak + words, unit, [group[case][peak][i] for case in cases])
        return table
    at, quantities = ALONG_RAIL[name.rsplit("/", 1)[-1]]
    table.add("x", *units(group[at]), group[at][:])
    for case in cases:
        for quantity in quantities:
            table.add(f"{case}/{quantity}", *units(group[case][quantity]), group[case][quantity][:])
    return table


def table_of(file, name):
    """The table of a series, of all series in a group, of the sweep or the study; ValueError if there is none."""
    name = name.strip("/")
    if name == "sweep" or name.startswith("sweep/") and name in file:
        return of_sweep(file)
    if name in OVER_RUNS and datasets(file, name):
        return over_runs(file, name)
    if name in profile_names(file):
        return of_profile(file, name)
    if name in rail_names(file):
        return of_rail(file, name)
    if write := export_answers.tables(file).get(name):
        table = Table()
        write(file, table.add)
        return table
    chosen = [one for one in series_names(file) if one == name or one.startswith(f"{name}/")]
    if not chosen:
        raise ValueError(f"no series or table {name}; --list names what there is")
    return over_time(file, chosen)
