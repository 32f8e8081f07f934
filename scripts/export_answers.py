"""Tables of searches, sensitivity analyses, fits, screens, verdicts, natural modes and static effects for export.py, one
row for each answer, effect, estimate, value, pair, limit, mode or station."""

import numpy as np


def texts(file, name):
    return file[name].asstr()[:]


def named(names, numbers):
    """The names with these numbers, which count from 0; empty for NaN."""
    return [names[int(number)] if np.isfinite(number) and 0 <= number < len(names) else "" for number in numbers]


def add_existing(file, group, names, add):
    """Adds those of these datasets of a group that the file has."""
    for name in names:
        if f"{group}/{name}" in file:
            add(name, file[f"{group}/{name}"].attrs["unit"], file[f"{group}/{name}"][:])


def of_find(file, add):
    """A row for each value of the searched option: its greatest ratio to the bound for each answer, with the run and the
    limit of this ratio."""
    add(str(file["find"].attrs["option"]), file["find/value"].attrs["unit"], file["find/value"][:])
    for i, answer in enumerate(texts(file, "answer")):
        add(f"ratio of {answer}", "1", file["find/ratio"][i])
        add(f"run of {answer}", "", [int(run) if np.isfinite(run) else "" for run in file["find/run"][i]])
        if "criterion" in file:
            add(f"limit of {answer}", "text", named(texts(file, "criterion"), file["find/limit"][i]))


def of_intervals(file, add):
    """A row for each interval in which the condition holds."""
    answer = file["find/interval_answer"][:].astype(int)
    add("answer", "text", texts(file, "answer")[answer])
    for k, end in enumerate(("from", "to")):
        add(end, file["find/interval"].attrs["unit"], file["find/interval"][:, k])
        add(f"{end} is an end of the range", "1", file["find/interval_at_end"][:, k].astype(int))


def of_sensitivity(file, add):
    """A row for each quantity and factor."""
    quantities, factors = texts(file, "sensitivity/units"), texts(file, "factor")
    add("quantity", "text", np.repeat(quantities[:, 0], len(factors)))
    add("unit", "text", np.repeat(quantities[:, 1], len(factors)))
    add("factor", "text", np.tile(factors, len(quantities)))
    for name, measure in file["sensitivity"].items():
        if name != "units":
            add(name, "1" if measure.attrs["unit"] == "1" else "", measure[:].ravel())


def of_estimates(file, add):
    """A row for each unknown of a fit."""
    add("unknown", "text", texts(file, "unknown"))
    add("unit", "text", str(file["fit/estimate"].attrs["unit"]).split(", "))
    for name in ("estimate", "standard_error", "low", "high", "start"):
        add(name, "", file[f"fit/{name}"][:])
    add("at_bound", "1", file["fit/at_bound"][:].astype(int))


def of_correlations(file, add):
    """A row and a column for each unknown of a fit."""
    names = texts(file, "unknown")
    add("unknown", "text", names)
    for name, column in zip(names, file["fit/correlation"][:].T):
        add(f"correlation with {name}", "1", column)


def of_starts(file, add):
    """A row for each minimisation of a fit: its misfit and its estimates."""
    estimates = file["fit/starts/estimate"]
    add("misfit", "1", file["fit/starts/misfit"][:])
    for name, unit, column in zip(texts(file, "unknown"), str(estimates.attrs["unit"]).split(", "), estimates[:].T):
        add(name, unit, column)


def of_frequencies(file, add):
    """A row for each measured frequency of a fit."""
    add("frequency", "text", texts(file, "measured_frequency"))
    add_existing(file, "fit/frequencies", ("measured", "computed", "sd", "mac"), add)


def of_deviations(file, add):
    """A row for each series of a fit: the standard deviation of a value."""
    add("series", "text", texts(file, "measured_series"))
    add("unit", "text", str(file["fit/series_sd"].attrs["unit"]).split(", "))
    add("standard_deviation", "", file["fit/series_sd"][:])


def of_pairs(file, add):
    """A row for each bridge and formation of a screen."""
    bridges, formations = texts(file, "bridge"), texts(file, "formation")
    add("bridge", "text", np.repeat(bridges, len(formations)))
    add("formation", "text", np.tile(formations, len(bridges)))
    for name in ("ratio", "bound", "permitted_speed", "governing_speed", "exceeding_speeds", "decided_by"):
        add(name, file[f"screen/{name}"].attrs["unit"], file[f"screen/{name}"][:].ravel())


def of_bridges(file, add):
    """A row for each bridge of a screen, with the formation that governs it."""
    add("bridge", "text", texts(file, "bridge"))
    add_existing(file, "screen", ("bridge_length", "bridge_frequency", "bridge_damping", "bridge_speed", "bridge_ratio"),
                 add)
    add("governing_formation", "text", named(texts(file, "formation"), file["screen/governing_formation"][:]))


