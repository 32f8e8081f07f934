"""A4 pages: headings, text, tables and axes; all sizes are in inches."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import picture_axes  # noqa: E402, F401: sets its style first
import picture_layout  # noqa: E402
from matplotlib.backends.backend_pdf import PdfPages  # noqa: E402
from picture_layout import wrapped  # noqa: E402

plt.rcParams.update({"font.size": 8.5, "axes.titlesize": 10, "axes.titlepad": 6, "lines.linewidth": 1.2,
                     "figure.max_open_warning": 0})  # one figure per page

WIDTH, HEIGHT = 8.27, 11.69
LEFT, RIGHT, TOP, BOTTOM = 0.8, 7.6, 11.0, 0.75
INK, GREY, PALE, RED, GREEN, AMBER = "#222222", "#666666", "#C8C8C8", "#B00020", "#00693E", "#8A5A00"
SIZE = 8.5


class Page:
    """One page. y: position of the next item, inches from the bottom."""

    def __init__(self, heading):
        self.figure = plt.figure(figsize=(WIDTH, HEIGHT))
        self.paper = self.figure.add_axes([0, 0, 1, 1])
        self.paper.set(xlim=(0, WIDTH), ylim=(0, HEIGHT))
        self.paper.axis("off")
        self.heading = heading
        self.y = TOP
        self.text(LEFT, heading, size=14, weight="bold")
        self.y -= 0.12

    def text(self, x, text, size=SIZE, colour=INK, width=None, **words):
        """Writes lines from y downward."""
        room = (RIGHT - x) if width is None else width
        for line in wrapped(text, room, size, words.get("weight", "normal")):
            self.paper.text(x, self.y, line, fontsize=size, color=colour, va="top", **words)
            self.y -= 1.45 * size / 72.0

    def room(self):
        return self.y - BOTTOM

    def fit(self, ax, below=0.45):
        """Adapts drawn axes to long titles above them and to a key of long names below."""
        above, key = picture_layout.fit(ax, RIGHT / WIDTH, below, size=7.5)
        box = ax.get_position()
        ax.set_position([box.x0, box.y0 - above / HEIGHT, box.width, box.height])
        self.y -= above + key

    def axes(self, height, left=0.55, right=0.0, above=0.3, below=0.45):
        """Adds axes of this height within the margins, with space for a title, labels and names."""
        bottom = self.y - above - height
        self.y = bottom - below
        return self.figure.add_axes([(LEFT + left) / WIDTH, bottom / HEIGHT, (RIGHT - right - LEFT - left) / WIDTH,
                                     height / HEIGHT])


class Report:
    """The pages of a report in their order."""

    def __init__(self, title, foot):
        self.title, self.foot, self.pages = title, foot, []

    def page(self, heading):
        self.pages.append(Page(heading))
        return self.pages[-1]

    def save(self, path):
        with PdfPages(path, metadata={"Title": self.title}) as pdf:
            for number, page in enumerate(self.pages, 1):
                page.paper.plot([LEFT, RIGHT], [0.62, 0.62], color=PALE, lw=0.6)
                page.paper.text(LEFT, 0.55, f"{self.title}   {self.foot}", fontsize=7, color=GREY, va="top")
                page.paper.text(RIGHT, 0.55, f"page {number} of {len(self.pages)}", fontsize=7, color=GREY, va="top",
                                ha="right")
                pdf.savefig(page.figure)
                plt.close(page.figure)


def table(report, page, columns, rows, size=7.5, heading=None):
    """Draws a table. columns: (name, width in inches, alignment). A cell is a text, or (text, colour). The table
    continues on further pages with the heading of the first one. Returns its last page."""
    step = 1.35 * size / 72.0

    def draw_head():
        draw_row([(name, GREY) for name, _, _ in columns], "bold")

    def draw_row(cells, weight="normal"):
        x, lines = LEFT, []
        for cell, (_, width, _) in zip(cells, columns):
            text = cell[0] if isinstance(cell, tuple) else cell
            lines.append(wrapped(text, width - 0.08, size, weight))
        for cell, words, (_, width, align) in zip(cells, lines, columns):
            colour = cell[1] if isinstance(cell, tuple) else INK
            for i, line in enumerate(words):
                page.paper.text(x if align == "left" else x + width - 0.08, page.y - i * step, line, fontsize=size,
                                color=colour, va="top", ha=align, weight=weight)
            x += width
        page.y -= max(map(len, lines)) * step + 0.05
        page.paper.plot([LEFT, RIGHT], [page.y + 0.025] * 2, color=PALE, lw=0.5)

    def height_of(cells):
        texts = [cell[0] if isinstance(cell, tuple) else cell for cell in cells]
        return max(len(wrapped(text, width - 0.08, size)) for text, (_, width, _) in zip(texts, columns)) * step + 0.05

    draw_head()
    for row in rows:
        if page.y - height_of(row) < BOTTOM:
            page = report.page(f"{heading or page.heading} (continued)".replace(" (continued) (continued)",
                                                                                " (continued)"))
            draw_head()
        draw_row(row)
    page.y -= 0.12
    return page
