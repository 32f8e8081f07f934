#!/usr/bin/python3
"""Draws several results files in common axes: compare.py A.h5 B.h5 [C.h5 ...] -o OUT.png [--formats png,svg,pdf,csv]

The page contains the quantities that at least two of the files have: of single runs over time, or over the place of the
first wheel if the speeds differ, and along the bridge; of sweeps and studies over the common option. A table lists the
peaks with their differences from the first file, and another one the options in which the files differ.
"""

import argparse
import sys

import matplotlib

matplotlib.use("Agg")
import numpy as np  # noqa: E402
import output_files  # noqa: E402
import picture_page  # noqa: E402
from checked_results import in_one_line  # noqa: E402
from compare_data import abscissa, differing, opened_cases, peaks, runs_over_x, shown_option, station_curves  # noqa: E402
from engineering_units import shown  # noqa: E402
from picture_axes import COLOURS, GREY, STYLES, End, Panel, label_at_ends  # noqa: E402
from picture_bridge import QUANTITIES, STATIC  # noqa: E402
from picture_data import envelope, thin  # noqa: E402
from picture_layout import LEADING, wrapped  # noqa: E402
from picture_runs import digits  # noqa: E402
from picture_table import draw_curve  # noqa: E402
from picture_vehicles import cars_of, wheels_of  # noqa: E402

MOST_FILES, SIZE = 8, 9.0
MOST_OPTIONS = 24  # rows of the table of options
# Panels of scene_analysis rail: the quantity, the row of engineering_units.csv, its places, its title.
RAIL = [("stress", "stress", "x", "Additional stress of the rails"),
        ("slip", "displacement", "sleeper_x", "Displacement of the rail relative to deck or ground")]


