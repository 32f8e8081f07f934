"""A4 pages: headings, text, tables and axes; all sizes are in inches."""

import functools

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import picture_axes  # noqa: E402, F401  sets its style first
import picture_layout  # noqa: E402

from .language import Ticks, capital, t  # noqa: E402

plt.rcParams.update({"font.size": 8.5, "axes.titlesize": 10, "axes.titlepad": 6, "lines.linewidth": 1.2,
                     "pdf.fonttype": 42,  # whole letters, so that Greek ones can be searched
                     "figure.max_open_warning": 0})  # one figure per page

WIDTH, HEIGHT = 8.27, 11.69
LEFT, RIGHT, TOP, BOTTOM = 0.8, 7.6, 10.85, 0.75
BETWEEN, BEGINNING = 0.25, 2.0  # above the heading of a section within a page; for a heading and the first rows of a table
INK, GREY, PALE, RED, GREEN, AMBER = "#222222", "#666666", "#C8C8C8", "#B00020", "#00693E", "#8A5A00"
SIZE = 8.5
SMALLEST = 0.7  # of the size of a table, for words that are longer than their column

width_of = functools.lru_cache(maxsize=20_000)(picture_layout.width_of)


@functools.lru_cache(maxsize=20_000)
def wrapped(text, inches, size, weight="normal"):
    return picture_layout.wrapped(text, inches, size, weight)


class Page:
    """One page. y: position of the next item, inches from the bottom."""

    def __init__(self, heading, number=""):
        self.figure = plt.figure(figsize=(WIDTH, HEIGHT))
        self.paper = self.figure.add_axes([0, 0, 1, 1])
        self.paper.set(xlim=(0, WIDTH), ylim=(0, HEIGHT))
        self.paper.axis("off")
        self.headings, self.number, self.foot_note = [heading], number, ""
        self.y = TOP

    @property
    def heading(self):
        """Of the section at its end."""
        return self.headings[-1]

    def text(self, x, text, size=SIZE, colour=INK, width=None, **words):
        """Writes lines from y downward."""
        room = (RIGHT - x) if width is None else width
        for line in wrapped(text, room, size, words.get("weight", "normal")):
            self.paper.text(x, self.y, line, fontsize=size, color=colour, va="top", **words)
            self.y -= 1.45 * size / 72.0

    def room(self):
        return self.y - BOTTOM

    def line(self, y, left=LEFT, right=RIGHT, colour=PALE, width=0.5):
        self.paper.plot([left, right], [y, y], color=colour, lw=width, solid_capstyle="butt")

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
        return self.framed(LEFT + left, bottom, RIGHT - right - LEFT - left, height)

    def framed(self, left, bottom, width, height):
        """Adds axes at this place; numbers at their ticks are in the language of the report."""
        ax = self.figure.add_axes([left / WIDTH, bottom / HEIGHT, width / WIDTH, height / HEIGHT])
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_major_formatter(Ticks())
        return ax


class Reference:
    """A cell with the number of a page: of the page itself, or of an anchor of this part of the report, or of ("", anchor)
    without a part."""

    def __init__(self, target):
        self.target = target


