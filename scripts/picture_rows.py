"""Horizontal rows of a panel, with lines of text beside the axes at the height of each row."""

from picture_axes import LABEL_SIZE
from picture_layout import LEADING, MARGIN, wrapped
from picture_page_size import LEFT, NARROW, WIDTH

SIZE = 8.5  # of the texts
BETWEEN = 0.5  # free lines between rows
