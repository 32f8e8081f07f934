"""A page of panels below each other with a heading, and its files."""

import pathlib
import sys

import matplotlib.pyplot as plt
import output_files
import picture_table
from picture_axes import GREY
from picture_layout import fit, stack, wrapped

WIDTH, LEFT = 11.5, 0.98  # inches: width of the picture, left margin of its axes
NARROW, WIDE = 0.625, 0.875  # widths of the axes as shares, without and with the room for names beside them
FORMATS = ["png", "svg", "pdf", "csv"]


def new_figure():
    return plt.figure(figsize=(WIDTH, 7.5))


def heading_lines(title, said):
    """Lines of the title and of the text below it, as they fit the width of the page."""
    return wrapped(title, 0.9 * WIDTH, 18, "bold"), wrapped(said, 0.9 * WIDTH, 11.5)


def heading(figure, title, said, foot):
    """Draws the title, the text below it, and the foot of the page."""
    (title, said), height = heading_lines(title, said), figure.get_figheight()
    figure.text(0.06, 1.0 - 0.30 / height, "\n".join(title), fontsize=18, weight="bold", va="top")
    figure.text(0.06, 1.0 - (0.32 + 0.36 * len(title)) / height, "\n".join(said), fontsize=11.5, color=GREY, va="top")
    figure.text(0.94, 0.16 / height, foot, fontsize=8.5, color=GREY, ha="right")


def heading_height(title, said):
    """Height above the first panel, inches."""
    title, said = heading_lines(title, said)
    return 1.45 + 0.36 * (len(title) - 1) + 0.22 * max(len(said) - 1, 0)


def draw_panels(figure, found, title, said, foot):
    """Draws panels below each other, each with the height that its names need. The first one may return the instant of
    the largest deflection for the others."""
    worst, axes, heights, gaps = None, [], [], [heading_height(title, said)]
    for i, panel in enumerate(found):
        width, height = WIDE if panel.wide else NARROW, panel.height / figure.get_figheight()
        ax = figure.add_axes([LEFT / WIDTH, 0.1, width, height], label=str(i))
        returned = panel.draw(ax, worst)
        worst = returned if i == 0 else worst
        follows = i + 1 < len(found) and not found[i + 1].wide
        ax.xaxis.label.set_visible(not (follows and ax.get_xlabel() == "time (s)"))
        axes.append(ax)
        heights.append(panel.height)
        above, below = fit(ax, 1.0, 0.62)
        gaps[-1] += above
        gaps.append((1.0 if ax.axison else 0.7) + below)
    stack(figure, axes, heights, gaps)
    heading(figure, title, said, foot)


def files(out, formats):
    """The file `out`, or files of this name with the endings of the formats."""
    return [pathlib.Path(out).with_suffix(f".{one}") for one in formats] or [pathlib.Path(out)]


def check(out, formats, inputs):
    """OutputError unless the files may be written."""
    for path in files(out, formats):
        output_files.check(path, output_files.kind_of(path, FORMATS), inputs)


def save(figure, out, formats=()):
    """Writes the page into its files; csv: its curves."""
    for path in files(out, formats):
        if path.suffix == ".csv":
            picture_table.write(figure, path)
        else:
            output_files.save_figure(figure, path, dpi=130)
    plt.close(figure)


def add_formats(parser):
    parser.add_argument("--formats", default="", metavar="LIST",
                        help="files with the name of the picture and these endings, with commas between: "
                             f"{', '.join(FORMATS)}; csv: the curves of the picture (default: the picture only)")


def listed(script, option, text, allowed):
    """The names of an option with commas between them; ends the script with one line at a name that is not allowed."""
    names = [name.strip() for name in text.split(",") if name.strip()]
    for name in names:
        if name not in allowed:
            sys.exit(f"{script}: --{option} {name}: allowed: {', '.join(allowed)}")
    return names
