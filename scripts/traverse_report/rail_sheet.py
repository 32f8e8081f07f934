"""The page of track-bridge interaction by UIC 774-3: effects of temperature, weight and braking along the track."""

from picture_axes import PALE

from .curves import look
from .language import digits, num, t
from .page import GREY, LEFT, table
from .quantities import unit_of_si

CASES = {"temperature": "temperature", "bending": "vertical load", "braking": "braking", "traction": "traction",
         "separate": "sum of the separate cases", "in_sequence": "loads in sequence", "at_once": "all loads at once"}
PEAKS = {"tension": ("additional tension", "Pa"), "compression": ("additional compression", "Pa"),
         "slip": ("rail relative to deck or ground", "m"), "end": ("longitudinal displacement of the deck end", "m")}
FORCES = {"bearing": ("longitudinal bearing force", "N", "bearing_x"),
          "opening": ("movement of the expansion device", "m", "device_x")}


def cases(source):
    return [case for case in CASES if case in source.file["rail_forces"]]


def places(source):
    """(name, words, unit, factor, x) of the stored values of bearings and devices."""
    group = source.file["rail_forces"]
    return [(name, t(words), *unit_of_si(si), group[at][:]) for name, (words, si, at) in FORCES.items()
            if at in group and len(group[at])]


def rows(source):
    """Head and rows, one row per case: peaks with their x, bearing forces, movements of devices."""
    if not source.is_rail:
        return [], []
    group = source.file["rail_forces"]
    peaks = {name: (t(words), *unit_of_si(si)) for name, (words, si) in PEAKS.items()}
    head = [t("case")] + [said for words, unit, _ in peaks.values()
                          for said in (f"{words} ({unit})", f"{words}, x (m)")]
    head += [f"{words}, x = {num(x)} m ({unit})" for _, words, unit, _, stations in places(source) for x in stations]
    found = []
    for case in cases(source):
        values = [value for name, (_, _, factor) in peaks.items()
                  for value in (factor * group[f"{case}/{name}"][0], group[f"{case}/{name}"][1])]
        values += [factor * value for name, _, _, factor, _ in places(source) for value in group[f"{case}/{name}"][:]]
        found.append([t(CASES[case]), *values])
    return head, found


def envelope_rows(source):
    """Head and rows: least and greatest additional stress of every case along the track."""
    if not source.is_rail:
        return [], []
    group, (unit, factor) = source.file["rail_forces"], unit_of_si("Pa")
    names = [(case, side) for case in cases(source) if f"{case}/least_stress" in group
             for side in ("least", "greatest")]
    return (["x (m)"] + [f"{t(CASES[case])}, {t(side)} ({unit})" for case, side in names],
            list(zip(group["x"][:], *(factor * group[f"{case}/{side}_stress"][:] for case, side in names))))


def peak_rows(source):
    """Rows (quantity, value, unit, place) of the peaks under the loads in sequence, in the unit."""
    case, found = source.file["rail_forces/in_sequence"], []
    for name, (words, si) in PEAKS.items():
        (unit, factor), (value, x, front) = unit_of_si(si), case[name][:]
        found.append((t(words), factor * value, unit,
                      t("x = {x} m, front of the train at {front} m", x=num(round(x, 3)), front=num(front))))
    return found + [(words, factor * value, unit, f"x = {num(x)} m")
                    for name, words, unit, factor, stations in places(source)
                    for x, value in zip(stations, case[name][:])]


def draw_envelopes(ax, source, quantity, si, at):
    """Draws least and greatest values of every case along the track, over all positions of the train."""
    group, (unit, factor) = source.file["rail_forces"], unit_of_si(si)
    x, ends = group[at][:], source.model.span_ends
    for i, case in enumerate(cases(source)):
        colour, style, _ = look(i)
        for side in ("least", "greatest"):
            if f"{case}/{side}_{quantity}" in group:
                ax.plot(x, factor * group[f"{case}/{side}_{quantity}"][:], color=colour, ls=style,
                        lw=1.8 if case == "in_sequence" else 1.0, label=None if side == "least" else t(CASES[case]))
    ax.axhline(0.0, color=PALE, lw=1.0)
    for end in (ends[0], ends[-1]):
        ax.axvline(end, color=PALE, lw=1.0)
    beyond = ends[-1] - ends[0]
    ax.set(xlim=(max(x[0], ends[0] - beyond), min(x[-1], ends[-1] + beyond)), xlabel=t("position along the track (m)"),
           ylabel=unit)
    ax.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False, fontsize=7.5, handlelength=2.6)


def sheet(report, source):
    if not source.is_rail:
        return
    page = report.page(t("Track-bridge interaction by UIC 774-3"))
    report.anchor("rail")
    page.text(LEFT, t("The greatest values over all positions of the train, with their position x. The stress is "
                      "additional to that of a rail without bridge. The limits apply to the loads in sequence: "
                      "temperature, then the train."))
    page.y -= 0.1
    group, cells = source.file["rail_forces"], []
    for case in cases(source):
        peaks = [f"{digits(factor * group[f'{case}/{name}'][0])} {unit}, x = "
                 f"{num(round(group[f'{case}/{name}'][1], 3))}"
                 for name, (unit, factor) in ((name, unit_of_si(si)) for name, (_, si) in PEAKS.items())]
        others = [t("; ").join(f"{digits(factor * value)} {unit}, x = {num(x)}"
                               for x, value in zip(stations, group[f"{case}/{name}"][:]))
                  for name, _, unit, factor, stations in places(source)]
        cells.append([t(CASES[case]), *peaks, *others])
    columns = [(t("case"), 1.2, "left")] + [(t(words), 1.02, "left") for words, _ in PEAKS.values()]
    columns += [(words, 0.75, "left") for _, words, *_ in places(source)]
    page = table(report, page, columns, cells, size=6.5)
    page.text(LEFT, t("Check of equilibrium: the sum of all forces along the track is {share} of the largest force.",
                      share=num(float(group.attrs["residual"]), ".1g")), size=8, colour=GREY)
    for quantity, si, at, words in (("stress", "Pa", "x", "Additional stress of the rails, least and greatest"),
                                    ("slip", "m", "sleeper_x", "Rail relative to deck or ground, least and greatest")):
        ax = page.axes(2.2, right=1.95)
        draw_envelopes(ax, source, quantity, si, at)
        ax.set_title(t(words))
