"""A results file for the report: a single run, or a table of runs with varied options and results."""

import pathlib
import re

import h5py
import numpy as np
from picture_data import Results
from picture_model import Model


class ReportError(Exception):
    """The reason why the report fails, in one line."""


# Name in the file: description, unit in the report, and the factor to this unit.
QUANTITIES = {
    "peak_deflection": ("greatest deflection", "mm", 1e3),
    "peak_acceleration": ("greatest deck acceleration, unfiltered", "m/s²", 1.0),
    "deck_acceleration": ("greatest deck acceleration, low-passed", "m/s²", 1.0),
    "peak_moment": ("greatest bending moment", "kN m", 1e-3),
    "amplification": ("amplification at the greatest deflection", "", 1.0),
    "least_wheel_force": ("least wheel force", "kN", 1e-3),
    "greatest_wheel_force": ("greatest wheel force", "kN", 1e-3),
    "longest_loss": ("longest loss of contact", "ms", 1e3),
    "end_rotation": ("greatest rotation at the bridge's ends", "mrad", 1e3),
    "joint_rotation": ("greatest rotation between two decks", "mrad", 1e3),
    "car_acceleration": ("greatest vertical acceleration of car bodies", "m/s²", 1.0),
    "wheel_unloading": ("greatest wheel unloading, unfiltered", "", 1.0),
    "filtered_wheel_unloading": ("greatest wheel unloading, low-passed", "", 1.0),
    "unloading_time": ("longest time of unloading, low-passed", "ms", 1e3),
}
PARAMETERS = {"speed": ("speed", "km/h", 3.6), "seed": ("seed", "", 1.0)}


def parameter_words(name):
    """The name of a varied option, its unit and the factor to this unit."""
    for end, words in PARAMETERS.items():
        if name.endswith(end):
            return (words[0] if name in ("train_speed", "load_speed", "speed") else name, words[1], words[2])
    return name, "", 1.0


def number(value):
    return f"{value:.0f}" if value == round(value) and abs(value) < 1e5 else digits(value)


def digits(value):
    """A number with four significant digits, without an exponent if possible."""
    short = f"{value:.4g}"
    return f"{value:,.0f}" if "e" in short and 1e4 <= abs(value) < 1e6 else re.sub(r"e\+?(-?)0*", r"e\1", short)


