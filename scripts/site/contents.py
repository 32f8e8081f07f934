"""The navigation: chapters from the lists of links in doc/guide.md, and what the guide does not list."""

import pathlib
import re

GUIDE = "doc/guide"
DECISIONS, MEASURED = "doc/decisions/README", "doc/measured"  # each has a folder of pages
OVERVIEW = ("Overview", ["doc/index", "README", GUIDE, "doc/gallery"])
OTHERS = [
    ("Reference", ["doc/results_file", "doc/words", "doc/accuracy"]),
    ("Theory and evidence", ["doc/theory", "doc/verification", "doc/solid_bridge", "doc/comparison", "doc/performance", "doc/scaling"]),
    ("Development", ["doc/architecture", "doc/new_joint", DECISIONS, "CONTRIBUTING", "SECURITY", "CHANGELOG"]),
]


def text_of(app, page):
    return pathlib.Path(app.srcdir, f"{page}.md").read_text(encoding="utf-8")


def chapters_of_guide(text):
    """Each heading of the guide with the pages that its list links to."""
    parts = re.split(r"^## +(.+)$", text, flags=re.MULTILINE)[1:]
    return [(heading, [f"doc/{name}" for name in re.findall(r"^- \[[^\]]+\]\(([\w/]+)\.md\)", body, re.MULTILINE)])
            for heading, body in zip(parts[::2], parts[1::2])]


def find_chapters(app, config):
    """Headings with their pages and titles: when one of them changes, all pages are made anew."""
    config.traverse_chapters = [
        (heading, [(page, re.search(r"^# +(.+)$", text_of(app, page), re.MULTILINE)[1]) for page in pages])
        for heading, pages in [OVERVIEW, *chapters_of_guide(text_of(app, GUIDE)), *OTHERS]]


def toctree(pages, options):
    return "\n\n```{toctree}\n" + options + "\n" + "\n".join(f"/{page}" for page in pages) + "\n```\n"


def add_toctrees(app, docname, source):
    """Sphinx takes the order of the pages from the start page, and that of the decisions from theirs."""
    if docname == app.config.root_doc:
        app.env.note_dependency(str(pathlib.Path(app.srcdir, f"{GUIDE}.md")))
        pages = [page for _, titled in app.config.traverse_chapters for page, _ in titled if page != docname]
        source[0] += toctree(pages, ":hidden:")
    elif docname == DECISIONS:
        source[0] += toctree(["doc/decisions/0*"], ":glob:\n:titlesonly:")
    elif docname == MEASURED:
        source[0] += toctree(["doc/measured/*"], ":glob:\n:hidden:")


def add_chapters(app, pagename, templatename, context, doctree):
    """What the layout shows at the left of each page."""
    own = (DECISIONS if pagename.startswith("doc/decisions/") else MEASURED if pagename.startswith(f"{MEASURED}/") else
           pagename)
    context["chapters"] = [
        {"heading": heading, "open": own in dict(pages),
         "pages": [{"title": title, "uri": context["pathto"](page), "current": page == own} for page, title in pages]}
        for heading, pages in app.config.traverse_chapters]
    if app.config.traverse_has_api:
        context["chapters"][-1]["pages"].append({"title": "Public headers", "uri": context["pathto"]("api/index.html", 1)})


def setup(app):
    app.add_config_value("traverse_chapters", [], "html")
    app.connect("config-inited", find_chapters)
    app.connect("source-read", add_toctrees)
    app.connect("html-page-context", add_chapters)
    return {"parallel_read_safe": True}
