"""The title page of the report with places to sign, and its table of contents."""

import datetime
import hashlib
from typing import NamedTuple

import matplotlib.pyplot as plt
from matplotlib.backends.backend_pdf import PdfPages
from output_files import WRITER, written

from . import norm_sheet, structure
from .language import capital, t
from .page import AMBER, GREEN, GREY, INK, LEFT, PALE, RED, RIGHT, Reference, table

FIELDS = ("project", "structure", "line", "author", "checker", "revision", "date", "note", "logo", "norm_edition",
          "national_annex", "language")
LOGO_WIDTH, LOGO_HEIGHT = 2.2, 0.8  # inches
PALES = {GREEN: "#E3F2E9", GREY: "#EEEEEE", AMBER: "#FBF0DC", RED: "#F9E1E4"}


class Title(NamedTuple):
    """The texts of the title page; empty if they are unknown."""
    project: str = ""
    structure: str = ""
    line: str = ""
    author: str = ""
    checker: str = ""
    revision: str = ""
    date: str = ""
    note: str = ""
    logo: object = None  # a picture
    norm_edition: str = ""
    national_annex: str = ""


def day_of(source):
    """The day on which the results file was written."""
    return datetime.date.fromtimestamp(source.path.stat().st_mtime).isoformat()


def local(date):
    """A date such as 2026-11-27 as the language of the report writes it; other texts remain."""
    try:
        return datetime.date.fromisoformat(date).strftime(t("%Y-%m-%d"))
    except ValueError:
        return date


def digest_of(path):
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def title_of(sources, given, folder):
    """The texts for the title page: as given on the command line, otherwise the option of the first results file that
    has it."""
    texts = {name: given.get(name)
             or next(filter(None, (source.options.get(f"report_{name}") for source in sources)), "")
             for name in FIELDS if name != "language"}
    if given.get("structure") and len(sources) == 1:
        sources[0].options["report_structure"] = given["structure"]
    texts["structure"] = given.get("structure") or ", ".join(dict.fromkeys(source.title() for source in sources))
    texts["date"] = local(texts["date"] or max(day_of(source) for source in sources))
    texts["logo"] = structure.picture("logo", given.get("logo"), texts["logo"], sources, folder)
    return Title(**texts)


def draw_logo(page, picture):
    """Draws the logo at the top right, as large as it fits."""
    inches = min(LOGO_WIDTH / picture.width, LOGO_HEIGHT / picture.height)
    width, height = inches * picture.width, inches * picture.height
    ax = page.framed(RIGHT - width, 11.2 - height, width, height)
    ax.imshow(picture, aspect="auto", interpolation="none")
    ax.axis("off")


def draw_verdict(page, lines, colour):
    """Draws the result in a frame; its first line is the largest."""
    top = page.y + 0.08
    page.y -= 0.06
    for i, line in enumerate(lines):
        page.text(LEFT + 0.15, line, size=9 if i else 12.5, colour=INK if i else colour, width=RIGHT - LEFT - 0.3,
                  weight="normal" if i else "bold")
    page.paper.add_patch(plt.Rectangle((LEFT, page.y - 0.08), RIGHT - LEFT, top - page.y + 0.08, fc=PALES[colour],
                                       ec=colour,
                                       lw=1.0, zorder=-1))
    page.y -= 0.4


def draw_signatures(page, title):
    """A row with name, date and signature for the author and for the checker."""
    columns = [("", 1.2), (t("name"), 2.0), (t("date"), 1.2), (t("signature"), 2.4)]
    x, top = LEFT, page.y
    rows = [(t("prepared by"), title.author), (t("checked by"), title.checker)]
    for i, (name, width) in enumerate(columns):
        page.paper.text(x + 0.06, top - 0.08, capital(name), fontsize=8, color=GREY, va="top")
        for row, cells in enumerate(rows):
            if i < 2:
                page.y = top - 0.42 - 0.5 * row
                page.text(x + 0.06, cells[i] if i else capital(cells[i]), size=9, width=width - 0.12)
        x += width
    lines = [LEFT, *(LEFT + sum(width for _, width in columns[:i + 1]) for i in range(len(columns)))]
    bottom = top - 0.28 - 0.5 * len(rows)
    for at in lines:
        page.paper.plot([at, at], [bottom, top], color=PALE, lw=0.8)
    for y in (top, top - 0.28, *(top - 0.28 - 0.5 * (row + 1) for row in range(len(rows)))):
        page.line(y, width=0.8)
    page.y = bottom - 0.3


