"""A results file for the report: a single run, or a table of runs with varied options and results."""

import pathlib

import checked_results
import numpy as np
import search_answers
from engineering_units import printed, shown
from option_words import WORDS, option_in_words
from picture_data import Results
from picture_hanging import on_ropes
from picture_model import Model

from . import hslm
from .language import number, t
from .quantities import with_factor


# Rows of engineering_units.csv for varied options of these units.
OF_OPTION = {"N m2": "bending_stiffness", "kg/m": "mass_per_length", "N/m": "spring_stiffness", "N/m2": "bed_stiffness",
             "N m/rad": "rotational_stiffness", "N s/m": "damping", "kg": "mass"}


class ReportError(Exception):
    """The reason why the report fails, in one line."""


def parameter_words(name, unit=""):
    """The name of a varied option, its unit for print and the factor from the unit of the file to this one."""
    if name.endswith("speed"):
        return (t("speed") if name in ("train_speed", "load_speed", "speed") else name, *shown("speed"))
    said = t(WORDS[name]) if name in WORDS else t("seed") if name.endswith("seed") else option_in_words(name)
    return (said, *shown(OF_OPTION[unit])) if unit in OF_OPTION else (said, printed(unit) if unit != "1" else "", 1.0)


class Runs:
    """The runs of a sweep or a study. values: name -> [runs] or [runs, probes]; NaN without a result."""

    def __init__(self, parameters, values, probes, static, over=(), units=None):
        self.parameters, self.values, self.probes, self.static = parameters, values, probes, static
        self.units = units or {}
        self.places, self.factors = {}, {}  # of judged quantities: one station per run, and the factor of the limit
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
    def is_over_speed(self):
        return self.x_name is not None and self.x_name.endswith("speed")

    @property
    def finished(self):
        known = self.values["peak_deflection"]
        return ~np.isnan(known.reshape(self.count, -1)).any(axis=1)

    def words(self, name):
        """The name of a varied option, its unit for print and the factor to it."""
        return parameter_words(name, self.units.get(name, ""))

    def quantity_in_words(self, name):
        """A quantity with the factor of its limit that its values in the file contain."""
        return with_factor(name, self.factors.get(name, 1.0))

    def x(self):
        name, unit, factor = self.words(self.x_name)
        return factor * self.parameters[self.x_name], f"{name} ({unit})" if unit else name

    def lines_in_words(self):
        """The varied options of the lines, in the order of the numbers in their names."""
        found = [(name, *self.words(name)[:2]) for name in self.line_names]
        return ", ".join(t("train") if name == "hslm_a" else f"{said} ({unit})" if unit else said
                         for name, said, unit in found)

    def value(self, name, run):
        """The value of a varied option in a run with its unit: 'A10', '250 km/h'."""
        _, unit, factor = self.words(name)
        value = factor * self.parameters[name][run]
        if name.endswith("hslm_a"):
            return f"A{value:.0f}"
        return f"{value:.0f}" if name.endswith("seed") else f"{number(value)} {unit}".strip()

    def named_value(self, name, run):
        """The same with the name of the option, which trains and speeds do not need."""
        obvious = name.endswith(("hslm_a", "speed"))
        return self.value(name, run) if obvious else f"{self.words(name)[0]} {self.value(name, run)}"

    def line_name(self, run):
        if len(self.line_names) == 1 and self.words(self.line_names[0])[1]:
            return self.value(self.line_names[0], run)
        return ", ".join(self.named_value(name, run) for name in self.line_names) or t("all runs")

    def curve_name(self, run):
        """A short name for a picture with lines_in_words in its heading: only the values of several options."""
        if len(self.line_names) < 2:
            return self.line_name(run)
        return ", ".join(self.value(name, run).split(" ")[0] for name in self.line_names)

    def run_in_words(self, run):
        """The name of a run: 'A10, 344 km/h'."""
        names = self.line_names + ([self.x_name] if self.x_name else []) + self.over
        return ", ".join(self.named_value(name, run) for name in names)

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


