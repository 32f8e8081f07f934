"""scripts/site.sh: a page for each document, without a warning; all links inside lead somewhere; search and formulas work from the
disk; a broken link is an error; what has not changed is not made anew. In a copy of the project."""

import html.parser
import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser  # noqa: E402
from documents_test import documents  # noqa: E402
from project_copy import SOURCE, copy_project  # noqa: E402

NEEDED = [importlib.util.find_spec(name) for name in ("sphinx", "myst_parser")] + [pathlib.Path("/usr/share/javascript/katex").exists()]
NOT_OURS = ("api/", "_static/")


class Links(html.parser.HTMLParser):
    """The identifiers of a page and what it links to or loads."""

    def __init__(self, path):
        super().__init__()
        self.ids, self.targets = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.ids.update(values[name] for name in ("id", "name") if values.get(name))
        self.targets += [values[name] for name in ("href", "src", "action") if values.get(name)]


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not all(NEEDED):
            raise unittest.SkipTest("the packages of the documents are not installed")
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.root = pathlib.Path(cls.scratch.name, "project")
        cls.root.mkdir()
        copy_project(cls.root)
        cls.folder = pathlib.Path(cls.scratch.name, "site")
        cls.html = cls.folder / "html"
        cls.first = cls.build()

    @classmethod
    def build(cls):
        return subprocess.run([cls.root / "scripts/site.sh", cls.folder], capture_output=True, text=True)

    def complaints(self, browser):
        """Exceptions, messages of the console, and what the page asked for besides files of the site."""
        asked = [message["params"]["request"]["url"] for message in browser.messages
                 if message.get("method") == "Network.requestWillBeSent"]
        return ([message for message in browser.messages if message.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded")]
                + [address for address in asked if not address.startswith((self.html.as_uri(), "data:"))])

    def written(self):
        return {path: path.stat().st_mtime_ns for path in self.html.rglob("*.html")}

    def test_1_each_document_has_a_page(self):
        self.assertEqual((self.first.returncode, self.first.stderr), (0, ""))
        self.assertEqual(self.first.stdout, f"The documents are in {self.html}/index.html.\n")
        pages = [path.relative_to(SOURCE).with_suffix(".html") for path in documents()]
        self.assertGreater(len(pages), 100)
        self.assertEqual([page for page in pages if not (self.html / page).exists()], [])

    def test_2_links_lead_somewhere(self):
        pages = {path: Links(path) for path in self.html.rglob("*.html")
                 if not str(path.relative_to(self.html)).startswith(NOT_OURS)}
        wrong, followed = [], 0
        for path, page in pages.items():
            for target in page.targets:
                parts = urllib.parse.urlsplit(target)
                if parts.scheme:
                    continue
                followed += 1
                place = pathlib.Path(path.parent, urllib.parse.unquote(parts.path)).resolve() if parts.path else path
                if not place.is_relative_to(self.html) or not place.exists():
                    wrong.append(f"{path.relative_to(self.html)}: {target}: no such file")
                elif parts.fragment and place in pages and urllib.parse.unquote(parts.fragment) not in pages[place].ids:
                    wrong.append(f"{path.relative_to(self.html)}: {target}: no such place")
        self.assertEqual(wrong, [])
        self.assertGreater(followed, 10000)

    def test_3_the_index_of_the_search_has_terms(self):
        index = (self.html / "searchindex.js").read_text(encoding="utf-8")
        for term in ("ballast", "timoshenko"):
            self.assertRegex(index, rf'\W{term}"?:')

    def test_4_it_works_from_the_disk(self):
        """Search, formulas and the width of a phone in a real browser."""
        browser = Browser()
        self.addCleanup(browser.close)
        browser.open(self.html / "doc/theory.html", 400)
        self.assertGreater(browser.evaluate("document.querySelectorAll('.formula .katex').length"), 15)
        self.assertEqual(browser.evaluate("document.querySelectorAll('.formula:not(:has(.katex)), .katex-error').length"), 0)
        self.assertNotIn("\\begin", browser.evaluate("[...document.querySelectorAll('main p')].map(each => each.textContent).join(' ')"))
        self.assertLessEqual(browser.evaluate("document.documentElement.scrollWidth"), 400)
        self.assertEqual(self.complaints(browser), [])
        browser.open(self.html / "search.html")
        found = browser.evaluate("""new Promise(done => {
          const box = document.querySelector("header input");
          const look = () => {
            const links = [...document.querySelectorAll("#search-results a")].map(link => link.getAttribute("href"));
            links.length ? done(links) : setTimeout(look, 50);
          };
          Search.performSearch("hanging sleepers");
          look();
        })""")
        self.assertTrue(any(link.startswith("doc/guide/track_defects.html") for link in found), found)
        self.assertEqual(self.complaints(browser), [])

    def test_5_nothing_is_made_twice(self):
        before = self.written()
        again = self.build()
        self.assertEqual((again.returncode, again.stderr), (0, ""))
        self.assertEqual(self.written(), before)

    def test_6_a_broken_link_is_an_error(self):
        page = self.root / "doc/guide/trains.md"
        page.write_text(page.read_text(encoding="utf-8") + "\n[nowhere](no_such_page.md)\n", encoding="utf-8")
        ended = self.build()
        self.assertNotEqual(ended.returncode, 0)
        self.assertRegex(ended.stderr, r"guide/trains\.md.*no_such_page\.md")


if __name__ == "__main__":
    unittest.main()
