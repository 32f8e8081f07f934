"""Panels of the vehicles: wheel forces, accelerations of car bodies, signals of sensors."""

import numpy as np
from engineering_units import shown
from picture_axes import COLOURS, time_panel
from picture_data import (
    CALLED_CAR, MOST_CURVES, MOST_WHEELS, bodies_of, car_body, choose, envelope, listed_names, natural, ordinal,
    part_name, spaced, spring_names)
from picture_model import Model
from picture_table import keep
from picture_track import draw_losses

FEWEST_LINKS = 8  # joints of the type distance with numbered names that make a chain
DRIVES = "Force of ropes and of springs with a prescribed free length, tension positive"

# Signals of sensors: the dataset, its title and unit. The first is drawn by default, the others on request.
SIGNALS = {"acceleration_y": ("Vertical acceleration at the sensors", "m/s²"),
           "acceleration_x": ("Acceleration along the track at the sensors", "m/s²"),
           "pitch_rate": ("Pitch rate of the sensors' bodies, counter-clockwise", "rad/s")}


def wheels_of(results):
    """(number of the vehicle, name, forces) of every wheel, from the front of the train."""
    return [(k, name, vehicle[name]["normal_force"]) for k, vehicle in enumerate(results.vehicles)
            for name in sorted(vehicle, key=natural) if "normal_force" in vehicle[name]]


def cars_of(results):
    """(name, its group) of the car body, otherwise of the highest body, of each vehicle with bodies."""
    return [(name, vehicle[name]) for vehicle in results.vehicles if (name := car_body(vehicle)) is not None]


def sensors_of(results):
    """(number of the vehicle, name, its group) of every sensor."""
    return [(k, name, vehicle[name]) for k, vehicle in enumerate(results.vehicles)
            for name in sorted(vehicle, key=natural) if "pitch_rate" in vehicle[name]]


def draw_wheels(ax, results, wheels):
    """Draws the forces of a few wheels, or of the first and the last one with the range of all; losses of contact are
    gaps."""
    count, (unit, factor) = len(results.vehicles), shown("force")
    title = "Wheel forces on the track" if results.supports is not None else "Wheel forces"
    if len(wheels) <= MOST_WHEELS:
        curves = [(part_name(k, count, name), factor * results.over_time(data))
                  for k, name, data in wheels]
        time_panel(ax, results, title, unit, curves)
    else:
        least, greatest = envelope(results, (factor * results.over_time(data) for _, _, data in wheels))
        curves = [(f"{end} wheel of the train", factor * results.over_time(wheels[i][2]))
                  for i, end in ((0, "first"), (-1, "last"))]
        time_panel(ax, results, title, unit, curves, (f"all {len(wheels)} wheels, least to greatest", least, greatest))
    draw_losses(ax, results)


def draw_static_wheels(ax, results, wheels):
    """Draws the wheel forces of one instant, one bar per wheel, from the front of the train."""
    unit, factor = shown("force")
    forces = [factor * data[0] for _, _, data in wheels]
    ax.set(title="Wheel forces, from the front of the train", ylabel=unit, xlabel="number of the wheel")
    keep(ax, "force", np.arange(1.0, len(forces) + 1.0), forces)
    ax.bar(np.arange(len(forces)), forces, width=0.6, color=COLOURS[0])
    ax.set_xmargin(0.03)
    ax.grid(False, axis="x")
    if len(forces) <= MOST_CURVES:
        names = [part_name(k, len(results.vehicles), name).replace(", ", ",\n") for k, name, _ in wheels]
        ax.set_xticks(np.arange(len(forces)), names, fontsize=9)
    else:
        ax.set_xticks([])


def with_article(noun):
    """'the trolley', but 'step 41'."""
    return noun if noun[-1:].isdigit() else f"the {noun}"


