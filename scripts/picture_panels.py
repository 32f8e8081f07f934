"""The panels of a picture from top to bottom: what a results file holds decides which there are."""

import picture_find
import picture_fit
import picture_hanging
import picture_rail
import picture_screen
import picture_sensitivity
from picture_axes import Panel
from picture_bridge import QUANTITIES, STATIC, draw_bearings, draw_probes, draw_shape, draw_static
from picture_data import spring_gaps
from picture_study import panels_of
from picture_track import FEWEST_SPRINGS, draw_seats, draw_wheel_paths, seats_of, track_of, wheel_paths
from picture_vehicles import (
    SIGNALS, cars_of, chains_of, draw_accelerations, draw_chains, draw_drives, draw_positions, draw_sensors,
    draw_static_wheels, draw_wheels, drives_of, sensors_of, wheels_of)

MAY_BE_ASKED = ["acceleration", "moment", "shear", "bearings", "sensors", "wheels"]


def over_time(drawing, *data):
    """A panel of a function of axes, results and data."""
    return Panel(lambda ax, worst: drawing(ax, *data))


def asked_panels(results, asked):
    """The requested panels of a single run with data in the file; bearing forces also where a gap may close."""
    found, sensors = [], sensors_of(results)
    for name in dict.fromkeys([*asked, *(["bearings"] if gaps_of(results) else [])]):
        if name == "bearings" and ("supports/reaction" in results.file or "foundation/vertical/force" in results.file):
            found.append(over_time(draw_bearings, results))
        elif name == "sensors" and sensors:
            found += [over_time(draw_sensors, results, sensors, signal) for signal in list(SIGNALS)[1:]]
        elif name in QUANTITIES and f"probes/{name}" in results.file:
            found.append(over_time(draw_probes, results, name))
    return found


def gaps_of(results):
    """Whether a few foundation springs have gaps, so that their forces are of interest."""
    return 0 < len(spring_gaps(results)) < FEWEST_SPRINGS


def of_vehicles(results):
    """Panels of the vehicles of a single run."""
    found, wheels, cars, sensors = [], wheels_of(results), cars_of(results), sensors_of(results)
    along = list(wheel_paths(results)) if results.rows > 1 and (track_of(results) or seats_of(results)) else []
    if wheels and (not along or "separations/start" in results.file):
        found.append(over_time(draw_wheels if results.rows > 1 else draw_static_wheels, results, wheels))
    if results.rows < 2:
        return found
    found += [over_time(draw_wheel_paths, results, along)] if along else []
    hanging = picture_hanging.hanging_of(results)
    found += [over_time(picture_hanging.draw, results, hanging, what) for what in ("swing", "force") if hanging]
    chains = chains_of(results)
    drives = drives_of(results, [name for one in hanging for name in one.joint.split(" and ")])
    found += [over_time(draw_chains, results, chains)] if chains else []
    found += [over_time(draw_drives, results, drives)] if drives else []
    if cars and not wheels and results.probes is None:
        found += [over_time(draw_positions, results, direction) for direction in (0, 1)]
    elif cars:
        found.append(over_time(draw_accelerations, results, cars))
    return found + ([over_time(draw_sensors, results, sensors, next(iter(SIGNALS)))] if sensors else [])


def of_run(results, asked):
    """Panels of a single run: the bridge, the loads that hang, the stations over time, the track and the vehicles."""
    file, found = results.file, []
    if "shape/deflection" in file and len(file["shape/x"]) > 1:
        found.append(Panel(lambda ax, worst: draw_shape(ax, results), 2.2 if track_of(results) else 1.75))
    if results.rows < 1:
        return found
    if results.rows > 1:
        travelling = [one for one in picture_hanging.hanging_of(results) if one.travels]
        if travelling and results.probes is not None:
            found.append(Panel(lambda ax, worst: picture_hanging.draw_places(ax, results, travelling), 2.4))
        if "probes/deflection" in file and len(results.probes):
            found.append(Panel(lambda ax, worst: draw_probes(ax, results, "deflection", worst)))
            if "rail/deflection" in file:
                found.append(over_time(draw_probes, results, "deflection", None, "rail"))
        found += asked_panels(results, asked)
        seats = seats_of(results)
        found += [over_time(draw_seats, results, seats)] if seats else []
    return found + of_vehicles(results)


def panels(results, asked=()):
    """All panels from top to bottom."""
    file, found = results.file, of_run(results, asked)
    if "find/ratio" in file:
        found += picture_find.panels_of(results)
    elif "sensitivity/units" in file:
        found += picture_sensitivity.panels_of(results, asked)
    elif "sweep/peak_deflection" in file or "study/finished" in file:
        found += panels_of(results, asked)
    if "fit" in file:
        found += picture_fit.panels_of(results)
    if not found and "static/x" in file:
        found += [over_time(draw_static, results, name) for name in STATIC]
    if not found and "rail_forces/x" in file:
        found += [over_time(panel, results) for panel in picture_rail.PANELS]
    if not found and "screen/ratio" in file:
        found.append(Panel(lambda ax, worst: picture_screen.draw(ax, results), 5.0))
    return found
