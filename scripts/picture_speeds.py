"""Curves over the speed or another option: governing lines in front, the others pale; limits, and where they are
exceeded."""

import numpy as np
from picture_axes import COLOURS, GREY, PALE, RED, STYLES, note_beside
from picture_layout import LEADING, MARGIN, width_of, wrapped
from picture_runs import SPAN, digits, engineering, in_words, worst_of
from picture_table import draw_curve, keep

MOST_LINES = 8  # that all have colours; of more lines only the governing ones
MOST_NAMED, MOST_LISTED = 6, 14  # coloured lines of many; rows of the list beside the axes
SIZE = 8.5  # of the texts in and beside the axes


def is_logarithmic(x):
    """Whether given values are rather spaced by factors than by differences."""
    return x[0] > 0.0 and x[-1] / x[0] >= 10.0 and \
        (len(x) < 3 or np.ptp(np.diff(np.log(x))) < np.ptp(np.diff(x)) / np.mean(x))


def governing(values):
    """The lines that are the greatest of all somewhere, by their greatest value there: at most MOST_NAMED."""
    known = np.where(np.isnan(values), -np.inf, values)
    greatest = known.max(axis=0)
    reached = [greatest[(line == greatest) & np.isfinite(greatest)].max(initial=-np.inf) for line in known]
    return [int(i) for i in np.argsort(-np.array(reached), kind="stable")[:MOST_NAMED] if np.isfinite(reached[i])]


def intervals(x, where):
    """[(from, to)] of neighbouring places where it is true."""
    padded = np.concatenate([[False], where, [False]]).astype(int)
    starts, ends = np.flatnonzero(np.diff(padded) == 1), np.flatnonzero(np.diff(padded) == -1) - 1
    return list(zip(x[starts], x[ends]))


def ranges_in_words(x, where):
    """The places where it is true: '306 to 342, 387 to 414'; of many the first three."""
    parts = intervals(x, where)
    places = [digits(low) if low == high else f"{digits(low)} to {digits(high)}" for low, high in parts[:3]]
    return ", ".join(places) + (f" and {len(parts) - 3} more ranges" if len(parts) > 3 else "")


def above_in_words(limit, x, lines, unit):
    """Where lines (name, values) are above a limit, the greatest line first; empty if they are nowhere above it."""
    broken = [(name, values) for name, values in lines if np.any(np.nan_to_num(values) > limit.value)]
    broken.sort(key=lambda line: -np.nanmax(line[1]))
    said = [": ".join(filter(None, (name, f"{ranges_in_words(x, np.nan_to_num(values) > limit.value)} {unit}".strip())))
            for name, values in broken[:MOST_NAMED]]
    said += [f"and {len(broken) - MOST_NAMED} more"] if len(broken) > MOST_NAMED else []
    return f"above {limit.words}: {'; '.join(said)}" if said else ""


def draw_limits(ax, x, worst, limits):
    """Draws limits as lines, and the area above them."""
    high, far = ax.get_ylim()[1], []
    near = [limit for limit in limits if limit.value <= 2.5 * high]
    if near:
        ax.set_ylim(top=max(high, 1.14 * max(limit.value for limit in near)))
    for limit in limits:
        if limit not in near:
            far.append(limit.words)
            continue
        keep(ax, limit.words, x, np.full(len(x), limit.value))
        ax.axhline(limit.value, color=RED, lw=1.2, ls=(0, (6, 2)), zorder=4)
        ax.text(0.008, limit.value, limit.words, color=RED, fontsize=8, va="bottom", zorder=6,
                transform=ax.get_yaxis_transform(), bbox={"fc": "white", "ec": "none", "alpha": 0.8, "pad": 0.6})
        ax.fill_between(x, limit.value, worst, where=np.nan_to_num(worst) > limit.value, interpolate=True, color=RED,
                        alpha=0.12, lw=0, zorder=1)
    if far:
        ax.text(0.008, 0.985, "far above: " + "; ".join(far), color=RED, fontsize=8, va="top", transform=ax.transAxes)


