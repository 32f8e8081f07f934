"""The units in which pictures, reports and the terminal show quantities: engineering_units.csv, the only table of them."""

import csv
import functools
import pathlib


@functools.cache
def table():
    """{quantity: (SI unit, engineering unit, factor from SI to it)}"""
    with pathlib.Path(__file__).with_name("engineering_units.csv").open(encoding="utf-8", newline="") as file:
        return {row["quantity"]: (row["si"], row["engineering"], float(row["factor"])) for row in csv.DictReader(file)}


def printed(unit):
    """A unit for print: exponents as superscripts, such as MN m² or m/s²."""
    return unit.replace("2", "²").replace("3", "³")


def shown(quantity):
    """(unit for print, factor from SI) of a quantity."""
    _, unit, factor = table()[quantity]
    return printed(unit), factor
