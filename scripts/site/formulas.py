"""Formulas by KaTeX of the distribution, whose files become part of the site: it needs no network."""

import html
import pathlib
import shutil

from docutils import nodes

KATEX = pathlib.Path("/usr/share/javascript/katex")


def inline(writer, node):
    writer.body.append(f'<span class="formula">{html.escape(node.astext())}</span>')
    raise nodes.SkipNode


def block(writer, node):
    writer.body.append(f'<div class="formula block">{html.escape(node.astext())}</div>')
    raise nodes.SkipNode


def add_katex(app, pagename, templatename, context, doctree):
    """Loads KaTeX on pages with formulas only."""
    if doctree and any(doctree.findall(lambda node: isinstance(node, (nodes.math, nodes.math_block)))):
        app.add_css_file("katex/katex.min.css")
        app.add_js_file("katex/katex.js")
        app.add_js_file("formulas.js")


def copy_katex(app):
    if app.builder.format == "html":
        target = pathlib.Path(app.outdir, "_static/katex")
        if not target.exists():
            shutil.copytree(KATEX / "fonts", target / "fonts")
        for name in ("katex.min.css", "katex.js"):
            shutil.copyfile(KATEX / name, target / name)


def setup(app):
    app.add_html_math_renderer("katex", (inline, None), (block, None))
    app.connect("html-page-context", add_katex)
    app.connect("builder-inited", copy_katex)
    return {"parallel_read_safe": True}
