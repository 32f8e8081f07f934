"""Panels of the vehicles: wheel forces, accelerations of car bodies, signals of sensors."""

import numpy as np
from picture_axes import COLOURS, time_panel
from picture_data import CAR, MOST_CURVES, MOST_WHEELS, bodies_of, car_body, choose, envelope, natural, ordinal

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
    count = len(results.vehicles)
    title = "Wheel forces on the track" if results.supports is not None else "Wheel forces"
    if len(wheels) <= MOST_WHEELS:
        curves = [(f"{ordinal(k, count, 'vehicle')}, {name.replace('_', ' ')}", 1e-3 * results.over_time(data))
                  for k, name, data in wheels]
        time_panel(ax, results, title, "kN", curves)
        return
    least, greatest = envelope(results, (1e-3 * results.over_time(data) for _, _, data in wheels))
    curves = [(f"{end} wheel of the train", 1e-3 * results.over_time(wheels[i][2]))
              for i, end in ((0, "first"), (-1, "last"))]
    time_panel(ax, results, title, "kN", curves, (f"all {len(wheels)} wheels, least to greatest", least, greatest))


def draw_static_wheels(ax, results, wheels):
    """Draws the wheel forces of one instant, one bar per wheel, from the front of the train."""
    forces = [1e-3 * data[0] for _, _, data in wheels]
    ax.set_title("Wheel forces, from the front of the train")
    ax.set_ylabel("kN")
    ax.bar(np.arange(len(forces)), forces, width=0.6, color=COLOURS[0])
    ax.set_xmargin(0.03)
    ax.grid(False, axis="x")
    if len(forces) <= MOST_CURVES:
        names = [f"{ordinal(k, len(results.vehicles), 'vehicle')},\n{name.replace('_', ' ')}" for k, name, _ in wheels]
        ax.set_xticks(np.arange(len(forces)), names, fontsize=9)
    else:
        ax.set_xticks([])


def draw_accelerations(ax, results, cars):
    """Draws vertical accelerations of car bodies; other bodies keep their own names."""
    count = len(cars)
    series = [results.over_time(car["acceleration"])[:, 1] for _, car in cars]
    names = {name.replace("_", " ") for name, _ in cars}
    if all(CAR.search(name) for name in names):
        noun, what = "car", "car body" if count == 1 else "car bodies"
    else:
        noun, what = (names.pop() if len(names) == 1 else "body"), "highest bodies"
        what = noun if noun != "body" and count == 1 else what
    title = f"Vertical acceleration of the {what}"
    if count <= MOST_WHEELS:
        time_panel(ax, results, title, "m/s²", [(ordinal(k, count, noun), a) for k, a in enumerate(series)])
        return
    band = (f"all {count}, least to greatest", *envelope(results, series))
    time_panel(ax, results, title, "m/s²", [(f"first {noun}", series[0]), (f"last {noun}", series[-1])], band)


def draw_positions(ax, results, direction):
    """Draws the bodies of a mechanism with the largest motion; direction 0: along x, 1: along y."""
    bodies = [(name, results.over_time(vehicle[name]["position"])[:, direction])
              for vehicle in results.vehicles for name in bodies_of(vehicle)]
    chosen = choose(len(bodies), MOST_CURVES, np.array([np.ptp(values) for _, values in bodies]))
    note = "" if len(chosen) == len(bodies) else f" ({len(chosen)} of {len(bodies)})"
    time_panel(ax, results, f"Centres of the bodies: {'xy'[direction]}{note}", "m",
               [(bodies[i][0].replace("_", " "), bodies[i][1]) for i in chosen])


def draw_sensors(ax, results, sensors, signal):
    title, unit = SIGNALS[signal]
    count = len(results.vehicles)
    series = [results.over_time(group[signal]) for _, _, group in sensors]
    chosen = choose(len(series), MOST_CURVES, np.array([np.abs(values).max() for values in series]))
    note = "" if len(chosen) == len(series) else f" ({len(chosen)} of {len(series)})"
    names = [f"{ordinal(k, count, 'vehicle')}, {name.replace('_', ' ')}" for k, name, _ in sensors]
    time_panel(ax, results, title + note, unit, [(names[i], series[i]) for i in chosen])
