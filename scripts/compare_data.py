"""Several results files side by side: their names, the options in which they differ, and their peaks."""

import pathlib
from typing import NamedTuple

import numpy as np
from checked_results import in_one_line, opened
from engineering_units import shown
from picture_data import Results, place_in_words
from picture_model import Model
from picture_runs import SAME, SPAN, Runs, digits, engineering, sign_of, worst_over
from picture_track import wheel_paths
from traverse_report.language import capital
from traverse_report.quantities import QUANTITIES, with_factor

# Options about the file and the terminal, in which runs may differ without different results.
UNRELATED = ("output_file", "output_quiet", "options_file", "scene_name", "report_")
LONGEST_VALUE, MOST_NAMING = 28, 2  # letters of an option's value in a name; options in a name
# Peaks of /summary: the attribute, words, and the row of engineering_units.csv ('' for a ratio).
PEAKS = [("deflection", "greatest deflection", "deflection"),
         ("static_deflection", "static deflection there", "deflection"),
         ("amplification", "amplification of the deflection", ""),
         ("acceleration", "greatest acceleration of the bridge, unfiltered", "acceleration"),
         ("acceleration_lowpass", "greatest acceleration of the bridge, low-passed", "acceleration"),
         ("moment", "greatest bending moment", "moment"), ("shear", "greatest shear force", "force"),
         ("least_wheel_force", "least wheel force", "force"), ("greatest_wheel_force", "greatest wheel force", "force"),
         ("wheel_unloading", "greatest wheel unloading", ""), ("longest_loss", "longest loss of contact", "loss_time")]

# Rows of engineering_units.csv of options with a number; values of other options are shown as they are given.
KINDS = {"beam_EI": "bending_stiffness", "beam_EA": "axial_stiffness", "beam_GA": "axial_stiffness", "beam_mass": "mass_per_length",
         "beam_tension": "force", "foundation_vertical_k": "spring_stiffness", "foundation_longitudinal_k": "spring_stiffness",
         "foundation_rotational_k": "rotational_stiffness", "foundation_vertical_bed_k": "bed_stiffness",
         "support_stiffness": "spring_stiffness", "support_settlement": "displacement", "load_forces": "force",
         "train_speed": "speed", "load_speed": "speed"}

RAIL_PEAKS = [("tension", "greatest additional tension of the rails", "stress"),
              ("compression", "greatest additional compression of the rails", "stress")]


class Case(NamedTuple):
    """A results file of the comparison with its name."""
    path: pathlib.Path
    results: Results
    name: str


def opened_cases(paths):
    """Opens the files and names them; ValueError with the path at the first one that cannot be read."""
    paths, found = [pathlib.Path(path) for path in paths], []
    for path in paths:
        try:
            found.append(Results(opened(path)))
        except Exception as error:
            raise ValueError(f"{path}: {in_one_line(error)}") from None
    return [Case(*case) for case in zip(paths, found, names_of(paths, found))]


def differing(results):
    """{option: [its value in each file, '' where it is absent]} of the options in which the files differ."""
    names = sorted({name for one in results for name in one.options if not name.startswith(UNRELATED)})
    table = {name: [one.options.get(name, "") for one in results] for name in names}
    return {name: values for name, values in table.items() if len(set(values)) > 1}


def shown_option(name, text):
    """The value of an option with its engineering unit: '260 MN m²' of beam_EI 2.6e8."""
    try:
        value = float(text)
    except ValueError:
        return text
    if name not in KINDS:
        return text
    unit, factor = shown(KINDS[name])
    return f"{digits(factor * value)} {unit}"


def names_of(paths, results):
    """A name for each file: the values of the few options in which they differ, otherwise the name of the file."""
    table = {option: values for option, values in differing(results).items() if option != "limits"}
    rows = list(zip(*table.values()))
    short = table and len(table) <= MOST_NAMING and all(len(value) <= LONGEST_VALUE for row in rows for value in row)
    if short and len(set(rows)) == len(rows):
        return [", ".join(f"{name} {shown_option(name, value) or 'not given'}" for name, value in zip(table, row))
                for row in rows]
    stems = [path.stem for path in paths]
    names = stems if len(set(stems)) == len(stems) else [str(path) for path in paths]
    return names if len(set(names)) == len(names) else [f"{name} ({i})" for i, name in enumerate(names, 1)]


