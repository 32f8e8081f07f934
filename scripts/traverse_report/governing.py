"""The repeated governing run of a sweep or a study, for its time histories, envelopes and verdicts."""

import os
import pathlib
import re
import subprocess

import numpy as np
from search_answers import Search

from .language import t
from .limits import values_of
from .quantities import words_of

STATIONS_A_SPAN, MOST_STATIONS = 20, 161
LONGEST = 120.0  # s, limit for the run
# Options of the sweep or study, or of the first run only.
LEFT_OUT = re.compile(r"^(sweep|study|find|output|limits|report|scene_name|options_file|restart|checkpoint|log_view|"
                      r"malloc_debug|skip_petscrc)")


def value_text(value):
    return f"{int(value)}" if value == round(value) and abs(value) < 2 ** 53 else repr(float(value))


def modes_of(source):
    """The number of natural modes of the runs of a sweep or study; 0: by elements."""
    return int(source.file["sweep" if "sweep" in source.file else "study"].attrs.get("modes", 0))


def options_of(source, run):
    """The options of one run of the table: name -> value."""
    options = {name: value for name, value in source.options.items() if not LEFT_OUT.match(name)}
    group = "sweep" if "sweep" in source.file else "study"
    attributes = source.file[group].attrs
    vehicles = any(name.startswith("train_") for name in options)
    for name, value in source.runs.parameters.items():
        text = value_text(value[run])
        if name == "hslm_a":
            options["load_hslm_a"] = text
        elif name == "speed":
            options["train_speed" if vehicles else "load_speed"] = text
        else:
            also = "find_also" if name == source.options.get("find_option") else f"study_vary_{name}_also"
            for one in [name] + source.options.get(also, "").split(","):
                if one:
                    count = len(options.get(one, "").split(","))
                    options[one] = ",".join([text] * count)
    if modes_of(source) > 0:
        options["model_modes"] = str(modes_of(source))
    if "time_step" in attributes:
        options["ts_dt"] = repr(float(attributes["time_step"]))
    if "elements_per_span" in attributes:
        options["beam_elements_per_span"] = str(int(attributes["elements_per_span"]))
    if "method" in attributes:
        options["ts_type"] = str(attributes["method"])
    return options


def stations(source, run):
    """The stations of the sweep, and further ones for an envelope."""
    ends = source.model.span_ends
    own = source.runs.probes[run] if source.runs.probes.ndim == 2 else source.runs.probes
    each = max(min(STATIONS_A_SPAN, MOST_STATIONS // max(len(ends) - 1, 1)), 2)
    between = [np.linspace(a, b, each + 1) for a, b in zip(ends[:-1], ends[1:])]
    return np.unique(np.round(np.concatenate([own, *between]), 6))


def write_vehicles(options, folder):
    """Writes vehicles to separate files, because the table of PETSc's options is small. Returns the other options."""
    left = dict(options)
    for name in [name for name in options if re.fullmatch(r"vehicle_\w+_file", name)]:
        vehicle = name[len("vehicle_"):-len("_file")]
        prefix = f"vehicle_{vehicle}_"
        path = folder / f"{vehicle}.yml"
        lines = []
        for key in [key for key in left if key.startswith(prefix)]:
            value = left.pop(key)
            if key != name:
                lines.append(f"{key[len(prefix):]}: [{value}]" if "," in value else f"{key[len(prefix):]}: {value}")
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        left[name] = str(path)
    return left


def governing_run(source, limits):
    """The run with the least margin of a limit, otherwise the one with the largest deflection, and the reason. Of a
    search, whose runs exceed limits on purpose, the run closest to its bound within it."""
    if source.is_search:
        return Search(source.results).run_at_bound(), t("of the values within the bound, it is the run closest to it")
    worst, margin = int(np.nanargmax(source.runs.of_run("peak_deflection"))), np.inf
    why = t("it has the greatest deflection")
    for limit in limits:
        values, _ = values_of(source, limit)
        if limit.quantity == "deck_acceleration" and values is None:
            values, _ = values_of(source, limit._replace(quantity="unfiltered_deck_acceleration"))
        if values is None or np.isnan(values).all():
            continue
        if 1.0 - np.nanmax(values) / limit.value < margin:
            worst, margin = int(np.nanargmax(values)), 1.0 - np.nanmax(values) / limit.value
            why = t("it has the greatest utilisation of the limit: {quantity}", quantity=words_of(limit.quantity))
    return worst, why


def repeat(source, run, limits, program, folder, scratch, finer=1, name="governing"):
    """Computes the run, with `finer` times the elements and natural modes. Returns the path of its results, or None and
    the message of the program. name: of the results file."""
    options = write_vehicles(options_of(source, run), scratch)
    if finer > 1:
        for option in ("model_modes", "beam_elements_per_span"):
            options[option] = str(finer * int(options[option]))
    out = scratch / f"{name}_{finer}.h5"
    options["output_file"] = str(out)
    options["output_probes"] = ",".join(f"{x:.10g}" for x in stations(source, run))
    options["output_interval"] = "0.004"
    if any(limit.quantity == "deck_acceleration" for limit in limits):
        options["output_lowpass_series"] = "true"
    if limits:
        rows = "".join(f"- {{quantity: {limit.quantity}, value: {limit.value!r}, factor: {limit.factor!r}" +
                       "".join(f", {name}: {quoted(text)}" for name, text in
                               (("clause", limit.clause), ("text", limit.text)) if text) + "}\n" for limit in limits)
        (scratch / "limits.yml").write_text(rows, encoding="utf-8")
        options["limits"] = str(scratch / "limits.yml")
    words = [str(pathlib.Path(program).resolve()), "-output_quiet", "-skip_petscrc"]
    for option, value in options.items():
        words += [f"-{option}", value]
    own = {name: value for name, value in os.environ.items() if not name.startswith("PETSC_OPTIONS")}
    try:
        ended = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=LONGEST, env=own)
    except (OSError, subprocess.TimeoutExpired) as error:
        return None, str(error).splitlines()[0]
    if ended.returncode != 0 or not out.is_file():
        said = (ended.stderr or ended.stdout).strip().splitlines()
        return None, said[-1] if said else f"exit status {ended.returncode}"
    return out, ""


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
