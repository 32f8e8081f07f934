"""Checks that sources have comments: comments.py [ROOT]

The check fails, with one line for each place, if
  - a source file does not open with a comment,
  - a function of the public headers (include/traverse) has no comment above or beside it. A comment above the first of
    several declarations without a blank line between them is valid for all of them.
"""
import argparse
import pathlib
import re
import sys

FUNCTION = re.compile(r"^\s*(?!return|else|if|for|while|switch|throw|using|static_assert|#|//|})"
                      r"(?:[\w:<>,&*\[\]\s~]+\s)?[\w:~]+\([^;{]*\)\s*(?:const)?\s*(?:noexcept)?\s*(?:;|\{|=|:)")


def sources(root):
    for folder in ("include", "src", "tests", "benchmarks"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".cpp", ".hpp", ".h"):
                yield path


def without_head(root):
    for path in sources(root):
        if not path.read_text(encoding="utf-8").startswith(("//", "/*")):
            yield f"{path.relative_to(root)}:1: does not open with a comment that says what it holds"


def without_comment(root):
    """Yields functions of the public headers without a comment; private parts of classes are not checked."""
    for path in sorted((root / "include" / "traverse").rglob("*.hpp")):
        private = commented = False
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            text = line.strip()
            private = text == "private:" or (private and text not in ("public:", "};"))
            if text.startswith("//"):
                commented = True
            elif not text:
                commented = False
            elif not private and "//" not in text and not commented and FUNCTION.match(line):
                yield f"{path.relative_to(root)}:{number}: has no comment: {text}"


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[1])
    root = arguments.parse_args().root.resolve()
    places = [*without_head(root), *without_comment(root)]
    for place in places:
        print(place)
    if not places:
        print("All sources open with a comment, all public functions have one.")
    return 1 if places else 0


if __name__ == "__main__":
    sys.exit(main())