def draw_peak_names(ax, points):
    """Writes names at the peaks of curves, where there is room. points: (x, y, name, colour)."""
    figure, box = ax.figure, ax.get_position()
    width, height = box.width * figure.get_figwidth(), box.height * figure.get_figheight()
    scale = ax.transData + ax.transAxes.inverted()
    taken, tall = [box_of(text, ax, width, height) for text in ax.texts], 1.15 * SIZE / 72.0
    for x, y, name, colour in points:
        right, up = scale.transform((x, y)) * (width, height)
        half = 0.5 * width_of(name, SIZE) + 0.03
        right = float(np.clip(right, half, width - half))
        for lift in (0.04, 0.04 + tall, 0.04 + 2.0 * tall):
            place = (right - half, up + lift, right + half, up + lift + tall)
            if place[3] < height + 0.05 and not any(overlap(place, other) for other in taken):
                taken.append(place)
                ax.text(right / width, (up + lift) / height, name, transform=ax.transAxes, ha="center", va="bottom",
                        color=colour, fontsize=SIZE, zorder=5,
                        bbox={"fc": "white", "ec": "none", "alpha": 0.7, "pad": 0.3})
                break


def box_of(text, ax, width, height):
    """The rectangle (left, low, right, high) of a text that starts at its position, inches in axes of this size."""
    left, up = ax.transAxes.inverted().transform(text.get_transform().transform(text.get_position())) * (width, height)
    low = up - 1.3 * text.get_fontsize() / 72.0 if text.get_va() == "top" else up
    return left, low, left + width_of(text.get_text(), text.get_fontsize()), low + 1.3 * text.get_fontsize() / 72.0


def overlap(one, other):
    """Whether two rectangles (left, low, right, high) overlap."""
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


def draw_list(ax, rows):
    """Writes rows (text, colour) beside the axes, from top to bottom; long ones are wrapped."""
    box, inches = ax.get_position(), ax.figure.get_figwidth()
    room, line = (1.0 - box.x0 - 1.035 * box.width) * inches - MARGIN, 0
    for text, colour in rows:
        parts = wrapped(text, room, SIZE)
        ax.text(1.035, 1.0 - line * LEADING * SIZE / (box.height * ax.figure.get_figheight()), "\n".join(parts),
                transform=ax.transAxes, va="top", color=colour, fontsize=SIZE)
        line += len(parts)


def rows_of(names, values, x_axis, unit, colours, sign):
    """The greatest value (for sign -1 the least one) of each line with its place as text, the worst line first."""
    at = [int(np.nanargmax(sign * line)) if not np.isnan(line).all() else -1 for line in values]
    order = sorted((i for i in range(len(names)) if at[i] >= 0), key=lambda i: -sign * values[i, at[i]])

    rows = []
    for i in order[:MOST_LISTED]:
        place = x_axis.full_words(at[i])
        name = f"{names[i]}:  " if names[i] else ""
        rows.append((f"{name}{in_words(values[i, at[i]], unit)} at {place}", colours[i]))
    if len(order) > MOST_LISTED:
        most = "most" if sign > 0.0 else "least"
        next_one = values[order[MOST_LISTED], at[order[MOST_LISTED]]]
        rows.append((f"and {len(order) - MOST_LISTED} more, at {most} {in_words(next_one, unit)}", GREY))
    return rows


