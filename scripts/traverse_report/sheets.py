"""The pages of the report, each from one results file."""

import numpy as np
from picture_axes import GREY
from picture_data import MOST_CURVES, choose, natural, place_in_words

from . import curves, model_sheet, norm_sheet, rail_sheet
from .limits import judge_lines
from .page import AMBER, GREEN, LEFT, RED, table
from .source import QUANTITIES, digits, number

COLOURS = {"kept": GREEN, "kept alone": GREY, "broken": RED, "not judged": GREY, "below": GREEN, "above": AMBER}


def shown(value, limit):
    """A value of the quantity of a limit as text, with the usual unit."""
    if np.isnan(value):
        return ""
    if limit.quantity.endswith("deflection_over_span") and value > 0.0:
        return f"1/{digits(1.0 / value)}"
    factor, unit = {"rad": (1e3, "mrad"), "m": (1e3, "mm"), "Pa": (1e-6, "MPa")}.get(limit.unit, (1.0, limit.unit))
    return f"{factor * value:.4g} {unit}".strip()


def outcome(verdicts):
    """The main result in one sentence, and its colour."""
    judged = [verdict for verdict in verdicts if verdict.word in ("kept", "broken")]
    broken = [verdict for verdict in judged if verdict.word == "broken"]
    alone = sum(verdict.word == "kept alone" for verdict in verdicts)
    left = len(verdicts) - len(judged) - alone
    rest = f"; {left} could not be judged" if left else ""
    rest = f"; {alone} more kept in the governing run, unknown for the other runs{rest}" if alone else rest
    if not verdicts:
        return "No limits were given.", GREY
    if not judged:
        return "None of the limits could be judged.", GREY
    if broken:
        return f"{len(broken)} of {len(judged)} judged limits {'is' if len(broken) == 1 else 'are'} BROKEN{rest}.", RED
    subject = "The judged limit is" if len(judged) == 1 else f"All {len(judged)} judged limits are"
    return f"{subject} kept{rest}.", AMBER if alone else GREEN


def verdict_table(report, page, verdicts):
    columns = [("limit", 1.65, "left"), ("quantity", 1.05, "left"), ("allowed", 0.65, "right"), ("found", 0.7, "right"),
               ("margin", 0.6, "right"), ("verdict", 0.65, "left"), ("run, place, time", 1.5, "left")]
    rows = []
    for v in verdicts:
        judged = v.word != "not judged"
        rows.append(["; ".join(filter(None, (v.limit.clause, v.limit.text))), v.limit.quantity.replace("_", " "),
                     shown(v.limit.value, v.limit), shown(v.value, v.limit) if judged else "",
                     f"{100.0 * v.margin:.1f} %" if judged else "", (v.word, COLOURS[v.word]),
                     "; ".join(filter(None, (v.run, v.where)))])
    return table(report, page, columns, rows)


def is_known(runs, name):
    """Whether a quantity has values; for losses of contact, whether there are any."""
    if name not in runs.values or np.isnan(runs.of_run(name)).all():
        return False
    return name != "longest_loss" or np.nanmax(runs.of_run(name)) > 0.0


def peak_rows(source):
    """Rows (quantity, value, run and place) of the greatest values."""
    rows, runs = [], source.runs
    if source.is_rail:
        return rail_sheet.peak_rows(source)
    if runs is None:
        supports = source.results.supports
        for name, words, unit, factor in (("deflection", "greatest deflection", "mm", 1e3),
                                          ("acceleration", "greatest deck acceleration, unfiltered", "m/s²", 1.0),
                                          ("acceleration_lowpass", "the same, low-passed", "m/s²", 1.0),
                                          ("moment", "greatest bending moment", "kN m", 1e-3)):
            if name in source.summary:
                where = place_in_words(source.summary[f"{name}_place"], supports)
                rows.append((words, f"{digits(factor * abs(source.summary[name]))} {unit}",
                             f"{where}, t = {source.summary[f'{name}_time']:.4g} s"))
        for name, words, unit, factor in (("amplification", "of the deflection, relative to the static one",
                                           "", 1.0), ("least_wheel_force", "least wheel force", "kN", 1e-3)):
            if name in source.summary and (name == "amplification" or "least_wheel" in source.summary):
                rows.append((words if name != "amplification" else "amplification",
                             f"{digits(factor * source.summary[name])} {unit}".strip(),
                             words if name == "amplification" else source.summary["least_wheel"]))
        return rows
    for name, (words, unit, factor) in QUANTITIES.items():
        if not is_known(runs, name):
            continue
        values = runs.of_run(name)
        run = int(np.nanargmin(values) if name.startswith("least") else np.nanargmax(values))
        place = runs.place(name, run)
        where = "" if place is None else ", " + place_in_words(place, source.results.supports)
        rows.append((words, f"{digits(factor * values[run])} {unit}".strip(), runs.run_in_words(run) + where))
    return rows