class Report:
    """The pages of a report in their order, with their contents and with references between them."""

    def __init__(self, foot=""):
        self.foot = foot
        self.pages, self.contents, self.anchors, self.references = [], [], {}, []
        self.prefix, self.count, self.in_annex = "", 0, False
        self.foot_note = ""  # explains the marks of the pages that follow

    def part(self, title, number):
        """Starts the pages of one results file of several; its sections are numbered from 1."""
        self.count, self.in_annex = 0, False
        self.prefix = f"{number}." if title else ""
        if title:
            self.contents.append([str(number), title, None])

    def annex(self):
        self.count, self.in_annex = 0, True

    def page(self, heading, numbered=True, drop=0.0, least=HEIGHT):
        """Adds a page; of the same heading as the page before, it continues its section. drop: inches above the
        heading. least: with as many inches on the page before, the section begins there."""
        before = self.pages[-1] if self.pages else None
        if before is not None and before.heading == heading:
            page = Page(heading, before.number)
            page.text(LEFT, t("{heading} (continued)", heading=f"{page.number} {heading}".strip()), size=11,
                      colour=GREY)
        else:
            self.count += numbered
            own = chr(64 + self.count) if self.in_annex else str(self.count)
            number = self.prefix + own if numbered else ""
            if before is not None and before.room() > least:
                page, drop = self.pages.pop(), BETWEEN
                page.headings.append(heading)
                page.number = number
            else:
                page = Page(heading, number)
            page.y -= drop
            page.text(LEFT, f"{page.number}  {heading}".strip(), size=14, weight="bold")
            if self.contents and self.contents[-1][2] is None:
                self.contents[-1][2] = page
            if numbered:
                self.contents.append([page.number, heading, page])
        page.y -= 0.12
        page.foot_note = page.foot_note or self.foot_note
        self.pages.append(page)
        return page

    def anchor(self, key):
        """The last page is the one of this key; the first one remains."""
        self.anchors.setdefault((self.prefix, key), self.pages[-1])

    def refer(self, reference, artist):
        """Writes the number of a page into a text when all pages are known."""
        target = reference.target
        self.references.append(((self.prefix, target) if isinstance(target, str) else target, artist))

    def number_of(self, target):
        page = target if isinstance(target, Page) else self.anchors.get(target)
        return "" if page is None else str(self.pages.index(page) + 1)

    def fill_references(self):
        for target, artist in self.references:
            artist.set_text(self.number_of(target))


def text_of(cell):
    return "00" if isinstance(cell, Reference) else cell[0] if isinstance(cell, tuple) else cell


class Cell:
    """A cell of a table that is to be drawn: its lines, in a smaller size if a word is longer than its column."""

    def __init__(self, cell, width, size, weight):
        text = text_of(cell)
        longest = max((width_of(word, size, weight) for word in text.split(" ")), default=0.0)
        self.size = max(min(size, size * width / longest if longest else size), SMALLEST * size)
        self.lines = wrapped(text, width, self.size, weight)
        self.cell, self.weight = cell, weight
        self.colour = cell[1] if isinstance(cell, tuple) else INK

    def draw(self, report, page, x, align, step):
        for i, line in enumerate(self.lines):
            artist = page.paper.text(x, page.y - i * step, line, fontsize=self.size, color=self.colour, va="top",
                                     ha=align,
                                     weight=self.weight)
            if isinstance(self.cell, Reference):
                report.refer(self.cell, artist)


def table(report, page, columns, rows, size=7.5):
    """Draws a table. columns: (name, width in inches, alignment). A cell is a text, (text, colour) or a Reference. The
    table continues on further pages. Returns its last page."""
    step = 1.35 * size / 72.0

    def cells_of(row, weight="normal"):
        return [Cell(cell, width - 0.08, size, weight) for cell, (_, width, _) in zip(row, columns)]

    def height_of(cells):
        return max(len(cell.lines) for cell in cells) * step + 0.05

    def draw_row(cells):
        x = LEFT
        for cell, (_, width, align) in zip(cells, columns):
            cell.draw(report, page, x if align == "left" else x + width - 0.08, align, step)
            x += width
        page.y -= height_of(cells)
        page.line(page.y + 0.025)

    head = cells_of([(capital(name), GREY) for name, _, _ in columns], "bold")
    named = any(name for name, _, _ in columns)
    if named:
        draw_row(head)
    for row in rows:
        cells = cells_of(row)
        if page.y - height_of(cells) < BOTTOM:
            page = report.page(page.heading, bool(page.number))
            if named:
                draw_row(head)
        draw_row(cells)
    page.y -= 0.12
    return page
