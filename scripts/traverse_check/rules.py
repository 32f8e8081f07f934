"""The rules of rules.yml, and how their clauses appear in the output."""

import functools
import pathlib

import yaml

MARKS = ("⁰", "¹")  # for rules that no or one public source confirms, as in the report
CLAUSES = pathlib.Path(__file__).parents[1] / "traverse_report" / "clauses.yml"


def printable(text):
    """A text as one line without control characters, which a file or a name may contain."""
    return "".join(sign if sign.isprintable() else " " for sign in " ".join(str(text).split()))


class CheckError(Exception):
    """A message of one line for the user, and the exit status of the command."""

    def __init__(self, message, status=2):
        super().__init__(printable(message))
        self.status = status


@functools.cache
def data():
    return yaml.safe_load(pathlib.Path(__file__).with_name("rules.yml").read_text(encoding="utf-8"))


@functools.cache
def requirements():
    """The rows of the table of the report: requirements of EN 1990 and EN 1991-2 with their clauses."""
    return yaml.safe_load(CLAUSES.read_text(encoding="utf-8"))["requirements"]


def rule(name):
    return data()["rules"][name]


def marked(clause, sources):
    return clause + (MARKS[len(sources)] if len(sources) < len(MARKS) else "")


def clause(name):
    """The clause of a rule, with its mark."""
    return marked(rule(name)["clause"], rule(name)["sources"])
