"""The pages of a single run: envelopes along the bridge and time histories."""

import numpy as np
from picture_data import MOST_CURVES, choose, natural

from . import curves
from .language import num, place_in_words, t
from .page import GREY, LEFT
from .quantities import shown_value, unit_of_si

EFFECTS = (("deflection", "m", "Deflection, upward positive"), ("moment", "N m", "Bending moment, positive in sagging"),
           ("shear", "N", "Shear force, on both sides of passing loads"),
           ("acceleration", "m/s2", "Deck acceleration, unfiltered"),
           ("acceleration_lowpass", "m/s2", "Deck acceleration, low-pass filtered"))
HEIGHT = 0.8  # inches, of a curve along the bridge
DECK = {"acceleration": "unfiltered_deck_acceleration", "acceleration_lowpass": "deck_acceleration"}  # their limits


def words_of(source, name, words):
    """The heading of an effect. Deflections are relative to supports that move or have settled."""
    relative = name == "deflection" and "probes/relative_deflection" in source.file
    return t("Deflection relative to the supports, upward positive") if relative else t(words)


def envelope_of(source, name):
    """(least, greatest) value at each station; of filtered accelerations those of the stored instants."""
    file = source.file
    if f"envelope/{name}" in file:
        return file[f"envelope/{name}"][:].T
    if name == "acceleration_lowpass" and f"probes/{name}" in file:
        values = source.results.over_time(file[f"probes/{name}"])
        return values.min(axis=0), values.max(axis=0)
    return None


def deck_limits(limits, name, factor=1.0):
    """(value in a unit, text) of the limits of a deck acceleration without their factor, as its values do not contain it."""
    found = [limit for limit in limits if limit.quantity == DECK.get(name)]
    divided = [f" / {num(limit.factor)}" if limit.factor != 1.0 else "" for limit in found]
    return [(factor * limit.value / limit.factor,
             t("limit {value}", value=shown_value(limit.value, limit.quantity) + said)) for limit, said in zip(found, divided)]


def envelope_sheet(report, source, heading, run, limits):
    """The deflected shape of one run at the largest deflection, and its envelopes with the static line."""
    file, x = source.file, source.results.probes
    page = report.page(heading)
    page.text(LEFT, run, colour=GREY)
    if "envelope/static_deflection" in file:
        page.text(LEFT, t("Dashed line: greatest static deflection, drawn downward."), size=8, colour=GREY)
    unit, factor = unit_of_si("m")
    if "shape/x" in file and len(file["shape/x"]) > 1:
        ax = page.axes(HEIGHT, right=0.1)
        ax.plot(file["shape/x"][:], factor * file["shape/deflection"][:], color=curves.COLOURS[0], lw=1.8)
        ax.axhline(0.0, color=curves.PALE, lw=0.8)
        ends = source.model.span_ends
        ax.set(title=t("Deflected shape at the greatest deflection, t = {time} s",
                       time=num(file["shape/deflection"].attrs["time"])),
               ylabel=unit, xlabel=t("position along the bridge (m)"), xlim=(ends[0], ends[-1]))
    if "envelope/deflection" not in file:
        return
    if len(x) < curves.ENOUGH_A_SPAN * (len(source.model.span_ends) - 1):
        page.text(LEFT, t("Envelopes are drawn for at least {count} stations in each span (option -output_probes); "
                          "this run has {all} in total.", count=curves.ENOUGH_A_SPAN, all=len(x)), colour=GREY)
        return
    for name, si, words in EFFECTS:
        found = envelope_of(source, name)
        if found is None:
            continue
        page = report.page(heading) if page.room() < HEIGHT + 0.7 else page
        ax = page.axes(HEIGHT, right=0.1)
        unit, factor = unit_of_si(si)
        least, greatest = (factor * values for values in found)
        curves.along_bridge(ax, source.model.span_ends, x, [("", least, greatest)], unit, marks=False)
        ax.axhline(0.0, color=curves.PALE, lw=0.8)
        ax.set_title(t("{effect}: least and greatest values", effect=words_of(source, name, words)))
        if name in DECK:
            curves.draw_bounds(ax, deck_limits(limits, name, factor))
        page.fit(ax)
        if name == "deflection" and "envelope/static_deflection" in file:
            order = np.argsort(x)
            curves.draw_static(ax, x[order], file["envelope/static_deflection"][:][order])


def history_sheets(report, source, heading, run, limits):
    """Time histories: the bridge at the probes with the largest responses, the bearings, the wheels."""
    time, page = source.results.time, None
    for title, unit, series, lines in deck_panels(source, limits) + bearing_panels(source) + wheel_panels(source):
        names = [name for name, _ in series]
        if page is None or page.room() < 1.75 + curves.key_room(names):
            page = report.page(heading)
            page.text(LEFT, run, colour=GREY)
        ax = page.axes(1.05, right=curves.room_for(names))
        curves.history(ax, time, series, title, unit, lines)
        page.fit(ax)


def deck_panels(source, limits):
    results, file, panels = source.results, source.file, []
    for name, si, words in EFFECTS:
        if name != "shear" and f"probes/{name}" in file and len(results.probes):
            unit, factor = unit_of_si(si)
            stored = file.get(f"probes/relative_{name}", file[f"probes/{name}"])
            values = factor * results.over_time(stored)
            worst = int(np.argmax(np.abs(values).max(axis=0)))
            place = place_in_words(results.probes[worst], results.supports)
            panels.append((f"{words_of(source, name, words)}, {place}", unit,
                           [("", values[:, worst])], deck_limits(limits, name, factor)))
    return panels


def of_all(title, chosen, count):
    """The title of a panel with some of the curves."""
    return title if chosen == count else f"{title} ({t('{count} of {all}', count=chosen, all=count)})"


def bearing_panels(source):
    file, results, panels = source.file, source.results, []
    unit, factor = unit_of_si("N")
    if "supports/reaction" not in file:
        return []
    forces = factor * results.over_time(file["supports/reaction"])[:, :, 1]
    moving = [i for i in range(forces.shape[1]) if np.any(forces[:, i])]
    if moving:
        chosen = [moving[i] for i in choose(len(moving), MOST_CURVES, np.abs(forces[:, moving]).max(axis=0))]
        panels.append((of_all(t("Bearing forces on the bridge, upward positive"), len(chosen), len(moving)), unit,
                       [(f"x = {num(results.supports[i])} m", forces[:, i]) for i in chosen], []))
    if "foundation/vertical/force" in file:
        forces = factor * results.over_time(file["foundation/vertical/force"])
        x = file["foundation/vertical/x"][:]
        chosen = choose(len(x), MOST_CURVES, np.abs(forces).max(axis=0))
        panels.append((of_all(t("Forces of the springs under the bridge"), len(chosen), len(x)), unit,
                       [(f"x = {num(x[i])} m", forces[:, i]) for i in chosen], []))
    return panels


def wheel_panels(source):
    results = source.results
    wheels = [(k, name, vehicle[name]["normal_force"]) for k, vehicle in enumerate(results.vehicles)
              for name in sorted(vehicle, key=natural) if "normal_force" in vehicle[name]]
    if not wheels:
        return []
    unit, factor = unit_of_si("N")
    forces = [factor * results.over_time(data) for _, _, data in wheels]
    chosen = choose(len(wheels), 4, np.array([-force.min() for force in forces]))
    return [(of_all(t("Wheel forces, including the least one"), len(chosen), len(wheels)), unit,
             [(t("vehicle {number}, {part}", number=wheels[i][0], part=wheels[i][1].replace("_", " ")), forces[i])
              for i in chosen], [])]
