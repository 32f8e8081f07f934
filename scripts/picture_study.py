"""Panels of a sweep or a study by its axes: a curve, curves, a heat map, or frames of these."""

import numpy as np
from picture_axes import COLOURS, LABEL_SIZE, RED, STYLES, Panel, note_beside
from picture_data import choose
from picture_draws import band_in_words, draw_distribution, draw_statistics
from picture_runs import Runs, digits, in_words, sign_of, worst_of
from picture_speeds import (
    MOST_LINES, MOST_NAMED, draw_limits, draw_lines, draw_list, draw_resonances, finish, is_logarithmic, label_values,
    looks_of)
from picture_table import draw_curve, keep

MOST_FRAMES = 9
SMALLEST_CELL = (0.33, 0.13)  # inches, with a written value


def panels_of(results, asked=()):
    """One panel for each drawn quantity of a sweep or a study."""
    runs, looks = Runs(results), {}
    return [panel_of(runs, name, looks) for name in runs.drawn(asked)]


def panel_of(runs, name, looks):
    """looks: those of the lines, which the first panel sets for all."""
    values, axes, left_out = arranged(runs, name)
    listed = [axis for axis in axes if not axis.random]
    wide = framed(listed, values)
    count = len(choose_frames(listed[0])) if wide else 1
    lines = [listed[0].words(i) for i in range(len(listed[0].values))] if len(listed) == 2 and not wide else []
    if lines and not looks:
        looks.update(looks_of(lines, values))
    height = 2.3 * -(-count // columns_of(count)) if wide else 3.1 if len(lines) > MOST_NAMED else 2.3
    if len(lines) > MOST_LINES and listed[0].name != "train":
        height = float(np.clip(0.16 * len(lines), 2.0, 6.0))  # a heat map
    return Panel(lambda ax, worst: draw(ax, runs, name, values, axes, left_out, looks), height, wide)


def framed(listed, values):
    """Whether the picture has several frames: with three axes, or with two and random draws."""
    return len(listed) > 2 or (len(listed) == 2 and values.ndim == 3)


def arranged(runs, name):
    """(values, axes, note): frames first, then lines, then the axis along x, then the draws. Of more than three axes
    with given values, or of more than two beside random draws, the worst of their values replaces the shortest ones."""
    sign, values, axes = sign_of(name), runs.values(name), list(runs.axes)
    most, over = 3 if len(runs.listed) == len(axes) else 2, []
    while len([axis for axis in axes if not axis.random]) > most:
        shortest = min((i for i, axis in enumerate(axes) if not axis.random), key=lambda i: len(axes[i].values))
        moved = np.moveaxis(values, shortest, 0)
        values = worst_of(moved, sign)
        over.append(axes.pop(shortest).said)
    x = next((i for i, axis in enumerate(axes) if axis.name.endswith("speed")), None)
    x = max(range(len(axes)), key=lambda i: (not axes[i].random, len(axes[i].values)), default=0) if x is None else x
    rest = sorted((i for i in range(len(axes)) if i != x and not axes[i].random), key=lambda i: len(axes[i].values))
    order = [*rest, *([x] if axes and not axes[x].random else []), *(i for i, axis in enumerate(axes) if axis.random)]
    note = f"{'greatest' if sign > 0 else 'least'} over all values of {' and '.join(over)}" if over else ""
    return np.transpose(values, order), [axes[i] for i in order], note


def draw(ax, runs, name, values, axes, left_out, looks):
    """Draws one quantity of all runs."""
    unit, limits = runs.unit(name), runs.limits(name)
    listed = [axis for axis in axes if not axis.random]
    notes = [left_out] if left_out else []
    missing = int(np.isnan(values).sum())
    notes += [f"{missing} of {values.size} runs are missing"] if missing else []
    what, note = runs.title(name), f" ({'; '.join(notes)})" if notes else ""
    if not axes:
        draw_single(ax, values, unit, limits)
    elif not listed:
        draw_distribution(ax, values, what, unit, limits)
        what += f": {len(values):,} draws of {axes[0].said}"
    elif framed(listed, values):
        draw_frames(ax, listed, values, unit, limits, sign_of(name))
        count, drawn = len(listed[0].values), len(choose_frames(listed[0]))
        what += f" for {'each' if drawn == count else f'{drawn} of {count} values of'} {listed[0].said}"
        what += "" if len(listed) > 2 else f"; thick: median, band: {band_in_words()}, orange: greatest"
    else:
        draw_frame(ax, listed, values, unit, limits, sign_of(name), looks)
        if len(listed) == 1 and listed[0].name == "speed" and draw_resonances(ax, runs.results):
            note_beside(ax, "i: predicted resonance, v = f1 d/i")
    ax.set_title(what + note)


def draw_single(ax, value, unit, limits):
    """Draws the value of a single run as a bar."""
    ax.set(xticks=[], xlabel="the only run", ylim=(0.0, 1.14 * value if value > 0.0 else 1.0))
    label_values(ax, unit)
    keep(ax, "value", np.ones(1), np.atleast_1d(value))
    ax.bar([1.0], [value], width=0.3, color=COLOURS[0])
    ax.set_xlim(0.0, 2.0)
    draw_limits(ax, np.array([0.0, 2.0]), np.full(2, value), limits)
    draw_list(ax, [(in_words(float(value), unit), COLOURS[0])])


def draw_frame(ax, listed, values, unit, limits, sign, looks):
    """Draws a single frame of one axis with or without draws, or of two axes without draws."""
    if len(listed) == 1:
        if values.ndim == 2:
            draw_statistics(ax, listed[0], values, unit, limits)
        else:
            draw_lines(ax, listed[0], [""], values[None], unit, limits, sign, looks)
    elif listed[0].name == "train" or len(listed[0].values) <= MOST_LINES:
        names = [listed[0].words(i) for i in range(len(listed[0].values))]
        draw_lines(ax, listed[1], names, values, unit, limits, sign, looks)
    else:
        draw_heat_map(ax, listed[0], listed[1], values, unit, limits)


def ticks(axis, most):
    """(indices, texts) of at most `most` values of an axis, at equal distances."""
    chosen = np.arange(0, len(axis.values), -(-len(axis.values) // most))
    return chosen, [axis.words(i) if axis.name == "train" else digits(axis.values[i]) for i in chosen]


def draw_heat_map(ax, rows, columns, values, unit, limits, scale=None, most=(14, 30)):
    """Draws values [rows, columns] as colours, and as numbers if they fit; values above the lowest limit are bold and
    red. scale: the least and the greatest value of several maps, which then have no numbers. most: values named along x
    and y."""
    least, greatest = scale or (np.nanmin(values), np.nanmax(values))
    mesh = ax.pcolormesh(np.ma.masked_invalid(values), cmap="Blues", vmin=least - 0.02 * (greatest - least),
                         vmax=greatest, edgecolors="white", lw=0.3)
    for axis, set_ticks, count in ((columns, ax.set_xticks, most[0]), (rows, ax.set_yticks, most[1])):
        places, texts = ticks(axis, count)
        set_ticks(places + 0.5, texts, fontsize=8.5)
    ax.grid(False)
    ax.set(xlabel=columns.label(), ylabel=rows.label())
    limit, box, figure = min((limit.value for limit in limits), default=np.inf), ax.get_position(), ax.figure
    fits = scale is None and box.width * figure.get_figwidth() / len(columns.values) > SMALLEST_CELL[0] and \
        box.height * figure.get_figheight() / len(rows.values) > SMALLEST_CELL[1]
    for i, row in enumerate(values):
        keep(ax, rows.words(i), columns.values, row, unit)
        for j, value in enumerate(row) if fits else ():
            if not np.isnan(value):
                dark, above = value > least + 0.6 * (greatest - least), value > limit
                ax.text(j + 0.5, i + 0.5, f"{value:.3g}", ha="center", va="center", fontsize=7.5,
                        color="white" if dark else RED if above else "black", weight="bold" if above else "normal")
    if scale is None:
        bar = ax.figure.colorbar(mesh, cax=ax.inset_axes([1.035, 0.0, 0.02, 1.0]))
        bar.set_label(unit or "ratio")
    return mesh


def choose_frames(axis):
    """The values of an axis that have a frame."""
    return choose(len(axis.values), MOST_FRAMES, np.zeros(len(axis.values)))


def columns_of(count):
    return min(count, 2 if count in (2, 4) else 3)


def draw_named(ax, x_axis, names, values, unit, limits, sign):
    """Draws a few curves in a frame; a legend beside all frames has their names."""
    for i, (name, line) in enumerate(zip(names, values)):
        draw_curve(ax, x_axis.values, line, name, color=COLOURS[i % len(COLOURS)], ls=STYLES[i // len(COLOURS)],
                   label=name, marker="o" if len(line) < 10 else None, ms=3)
    ax.set_xlabel(x_axis.label())
    label_values(ax, unit)
    worst = worst_of(values, sign)
    finish(ax, x_axis.values, worst)
    draw_limits(ax, x_axis.values, worst, limits)


def draw_frames(ax, listed, values, unit, limits, sign):
    """Draws a frame for each value of the first axis, all with the same scale."""
    ax.axis("off")
    limits = [limit._replace(words=limit.short) for limit in limits]
    chosen, line_axis = choose_frames(listed[0]), listed[-2] if values.ndim - len(listed) == 0 else None
    columns = columns_of(len(chosen))
    rows = -(-len(chosen) // columns)
    wide, tall = (1.0 if line_axis is None else 0.84) / columns, 1.0 / rows  # with room for names or for a scale
    frames, names = [], [] if line_axis is None else [line_axis.words(i) for i in range(len(line_axis.values))]
    lines = line_axis is not None and len(names) <= MOST_LINES
    scale = (np.nanmin(values), np.nanmax(values))
    for number, i in enumerate(chosen):
        row, column = divmod(number, columns)
        frame = ax.inset_axes([column * wide + 0.01, 1.0 - (row + 1) * tall + 0.28 * tall, wide - 0.06, 0.6 * tall])
        frame.set_title(listed[0].words(i), fontsize=10, pad=4)
        frames.append(frame)
        if line_axis is None and values.ndim == 3:
            draw_statistics(frame, listed[1], values[i], unit, limits, names=False)
        elif lines:
            draw_named(frame, listed[2], names, values[i], unit, limits, sign)
        else:
            mesh = draw_heat_map(frame, line_axis, listed[2], values[i], unit, limits, scale, (6, 6))
        if not is_logarithmic(listed[-1].values) and values.ndim == 3:
            frame.locator_params(axis="x", nbins=6)
        frame.yaxis.label.set_visible(column == 0 and frame.yaxis.label.get_visible())
        if row < rows - 1:
            frame.xaxis.label.set_visible(False)
    if lines or line_axis is None:
        top = max(frame.get_ylim()[1] for frame in frames)
        for frame in frames:
            frame.set_ylim(top=top)
    if lines:
        handles, words = frames[0].get_legend_handles_labels()
        ax.legend(handles, words, loc="center left", bbox_to_anchor=(0.83, 0.5), frameon=False, fontsize=LABEL_SIZE,
                  title=line_axis.label(), title_fontsize=LABEL_SIZE)
    elif line_axis is not None:
        ax.figure.colorbar(mesh, cax=ax.inset_axes([0.84, 0.25, 0.015, 0.6])).set_label(unit or "ratio")