def look(i):
    """Later lines are thinner, so that equal ones remain visible."""
    return {"color": COLOURS[i % len(COLOURS)], "ls": STYLES[i // len(COLOURS)], "lw": max(2.6 - 0.6 * i, 0.8)}


def draw_curves(ax, cases, curves, title, unit, label):
    """Draws one or several curves of each case, which has one name. curves: for each case [(x, values, what)]."""
    ends = []
    for i, (case, own) in enumerate(zip(cases, curves)):
        for x, values, what in own:
            draw_curve(ax, *thin(x, values), f"{case.name}{what}", **look(i))
        if own:
            ends.append((own[0][0], own[0][1], case.name, look(i)))
    ax.set(title=title, ylabel=unit or "ratio", xlabel=label)
    low, high = min(x[0] for x, *_ in ends), max(x[-1] for x, *_ in ends)
    ax.set_xlim(low, high if high > low else low + 1.0)
    least, greatest = ax.get_ylim()
    if 0.0 < least < 0.6 * greatest:
        ax.set_ylim(bottom=0.0)
    wide = max(high - low, 1e-12)
    label_at_ends(ax, [End(values[last[-1]], name, own["color"], own["ls"], (x[last[-1]] - low) / wide)
                       for x, values, name, own in ends if len(last := np.flatnonzero(~np.isnan(values)))])


def panel(cases, curves, title, unit, label):
    """One panel of the curves of each case, if at least two cases have some; otherwise none."""
    return [Panel(lambda ax, worst: draw_curves(ax, cases, curves, title, unit, label), 2.2)] if \
        sum(bool(own) for own in curves) > 1 else []


def of_stations(cases, label, xs):
    """Panels of the bridge over time or over the place of the train."""
    found = []
    for name, (title, kind) in QUANTITIES.items():
        drawn = station_curves(cases, name, kind) if name != "shear" else None
        if drawn is not None:
            unit, place, values = drawn
            found += panel(cases, [[(x, one, "")] if one is not None else [] for x, one in zip(xs, values)],
                           f"{title}: {place}", unit, label)
    return found


def of_envelopes(cases):
    """Panels of the least and greatest values along the bridge."""
    found = []
    for name, (title, kind) in QUANTITIES.items():
        unit, factor = shown(kind)
        curves = []
        for case in cases:
            values = case.results.values(f"envelope/{name}")
            curves.append([] if values is None or len(values) < 4 else
                          [(case.results.probes, factor * values[:, side], f", {word}")
                           for side, word in enumerate(("least", "greatest"))])
        found += panel(cases, curves, f"{title.split(',')[0]} along the bridge, least and greatest", unit,
                       "place along the bridge (m)")
    return found


def of_statics(cases):
    """Panels of static effects along the bridge, least and greatest of all loads and of all their positions."""
    found = []
    for name, title in STATIC.items():
        unit, factor = shown(QUANTITIES[name][1])
        curves = []
        for case in cases:
            x, values = case.results.values("static/x"), case.results.values(f"static/{name}")
            curves.append([] if x is None else [(x, factor * values[..., 0].min(axis=0), ", least"),
                                                (x, factor * values[..., 1].max(axis=0), ", greatest")])
        found += panel(cases, curves, title, unit, "place along the bridge (m)")
    return found


def of_rails(cases):
    """Panels of scene_analysis rail: least and greatest values along the track, of the loads one after the other."""
    found = []
    for quantity, kind, at, title in RAIL:
        unit, factor = shown(kind)
        curves = []
        for case in cases:
            x = case.results.values(f"rail_forces/{at}")
            curves.append([] if x is None else
                          [(x, factor * case.results.values(f"rail_forces/in_sequence/{side}_{quantity}"), f", {side}")
                           for side in ("least", "greatest")])
        found += panel(cases, curves, title, unit, "place along the track (m)")
    return found


def of_vehicles(cases, label, xs):
    """Panels of all wheel forces, least and greatest, and of the accelerations of the first car."""
    (force, newton), (acceleration, factor) = shown("force"), shown("acceleration")
    wheels, cars = [], []
    for case, x in zip(cases, xs):
        results = case.results
        there = [newton * results.over_time(data) for _, _, data in wheels_of(results)] if results.rows > 1 else []
        sides = zip(envelope(results, there), ("least", "greatest"))
        wheels.append([(x, values, f", {word}") for values, word in sides] if there else [])
        bodies = cars_of(results) if results.rows > 1 else []
        cars.append([(x, factor * results.over_time(bodies[0][1]["acceleration"])[:, 1], "")] if bodies else [])
    return panel(cases, wheels, "Wheel forces, least and greatest of all wheels", force, label) + \
        panel(cases, cars, "Vertical acceleration of the first car, or of its highest body", acceleration, label)


def of_runs(cases):
    """Panels of sweeps and studies: the worst of all other options over the common one."""
    return [one for title, unit, label, lines in runs_over_x(cases)
            for one in panel(cases, [[line] if line is not None else [] for line in lines], title, unit, label)]


def difference(value, first):
    """The difference from the first value as text: '+3.2 %'."""
    if np.isnan(value) or np.isnan(first) or first == 0.0:
        return ""
    percent = 100.0 * (abs(value) - abs(first)) / abs(first)
    return f"{percent:+.3g} %".replace("-", "−") if abs(percent) >= 0.001 else "0 %"


def peak_rows(cases):
    """Head and rows of the table of peaks, in words. Values at different places have these instead of differences."""
    rows = []
    for words, unit, values, places in peaks(cases):
        texts = ["" if np.isnan(value) else digits(value).replace("-", "−") for value in values]
        changes = ["", *(difference(value, values[0]) for value in values[1:])]
        if len({round(place, 3) for place in places if not np.isnan(place)}) > 1:
            changes = ["" if np.isnan(place) else f"at {place:.5g} m" for place in places]
        rows.append([f"{words} ({unit})" if unit else words,
                     *(f"{text} ({change})" if change else text for text, change in zip(texts, changes))])
    return ["peak (difference from the first, or place)", *(case.name for case in cases)], rows


def option_rows(cases):
    """Head and rows of the table of options in which the files differ."""
    table = differing([case.results for case in cases])
    rows = [[name, *(shown_option(name, value) or "–" for value in values)]
            for name, values in list(table.items())[:MOST_OPTIONS]]
    if len(table) > MOST_OPTIONS:
        rows.append([f"and {len(table) - MOST_OPTIONS} more", *[""] * len(cases)])
    return ["option", *(case.name for case in cases)], rows


def table_panel(title, head, rows):
    """A panel with a table of texts; the first column is twice as wide as the others. Its texts are wrapped."""
    width = picture_page.WIDE * picture_page.WIDTH / (len(head) + 1)
    widths = [2.0 * width, *[width] * (len(head) - 1)]
    cells = [[wrapped(text, inches - 0.15, SIZE, "bold" if row is head else "normal")
              for text, inches in zip(row, widths)] for row in [head, *rows]]
    heights = [LEADING * SIZE * (max(map(len, row)) + 0.25) for row in cells]

    def draw(ax, worst):
        ax.axis("off")
        ax.set_title(title)
        total, y = sum(heights), 0.0
        for number, (row, height) in enumerate(zip(cells, heights)):
            for i, lines in enumerate(row):
                colour = COLOURS[(i - 1) % len(COLOURS)] if number == 0 and i else GREY if number == 0 else "black"
                ax.text(sum(widths[:i]) / sum(widths), 1.0 - y / total, "\n".join(lines), transform=ax.transAxes,
                        va="top", fontsize=SIZE, color=colour, weight="bold" if number == 0 else "normal")
            y += height
            ax.plot([0.0, 1.0], [1.0 - (y - 0.03) / total] * 2, color="#DDDDDD", lw=0.7, transform=ax.transAxes,
                    clip_on=False)

    return Panel(draw, sum(heights), True)


def draw(cases, out, formats):
    """Draws the comparison; ValueError if the files have nothing in common."""
    label, xs = abscissa(cases)
    found = of_stations(cases, label, xs) + of_vehicles(cases, label, xs) + of_envelopes(cases) + of_runs(cases) + \
        of_statics(cases) + of_rails(cases)
    head, rows = peak_rows(cases)
    if not found and not rows:
        raise ValueError("the files have no quantity in common")
    options = option_rows(cases)
    found += [table_panel("Peaks", head, rows)] if rows else []
    found += [table_panel("Options in which the files differ", *options)] if options[1] else []
    figure = picture_page.new_figure()
    scenes = list(dict.fromkeys(case.results.scene() for case in cases))
    same = "" if options[1] else "; their options are the same"
    picture_page.draw_panels(figure, found, f"Comparison of {len(cases)} results: {', '.join(scenes)}",
                             "; ".join(case.path.name for case in cases) + same, "")
    picture_page.save(figure, out, formats)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", nargs="+", help=f"results files (HDF5), 2 to {MOST_FILES}")
    parser.add_argument("-o", "--out", required=True, help="the picture: .png, .pdf or .svg")
    picture_page.add_formats(parser)
    arguments = parser.parse_args()
    formats = picture_page.listed("compare.py", "formats", arguments.formats, picture_page.FORMATS)
    if not 2 <= len(arguments.results) <= MOST_FILES:
        sys.exit(f"compare.py: give 2 to {MOST_FILES} results files, not {len(arguments.results)}")
    try:
        picture_page.check(arguments.out, formats, arguments.results)
        draw(opened_cases(arguments.results), arguments.out, formats)
    except (OSError, ValueError) as error:
        sys.exit(f"compare.py: {in_one_line(error)}")
    except Exception as error:
        sys.exit(f"compare.py: a file {in_one_line(error)}")


if __name__ == "__main__":
    output_files.run(main)
