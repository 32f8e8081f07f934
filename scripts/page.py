#!/usr/bin/python3
"""Writes a results file as one HTML page with a moving drawing and charts: page.py RESULTS.h5 OUT.html

The page needs no other file and no network; any browser opens it from the disk. It contains Chart.js, from the Debian
package libjs-chart.js.
"""

import argparse
import base64
import hashlib
import html
import json
import pathlib
import re
import sys

import output_files
from checked_results import in_one_line

here = pathlib.Path(__file__).resolve().parent
PARTS = here / "traverse_page"
SCRIPTS = ("format.js", "symbols.js", "places.js", "stage.js", "gestures.js", "charts.js", "tables.js", "runs.js",
           "heat.js", "page.js")
LARGEST = 3_000_000  # bytes
LIBRARY = ("chart.min.js", "Chart.min.js", "chart.umd.js", "chart.js")
FOLDERS = ("/usr/share/javascript/chart.js", "/usr/share/nodejs/chart.js/dist", "/usr/local/share/javascript/chart.js")


def chart_library(folders=FOLDERS):
    """The text of Chart.js; ValueError if it is not installed."""
    for folder in folders:
        for name in LIBRARY:
            path = pathlib.Path(folder) / name
            if path.is_file():
                return path.read_text(encoding="utf-8")
    raise ValueError("Chart.js is missing: please install the package libjs-chart.js")


def as_json(data):
    """JSON that cannot end its script element, whatever the texts in it are."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def fingerprint(text):
    """The permission of the browser to use exactly this script or style."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def page(data):
    """The HTML text of the page."""
    library = chart_library()
    style = (PARTS / "page.css").read_text(encoding="utf-8")
    script = "".join((PARTS / name).read_text(encoding="utf-8") for name in SCRIPTS)
    policy = (f"default-src 'none'; script-src {fingerprint(library)} {fingerprint(script)}; "
              f"style-src {fingerprint(style)}; base-uri 'none'; form-action 'none'")
    words = {name: html.escape(text) for name, text in data["words"].items()}
    parts = {**words, "title": html.escape(data["title"]), "generator": output_files.GENERATOR,
             "policy": policy, "style": style, "library": library,
             "script": script, "data": as_json(data)}
    template = (PARTS / "page.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], template)


def write(results, out):
    sys.path.insert(0, str(here))
    from traverse_page.data import collect  # imported here because it takes a second
    output_files.kind_of(out, ("html", "htm"))
    output_files.check(out, "html", [results])
    text = page(collect(results)).encode("utf-8", "replace")
    if len(text) > LARGEST:
        raise ValueError(f"the page would have {len(text):,} bytes, more than {LARGEST:,}")
    with output_files.written(out, "html", [results]) as temporary:
        temporary.write_bytes(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="RESULTS.h5", help="a results file")
    parser.add_argument("out", metavar="OUT.html", help="the page")
    given = parser.parse_args()
    try:
        write(given.results, given.out)
    except output_files.OutputError as error:
        print(f"page.py: {error}", file=sys.stderr)
        return 1
    except Exception as error:
        print(f"page.py: {given.results}: {in_one_line(error)}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    output_files.run(main)
