"""Lines and numbers of other programs' files: each refusal names the file and its row."""

import re

import numpy as np
from input_files import LARGEST_TABLE, InputError, bytes_of

LARGEST_VALUE = 1e50  # in magnitude, of a quantity in any unit
# A number as Fortran, C and Nastran write it: 1.5, 1.5E+3, 1.5D+3, 1.5+3.
NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[EeDd]?([+-]\d{1,3})|[EeDd](\d{1,3}))?", re.ASCII)


def number(text):
    """A finite number; ValueError for anything else."""
    found = NUMBER.fullmatch(text.strip())
    value = float(f"{found[1]}e{found[2] or found[3] or 0}") if found else np.inf
    if not abs(value) <= LARGEST_VALUE:
        raise ValueError(f"'{text.strip()[:40]}' is no finite number")
    return value


def integer(text):
    """A whole number; a blank field of Fortran is 0."""
    word = text.strip()
    if not re.fullmatch(r"[+-]?\d{1,12}|", word, re.ASCII):
        raise ValueError(f"'{word[:40]}' is no whole number")
    return int(word or 0)


def count(text):
    value = integer(text)
    if value < 0:
        raise ValueError(f"'{text.strip()}' is no count")
    return value


def fields(text, width, first=0):
    """The fields of a line by their columns, without empty ones at its end."""
    text = text.rstrip()
    return [text[at:at + width] for at in range(first, len(text), width)]


def label(text):
    """A word of a person: UTF-8, or else Latin-1, as which all lines are read."""
    try:
        return text.encode("latin-1").decode("utf-8").strip()
    except UnicodeError:
        return text.strip()


class Lines:
    """The lines of a file, read as Latin-1 so that columns are bytes."""

    def __init__(self, path):
        self.path, self.content = path, bytes_of(path, LARGEST_TABLE)
        self.at = self.row = 0  # the next byte; the number of the last line

    def refuse(self, why, row=None):
        raise InputError(f"{self.path}:{row or self.row}: {why}")

    def refuse_file(self, why):
        raise InputError(f"{self.path}: {why}")

    def take(self):
        """The next line; None after the last one."""
        if self.at >= len(self.content):
            return None
        end = self.content.find(b"\n", self.at)
        end = len(self.content) if end < 0 else end
        line = self.content[self.at:end].decode("latin-1").rstrip("\r")
        self.at, self.row = end + 1, self.row + 1
        return line

    def need(self, what):
        """The next line, which must exist."""
        line = self.take()
        if line is None:
            self.refuse(f"the file ends here; expected {what}")
        return line

    def bytes(self, size, what):
        """The next bytes as they are."""
        if size > len(self.content) - self.at:
            self.refuse(f"{what} has {size:,} bytes by its head; the file has {len(self.content) - self.at:,} more")
        data = self.content[self.at:self.at + size]
        self.at, self.row = self.at + size, self.row + data.count(b"\n")
        return data

    def read(self, convert, *words, row=None):
        """convert(words), whose ValueError is refused with the row."""
        try:
            return convert(*words)
        except ValueError as error:
            self.refuse(str(error), row)

    def numbers(self, words, row=None):
        """The finite numbers of words. row: that of all words, or a list with the row of each."""
        try:
            values = np.array(words, dtype=float)
            if np.all(np.abs(values) <= LARGEST_VALUE) and "_" not in "".join(words):
                return values
        except ValueError:
            pass
        rows = row if isinstance(row, list) else [row] * len(words)
        return np.array([self.read(number, word, row=one) for word, one in zip(words, rows)])

    def tables(self, rows, lines, columns):
        """Numbers in fixed columns of lines: [line, column]. rows: their numbers in the file; columns: (first, end)."""
        cells = [line[first:end] for line in lines for first, end in columns]
        return self.numbers(cells, [row for row in rows for _ in columns]).reshape(len(lines), len(columns))