def looks_of(names, values):
    """{name: (colour, style)} of lines [k, x] by their greatest values, for all panels of a picture."""
    order = np.argsort(-np.nanmax(np.nan_to_num(values, nan=-np.inf), axis=1), kind="stable")
    return {names[i]: (COLOURS[rank % len(COLOURS)], STYLES[rank // len(COLOURS) % len(STYLES)])
            for rank, i in enumerate(order)}


def draw_lines(ax, x_axis, names, values, unit, limits, sign, looks):
    """Draws lines [k, x]: the governing ones in their looks, the others pale, each with its worst value beside the
    axes, and the limits."""
    x, worst = x_axis.values, worst_of(values, sign)
    front = list(range(len(names))) if len(names) <= MOST_LINES else governing(sign * values)
    looks = [looks.get(name, (COLOURS[0], "-")) for name in names]
    colours = [looks[i][0] if i in front else GREY for i in range(len(names))]
    for i, name in enumerate(names):
        own = {"color": colours[i], "ls": looks[i][1], "lw": 1.7, "zorder": 3} if i in front else \
            {"color": PALE, "lw": 0.9, "zorder": 2}
        few = np.count_nonzero(~np.isnan(values[i])) < 4
        draw_curve(ax, x, values[i], name, marker="o" if few else None, ms=4, **own)
    if len(names) > 1:
        what = "greatest" if sign > 0.0 else "least"
        ax.plot(x, worst, color="#FFD24D", lw=7.0, alpha=0.55, zorder=1.5, solid_capstyle="round")
        note_beside(ax, f"yellow: {what} of all" + ("; grey: the other lines" if len(front) < len(names) else ""))
    ax.set_xlabel(x_axis.label())
    label_values(ax, unit)
    finish(ax, x, worst)
    if x_axis.name == "train":
        ax.set_xticks(x, [x_axis.words(i) for i in range(len(x))])
    draw_limits(ax, x, worst, limits)
    rows = [(words, RED) for limit in limits if (words := above_in_words(limit, x, zip(names, values), x_axis.unit))]
    peaks = [(i, int(np.nanargmax(sign * line))) for i, line in enumerate(values) if not np.isnan(line).all()]
    peaks.sort(key=lambda peak: (peak[0] not in front, -sign * values[peak]))
    if len(names) > 1 and sign > 0.0:
        draw_peak_names(ax, [(x[at], values[i, at], names[i], colours[i]) for i, at in peaks
                             if 0 < at < len(x) - 1 or i not in front])
    listed = [f"{name} (dashed)" if i in front and looks[i][1] != "-" else name for i, name in enumerate(names)]
    draw_list(ax, rows_of(listed, values, x_axis, unit, colours, sign) + rows)


def label_values(ax, unit):
    """Labels the axis of the values with their unit; deflections over the span are written at the axis as L/600."""
    ax.set_ylabel(unit or "ratio")
    if unit == SPAN:
        ax.yaxis.set_major_formatter(lambda value, place: in_words(value, SPAN))
        ax.yaxis.label.set_visible(False)


def finish(ax, x, worst):
    """Sets the ranges of the axes: from zero to above the greatest value."""
    if is_logarithmic(x):
        ax.set_xscale("log")
        ax.set_xticks(x if len(x) < 9 else x[::len(x) // 6], minor=False)
        ax.set_xticks([], minor=True)
        ax.xaxis.set_major_formatter(lambda value, place: digits(value))
    there = x[~np.isnan(worst)]
    if len(there) > 1:
        ax.set_xlim(there[0], there[-1])
    top, low = (np.nanmax(worst), np.nanmin(worst)) if len(there) else (1.0, 0.0)
    ax.set_ylim(min(0.0, 1.1 * low), 1.14 * top if top > 0.0 else 1.0)


def draw_resonances(ax, results):
    """Draws pale lines at the resonance speeds v = f1 d/i that the file predicts for a single train; whether there are
    any."""
    if "resonances/speed" not in results.file or "resonances/hslm_a" in results.file:
        return False
    first = results.values("resonances/mode") == 1.0
    speeds = engineering("speed")[1] * results.values("resonances/speed")[first]
    orders = results.values("resonances/order")[first]
    low, high = ax.get_xlim()
    inside = (speeds > low) & (speeds < high) & (orders <= 4.0)
    for speed, order in zip(speeds[inside], orders[inside]):
        ax.axvline(speed, color=COLOURS[0], lw=1.0, alpha=0.35, zorder=0.5)
        ax.text(speed, 0.99, f" i = {order:.0f}", transform=ax.get_xaxis_transform(), fontsize=8, va="top", color=GREY)
    return bool(inside.any())
