"""The documents as a site: Sphinx reads the Markdown files where they are. scripts/site.sh builds it."""

import pathlib
import re
import sys

folder = pathlib.Path(__file__).parent
sys.path.insert(0, str(folder))

project = "Traverse"
version = re.search(r"^project\(\w+ VERSION ([\d.]+)", (folder.parents[1] / "CMakeLists.txt").read_text(encoding="utf-8"), re.M)[1]

root_doc = "doc/index"
include_patterns = ["*.md", "doc/**.md"]
exclude_patterns = [".*", "build*", "results", "src", "include", "tests", "benchmarks", "options", "scripts", "examples", "python",
                    "packaging"]
extensions = ["myst_parser", "api_pages", "contents", "formulas", "source_pages"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
highlight_language = "text"
smartquotes = False  # v' is a derivative

html_theme_path = ["."]
html_theme = "theme"
html_title = f"Traverse {version}"
html_copy_source = False
html_use_index = False
html_show_search_summary = False  # a page that is read from a disk may not read others
html_additional_pages = {"index": "to_start.html"}
