"""Charts of a run over time: bridge, track, supports, vehicles, mechanisms."""

import numpy as np
from engineering_units import shown
from picture_axes import legible
from picture_data import (
    CALLED_CAR, MOST_CURVES, MOST_WHEELS, bodies_of, choose, choose_probes, envelope, spaced)
from picture_hanging import hanging_of
from picture_vehicles import DRIVES, SIGNALS, cars_of, chains_of, drives_of, sensors_of, wheels_of
from traverse_report.language import known, num, place_in_words, t

from .packing import Chart, Curve

# Datasets with one column for each station: dataset, stations, title, quantity, what stands at the station.
COLUMNS = (
    ("probes/deflection", "probes/x", "Deflection of the bridge, upward positive", "deflection", ""),
    ("probes/acceleration", "probes/x", "Vertical acceleration of the bridge, unfiltered", "acceleration", ""),
    ("probes/acceleration_lowpass", "probes/x", "Vertical acceleration of the bridge, low-passed", "acceleration", ""),
    ("probes/moment", "probes/x", "Bending moment of the bridge, positive in sagging", "moment", ""),
    ("probes/shear", "probes/x", "Shear force of the bridge", "force", ""),
    ("probes/axial_force", "probes/x", "Axial force of the bridge, tension positive", "force", ""),
    ("foundation/vertical/force", "foundation/vertical/x", "Forces of the springs on the bridge, upward positive",
     "force", "spring"),
    ("foundation/longitudinal/force", "foundation/longitudinal/x", "Forces of the longitudinal springs on the bridge",
     "force", "spring"),
    ("supports/displacement", "supports/x", "Vertical motion of the supports", "displacement", "support"),
    ("rail/deflection", "probes/x", "Deflection of the rail, upward positive", "deflection", ""),
    ("rail/moment", "probes/x", "Bending moment of the rail", "moment", ""),
    ("rail/devices/opening", "rail/devices/x", "Opening of the expansion devices of the rail", "displacement",
     "device"),
    ("track/sleepers/pad_force", "track/sleepers/x", "Force of the rail pads, compression positive", "force",
     "sleeper"),
    ("track/sleepers/ballast_force", "track/sleepers/x", "Force of the ballast, compression positive", "force",
     "sleeper"),
    ("track/hanging/force", "track/hanging/x", "Upward force on the hanging sleepers", "force", "sleeper"),
    ("track/hanging/gap", "track/hanging/x", "Gaps of the hanging sleepers", "displacement", "sleeper"),
)


def scaled(title, quantity, curves):
    """A chart of values in SI units, in the unit of the quantity, or in a smaller one if all values are small."""
    unit, factor = shown(quantity)
    unit, smaller = legible(unit, [factor * values for _, values in curves])
    return Chart(title, unit, [Curve(name, smaller * factor * values) for name, values in curves])


def part_of(kept, every):
    """A note that a title has if a chart has a part of all curves only."""
    return "" if len(kept) == len(every) else f" ({t('{count} of {all}', count=len(kept), all=len(every))})"


def some(title, quantity, curves):
    """A chart of at most MOST_CURVES curves, among them the one with the largest value."""
    kept = choose(len(curves), MOST_CURVES, np.array([np.nanmax(np.abs(values), initial=0.0) for _, values in curves]))
    return scaled(known(title) + part_of(kept, curves), quantity, [curves[i] for i in kept])


def column_charts(results):
    for name, stations, title, quantity, noun in COLUMNS:
        if name not in results.file or not results.file[name].shape[1]:
            continue
        values, x = results.over_time(results.file[name]), results.values(stations)
        if not values.any() and name != "probes/deflection":
            continue
        if noun:
            yield some(title, quantity, [(f"{noun} at {place:.6g} m", values[:, i]) for i, place in enumerate(x)])
            continue
        kept = choose_probes(results, np.nanmax(np.abs(values), axis=0))
        yield scaled(known(title) + part_of(kept, x), quantity,
                     [(place_in_words(x[i], results.supports) + results.beside_axis(i), values[:, i]) for i in kept])


def support_charts(results):
    if "supports/reaction" in results.file:
        forces = results.over_time(results.file["supports/reaction"])[:, :, 1]
        curves = [(t("support at x = {x} m", x=num(x, ".6g")), forces[:, i])
                  for i, x in enumerate(results.supports) if forces[:, i].any()]
        if curves:
            yield some(t("Support reactions on the bridge, upward positive"), "force", curves)


def named(results, vehicle, part):
    """The name of a part of a vehicle, with the number of the vehicle if there are several."""
    return spaced(part) if len(results.vehicles) == 1 else \
        t("vehicle {number}, {part}", number=vehicle + 1, part=spaced(part))


def band_of(results, series, words):
    return words, np.column_stack(envelope(results, series))


