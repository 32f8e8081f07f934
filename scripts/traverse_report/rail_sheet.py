"""The page of track-bridge interaction by UIC 774-3: effects of temperature, weight and braking along the track."""

import picture_rail

from .page import GREY, LEFT, table
from .source import digits

CASES = ("temperature", "bending", "braking", "traction", "separate", "in_sequence", "at_once")
WORDS = {**picture_rail.CASES, "separate": "these added up"}
PEAKS = {"tension": ("tension", "MPa", 1e-6), "compression": ("compression", "MPa", 1e-6),
         "slip": ("rail relative to deck or ground", "mm", 1e3), "end": ("deck end", "mm", 1e3)}
FORCES = {"bearing": ("bearing", "kN", 1e-3), "opening": ("device opening", "mm", 1e3)}


def places(source):
    """(quantity, name, unit, factor, x) of the stored values of bearings and devices."""
    group = source.file["rail_forces"]
    return [(name, *FORCES[name], group[f"{at}_x"][:]) for name, at in (("bearing", "bearing"), ("opening", "device"))
            if f"{at}_x" in group and len(group[f"{at}_x"])]


def rows(source):
    """Head and rows in SI units, one row per case: peaks with their x, bearing forces, openings of devices."""
    if not source.is_rail:
        return [], []
    group = source.file["rail_forces"]
    head = ["case"] + [f"{name} ({unit})" for peak in PEAKS for name, unit in
                       ((peak, "Pa" if peak in ("tension", "compression") else "m"), (f"{peak}, x", "m"))]
    head += [f"{name} at {x:g} m ({group[f'in_sequence/{name}'].attrs['unit']})"
             for name, *_, stations in places(source) for x in stations]
    found = [[WORDS[case]] + [value for peak in PEAKS for value in group[f"{case}/{peak}"][:2]] +
             [value for name, *_ in places(source) for value in group[f"{case}/{name}"][:]]
             for case in CASES if case in group]
    return head, found


def envelope_rows(source):
    """Head and rows: least and greatest additional stress of every case along the track."""
    if not source.is_rail:
        return [], []
    group = source.file["rail_forces"]
    names = [f"{case}/{side}_stress" for case in CASES if case in group for side in ("least", "greatest")]
    return ["x (m)"] + [f"{name} (Pa)" for name in names], list(zip(group["x"][:], *(group[name][:] for name in names)))


def peak_rows(source):
    """Rows (quantity, value, place) of the peaks under the loads in sequence."""
    case = source.file["rail_forces/in_sequence"]
    found = [(words, f"{digits(factor * case[name][0])} {unit}", f"x = {case[name][1]:.4g} m, train's front at "
              f"{case[name][2]:.4g} m") for name, (words, unit, factor) in PEAKS.items()]
    for name, words, unit, factor, stations in places(source):
        found += [(words, f"{digits(factor * value)} {unit}", f"x = {x:.4g} m") for x, value in zip(stations, case[name][:])]
    return found


def sheet(report, source):
    if not source.is_rail:
        return
    page = report.page("Track-bridge interaction: UIC 774-3")
    page.text(LEFT, "The largest values over all positions of the train, @ x in m. The stress is additional to that of a "
                    "restrained rail. Limits apply to the sequence of temperature and train.", size=8.5)
    page.y -= 0.1
    group, cells = source.file["rail_forces"], []
    for case in CASES:
        if case not in group:
            continue
        peaks = [f"{digits(factor * group[f'{case}/{name}'][0])} {unit} @ {round(group[f'{case}/{name}'][1], 3):.4g}"
                 for name, (_, unit, factor) in PEAKS.items()]
        others = ["; ".join(f"{digits(factor * value)} {unit} @ {x:.4g}" for x, value in
                            zip(stations, group[f"{case}/{name}"][:])) for name, _, unit, factor, stations in places(source)]
        cells.append([WORDS[case], *peaks, *others])
    columns = [("", 1.2, "left")] + [(words, 1.0, "left") for words, _, _ in PEAKS.values()]
    columns += [(words, 0.85, "left") for _, words, *_ in places(source)]
    page = table(report, page, columns, cells, size=6.5)
    residual = float(group.attrs["residual"])
    page.text(LEFT, f"Sum of all forces along x: {residual:.1g} of the largest force.", size=8, colour=GREY)
    for draw in picture_rail.PANELS:
        draw(page.axes(2.3, right=1.75), source.results)
