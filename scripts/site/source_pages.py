"""Listings of the source files and folders that the documents link to, so that these links work on any machine."""

import html
import pathlib
import posixpath
import re

from docutils import nodes
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound
from sphinx import addnodes

OF_SPHINX = (".md", ".png")  # what Sphinx makes pages of or copies by itself
NAMED = re.compile(r"(benchmarks|examples|include|options|packaging|python|scripts|src|tests)/[\w./-]+\.\w+")


def linked_path(app, docname, target):
    """The file or folder of the project that a link names, relative to its root, if it needs a listing."""
    path = posixpath.normpath(posixpath.join(posixpath.dirname(docname), target))
    if path.startswith("..") or path.endswith(OF_SPHINX) or not pathlib.Path(app.srcdir, path).exists():
        return None
    return path


def address(app, docname, path):
    """Where a file or folder is listed, as seen from a document; notes that this is needed."""
    to_root = "../" * docname.count("/")
    place = pathlib.Path(app.srcdir, path)
    if (place / "README.md").exists():  # it stands for its folder
        return f"{to_root}{path}/README.html"
    if place.is_file():
        app.env.note_dependency(str(place))
    app.env.traverse_listed.setdefault(docname, set()).add(path)
    return f"{to_root}source/{path}.html"


def link_to_listings(app, doctree):
    """Lets links to files and folders of the project, and names of files in running text, lead to their listings."""
    docname = app.env.docname
    for link in list(doctree.findall(nodes.Element)):
        if isinstance(link, (addnodes.download_reference, addnodes.pending_xref)):
            path, inner = linked_path(app, docname, link["reftarget"]), link.children
        elif isinstance(link, nodes.literal) and NAMED.fullmatch(link.astext()) and not in_link(link):
            path, inner = linked_path(app, "", link.astext()), [link.deepcopy()]
        else:
            continue
        if path is not None:
            link.replace_self(nodes.reference("", "", *inner, internal=True, refuri=address(app, docname, path)))


def in_link(node):
    while node := node.parent:
        if isinstance(node, (nodes.reference, addnodes.download_reference, addnodes.pending_xref)):
            return True
    return False


def start(app):
    app.env.traverse_listed = getattr(app.env, "traverse_listed", {})  # paths by document


def forget(app, env, docname):
    env.traverse_listed.pop(docname, None)


def listing(place):
    """A file with numbered lines, or the names in a folder."""
    if place.is_dir():
        names = (html.escape(path.name) for path in sorted(place.iterdir()) if not path.name.startswith((".", "__")))
        return "<ul>" + "".join(f'<li><a href="{place.name}/{name}.html">{name}</a></li>' for name in names) + "</ul>"
    try:
        lexer = get_lexer_for_filename(place.name, stripnl=False)
    except ClassNotFound:
        lexer = TextLexer(stripnl=False)
    return highlight(place.read_text(encoding="utf-8"), lexer, HtmlFormatter(linenos="inline", lineanchors="line"))


def write_listings(app, exception):
    """Writes the listings that are missing or older than their files."""
    if exception or app.builder.format != "html":
        return
    ahead = list(set().union(*app.env.traverse_listed.values()))
    for path in ahead:
        place, page = pathlib.Path(app.srcdir, path), pathlib.Path(app.outdir, "source", f"{path}.html")
        if place.is_dir():
            ahead += [f"{path}/{inner.name}" for inner in place.iterdir()
                      if not inner.name.startswith((".", "__")) and f"{path}/{inner.name}" not in ahead]
        if page.exists() and page.stat().st_mtime > place.stat().st_mtime:
            continue
        page.parent.mkdir(parents=True, exist_ok=True)
        page.write_text(app.builder.templates.render("listing.html", {
            "path": path, "root": "../" * (path.count("/") + 1), "start": app.builder.get_target_uri(app.config.root_doc),
            "body": listing(place)}), encoding="utf-8")


def setup(app):
    app.connect("builder-inited", start)
    app.connect("env-purge-doc", forget)
    app.connect("doctree-read", link_to_listings, priority=400)  # before Sphinx copies the files
    app.connect("build-finished", write_listings)
    return {"parallel_read_safe": False}