def front(report, source, verdicts, governing):
    """The first page of a file: the scene, the verdicts and their margins."""
    page = report.page(source.title())
    train = "" if source.runs is not None and "hslm_a" in source.runs.parameters else f"{source.train_in_words()}; "
    page.text(LEFT, f"{train}{source.kind_in_words()}", size=9.5)
    page.text(LEFT, f"Results file {source.path.name}", size=8, colour=GREY)
    if source.summary.get("ended", "no summary") != "reached its end":
        page.text(LEFT, f"The computation did not reach its end: {source.summary.get('ended', 'it was killed')}.",
                  size=9, colour=RED)
    if len(source.model.span_ends) > 1:
        model_sheet.draw_bridge(page, source)
    sentence, colour = outcome(verdicts)
    page.text(LEFT, sentence, size=12, colour=colour, weight="bold")
    page.y -= 0.1
    if verdicts:
        page = verdict_table(report, page, verdicts)
    if said := norm_sheet.sentence(source):
        page.text(LEFT, said, size=8.5)
        page.y -= 0.1
    page = table(report, page, [("greatest of all runs" if source.runs is not None else "greatest of the run", 2.6, "left"),
                                ("value", 1.1, "right"), ("where", 3.1, "left")], peak_rows(source))
    if governing is not None:
        front_of_governing(page, governing)


def front_of_governing(page, governing):
    page.text(LEFT, f"The governing run, {governing.words}, was repeated, because {governing.why}. Results marked "
                    "'kept alone' refer to that run only.", size=8.5)
    if governing.trouble:
        page.text(LEFT, f"The run could not be repeated: {governing.trouble}", size=8.5, colour=RED)


def line_sheet(report, source, limits):
    """Every train with each limit: greatest value, its speed and margin, and the speeds at which it is broken."""
    rows = judge_lines(source, limits)
    if not rows:
        return
    _, label = source.runs.x()
    unit = label.split("(")[-1].rstrip(")") if "(" in label else ""
    page = report.page("Every train and its limits" if "hslm_a" in source.runs.line_names else "Every case and its limits")
    cells, short = [], dict(zip((name for name, _ in source.runs.lines()), curves.names_of(source.runs)))
    for row in rows:
        broken = "; ".join(number(a) if a == b else f"{number(a)} to {number(b)}" for a, b in row.broken)
        cells.append([short[row.line], f"{row.limit.quantity.replace('_', ' ')} ({row.limit.clause})",
                      shown(row.limit.value, row.limit), shown(row.value, row.limit), number(row.x),
                      f"{100.0 * row.margin:.1f} %", (row.word, COLOURS[row.word]), broken])
    if any(row.word in ("above", "below") for row in rows):
        page.text(LEFT, "Above and below: unfiltered peaks, compared with a limit of low-passed ones. A peak below the "
                        "limit almost certainly keeps it; a low-passed peak may keep it although the unfiltered "
                        "one is above.", size=8, colour=GREY)
        page.y -= 0.08
    case = source.runs.lines_in_words() or "case"
    table(report, page, [(case, 1.45, "left"), ("limit", 1.4, "left"), ("allowed", 0.65, "right"),
                         ("greatest", 0.7, "right"), (f"at ({unit})" if unit else "at", 0.7, "right"),
                         ("margin", 0.6, "right"), ("verdict", 0.55, "left"),
                         (f"broken at ({unit})" if unit else "broken at", 0.75, "left")], cells, size=7)


