"""Tables of searches, sensitivity analyses, fits, screens, natural modes and static effects for export.py, one row for each
answer, effect, estimate, value, pair, mode or station."""

import numpy as np


def texts(file, name):
    return file[name].asstr()[:]


def of_find(file, add):
    """A row for each value of the searched option: its greatest ratio to the bound for each answer."""
    add(str(file["find"].attrs["option"]), file["find/value"].attrs["unit"], file["find/value"][:])
    for answer, ratio in zip(texts(file, "answer"), file["find/ratio"][:]):
        add(f"ratio of {answer}", "1", ratio)


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


def of_pairs(file, add):
    """A row for each bridge and formation of a screen."""
    bridges, formations = texts(file, "bridge"), texts(file, "formation")
    add("bridge", "text", np.repeat(bridges, len(formations)))
    add("formation", "text", np.tile(formations, len(bridges)))
    for name in ("ratio", "bound", "permitted_speed", "governing_speed", "exceeding_speeds", "decided_by"):
        add(name, file[f"screen/{name}"].attrs["unit"], file[f"screen/{name}"][:].ravel())


def of_modes(first, *others):
    """The table of natural modes: a row for each mode with those of these quantities that the file has."""
    def table(file, add):
        add("mode", "", np.arange(len(file[f"modes/{first}"])) + 1)
        for name in (first, *others):
            if f"modes/{name}" in file:
                add(name, file[f"modes/{name}"].attrs["unit"], file[f"modes/{name}"][:])
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
        for name in quantities:
            effects = file[f"static/{name}"]
            for k, load in enumerate(texts(file, "static/load")[:, 0]):
                for side, extreme in enumerate(("least", "greatest")):
                    add(f"{name} under {load}, {extreme}", effects.attrs["unit"], effects[k, :, side])
    return table


def of_series(name):
    """The table of a fitted series: measured and computed values by the clock of the measurement."""
    def table(file, add):
        for column in ("time", "measured", "computed"):
            add(column, file[f"{name}/{column}"].attrs["unit"], file[f"{name}/{column}"][:])
    return table


TABLES = {"find/ratios": ("find/value", of_find), "find/intervals": ("find/interval", of_intervals),
          "sensitivity": ("sensitivity/units", of_sensitivity), "fit/estimates": ("fit/estimate", of_estimates),
          "screen": ("screen/ratio", of_pairs), "modes/shapes": ("modes/x", of_shapes),
          "modes/undamped": ("modes/frequency", of_modes("frequency", "modal_damping_ratio", "modal_mass", "axial")),
          "modes/damped": ("modes/damped_frequency",
                           of_modes("damped_frequency", "damping_ratio", "decay_rate", "damped_axial")),
          "static/effects": ("static/x", of_static_effects("x", ("deflection", "moment", "shear"))),
          "static/reactions": ("static/reaction", of_static_effects("reaction_x", ("reaction",))),
          "static/end_rotations": ("static/end_rotation", of_static_effects("end_rotation_x", ("end_rotation",)))}


def tables(file):
    """The tables of this file: name and function(file, add), with add(name, unit, values)."""
    found = {name: write for name, (dataset, write) in TABLES.items() if dataset in file}
    for name in file.get("fit/series", ()):
        found[f"fit/series/{name}"] = of_series(f"fit/series/{name}")
    return found
