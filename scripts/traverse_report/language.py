"""The language of the report: texts.csv, the only table of texts on its pages and in its workbook, and numbers with the
decimal sign of the language."""

import csv
import functools
import pathlib
import re
import threading

import numpy as np
from matplotlib.ticker import ScalarFormatter

LANGUAGES = ("en", "de", "fr")
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class OfThread(threading.local):
    language = "en"


Chosen = OfThread()


@functools.cache
def table():
    """{English text: {language: text}}"""
    with pathlib.Path(__file__).with_name("texts.csv").open(encoding="utf-8", newline="") as file:
        return {row["en"]: row for row in csv.DictReader(file)}


def choose(language):
    Chosen.language = language


def t(text, **parts):
    """A text of the table in the language of the report; {name} stands for a part of it."""
    said = table()[text][Chosen.language]
    return said.format(**parts) if parts else said


def known(text):
    """A text of the program: translated if the table contains it, otherwise as the program writes it."""
    part = re.fullmatch(r"vehicle (\d+), (.*)", text)
    if part:
        return t("vehicle {number}, {part}", number=part[1], part=part[2].replace("_", " "))
    return t(text) if text in table() else text


def capital(text):
    """With a capital letter, except for symbols such as x (m) and names such as beam_EI."""
    return text[:1].upper() + text[1:] if text[1:2].isalpha() and "_" not in text.split(" ")[0] else text


def decimal(text):
    """A number in Python's notation with the decimal sign of the language, powers of ten and narrow spaces."""
    text = re.sub(r"e\+?(-?)0*(\d+)", lambda found: "·10" + (found[1] + found[2]).translate(SUPERSCRIPTS), text)
    text = text.replace(",", "\u202f").replace("-", "−")
    return text if Chosen.language == "en" else text.replace(".", ",")


def num(value, form=".4g"):
    return decimal(format(value + 0.0, form))  # no -0


def digits(value):
    """A number with four significant digits, without a power of ten if possible."""
    value += 0.0  # no -0
    short = f"{value:.4g}"
    return decimal(f"{value:,.0f}" if "e" in short and 1e4 <= abs(value) < 1e7 else short)


def number(value):
    return num(value, ".0f") if value == round(value) and abs(value) < 1e4 else digits(value)


def percent(share):
    return f"{num(100.0 * share, '.1f')} %"


class Ticks(ScalarFormatter):
    """Numbers at the ticks of axes."""

    def __call__(self, x, pos=None):
        return decimal(super().__call__(x, pos))

    def get_offset(self):
        return decimal(super().get_offset())


def span_of(x, supports):
    """The number of the span of a position and the part of it before it: 0, 0.25, 0.5, 0.75, 1 or None for another one.
    None for a position in no span."""
    if supports is None or len(supports) < 2 or not supports[0] <= x <= supports[-1]:
        return None
    span = min(int(np.searchsorted(supports, x, side="right")) - 1, len(supports) - 2)
    part = (x - supports[span]) / (supports[span + 1] - supports[span])
    return span + 1, next((value for value in (0.0, 0.25, 0.5, 0.75, 1.0) if abs(part - value) < 0.005), None)


def place_in_words(x, supports):
    """A position as text: 'midspan, span 1 (x = 12.5 m)'."""
    at, inside = f"{num(x, '.6g')} m", span_of(x, supports)
    if inside is None:
        return f"x = {at}"
    words = {0.0: "left end", 0.25: "quarter point", 0.5: "midspan", 0.75: "three-quarter point", 1.0: "right end"}
    said = [] if inside[1] is None else [t(words[inside[1]])]
    said += [t("span {number}", number=inside[0])] if len(supports) > 2 else []
    return f"{', '.join(said)} (x = {at})" if said else f"x = {at}"