def heading_of(sources):
    """What the report is about."""
    kinds = ((t("Fit to measurements"), [source.is_fit for source in sources]),
             (t("Screen of bridges and formations"), [source.is_screen for source in sources]),
             (t("Computation under moving loads"), [source.is_crane for source in sources]),
             (t("Computations of bridges under moving loads"), [not source.is_verification for source in sources]),
             (t("Verification of the bridge under static load models"), [source.is_static for source in sources]),
             (t("Verification of track-bridge interaction"), [source.is_rail for source in sources]),
             (t("Verification of the bridge under moving loads"), [not source.is_rail for source in sources]))
    return next((words for words, of_kind in kinds if all(of_kind)), t("Verification of the bridge and of its track"))


def title_page(report, title, sources, lines, colour):
    page = report.page(heading_of(sources), numbered=False, drop=0.55)
    if title.logo is not None:
        draw_logo(page, title.logo)
    page.y -= 0.2
    draw_verdict(page, [*lines, *map(norm_sheet.sentence, filter(norm_sheet.trains_govern, sources))], colour)
    page.text(LEFT, title.structure, size=15, weight="bold")
    page.y -= 0.12
    rows = [(t("project"), title.project), (t("line and position"), title.line), (t("norm"), title.norm_edition),
            (t("national annex"), title.national_annex), (t("revision"), title.revision), (t("date"), title.date),
            (t("remark"), title.note)]
    page = table(report, page, [("", 1.5, "left"), ("", 5.3, "left")],
                 [(capital(words), said) for words, said in rows if said], size=9.5)
    page.y = max(min(page.y - 0.2, 4.2), 1.6)
    draw_signatures(page, title)
    rows = [(source.path.name, local(day_of(source)), f"traverse {source.file.attrs.get('version', '')}",
             digest_of(source.path))
            for source in sources]
    table(report, page,
          [(t("results file"), 1.4, "left"), (t("written on"), 0.75, "left"), (t("program"), 0.95, "left"),
           (t("digest (SHA-256)"), 3.7, "left")], rows, size=6.5)
    return page


def contents_page(report, compared):
    """The table of contents; compared: the pages with the comparison of several results files."""
    entries = [("", page.heading, page) for page in compared[:1]] + report.contents
    page = report.page(t("Contents"), numbered=False)
    rows = [(number, heading, Reference(target)) for number, heading, target in entries]
    table(report, page, [("", 0.6, "left"), (t("section"), 5.5, "left"), (t("page"), 0.7, "right")], rows, size=9)


def shortened(text, most):
    """A text with at most so many characters, cut between words."""
    return text if len(text) <= most else text[:most].rsplit(" ", 1)[0] + " …"


def save(report, path, title):
    """Writes the pages with their header, their footer and their numbers."""
    head = shortened(" · ".join(filter(None, (title.project, title.structure))), 90)
    side = f"{t('revision')} {title.revision} · {title.date}" if title.revision else title.date
    report.fill_references()
    about = {"Title": head, "Author": title.author or None, "Creator": WRITER}
    with written(path, "pdf") as temporary, PdfPages(temporary, metadata=about) as pdf:
        for number, page in enumerate(report.pages, 1):
            if number > 1:
                page.paper.text(LEFT, 11.25, head, fontsize=7.5, color=GREY, va="top")
                page.paper.text(RIGHT, 11.25, side, fontsize=7.5, color=GREY, va="top", ha="right")
                page.line(11.08, width=0.6)
            page.line(0.62, width=0.6)
            page.paper.text(LEFT, 0.55, report.foot, fontsize=7, color=GREY, va="top")
            page.paper.text(LEFT, 0.38, page.foot_note, fontsize=6.5, color=GREY, va="top")
            page.paper.text(RIGHT, 0.55, t("page {number} of {count}", number=number, count=len(report.pages)),
                            fontsize=7,
                            color=GREY, va="top", ha="right")
            pdf.savefig(page.figure)
            plt.close(page.figure)
