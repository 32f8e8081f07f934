"""The pages of the public headers, which scripts/api_pages.sh makes, become a part of the site if they are there."""

import pathlib
import shutil


def made(app):
    return pathlib.Path(app.srcdir, "build/api/html")


def look(app, config):
    config.traverse_has_api = made(app).is_dir()


def copy(app, exception):
    if not exception and app.builder.format == "html" and app.config.traverse_has_api:
        shutil.copytree(made(app), pathlib.Path(app.outdir, "api"), dirs_exist_ok=True)


def setup(app):
    app.add_config_value("traverse_has_api", False, "html")  # all pages are made anew when the link to them comes or goes
    app.connect("config-inited", look)
    app.connect("build-finished", copy)
    return {"parallel_read_safe": True}