def peaks(cases):
    """[(words, unit, [value of each case], [its place in m])] of the peaks that at least two cases have, signed as in
    /summary."""
    found, nowhere = [], [np.nan] * len(cases)
    for attribute, words, kind in PEAKS:
        of = "deflection" if attribute in ("static_deflection", "amplification") else attribute
        places = [float(case.results.summary.get(f"{of}_place", np.nan)) for case in cases]
        unit, factor = engineering(kind)
        values = [factor * float(case.results.summary.get(attribute, np.nan)) for case in cases]
        if np.count_nonzero(~np.isnan(values)) > 1 and np.any(np.nan_to_num(values)):
            found.append((words, unit, values, places))
    for name, words, kind in RAIL_PEAKS:
        unit, factor = shown(kind)
        tables = [case.results.values(f"rail_forces/in_sequence/{name}") for case in cases]
        if sum(table is not None for table in tables) > 1:
            values = [np.nan if table is None else factor * float(table[0]) for table in tables]
            found.append((words, unit, values, nowhere))
    frequencies = [case.results.values("modes/frequency") for case in cases]
    if all(one is not None and len(one) for one in frequencies):
        found.append(("first natural frequency", "Hz", [float(one[0]) for one in frequencies], nowhere))
    return found


def front(results):
    """Positions of the first wheel or force over the samples, m; None if nothing moves forward."""
    if results.rows < 2:
        return None
    wheel = next(wheel_paths(results), None)
    if wheel is not None:
        place = wheel[2]
    else:
        model = Model(results)
        if "load" not in model.forces:
            return None
        place = np.array([model.forces_at(time, results.options)[0, 0] for time in results.time])
    return place if len(place) > 1 and np.all(np.diff(place) > 0.0) else None


def abscissa(cases):
    """(label, [x of each case]): the place of the first wheel or force if the speeds differ, otherwise the time."""
    speeds, fronts = {case.results.speed() for case in cases}, [front(case.results) for case in cases]
    if len(speeds) > 1 and all(place is not None for place in fronts):
        return "place of the first wheel or force (m)", fronts
    return "time (s)", [case.results.time for case in cases]


def station_curves(cases, name, kind):
    """(unit, place, [values over time, or None]) of a quantity of the probes, at the common probe with the greatest
    value; without a common probe at that of each case. None if fewer than two cases have it."""
    data = [case.results.over_time(case.results.file[f"probes/{name}"]) if f"probes/{name}" in case.results.file and
            case.results.rows > 1 else None for case in cases]
    known = [i for i, values in enumerate(data) if values is not None and values.size]
    if len(known) < 2:
        return None
    places = [set(np.round(cases[i].results.probes, 6)) for i in known]
    common = sorted(set.intersection(*places))
    unit, factor = shown(kind)

    def column(i, x):
        return int(np.argmin(np.abs(cases[i].results.probes - x)))

    if common:
        x = max(common, key=lambda x: max(np.abs(data[i][:, column(i, x)]).max() for i in known))
        words, at = place_in_words(x, cases[known[0]].results.supports), {i: column(i, x) for i in known}
    else:
        words, at = "the place of its greatest value", {i: int(np.abs(data[i]).max(axis=0).argmax()) for i in known}
    return unit, words, [factor * data[i][:, at[i]] if i in known else None for i in range(len(cases))]


def runs_over_x(cases):
    """[(quantity, unit, label of x, [(x, worst of all other axes, words) or None])] of the quantities and of the option
    along x that at least two sweeps or studies have; without those that are 0 in all runs, as losses of contact. The words
    name the factor of a limit that the values contain, if it is not the same in all files and therefore in the quantity.
    """
    runs = [Runs(case.results) if {"sweep", "study"} & set(case.results.file) else None for case in cases]
    known, found = [one for one in runs if one is not None], []
    if len(known) < 2:
        return []
    labels = [{axis.label() for axis in one.listed if axis.name != "train"} for one in known]
    common = set.intersection(*labels)
    if not common:
        return []
    label = next((one for one in sorted(common) if one.startswith("speed")), sorted(common)[0])
    for name in [name for name in QUANTITIES if name not in SAME]:
        lines = [None if one is None else worst_over(one, name, label) for one in runs]
        if sum(line is not None for line in lines) > 1 and any(line is not None and line[1].any() for line in lines):
            others = any(len(one.axes) > 1 for one in known)
            worst = "least" if sign_of(name) < 0.0 else "greatest"
            words = f", the {worst} over all other varied options" if others else ""
            factors = [1.0 if one is None else one.contained(name) for one in runs]
            drawn = {factor for factor, line in zip(factors, lines) if line is not None}
            common = factors[next(i for i, line in enumerate(lines) if line is not None)] if len(drawn) == 1 else None
            unit, by = next(one.unit(name) for one in known), 1.0
            if unit == SPAN:  # thousandths are readable, L/600 is no scale
                unit, by = "mm per m of the span", 1e3
            found.append((capital(with_factor(name, common or 1.0)) + words, unit, label,
                          [None if line is None else (line[0], by * line[1], f", × {factor:.5g}" if common is None else "")
                           for line, factor in zip(lines, factors)]))
    return found
