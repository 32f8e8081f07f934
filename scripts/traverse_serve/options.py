"""What the program says of its options: unit, range and default of each, from its own table by -help."""

import math
import re
import subprocess
from typing import NamedTuple

OPTION = re.compile(r"^  -(\w+)\s+(.*)\n {37}(.*)$", re.MULTILINE)
SECONDS = 20.0


class Option(NamedTuple):
    text: str     # one sentence
    allowed: str  # "number or file [N m2], above 1e-07"

    @property
    def unit(self):
        found = re.search(r"\[([^\],]+)\]", self.allowed)
        return found[1] if found else ""

    @property
    def range(self):
        """(least, greatest) in the unit of the option, and whether the least value itself is excluded; infinite without."""
        number = r"(-?[0-9.]+(?:e[-+]?[0-9]+)?)"
        least, most = (re.search(words + number, self.allowed) for words in (r"(above|not below|from) ", r"(at most|to) "))
        return (float(least[2]) if least else -math.inf, float(most[2]) if most else math.inf,
                bool(least) and least[1] == "above")


def table(program):
    """{name: Option} of all options of the program."""
    said = subprocess.run([program, "-help"], capture_output=True, text=True, timeout=SECONDS, check=True,
                          stdin=subprocess.DEVNULL).stdout
    return {name: Option(text, allowed) for name, text, allowed in OPTION.findall(said)}


def named_in(message, names):
    """The first of the names, as words, of a message of the program; empty if there is none."""
    found = re.search("|".join(rf"(?<![\w-]){re.escape(name)}(?![\w-])" for name in names), message)
    return found[0] if found else ""
