"""The fields of the forms: names, units and presets. Unit, range and text of an option are in the program's own table
(options.py), units in engineering_units.csv."""

import functools
import math
import re
from typing import NamedTuple

import engineering_units
from engineering_units import printed
from traverse_report.language import number as number_in_words
from traverse_report.language import t

from .inputs import InputError

LONGEST = 200  # characters of a field
PREFIXES = {"k": 1e3, "M": 1e6, "G": 1e9}


class Field(NamedTuple):
    """name: a word of traverse check, or an option; behind a dot its part. units: the first is preset. choices: {value:
    English text}. more: among the fields that are seldom needed."""
    name: str
    label: str
    preset: str = ""
    units: tuple = ()
    choices: dict = {}
    hint: str = ""
    kind: str = "number"  # or text, choice, flag
    more: bool = False
    many: bool = False    # several numbers
    optional: bool = False
    range: tuple = ()     # (least, greatest, whether the least value is excluded) in SI units, instead of that of its option

    @property
    def option(self):
        return self.name.partition(".")[0]


def chosen(name, label, choices, preset, **more):
    return Field(name, label, preset, choices=choices, kind="choice", **more)


def flag(name, label, **more):
    return Field(name, label, kind="flag", **more)


def text(name, label, **more):
    return Field(name, label, kind="text", optional=True, **more)


@functools.cache
def factors():
    """{unit: factor to SI} of engineering_units.csv, and of N with prefixes."""
    found = {}
    for si, unit, factor in engineering_units.table().values():
        found = {si: 1.0, unit: 1.0 / factor} | found  # t is a mass before it is a weight
    newtons = [si for si, *_ in engineering_units.table().values() if si.startswith("N")]
    return found | {prefix + si: by for prefix, by in PREFIXES.items() for si in newtons} | {"m/min": 1.0 / 60.0, "%": 0.01}


def unit_of(field, values):
    """The unit that was chosen for a field."""
    unit = values.get(f"{field.name}:unit", "") or (field.units[0] if field.units else "")
    if field.units and unit not in field.units:
        raise InputError(f"{unit}: allowed: {', '.join(field.units)}", field.name)
    return unit


def number(field, word):
    try:
        value = float(word)
    except ValueError:
        value = float("nan")
    if not re.fullmatch(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?", word) or abs(value) == float("inf"):
        raise InputError(f"{word}: " + t("allowed: a number of digits and one decimal sign, its unit is beside the field"
                                         if field.units else "allowed: a number of digits and one decimal sign"), field.name)
    return value


def separated(field, text):
    """The numbers of a field as they are written, with decimal points."""
    if not field.many:
        return [text.replace(",", ".")] if text else []
    if re.search(r";|[^,\s]\s+[^,\s]", text):  # what else than a comma separates them
        text = re.sub(r"(?<=[0-9]),(?=[0-9])", ".", text)
    elif re.search(r"[0-9],[0-9]", text) and (text.count(",") == 1 or re.search(r",\s", text)):
        raise InputError(f"{text}: " + t("is the comma a decimal sign? Allowed: a semicolon between numbers, or a decimal point "
                                         "and one number"), field.name)
    return [word for word in re.split(r"[,;\s]+", text) if word]


def numbers_of(field, values):
    """The numbers of a field as texts."""
    words = separated(field, written(field, values).strip())
    if not words and not field.optional:
        raise InputError(t("a number is missing"), field.name)
    for word in words:
        number(field, word)
    return words


def in_si(field, values):
    """The numbers of a field in SI units."""
    factor = factors()[unit_of(field, values)] if field.units else 1.0
    # Divides by a whole number rather than multiply by its inverse: 250 km/h are 250/3.6 m/s.
    return [float(f"{float(word) * factor:.12g}") for word in numbers_of(field, values)]


def check_range(field, values, allowed):
    """InputError in the unit of the field for a number outside of (least, greatest, whether the least one is excluded)."""
    (least, most, without), unit = allowed, unit_of(field, values)
    factor = factors()[unit] if unit else 1.0
    for word, value in zip(numbers_of(field, values), in_si(field, values)):
        if least < value <= most or (value == least and not without):
            continue
        low, high = (f"{shown(bound / factor)} {printed(unit)}".strip() for bound in (least, most))
        words = ("allowed: above {low}, at most {high}" if without else "allowed: from {low} to {high}") if most < math.inf \
            else "allowed: above {low}" if without else "allowed: at least {low}"
        raise InputError(t("{value} is not possible here; {allowed}", value=f"{shown(float(word))} {printed(unit)}".strip(),
                           allowed=t(words, low=low, high=high)), field.name)


def shown(value):
    """A number in words; one that is 0 for every bridge as 0, an infinite one not at all."""
    return "" if math.isinf(value) else number_in_words(value if abs(value) >= 1e-6 else 0.0)


def written(field, values):
    """What stands in a field, or its preset; InputError if it is too long or not one of its choices."""
    found = values.get(field.name, field.preset)
    if not isinstance(found, str) or len(found) > LONGEST or not found.isprintable():
        raise InputError(f"allowed: one line of at most {LONGEST} characters", field.name)
    if field.kind == "choice" and found not in field.choices:
        raise InputError(f"{found}: allowed: {', '.join(field.choices)}", field.name)
    if field.kind == "flag" and found not in ("", "true"):
        raise InputError("allowed: true, or nothing", field.name)
    return found


def read(fields, values, numbers=True):
    """{name: value} of all fields: lists of numbers in SI units or one number, texts, and True or False. Without
    `numbers`, these are texts with their units."""
    unknown = set(values) - {field.name for field in fields} - {f"{field.name}:unit" for field in fields}
    if unknown:
        raise InputError(f"{min(unknown)[:80]}: there is no such field")
    found = {}
    for field in fields:
        if field.kind == "number" and numbers:
            some = in_si(field, values)
            found[field.name] = some if field.many else some[0] if some else None
        elif field.kind == "number":
            some = ", ".join(numbers_of(field, values))
            found[field.name] = f"{some} {unit_of(field, values)}".strip() if some else ""
        else:
            text = written(field, values)
            found[field.name] = text == "true" if field.kind == "flag" else text
    return found
