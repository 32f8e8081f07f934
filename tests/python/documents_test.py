"""The documents: relative links, pictures and anchors lead somewhere, files that they name exist, README is short."""

import os
import pathlib
import re
import shutil
import subprocess
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2])).resolve()
SKIPPED = {".git", ".ccache", "results"}
LONGEST_README = 6000  # bytes
LONGEST_PAGE = 150  # lines, of the guide
FIRST_COMMAND = 12  # lines of a page of the guide, its first command among them
COMMAND = r"(build/traverse|\./run\.sh|scripts/\S+|mpirun|(/usr/bin/)?python3|cmake) "
FOLDERS = "include|src|tests|scripts|benchmarks|options|doc"


def documents():
    """All Markdown files of the repository; without git those outside of builds."""
    if shutil.which("git"):
        listed = subprocess.run(["git", "-C", str(SOURCE), "ls-files", "-co", "--exclude-standard", "*.md"],
                                capture_output=True, text=True)
        if listed.returncode == 0 and listed.stdout:
            return [SOURCE / name for name in listed.stdout.splitlines() if (SOURCE / name).exists()]
    return [path for path in SOURCE.rglob("*.md")
            if not any(part in SKIPPED or part.startswith("build") for part in path.relative_to(SOURCE).parts)]


def without_code(text):
    """The text without fenced and indented blocks of code, which hold no links."""
    text = re.sub(r"^```.*?^```\s*$", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"^(?: {4}|\t).*$", "", text, flags=re.MULTILINE)


def links(text):
    """Targets of Markdown's links and pictures, and of HTML's."""
    text = without_code(text)
    plain = re.sub(r"`[^`\n]*`", "", text)
    return re.findall(r"\]\(\s*<?([^)\s>]+)>?[^)]*\)", plain) + re.findall(r"(?:src|href)=\"([^\"]+)\"", plain)


def anchors(text):
    """What headings can be linked by, as GitHub makes it: lower case, no punctuation, hyphens for spaces."""
    found, times = set(), {}
    for heading in re.findall(r"^#{1,6}\s+(.+?)\s*#*\s*$", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S), re.M):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        count = times.get(slug, 0)
        times[slug] = count + 1
        found.add(slug if count == 0 else f"{slug}-{count}")
    return found | set(re.findall(r"<a (?:id|name)=\"([^\"]+)\"", text))


def commands(lines):
    """Those in fenced blocks that a reader can type in the root of the repository."""
    found, fenced = [], False
    for line in lines:
        if line.startswith("```"):
            fenced = not fenced
        elif fenced and re.match(COMMAND, line):
            found.append(line)
    return found


def broken_links(path):
    text = path.read_text(encoding="utf-8")
    wrong = []
    for target in links(text):
        if re.match(r"[a-z][a-z0-9+.-]*:", target):
            continue  # elsewhere
        file, _, anchor = target.partition("#")
        place = (path.parent / file) if file else path
        if not place.exists():
            wrong.append(f"{target}: there is no such file")
        elif not place.resolve().is_relative_to(SOURCE):
            wrong.append(f"{target}: lies outside of the repository")
        elif anchor and (place.suffix != ".md" or anchor not in anchors(place.read_text(encoding="utf-8"))):
            wrong.append(f"{target}: there is no such heading")
    return wrong


def missing_files(path):
    """Files of the repository that are named from its root, but for patterns and placeholders."""
    named = re.findall(rf"(?<![\w/.])((?:{FOLDERS})/[\w./-]*\w\.\w+)", path.read_text(encoding="utf-8"))
    return [name for name in named if not re.search(r"NAME|/x\.", name) and not (SOURCE / name).exists()]


class DocumentsTest(unittest.TestCase):
    def test_links_lead_somewhere(self):
        paths = documents()
        self.assertIn(SOURCE / "README.md", paths)
        for path in paths:
            with self.subTest(path.relative_to(SOURCE)):
                self.assertEqual(broken_links(path), [])

    def test_files_that_are_named_exist(self):
        for path in documents():
            if path.name != "CHANGELOG.md":  # it speaks of what has been
                with self.subTest(path.relative_to(SOURCE)):
                    self.assertEqual(missing_files(path), [])

    def test_documents_that_sources_name_exist(self):
        for folder in ("include", "src", "tests", "benchmarks", "scripts"):
            for path in (SOURCE / folder).rglob("*"):
                if path.suffix in (".hpp", ".cpp", ".py", ".sh"):
                    for name in re.findall(r"(?<![\w/.])(doc/[\w./-]+\.md)", path.read_text(encoding="utf-8")):
                        self.assertTrue((SOURCE / name).exists(), f"{path.relative_to(SOURCE)} names {name}")

    def test_readme_is_short(self):
        self.assertLessEqual((SOURCE / "README.md").stat().st_size, LONGEST_README)

    def test_pages_of_the_guide_are_short_and_begin_with_a_command(self):
        pages = sorted((SOURCE / "doc/guide").glob("*.md"))
        self.assertNotEqual(pages, [])
        for path in pages:
            with self.subTest(path.name):
                lines = path.read_text(encoding="utf-8").splitlines()
                self.assertLessEqual(len(lines), LONGEST_PAGE)
                self.assertNotEqual(commands(lines[:FIRST_COMMAND]), [], "no command at its beginning")

    def test_every_page_is_reached_from_readme(self):
        reached, ahead = set(), [SOURCE / "README.md"]
        while ahead:
            path = ahead.pop()
            if path in reached or not path.exists():
                continue
            reached.add(path)
            places = [(path.parent / target.partition("#")[0]).resolve() for target in links(path.read_text())
                      if ":" not in target and not target.startswith("#")]
            for place in places:
                ahead += [place] if place.suffix == ".md" else sorted(place.glob("*.md")) if place.is_dir() else []
        self.assertEqual([str(path.relative_to(SOURCE)) for path in documents() if path.resolve() not in reached], [])

    def test_the_test_sees_what_is_wrong(self):
        text = "# A `b`, c\n[x](#a-b-c) [y](nowhere.md) ![z](none.png)\n```\n[not](a link)\n```\n    [nor](this)\n"
        self.assertEqual(links(text), ["#a-b-c", "nowhere.md", "none.png"])
        self.assertEqual(anchors(text), {"a-b-c"})
        self.assertEqual(commands(["build/traverse a", "```sh", "beam: 1", "mpirun -n 2 b", "```", "cmake c"]), ["mpirun -n 2 b"])


if __name__ == "__main__":
    unittest.main()