def curve_sheets(report, source, limits):
    """Every quantity over the speed, two per page. Returns the number of lines of each."""
    runs, drawn = source.runs, {}
    if runs is None or runs.x_name is None:
        return drawn
    page, names = None, curves.names_of(runs)
    for name, (words, unit, factor) in QUANTITIES.items():
        if not is_known(runs, name):
            continue
        values = factor * runs.of_run(name)
        if page is None or page.room() < 4.6 + curves.key_room(names):
            page = report.page(f"{'Curves over the speed' if runs.x_name.endswith('speed') else 'Curves'}: "
                               f"{source.title()}")
            if runs.line_names and runs.line_names != ["hslm_a"]:
                page.text(LEFT, f"One line for each {runs.lines_in_words()}.", size=8, colour=GREY)
            if len(runs.lines()) > curves.MOST_LINES:
                page.text(LEFT, "Only some of the lines are drawn; the workbook contains all of them.", size=8,
                          colour=GREY)
            if runs.over:
                page.text(LEFT, f"Over all values of {' and '.join(runs.over)}: thick: greatest (of least values the "
                                "least); dotted: median; shaded: range.", size=8, colour=GREY)
            if "resonances" in source.file or "cancellations" in source.file:
                page.text(LEFT, resonances_in_words(source), size=8, colour=GREY)
        ax = page.axes(3.7, right=curves.room_for(names))
        ax.set_title(words[0].upper() + words[1:])
        drawn[name] = curves.over_x(ax, source, name, values, unit, curves.limit_lines(source, limits, name))
        page.fit(ax)
    return drawn


def resonances_in_words(source):
    file, said = source.file, []
    if "resonances/speed" in file:
        several = len(source.runs.lines()) > 3
        said.append(f"Light lines: resonance speeds v = f1 d{'' if several else '/i'}.")
    if "cancellations/speed" in file:
        said.append("Dotted lines: cancellation speeds v = 2 f1 L/(2k+1).")
    return " ".join(said)


def envelope_sheet(report, source):
    """The largest deflection, acceleration and moment of each train at every probe, for a table of runs."""
    runs = source.runs
    stations = runs.probes[0] if runs.probes.ndim == 2 else runs.probes
    if len(stations) < 3 or (runs.probes.ndim == 2 and np.ptp(runs.probes, axis=0).max() > 0.0):
        return
    page = None
    for name in ("peak_deflection", "peak_acceleration", "peak_moment"):
        words, unit, factor = QUANTITIES[name]
        known = np.abs(runs.values[name])
        if np.isnan(known).all():
            continue
        if page is None or page.room() < 3.1:
            page = report.page(f"Envelopes along the bridge: {source.title()}")
            if runs.line_names and runs.line_names != ["hslm_a"]:
                page.text(LEFT, f"One line for each {runs.lines_in_words()}.", size=8, colour=GREY)
        ax = page.axes(2.3, right=max(0.5 + curves.room_for(curves.names_of(runs)), 1.0))
        ax.set_title(f"{words[0].upper()}{words[1:]}, of all speeds; marks: probes")
        series = [(line, factor * np.nanmax(known[indices], axis=0), None)
                  for line, indices in curves.chosen_lines(ax, runs, known.max(axis=1), curves.MOST_LISTED)
                  if not np.isnan(known[indices]).all()]
        static = factor * np.nan_to_num(runs.static).max(axis=0) if name == "peak_deflection" else None
        curves.along_bridge(ax, source.model.span_ends, stations, series, unit, static=static)
        ax.set_ylim(0.0, ax.get_ylim()[1] * 1.1)
        page.fit(ax)


def run_envelope_sheet(report, source, heading):
    """The deflected shape of one run at the largest deflection, and its envelopes with the static line."""
    file, x = source.file, source.results.probes
    page = report.page(f"Along the bridge: {heading}")
    if "shape/x" in file and len(file["shape/x"]) > 1:
        ax = page.axes(1.4, right=0.1)
        ax.plot(file["shape/x"][:], 1e3 * file["shape/deflection"][:], color=curves.COLOURS[0], lw=1.8)
        ax.axhline(0.0, color=curves.PALE, lw=0.8)
        ends = source.model.span_ends
        ax.set(title=f"Deflection at its maximum, t = {file['shape/deflection'].attrs['time']:.4g} s", ylabel="mm",
               xlabel="place along the bridge (m)", xlim=(ends[0], ends[-1]))
    if "envelope/deflection" not in file:
        return
    if len(x) < curves.ENOUGH_A_SPAN * (len(source.model.span_ends) - 1):
        page.text(LEFT, f"Envelopes are drawn for at least {curves.ENOUGH_A_SPAN} probes in each span (-output_probes); "
                        f"this run has {len(x)} in all.", size=8.5, colour=GREY)
        return
    for name, words, unit, factor in (("deflection", "Deflection", "mm", 1e3),
                                      ("moment", "Bending moment, positive in sagging", "kN m", 1e-3),
                                      ("shear", "Shear, on both sides of passing forces", "kN", 1e-3),
                                      ("acceleration", "Deck acceleration, unfiltered", "m/s²", 1.0)):
        if f"envelope/{name}" not in file:
            continue
        ax = page.axes(1.2, right=0.1)
        least, greatest = factor * file[f"envelope/{name}"][:].T
        curves.along_bridge(ax, source.model.span_ends, x, [("", least, greatest)], unit, marks=False)
        ax.axhline(0.0, color=curves.PALE, lw=0.8)
        ax.set_title(f"{words}: least and greatest")
        if name == "deflection" and "envelope/static_deflection" in file:
            order = np.argsort(x)
            curves.draw_static(ax, x[order], file["envelope/static_deflection"][:][order])
            ax.set_title(f"{words}: least and greatest; dashed: largest static deflection, drawn downward")


