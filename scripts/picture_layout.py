"""Layout of texts in a picture without overlap: all sizes are measured after drawing, in inches."""

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path

NAME, NOTE = "name of a curve", "note"  # marks of the text objects
MARGIN = 0.12  # inches, free margin at the right edge
LEADING = 1.4 / 72.0  # inches from line to line, per point of font size


def width_of(text, size, weight="normal"):
    """The width of a text, inches."""
    font = FontProperties(size=size, weight=weight)
    return text_to_path.get_text_width_height_descent(text or " ", font, False)[0] / 72.0


def wrapped(text, inches, size, weight="normal"):
    """Lines with at most this width; a longer word is split."""
    lines = [""]
    for word in str(text).replace("\n", " ").split(" "):
        together = f"{lines[-1]} {word}" if lines[-1] else word
        if width_of(together, size, weight) <= inches:
            lines[-1] = together
            continue
        lines += [word] if lines[-1] else []
        lines[-1] = word
        while width_of(lines[-1], size, weight) > inches and len(lines[-1]) > 1:
            fits = max(int(len(lines[-1]) * inches / width_of(lines[-1], size, weight)) - 1, 1)
            lines[-1:] = [lines[-1][:fits], lines[-1][fits:]]
    return lines


def key_lines(entries, inches, size):
    """(number of columns, lines of each entry) of a key; entries: (number, name)."""
    widest = max(width_of(f"{number}   {name}", size) for number, name in entries) + 0.25
    columns = max(int(inches / widest), 1)
    return columns, [wrapped(f"{number}   {name}", inches / columns - 0.1, size) for number, name in entries]


def draw_key(ax, entries, inches, below, size):
    """Draws a key below the axes, entries: (number, name, colour). Returns its height, inches."""
    columns, lines = key_lines([entry[:2] for entry in entries], inches, size)
    rows = -(-len(lines) // columns)
    box, figure = ax.get_position(), ax.figure
    width, height = box.width * figure.get_figwidth(), box.height * figure.get_figheight()
    y = -below
    for row in range(rows):
        for column, i in enumerate(range(row, len(lines), rows)):
            ax.text(column * inches / columns / width, y / height, "\n".join(lines[i]), transform=ax.transAxes,
                    va="top", fontsize=size, color=entries[i][2], linespacing=1.2)
        y -= max(map(len, lines[row::rows])) * LEADING * size
    return -y - below + 0.5 * LEADING * size


def fit(ax, right, below, size=9.0):
    """Wraps the title of the axes and the notes beside it. Replaces names that exceed `right` (a fraction of the width
    of the figure) by numbers, with a key at the distance `below` (inches) below the axes. Returns the additional
    heights of title and key, inches."""
    box, figure = ax.get_position(), ax.figure
    width = box.width * figure.get_figwidth()
    title = ax._left_title
    lines = wrapped(title.get_text(), width, title.get_fontsize(), title.get_weight())
    title.set_text("\n".join(lines))
    above = (len(lines) - 1) * LEADING * title.get_fontsize()
    room = (right - box.x0) * figure.get_figwidth() - MARGIN  # from the left edge of the axes
    beside = room - 1.035 * width
    for note in (text for text in ax.texts if text.get_gid() == NOTE):
        note.set_text("\n".join(wrapped(note.get_text(), beside, note.get_fontsize())))
    names = [text for text in ax.texts if text.get_gid() == NAME]
    if not names or max(width_of(name.get_text(), name.get_fontsize()) for name in names) <= beside:
        return above, 0.0
    names.sort(key=lambda name: -name.get_position()[1])
    entries = [(str(i), name.get_text(), name.get_color()) for i, name in enumerate(names, 1)]
    for name, (number, _, _) in zip(names, entries):
        name.set_text(number)
    return above, draw_key(ax, entries, room, below, size)


def stack(figure, axes, heights, gaps):
    """Places axes of these heights below each other, with gaps above, between and below them in inches, and sets the
    height of the figure."""
    total = sum(gaps) + sum(heights)
    figure.set_figheight(total)
    y = total
    for ax, height, gap in zip(axes, heights, gaps):
        y -= gap + height
        box = ax.get_position()
        ax.set_position([box.x0, y / total, box.width, height / total])