def of_formations(file, add):
    """A row for each formation of a screen, with the bridge that it governs most."""
    add("formation", "text", texts(file, "formation"))
    add_existing(file, "screen", ("formation_speed", "formation_ratio"), add)
    add("governing_bridge", "text", named(texts(file, "bridge"), file["screen/governing_bridge"][:]))


def of_verdicts(file, add):
    """A row for each limit; value and limit are in the unit of the row."""
    for name, parts in (("quantity", ("quantity", "unit")), ("clause", ("clause", "text")),
                        ("verdict", ("verdict", "place"))):
        for part, column in zip(parts, texts(file, f"verdicts/{name}").T):
            add(part, "text", column)
    for name in ("value", "limit", "factor", "margin", "time", "runs", "broken_in"):
        if f"verdicts/{name}" in file:
            add(name, "s" if name == "time" else "", file[f"verdicts/{name}"][:])


def of_norm(file, add):
    """A row for each effect of the verdict of EN 1991-2, 6.4.6.5; effects are in the unit of the row."""
    effects = texts(file, "norm/effect")
    add("effect", "text", effects[:, 0])
    add("unit", "text", effects[:, 1])
    for name in ("train", "model", "governs"):
        add(name, "text", texts(file, f"norm/{name}")[:, 0])
    for name, data in file["norm"].items():
        if data.shape == (len(effects),) and data.dtype.kind == "f":
            unit = str(data.attrs["unit"])
            add(name, "" if unit.startswith("as /") else unit, data[:])


def of_modes(first, *others):
    """The table of natural modes: a row for each mode with those of these quantities that the file has."""
    def table(file, add):
        add("mode", "", np.arange(len(file[f"modes/{first}"])) + 1)
        add_existing(file, "modes", (first, *others), add)
    return table


def of_shapes(file, add):
    """A row for each station: the shape of each mode."""
    add("x", file["modes/x"].attrs["unit"], file["modes/x"][:])
    for k, shape in enumerate(file["modes/shape"][:]):
        add(f"shape of mode {k + 1}", file["modes/shape"].attrs["unit"], shape)


def of_static_effects(x, quantities):
    """The table of the least and greatest static effects of each load model at the stations x."""
    def table(file, add):
        add("x", file[f"static/{x}"].attrs["unit"], file[f"static/{x}"][:])
        for name in filter(file["static"].__contains__, quantities):
            effects = file[f"static/{name}"]
            for k, load in enumerate(texts(file, "static/load")[:, 0]):
                for side, extreme in enumerate(("least", "greatest")):
                    add(f"{name} under {load}, {extreme}", effects.attrs["unit"], effects[k, :, side])
    return table


def of_compared(name, over):
    """The table of a fitted series or mode shape: measured and computed values over time or x."""
    def table(file, add):
        for column in (over, "measured", "computed"):
            add(column, file[f"{name}/{column}"].attrs["unit"], file[f"{name}/{column}"][:])
    return table


TABLES = {"find/ratios": ("find/value", of_find), "find/intervals": ("find/interval", of_intervals),
          "sensitivity": ("sensitivity/units", of_sensitivity), "fit/estimates": ("fit/estimate", of_estimates),
          "fit/correlations": ("fit/correlation", of_correlations), "fit/starts": ("fit/starts/misfit", of_starts),
          "fit/frequencies": ("fit/frequencies/measured", of_frequencies),
          "fit/deviations": ("fit/series_sd", of_deviations), "screen": ("screen/ratio", of_pairs),
          "screen/bridges": ("screen/bridge_length", of_bridges),
          "screen/formations": ("screen/formation_ratio", of_formations),
          "verdicts": ("verdicts/limit", of_verdicts), "norm": ("norm/effect", of_norm), "modes/shapes": ("modes/x", of_shapes),
          "modes/undamped": ("modes/frequency", of_modes("frequency", "modal_damping_ratio", "modal_mass", "axial", "twisting")),
          "modes/damped": ("modes/damped_frequency",
                           of_modes("damped_frequency", "damping_ratio", "decay_rate", "damped_axial",
                                    "damped_twisting")),
          "static/effects": ("static/x", of_static_effects("x", ("deflection", "moment", "shear", "track_twist"))),
          "static/reactions": ("static/reaction", of_static_effects("reaction_x", ("reaction",))),
          "static/end_rotations": ("static/end_rotation", of_static_effects("end_rotation_x", ("end_rotation",)))}


def tables(file):
    """The tables of this file: name and function(file, add), with add(name, unit, values)."""
    found = {name: write for name, (dataset, write) in TABLES.items() if dataset in file}
    for group, over in (("fit/series", "time"), ("fit/shapes", "x")):
        for name in file.get(group, ()):
            found[f"{group}/{name}"] = of_compared(f"{group}/{name}", over)
    return found