def history_sheets(report, source, heading, limits):
    """Time histories: the bridge at the probes with the largest responses, the bearings, the wheels."""
    results, file = source.results, source.file
    time, probes = results.time, results.probes
    panels = []
    deck = [limit.value for limit in limits if limit.quantity == "unfiltered_deck_acceleration"]
    for name, words, unit, factor in (("deflection", "Deflection, upward positive", "mm", 1e3),
                                      ("acceleration", "Deck acceleration, unfiltered", "m/s²", 1.0),
                                      ("moment", "Bending moment", "kN m", 1e-3)):
        if f"probes/{name}" in file and len(probes):
            values = factor * results.over_time(file[f"probes/{name}"])
            worst = int(np.argmax(np.abs(values).max(axis=0)))
            panels.append((f"{words}, {place_in_words(probes[worst], results.supports)}", unit,
                           [("", values[:, worst])], deck if name == "acceleration" else []))
    panels += bearing_panels(source) + wheel_panels(source)
    page = None
    for title, unit, series, lines in panels:
        names = [name for name, _ in series]
        if page is None or page.room() < 1.9 + curves.key_room(names):
            page = report.page(f"Time histories: {heading}")
        ax = page.axes(1.2, right=curves.room_for(names))
        curves.history(ax, time, series, title, unit, lines)
        page.fit(ax)


def bearing_panels(source):
    file, results = source.file, source.results
    if "supports/reaction" not in file:
        return []
    forces = 1e-3 * results.over_time(file["supports/reaction"])[:, :, 1]
    moving = [i for i in range(forces.shape[1]) if np.any(forces[:, i])]
    panels = []
    if moving:
        chosen = [moving[i] for i in choose(len(moving), MOST_CURVES, np.abs(forces[:, moving]).max(axis=0))]
        note = "" if len(chosen) == len(moving) else f" ({len(chosen)} of {len(moving)})"
        panels.append((f"Bearing forces on the bridge, upward positive{note}", "kN",
                       [(f"at {results.supports[i]:.4g} m", forces[:, i]) for i in chosen], []))
    if "foundation/vertical/force" in file:
        forces = 1e-3 * results.over_time(file["foundation/vertical/force"])
        x = file["foundation/vertical/x"][:]
        chosen = choose(len(x), MOST_CURVES, np.abs(forces).max(axis=0))
        note = "" if len(chosen) == len(x) else f" ({len(chosen)} of {len(x)})"
        panels.append((f"Forces of the springs under the bridge{note}", "kN",
                       [(f"at {x[i]:.4g} m", forces[:, i]) for i in chosen], []))
    return panels


def wheel_panels(source):
    results = source.results
    wheels = [(k, name, vehicle[name]["normal_force"]) for k, vehicle in enumerate(results.vehicles)
              for name in sorted(vehicle, key=natural) if "normal_force" in vehicle[name]]
    if not wheels:
        return []
    forces = [1e-3 * results.over_time(data) for _, _, data in wheels]
    chosen = choose(len(wheels), 4, np.array([-force.min() for force in forces]))
    note = "" if len(chosen) == len(wheels) else f" ({len(chosen)} of {len(wheels)}, with the one of the least force)"
    return [(f"Wheel forces{note}", "kN",
             [(f"vehicle {wheels[i][0]}, {wheels[i][1].replace('_', ' ')}", forces[i]) for i in chosen], [])]
