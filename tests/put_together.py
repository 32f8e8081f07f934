"""Makes one source file of several test files, which compile in half the time: put_together.py OUTPUT FILE...

Each gets a namespace of its own, inside that which it opens, so that two may give different things the same name. What
compilers say, and GoogleTest of the place of a test, is of the file itself.
"""
import pathlib
import re
import sys

OPENED = re.compile(r"^(namespace traverse[\w:]*) \{$", re.MULTILINE)


INCLUDES = re.compile(r"(.*^#include [^\n]+\n)(.*)", re.MULTILINE | re.DOTALL)


def part(path):
    text = path.read_text(encoding="utf-8")
    if OPENED.search(text):
        text = OPENED.sub(rf"\1::in_{path.stem} {{", text)
    else:
        head, body = INCLUDES.fullmatch(text).groups()
        text = f"{head}namespace in_{path.stem} {{ {body}}}\n"
    return f'#line 1 "{path}"\n{text}'


def main():
    output, *files = map(pathlib.Path, sys.argv[1:])
    output.write_text("\n".join(part(path) for path in files), encoding="utf-8")


if __name__ == "__main__":
    main()