class Runs:
    """The runs of a sweep or a study. values: name -> [runs] or [runs, probes]; NaN without a result."""

    def __init__(self, parameters, values, probes, static, over=(), units=None):
        self.parameters, self.values, self.probes, self.static = parameters, values, probes, static
        self.units = units or {}
        self.places = {}  # stations of quantities with one value per run
        self.count = len(next(iter(parameters.values())))
        varied = {name: column for name, column in parameters.items() if len(np.unique(column)) > 1}
        self.over = [name for name in over if name in varied]
        rest = {name: column for name, column in varied.items() if name not in self.over}
        speeds = [name for name in rest if name.endswith("speed")]
        longest = sorted(rest, key=lambda name: -len(np.unique(rest[name])))
        trains = [name for name in longest if name != "hslm_a"]
        self.x_name = (speeds or trains or [None])[0]
        self.line_names = [name for name in rest if name != self.x_name]

    @property
    def finished(self):
        known = self.values["peak_deflection"]
        return ~np.isnan(known.reshape(self.count, -1)).any(axis=1)

    def x(self):
        name, unit, factor = parameter_words(self.x_name)
        label = "speed" if self.x_name.endswith("speed") else name
        unit = unit or self.unit(self.x_name)
        return factor * self.parameters[self.x_name], f"{label} ({unit})" if unit else label

    def unit(self, name):
        """The unit of a varied option in the file."""
        return self.units.get(name, "").replace("2", "²").replace("3", "³") if self.units.get(name) != "1" else ""

    def lines_in_words(self):
        """The varied options of the lines, in the order of the numbers in their names."""
        units = {name: parameter_words(name)[1] or self.unit(name) for name in self.line_names}
        return ", ".join("train" if name == "hslm_a" else f"{name} ({units[name]})" if units[name] else name
                         for name in self.line_names)

    def line_name(self, run):
        parts = []
        for name in self.line_names:
            value = self.parameters[name][run]
            said, unit, factor = parameter_words(name)
            unit = unit or self.unit(name)
            said = "" if len(self.line_names) == 1 and unit else f"{said} "
            parts.append(f"A{value:.0f}" if name.endswith("hslm_a") else f"{said}{number(factor * value)} {unit}".strip())
        return ", ".join(parts) or "all runs"

    def curve_name(self, run):
        """A short name for a picture with lines_in_words in its heading: only the values of several options."""
        if len(self.line_names) < 2:
            return self.line_name(run)
        return ", ".join(f"A{self.parameters[name][run]:.0f}" if name.endswith("hslm_a") else
                         number(parameter_words(name)[2] * self.parameters[name][run]) for name in self.line_names)

    def lines(self):
        """(name, indices of its runs by ascending x) of each drawn line, with all values of `over` together."""
        groups = {}
        for run in range(self.count):
            groups.setdefault(tuple(self.parameters[name][run] for name in self.line_names), []).append(run)
        order = self.parameters[self.x_name] if self.x_name else np.arange(self.count)
        return [(self.line_name(runs[0]), np.array(sorted(runs, key=lambda run: order[run])))
                for runs in groups.values()]

    def of_run(self, name):
        """One value per run: the largest of its probes (for amplifications that at the largest deflection)."""
        values = np.abs(self.values[name])
        if values.ndim == 1:
            return values
        if name == "amplification":
            deflection = np.nan_to_num(np.abs(self.values["peak_deflection"]))
            found = values[np.arange(self.count), deflection.argmax(axis=1)]
            return np.where(found > 0.0, found, np.nan)
        return values.max(axis=1)

    def place(self, name, run):
        """The station of this value."""
        if name in self.places:
            station = float(self.places[name][run])
            return None if np.isnan(station) else station
        values = self.values["peak_deflection" if name == "amplification" else name]
        stations = self.probes[run] if self.probes.ndim == 2 else self.probes
        return None if values.ndim == 1 else float(stations[int(np.nanargmax(np.abs(values[run])))])

    def run_in_words(self, run):
        """The name of a run: 'A10, 344 km/h'."""
        name = self.line_names[0] if len(self.line_names) == 1 and not self.line_names[0].endswith("hslm_a") else ""
        parts = [f"{name} {self.line_name(run)}".strip()] if self.line_names else []
        for name in ([self.x_name] if self.x_name else []) + self.over:
            said, unit, factor = parameter_words(name)
            said = "" if unit == "km/h" else f"{said} "
            parts.append(f"{said}{number(factor * self.parameters[name][run])} {unit}".strip())
        return ", ".join(parts)