def vehicle_charts(results):
    wheels = [(k, name, results.over_time(force)) for k, name, force in wheels_of(results)]
    if wheels:
        many = len(wheels) > MOST_WHEELS
        curves = [band_of(results, [force for *_, force in wheels], t(
            "all {count} wheels, least to greatest", count=len(wheels)))] if many else []
        for k, name, force in ((wheels[0], wheels[-1]) if many else wheels):
            curves.append((named(results, k, name), force))
        yield scaled(t("Wheel forces"), "force", curves)
    sensors = sensors_of(results)
    for signal, (title, unit) in SIGNALS.items() if sensors else ():
        yield Chart(title, unit, [Curve(named(results, k, name), results.over_time(group[signal]))
                                  for k, name, group in sensors[:MOST_CURVES]])
    cars = [(name, results.over_time(group["acceleration"])[:, 1]) for name, group in cars_of(results)]
    if cars and (wheels or results.probes is not None):
        series = [(named(results, k, name), values) for k, (name, values) in enumerate(cars)]
        if len(series) > MOST_CURVES:
            words = t("all {count} bodies, least to greatest", count=len(series))
            series = [band_of(results, [values for _, values in series], words), series[0], series[-1]]
        called_cars = all(CALLED_CAR.search(spaced(name)) for name, _ in cars)
        yield scaled(t("Vertical acceleration of the car bodies" if called_cars else
                       "Vertical acceleration of the highest bodies"), "acceleration", series)
    couplers = results.file["couplers"] if "couplers" in results.file else {}
    for name, group in couplers.items():
        data = group.get("force", group.get("fx"))
        if data is not None:
            title = "Force of the couplers {name}, tension positive" if "force" in group else \
                "Force along x of the couplers {name} on the rear vehicle"
            yield some(t(title, name=spaced(name)), "force",
                       [(t("behind vehicle {number}", number=int(gap) + 1), results.over_time(data)[:, i])
                        for i, gap in enumerate(group["gap"][:])])


def hanging_charts(results, hanging):
    for ropes in (False, True):
        found = [one for one in hanging if one.ropes == ropes][:MOST_CURVES]
        if not found:
            continue
        title = "Sway: the load relative to the top of its ropes, positive ahead" if ropes else \
            "Angle of the hanging body from the vertical, positive ahead"
        yield Chart(t(title), "m" if ropes else "°",
                    [Curve(named(results, one.vehicle, one.body), one.swing) for one in found])
        yield scaled(t("Force of its ropes together" if ropes else "Force of its joint"), "force",
                     [(named(results, one.vehicle, one.joint), one.force) for one in found])


def mechanism_charts(results):
    """Motions of the bodies and forces of joints and springs of vehicles without wheels on a bridge."""
    bodies = [(k, name, results.over_time(vehicle[name]["position"]))
              for k, vehicle in enumerate(results.vehicles) for name in bodies_of(vehicle)]
    for column, title in enumerate(("Centres of the bodies: x", "Centres of the bodies: y", "Angles of the bodies")):
        curves = [(named(results, k, name), values[:, column]) for k, name, values in bodies]
        kept = choose(len(curves), MOST_CURVES, np.array([np.ptp(values) for _, values in curves]))
        yield Chart(t(title) + part_of(kept, curves), "rad" if column == 2 else "m", [Curve(*curves[i]) for i in kept])
    for dataset, title in (("reaction", "Forces of the joints"), ("force", "Forces of the springs, tension positive")):
        found = [(named(results, k, name), results.over_time(vehicle[name][dataset]))
                 for k, vehicle in enumerate(results.vehicles) for name in vehicle if dataset in vehicle[name]]
        if found:
            yield some(t(title), "force", [(name, np.hypot(values[:, 0], values[:, 1]) if values.ndim == 2 else values)
                                        for name, values in found])


def output_charts(results):
    for name, data in (results.file["outputs"].items() if "outputs" in results.file else ()):
        yield Chart(t("Output of the given modes: {name}", name=spaced(name)), str(data.attrs.get("unit", "")),
                    [Curve(spaced(name), results.over_time(data))])


def charts(results):
    if results.rows < 2:
        return []
    hanging = hanging_of(results)
    found = [*column_charts(results), *support_charts(results), *vehicle_charts(results),
             *hanging_charts(results, hanging)]
    links = [(named(results, k, name), np.hypot(*results.over_time(force)[:, :2].T))
             for k, name, force in chains_of(results)]
    drives = [(spaced(name), results.over_time(force)) for name, force in
              drives_of(results, [part for one in hanging for part in one.joint.split(" and ")])]
    for title, curves in (("Force in the links of the chain", links),
                          (DRIVES, drives)):
        found += [some(title, "force", curves)] if curves else []
    if results.vehicles and results.probes is None and not wheels_of(results):
        found += mechanism_charts(results)
    return found + list(output_charts(results))