def opened(path):
    try:
        return checked_results.opened(path)
    except checked_results.ResultsError as error:
        raise ReportError(f"{path} {error}") from None


class Source:
    """One results file with the data of all pages. line: a flow_chart.Line, or None if it is unknown."""

    def __init__(self, path, line=None):
        self.line, self.governing = line, None  # the source of the governing run of a sweep or study
        self.least_bearing = None  # uplift.Bearing: the least bearing force over time of all its runs
        self.compared = []  # the sources of all files of the report
        self.replaced, self.cross_section = {}, None  # options report_... of the command line, and a picture
        self.path = pathlib.Path(path)
        self.file = opened(path)
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
        self.hslm_trains = self._hslm_trains()
        self.is_run = self.runs is None and "probes/deflection" in self.file and self.results.rows > 0
        self.is_rail = "rail_forces/x" in self.file
        self.is_search, self.is_sensitivity = "find/ratio" in self.file, "sensitivity/units" in self.file
        self.is_static = self.runs is None and not self.is_run and not self.is_rail and "static/x" in self.file
        self.is_dynamic = self.runs is not None or self.is_run
        self.is_fit, self.is_screen = "fit/estimate" in self.file, "screen/ratio" in self.file
        self.is_crane = self._is_crane()
        of_one_structure = self.is_dynamic or self.is_rail or self.is_static
        self.is_verification = of_one_structure and not self.is_crane  # by the norms of railway bridges
        if not of_one_structure and not self.is_fit and not self.is_screen:
            raise ReportError(f"{path} holds neither a run over a bridge nor a sweep or a study, nor static effects, "
                              "nor forces of the rails, nor a fit or a screen: nothing to report on")

    def _is_crane(self):
        """Whether a vehicle carries a load on ropes, as no train does."""
        return any(True for kind in np.unique(self.model.train[:, 0])
                   for _ in on_ropes(self.results, self.model, kind))

    def _hslm_trains(self):
        """{name: [axles, 2], places in m and forces in N} of all trains HSLM-A of the runs or of static effects. The
        model of a study has those of its first run only, without a name."""
        forces = self.model.forces
        named = {name: data for name, data in forces.items() if name != "load"}
        if not named and self.runs is not None and "hslm_a" in self.runs.parameters:
            return {hslm.name_of(number): hslm.forces_of(number) for number in np.unique(self.runs.parameters["hslm_a"])}
        if not named and "load_hslm_a" in self.options:
            alone = int(self.options["load_hslm_a"])
            return {hslm.name_of(alone): forces.get("load", hslm.forces_of(alone))}
        return named

    def judged_factors(self):
        """[(quantity, factor of its limit)] of the quantities that were judged with limits."""
        if "verdicts/quantity" in self.file:
            names = self.file["verdicts/quantity"].asstr()[:, 0]
            factors = self.file["verdicts/factor"][:] if "verdicts/factor" in self.file else np.ones(len(names))
            return list(zip(names, map(float, factors)))
        if "criterion" not in self.file:
            return []
        given = search_answers.factors_of(self.results)
        return [(name, given.get(name, 1.0)) for name in self.file["criterion"].asstr()[:]]  # of a search

    def _judged(self, runs):
        """Adds the values of quantities with limits, one per run."""
        columns, places = runs.values.pop("judged", None), runs.values.pop("judged_x", None)
        for i, (quantity, factor) in enumerate(self.judged_factors() if columns is not None else ()):
            if quantity not in runs.values and not np.isnan(columns[:, i]).all():
                runs.values[quantity], runs.places[quantity] = columns[:, i], places[:, i]
                runs.factors[quantity] = factor
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
        over += self.file["factor"].asstr()[:].tolist() if "factor" in self.file else []
        units = {name: str(group[name].attrs.get("unit", "1")) for name in names}
        return self._judged(Runs(parameters, values, group["probes_x"][:], group["static_deflection"][:], over, units))

    def static_loads(self):
        """The names of the trains and load models with static effects."""
        return [name for name, _ in self.file["static/load"].asstr()[:]] if "static/load" in self.file else []

    def load_models(self):
        """{name of a load model with static effects: its classification factor alpha}, without the trains."""
        if "norm" not in self.file or "static/load" not in self.file:
            return {}
        clauses = [clause for _, clause in self.file["static/load"].asstr()[:]]
        alpha = self.file["static/alpha"][:] if "static/alpha" in self.file else \
            np.full(len(clauses), float(self.file["norm"].attrs.get("alpha", 1.0)))
        return {name: float(factor) for name, clause, factor in zip(self.static_loads(), clauses, alpha) if clause}

    def title(self):
        return self.options.get("report_structure") or self.results.scene()

    def is_estimated(self, *options):
        """Whether a fit estimates one of these options."""
        return self.is_fit and not set(options).isdisjoint(self.file["unknown"].asstr()[:])

    def _fit_in_words(self):
        frequencies = len(self.file["fit/frequencies/measured"]) if "fit/frequencies" in self.file else 0
        values = sum(len(group["time"]) for group in self.file.get("fit/series", {}).values())
        return t("fit to measurements (unknowns: {unknowns}; frequencies: {frequencies}; values of series: {values})",
                 unknowns=len(self.file["unknown"]), frequencies=frequencies, values=number(values))

    def _screen_in_words(self):
        speed, (unit, factor) = self.file["screen/speed"][:], shown("speed")
        return t("screen (bridges: {bridges}; formations: {formations}; speeds: {speeds} from {low} to {high})",
                 bridges=number(len(self.file["bridge"])), formations=number(len(self.file["formation"])),
                 speeds=number(len(speed)), low=number(factor * speed.min()),
                 high=f"{number(factor * speed.max())} {unit}")

    def kind_in_words(self):
        if self.is_fit:
            return self._fit_in_words()
        if self.is_screen:
            return self._screen_in_words()
        if self.is_rail:
            return t("track-bridge interaction, static analysis")
        if self.is_static:
            return t("static effects over all positions of the loads, without dynamic analysis")
        if self.is_run:
            speed, (unit, factor) = self.results.speed(), shown("speed")
            return t("one run at {speed}", speed=f"{number(factor * speed)} {unit}") if speed else t("one run")
        runs = self.runs
        parts = []
        for name in runs.line_names + ([runs.x_name] if runs.x_name else []) + runs.over:
            values, (said, unit, factor) = np.unique(runs.parameters[name]), runs.words(name)
            low, high = (number(factor * values[i]) for i in (0, -1))
            if name.endswith("hslm_a"):
                parts.append(t("trains {first} to {last} of HSLM-A", first=f"A{low}", last=f"A{high}"))
            else:
                many = t("{count} speeds", count=len(values)) if name.endswith("speed") else \
                    t("{count} values of {name}", count=len(values), name=said)
                parts.append(t("{many} from {low} to {high}", many=many, low=low, high=f"{high} {unit}".strip()))
        missing = runs.count - int(runs.finished.sum())
        said = ", ".join([t("{count} runs", count=number(runs.count)), *parts])
        return t("; ").join((said, t("{count} of the runs have not ended", count=missing))) if missing else said

    def train_in_words(self):
        model = self.model
        if self.is_static:
            return ", ".join(self.static_loads())
        if self.is_screen:
            return t("formations of a fleet")
        if self.is_rail:
            return t("a train at {count} positions", count=len(self.file["rail_forces/front"]))
        if len(model.train):
            counted = []
            for name in (model.type_name(index) for index, _ in model.train):
                if counted and counted[-1][0] == name:
                    counted[-1][1] += 1
                else:
                    counted.append([name, 1])
            return ", ".join(name if count == 1 else f"{count} × {name}" for name, count in counted)
        names = list(self.hslm_trains)
        if names:
            return t("trains {first} to {last} of HSLM-A", first=names[0], last=names[-1]) if len(names) > 1 else \
                t("train {name} of HSLM-A", name=names[0])
        if "train_vehicles" in self.options:
            return self.options["train_vehicles"]
        count = len(model.forces.get("load", ()))
        return t("{count} moving forces", count=count) if count else t("no moving load")
