"""The page of ride comfort by scripts/comfort.py, for runs with accelerations of their cars."""

import comfort
import numpy as np
from picture_data import car_body

from .language import num, t
from .page import GREY, LEFT, table
from .quantities import unit_of_si

LONGEST_INTERVAL = 0.01  # s; longer intervals do not resolve the weighted frequencies


def places(source, vehicle, body):
    """Distances from the centre of the body: 0 and those of its outermost springs, above the bogies."""
    model = source.model
    if vehicle >= len(model.train) or "vehicles" not in model.group:
        return [0.0]
    index = model.train[vehicle, 0]
    names = [str(name) for name in model.group[f"vehicles/{int(index)}/names"].asstr()[:, 1]]
    if body not in names:
        return [0.0]
    number = names.index(body)
    centre = model.rows(index, "bodies", 3)[number, 0]
    ends = [x - centre for x1, _, x2, _, first, second in model.rows(index, "springs", 6)
            for x, held in ((x1, first), (x2, second)) if held == number]
    if not ends or max(ends) - min(ends) < 0.01:
        return [0.0]
    return [round(min(ends), 6), 0.0, round(max(ends), 6)]


def comfort_rows(source):
    """Rows (vehicle, body, distance, Comfort), and the reason if there are none."""
    results = source.results
    if results.time is None or results.rows < 3 or not results.vehicles or source.is_crane:
        return [], ""
    steps = np.diff(results.time[:results.rows])
    if np.ptp(steps) > 1e-6 * steps[0]:
        return [], t("The samples are not evenly spaced: comfort is not evaluated.")
    if steps[0] > LONGEST_INTERVAL * (1.0 + 1e-9):
        return [], t("Samples every {step} s are too long for the frequency weighting; allowed: at most {longest} s "
                     "(option -output_interval).", step=num(steps[0]), longest=num(LONGEST_INTERVAL))
    rows = []
    for i, vehicle in enumerate(results.vehicles):
        body = car_body(vehicle)
        if body is None:
            continue
        a = results.over_time(vehicle[f"{body}/acceleration"])
        rows += [(i, body, x, comfort.comfort(a[:, 1] + x * a[:, 2], steps[0])) for x in places(source, i, body)]
    return rows, ""


def sheet(report, source, run):
    rows, trouble = comfort_rows(source)
    if not rows and not trouble:
        return
    page = report.page(t("Ride comfort"))
    report.anchor("comfort")
    page.text(LEFT, run, colour=GREY)
    if trouble:
        page.text(LEFT, trouble, colour=GREY)
        return
    time = source.results.time
    page.text(LEFT, t("Vertical accelerations of the car bodies over {duration} s of one passage, sampled every {step} "
                      "s: root mean square; greatest root mean square weighted by Wb of EN 12299 in windows of 5 s; "
                      "index N_MV of the vertical direction only; ride index of Sperling. A run shorter than 5 s is "
                      "one window. The norm requires five minutes of line: these values are for comparison only.",
                      duration=num(time[-1] - time[0]),
                      step=num(time[1] - time[0])), size=8, colour=GREY)
    page.y -= 0.08
    unit, _ = unit_of_si("m/s2")
    table(report, page, [(t("vehicle"), 0.7, "right"), (t("body"), 1.0, "left"), (t("from its centre"), 0.95, "right"),
                         (f"{t('rms')} ({unit})", 0.85, "right"), (f"Wb ({unit})", 0.85, "right"),
                         (t("windows"), 0.75, "right"),
                         ("N_MV", 0.85, "right"), ("Sperling Wz", 0.85, "right")],
          [[f"{i}", body, f"{num(x, '+.4g')} m" if x else "0", num(felt.rms, ".4f"), num(felt.weighted, ".4f"),
            f"{felt.windows}",
            num(felt.n_mv, ".3f"), num(felt.sperling, ".3f")] for i, body, x, felt in rows])
