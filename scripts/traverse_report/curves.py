"""Curves over the speed, one per train, with limit lines; envelopes; time histories."""

import numpy as np
from engineering_units import shown
from picture_axes import COLOURS, GREY, LABEL_SIZE, PALE, End, label_at_ends, note_beside
from picture_data import choose, thin
from picture_layout import width_of, wrapped

from .language import t
from .limits import STORED
from .quantities import shown_value, unit_of

RED = "#B00020"  # used for limits only
# Lines differ in colour and in style, so that a grey print distinguishes them too.
STYLES = ["-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (7, 1.5, 1.2, 1.5))]
MARKS = ["o", "s", "^", "D", "v", "P"]
MOST_LINES = len(COLOURS) * len(STYLES)
ENOUGH_A_SPAN = 4  # probes per span, for a line between them
MOST_LISTED = 14  # entries of a list beside the axes
WIDEST_NAMES = 2.4  # inches beside the axes for names
BELOW_ORDERS = 0.95  # of the height of axes, below the orders of resonances


def look(i):
    """Colour, style and mark of line i: neighbouring lines differ in all of them."""
    turn = i // len(COLOURS)
    return COLOURS[i % len(COLOURS)], STYLES[(i + turn) % len(STYLES)], MARKS[(i + turn) % len(MARKS)]


def mark_every(count):
    return max(count // 12, 1)


def name_limit(ax, value, words, size, side):
    """Writes the name of a limit at its line, which is at this side of the text."""
    ax.text(0.006, value, words, color=RED, fontsize=size, va=side, ha="left", zorder=6,
            transform=ax.get_yaxis_transform(), bbox={"fc": "white", "ec": "none", "alpha": 0.8, "pad": 0.6})


def draw_limits(ax, limits, size=7):
    """Draws limits: (value, text) in the unit of the axes. A limit far above the curves is named, not drawn."""
    low, high = ax.get_ylim()
    shown = [limit for limit in limits if limit[0] <= 2.5 * high]
    if shown:
        ax.set_ylim(low, max(high, 1.12 * max(value for value, _ in shown)))
    for value, words in shown:
        ax.axhline(value, color=RED, lw=1.2, ls=(0, (6, 2)), zorder=4)
        name_limit(ax, value, words, size, "bottom")
    beyond = [words for value, words in limits if value > 2.5 * high]
    if beyond:
        low, high = ax.get_ylim()
        words = t("beyond this axis: {limits}", limits="\n".join(beyond))
        name_limit(ax, low + BELOW_ORDERS * (high - low), words, size, "top")


def limit_lines(source, limits, name):
    """The limits of a quantity of the file, in the unit of its curve."""
    factor = unit_of(name)[1]
    spans = np.unique(np.round(np.diff(source.model.span_ends), 6))
    lines = []
    for limit in limits:
        words = f"{shown_value(limit.value, limit.quantity)} ({limit.clause})"
        share = factor * source.runs.factors.get(name, 1.0) / limit.factor  # the curve has the factor of the file
        if STORED.get(limit.quantity, limit.quantity) == name:
            lines.append((share * limit.value, t("limit {value}", value=words)))
        elif limit.quantity == "deflection_over_span" and name == "peak_deflection" and len(spans) == 1:
            lines.append((share * limit.value * spans[0], t("limit {value}", value=words)))
        elif limit.quantity == "deck_acceleration" and name == "peak_acceleration" and \
                "deck_acceleration" not in source.runs.values:
            lines.append((share * limit.value, t("{value} applies to low-pass filtered values", value=words)))
    return lines


def draw_resonances(ax, source, lines):
    """Draws light lines at the predicted resonance speeds of the first frequency, in the colour of each train, and
    dotted lines at the cancellation speeds. Returns whether the file contains resonance speeds."""
    file = source.file
    low, high = ax.get_xlim()
    kmh = shown("speed")[1]
    if "cancellations/speed" in file:
        for speed in kmh * file["cancellations/speed"][:][file["cancellations/mode"][:] == 1.0]:
            if low < speed < high:
                ax.axvline(speed, color=GREY, lw=1.1, ls=(0, (1.0, 2.0)), zorder=0.6)
    if "resonances/speed" not in file:
        return False
    group = {name: data[:] for name, data in file["resonances"].items()}
    for train in np.unique(group["hslm_a"]) if "hslm_a" in group else [None]:
        name = f"A{train:.0f}" if train is not None else None
        place = [i for i, (line, _) in enumerate(lines) if name in (line, None)]
        own = (group["mode"] == 1.0) & (group["hslm_a"] == train if train is not None else True)
        for speed, order in zip(kmh * group["speed"][own], group["order"][own]):
            if not place or not low < speed < high or (len(lines) > 3 and order > 2.0):
                continue
            dashed = (0, (4.0, 2.0)) if len(lines) > 3 and order == 2.0 else "-"
            ax.axvline(speed, color=look(place[0])[0], lw=1.0, alpha=0.35, zorder=0.5, ls=dashed)
            if len(lines) <= 3:
                ax.text(speed, 0.99, f" i = {order:.0f}", transform=ax.get_xaxis_transform(), fontsize=6.5, va="top",
                        ha="left", color=GREY)
    return True


def chosen_lines(ax, runs, values, most=MOST_LINES):
    """(short name, runs) of the drawn lines: all of them, or at most `most` with the greatest one, and a note."""
    lines = [(runs.curve_name(indices[0]), indices) for _, indices in runs.lines()]
    chosen = choose(len(lines), most, np.array([np.nan_to_num(values[indices]).max() for _, indices in lines]))
    if len(chosen) < len(lines):
        note_beside(ax, t("{count} of {all} lines, including the greatest one", count=len(chosen), all=len(lines)), 7.5)
    return [lines[i] for i in chosen]


def by_x(x, values, indices, least=False):
    """(x, the worst value of the runs there) of one line, and the values of these runs: several seeds have the same x."""
    at = np.unique(x[indices])
    per = [values[indices][x[indices] == one] for one in at]
    return at, np.array([np.min(v) if least else np.max(v) for v in per]), per


def over_x(ax, source, name, values, unit, limits, band=True):
    """Draws one line per train over the speed; for runs with several seeds also their median and range."""
    runs = source.runs
    x, label = runs.x()
    lines = chosen_lines(ax, runs, values)
    ends, low, high = [], np.min(x), np.max(x)
    least_counts = name.startswith("least")
    for i, (line, indices) in enumerate(lines):
        colour, style, mark = look(i)
        at, worst, per = by_x(x, values, indices, least_counts)
        known = ~np.isnan(worst)
        if not known.any():
            continue
        if runs.over:
            with np.errstate(invalid="ignore"):
                other = np.array([np.max(v) if least_counts else np.min(v) for v in per])
                middle = np.array([np.median(v) for v in per])
            if band and len(lines) <= 3:
                ax.fill_between(at, other, worst, color=colour, alpha=0.15, lw=0)
            ax.plot(at, middle, color=colour, lw=0.9, ls=(0, (1.2, 1.2)))
        ax.plot(at, worst, color=colour, ls=style if len(lines) > 1 else "-", marker=mark, ms=3.2,
                markevery=mark_every(len(at)), mew=0.0)
        last = np.flatnonzero(known)[-1]
        part = (at[last] - low) / (high - low) if high > low else 0.5
        ends.append(End(worst[last], line, colour, style if len(lines) > 1 else "-", part))
    ax.set_xlabel(label)
    ax.set_ylabel(unit or t("ratio"))
    if high > low:
        ax.set_xlim(low, high)
    ax.set_ylim(min(0.0, np.nanmin(values)) if least_counts else 0.0, None)
    draw_limits(ax, limits)
    if runs.x_name.endswith("speed"):
        draw_resonances(ax, source, lines)
    if len(ends) > 1:
        label_at_ends(ax, ends)
    return len(ends)


def room_for(names):
    """Width right of the axes for the names of curves, inches; a key contains longer names."""
    return min(0.45 + max(width_of(name, LABEL_SIZE) for name in names), WIDEST_NAMES) if len(names) > 1 else 0.1


def key_room(names):
    """Height below the axes for such a key, inches."""
    long = len(names) > 1 and max(width_of(name, LABEL_SIZE) for name in names) > WIDEST_NAMES - 0.45
    return 0.16 * (min(len(names), MOST_LINES) + 1) if long else 0.0


def names_of(runs):
    """The names of the lines of a sweep or study."""
    return [runs.curve_name(indices[0]) for _, indices in runs.lines()]


def draw_static(ax, x, static):
    ax.plot(x, -shown("deflection")[1] * static, color=GREY, lw=1.4, ls=(0, (4, 2)), zorder=5)


def along_bridge(ax, supports, x, series, unit, marks=True, static=None):
    """Draws series: (name, least, greatest or None) at stations x; names are in a list right of the axes, because the
    curves coincide at the end of the bridge."""
    order = np.argsort(x)
    joined = len(x) >= ENOUGH_A_SPAN * (len(supports) - 1)  # values between fewer stations are unknown
    for i, (name, least, greatest) in enumerate(series):
        colour, style, mark = look(i)
        style = "none" if not joined else "-" if len(series) == 1 else style
        dense = {"marker": mark, "ms": 3.2, "mew": 0.0, "markevery": mark_every(len(x))} if marks else {}
        dense = dense if joined else {"marker": mark, "ms": 5.0, "mew": 0.0}
        ax.plot(x[order], least[order], color=colour, ls=style, label=name, **dense)
        if greatest is not None:
            ax.plot(x[order], greatest[order], color=colour, ls=style)
    ax.set_xlim(supports[0], supports[-1])
    ax.set_xlabel(t("position along the bridge (m)"))
    ax.set_ylabel(unit)
    if static is not None and static.any():
        ax.plot(x[order], static[order], color="#000000", lw=2.0, ls=(0, (3, 1.5)) if joined else "none", zorder=6,
                marker=None if joined else "_", ms=12, mew=2.0, label=t("static"))
    if len([line for line in ax.get_lines() if not line.get_label().startswith("_")]) > 1:
        handles, names = ax.get_legend_handles_labels()
        ax.legend(handles, ["\n".join(wrapped(name, WIDEST_NAMES - 0.5, 8)) for name in names], loc="upper left",
                  bbox_to_anchor=(1.01, 1.04), frameon=False, fontsize=8, handlelength=3.2, labelspacing=0.35,
                  borderpad=0.0)
    for support in supports:
        ax.axvline(support, color=PALE, lw=0.8)


def draw_bounds(ax, limits):
    """Draws limits of magnitudes, above and below: (value, text) in the unit of the axes."""
    for value, words in limits:
        for sign in (-1.0, 1.0):
            ax.axhline(sign * value, color=RED, lw=1.0, ls=(0, (6, 2)))
        name_limit(ax, value, words, 7, "bottom" if value < 0.7 * ax.get_ylim()[1] else "top")


def history(ax, time, curves, title, unit, limits=()):
    """Draws a time history. curves: (name, values)."""
    ends = []
    for i, (name, values) in enumerate(curves):
        colour, style = COLOURS[i % len(COLOURS)], STYLES[i // len(COLOURS) % len(STYLES)]
        ax.plot(*thin(time, values), color=colour, ls=style, lw=0.9)
        ends.append(End(values[-1], name, colour, style))
    ax.set_title(title)
    ax.set_ylabel(unit)
    ax.set_xlabel(t("time (s)"))
    if len(time) > 1:
        ax.set_xlim(time[0], time[-1])
    draw_bounds(ax, limits)
    if len(ends) > 1:
        label_at_ends(ax, ends)