def draw_accelerations(ax, results, cars):
    """Draws vertical accelerations of car bodies; other bodies keep their own names."""
    count, (unit, factor) = len(cars), shown("acceleration")
    series = [factor * results.over_time(car["acceleration"])[:, 1] for _, car in cars]
    names = {spaced(name) for name, _ in cars}
    if all(CALLED_CAR.search(name) for name in names):
        noun, what = "car", "car body" if count == 1 else "car bodies"
    else:
        noun, what = (names.pop() if len(names) == 1 else "body"), "highest bodies"
        what = noun if count == 1 else "bodies" if names == {"body"} else what
    title = f"Vertical acceleration of {with_article(what)}"
    if count <= MOST_WHEELS:
        time_panel(ax, results, title, unit, [(with_article(noun) if count == 1 else ordinal(k, count, noun), a)
                                                  for k, a in enumerate(series)])
        return
    band = (f"all {count}, least to greatest", *envelope(results, series))
    time_panel(ax, results, title, unit, [(f"first {noun}", series[0]), (f"last {noun}", series[-1])], band)


def draw_positions(ax, results, direction):
    """Draws the bodies of a mechanism with the largest motion; direction 0: along x, 1: along y."""
    bodies = [(name, results.over_time(vehicle[name]["position"])[:, direction])
              for vehicle in results.vehicles for name in bodies_of(vehicle)]
    chosen = choose(len(bodies), MOST_CURVES, np.array([np.ptp(values) for _, values in bodies]))
    note = "" if len(chosen) == len(bodies) else f" ({len(chosen)} of {len(bodies)})"
    time_panel(ax, results, f"Centres of the bodies: {'xy'[direction]}{note}", "m",
               [(bodies[i][0].replace("_", " "), bodies[i][1]) for i in chosen])


def chains_of(results):
    """(number of the vehicle, name, reaction) of every link of a chain: joints such as link0, link1, ..."""
    model, found = Model(results), []
    for k, (kind, _) in enumerate(model.train[:len(results.vehicles)]):
        links = [name for name, of in model.joint_names(kind) if of == "distance" and name[-1:].isdigit()]
        found += [(k, name, results.vehicles[k][name]["reaction"]) for name in links if len(links) >= FEWEST_LINKS]
    return found


def draw_chains(ax, results, links):
    unit, factor = shown("force")
    forces = [factor * np.hypot(*results.over_time(reaction)[:, :2].T) for _, _, reaction in links]
    chosen = choose(len(links), MOST_CURVES, np.array([force.max() for force in forces]))
    note = "" if len(chosen) == len(links) else f" ({len(chosen)} of {len(links)})"
    names = [f"{'' if len(results.vehicles) == 1 else f'vehicle {k}, '}{spaced(name)}" for k, name, _ in links]
    time_panel(ax, results, f"Force in the links of the chain{note}", unit, [(names[i], forces[i]) for i in chosen])


def drives_of(results, others):
    """(name, force) of ropes and of springs whose free length is prescribed over time, except for the others."""
    model, found = Model(results), []
    for k, (kind, _) in enumerate(model.train[:len(results.vehicles)]):
        option = f"vehicle_{model.type_name(kind)}_{{}}_winding_table"
        names = [name for name in spring_names(results, model, kind) if results.options.get(option.format(name))]
        found += [(name, results.vehicles[k][name]["force"])
                  for name in names + listed_names(results, model, kind, "ropes") if name not in others]
    return found[:MOST_CURVES]


def draw_drives(ax, results, drives):
    unit, factor = shown("force")
    time_panel(ax, results, DRIVES, unit,
               [(spaced(name), factor * results.over_time(force)) for name, force in drives])


def draw_sensors(ax, results, sensors, signal):
    title, unit = SIGNALS[signal]
    count = len(results.vehicles)
    series = [results.over_time(group[signal]) for _, _, group in sensors]
    chosen = choose(len(series), MOST_CURVES, np.array([np.abs(values).max() for values in series]))
    note = "" if len(chosen) == len(series) else f" ({len(chosen)} of {len(series)})"
    names = [part_name(k, count, name) for k, name, _ in sensors]
    time_panel(ax, results, title + note, unit, [(names[i], series[i]) for i in chosen])