class Source:
    """One results file with the data of all pages."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        try:
            self.file = h5py.File(path, "r", locking=False)
        except OSError:
            raise ReportError(f"{path} is no results file that can be read") from None
        if self.file.attrs.get("program") != "traverse":
            raise ReportError(f"{path} is no results file of traverse")
        self.results = Results(self.file)
        self.model = Model(self.results)
        self.summary, self.options = self.results.summary, self.results.options
        self.runs = None
        if "sweep/speed" in self.file:
            self.runs = self._sweep()
        elif "study/finished" in self.file:
            self.runs = self._study()
        self.is_run = self.runs is None and "probes/deflection" in self.file and self.results.rows > 0
        self.is_rail = "rail_forces/x" in self.file
        if self.runs is None and not self.is_run and not self.is_rail:
            raise ReportError(f"{path} holds neither a run over a bridge nor a sweep or a study, nor forces of the rails: "
                              "nothing to report on")

    def _judged(self, runs):
        """Adds the values of quantities with limits, one per run."""
        columns, places = runs.values.pop("judged", None), runs.values.pop("judged_x", None)
        if columns is None or "verdicts/quantity" not in self.file:
            return runs
        for i, (quantity, _) in enumerate(self.file["verdicts/quantity"].asstr()[:]):
            if quantity not in runs.values and not np.isnan(columns[:, i]).all():
                runs.values[quantity], runs.places[quantity] = columns[:, i], places[:, i]
        return runs

    def _sweep(self):
        group = self.file["sweep"]
        speed, trains = group["speed"][:], group["hslm_a"][:] if "hslm_a" in group else np.zeros(1)
        shape = (len(trains), len(speed))
        parameters = {"speed": np.tile(speed, len(trains))}
        if "hslm_a" in group:
            parameters["hslm_a"] = np.repeat(trains, len(speed))
        values = {}
        for name, data in group.items():
            if data.shape[:2] == shape and not name.endswith("_time"):
                values[name] = data[:].reshape(len(trains) * len(speed), *data.shape[2:])
        static = np.repeat(group["static_deflection"][:], len(speed), axis=0)
        return self._judged(Runs(parameters, values, self.file["probes/x"][:], static))

    def _study(self):
        group = self.file["study"]
        names = str(group.attrs["dimensions"]).split(",")
        parameters = {name.replace("sweep_hslm_a", "hslm_a").replace("load_hslm_a", "hslm_a"): group[name][:]
                      for name in names}
        skipped = set(names) | {"shape", "finished", "row_digest", "probes_x", "static_deflection", "statistics"}
        values = {name: data[:] for name, data in group.items()
                  if name not in skipped and not name.endswith("_time") and hasattr(data, "shape")}
        kept = set(group["statistics"]) if "statistics" in group else set(names)
        over = [name for name in parameters if name not in kept and name in names]
        units = {name: str(group[name].attrs.get("unit", "1")) for name in names}
        return self._judged(Runs(parameters, values, group["probes_x"][:], group["static_deflection"][:], over, units))

    def title(self):
        return self.results.scene()

    def kind_in_words(self):
        if self.is_rail:
            return "forces between rail and bridge, UIC 774-3"
        if self.is_run:
            speed = self.results.speed()
            return f"one run at {3.6 * speed:.4g} km/h" if speed else "one run"
        runs = self.runs
        parts = []
        for name in runs.line_names + ([runs.x_name] if runs.x_name else []) + runs.over:
            values, (said, unit, factor) = np.unique(runs.parameters[name]), parameter_words(name)
            if name.endswith("hslm_a"):
                parts.append(f"trains A{values[0]:.0f} to A{values[-1]:.0f} of HSLM-A")
            else:
                many = f"{len(values)} speeds" if said == "speed" else f"{len(values)} values of {said}"
                parts.append(f"{many} from {number(factor * values[0])} to "
                             f"{number(factor * values[-1])} {unit}".strip())
        done = int(runs.finished.sum())
        missing = "" if done == runs.count else f"; {runs.count - done} of the runs have not ended"
        return f"{runs.count:,} runs: {', '.join(parts)}{missing}" if parts else f"{runs.count} run{missing}"

    def train_in_words(self):
        model = self.model
        if self.is_rail:
            return f"a train at {len(self.file['rail_forces/front'])} places"
        if len(model.train):
            names = [model.type_name(index) for index, _ in model.train]
            counted = []
            for name in names:
                if counted and counted[-1][0] == name:
                    counted[-1][1] += 1
                else:
                    counted.append([name, 1])
            said = ", ".join(name if count == 1 else f"{count} × {name}" for name, count in counted)
            return said
        names = [name for name in model.forces if name != "load"]
        if names:
            return f"trains {names[0]} to {names[-1]} of HSLM-A" if len(names) > 1 else f"train {names[0]} of HSLM-A"
        if "load_hslm_a" in self.options:
            return f"train A{self.options['load_hslm_a']} of HSLM-A"
        if "train_vehicles" in self.options:
            return self.options["train_vehicles"]
        count = len(model.forces.get("load", ()))
        return f"{count} moving forces" if count else "nothing that moves"
