"""Horizontal rows of a panel, with lines of text beside the axes at the height of each row."""

from picture_layout import LEADING, MARGIN, wrapped
from picture_page import LEFT, NARROW, WIDTH

SIZE = 8.5       # of the texts
BETWEEN = 0.6    # lines between two rows
EDGE = 0.03      # of the width of the axes, between axes and texts


def wrapped_rows(rows):
    """Rows of (text, colour) with the lines that fit beside the axes."""
    room = WIDTH - LEFT - (1.0 + EDGE) * NARROW * WIDTH - MARGIN
    return [[(line, colour) for text, colour in row for line in wrapped(text, room, SIZE)] for row in rows]


def height_of(rows):
    """Height of a panel with these wrapped rows, inches."""
    return LEADING * SIZE * sum(len(row) + BETWEEN for row in rows)


def draw_beside(ax, rows):
    """Writes the wrapped rows from top to bottom, and scales the vertical axis in lines. Returns the middle of each
    row, and half its height."""
    total, top, middles = sum(len(row) + BETWEEN for row in rows), 0.0, []
    ax.set(ylim=(total, 0.0), yticks=[])
    for row in rows:
        for number, (line, colour) in enumerate(row):
            ax.text(1.0 + EDGE, top + 0.5 * BETWEEN + number + 0.5, line, transform=ax.get_yaxis_transform(),
                    va="center", color=colour, fontsize=SIZE)
        middles.append((top + 0.5 * (len(row) + BETWEEN), 0.5 * len(row)))
        top += len(row) + BETWEEN
    return middles
