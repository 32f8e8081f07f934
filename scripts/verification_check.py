"""The types of the rows of doc/verification.md, and values derived from several recorded ones."""

import math
from typing import Callable, NamedTuple, Optional, Union


class Check(NamedTuple):
    """One assertion. {} in `assertion` is the bound; `figure` is a pattern or a function of recorded values."""
    assertion: str
    figure: Union[None, str, Callable] = None
    what: str = ""                  # the quantity, if a row has several
    bound: str = ""                 # text of the bound, with {} for the number
    unit: str = ""                  # of the bound and of the recorded value
    file: Optional[str] = None      # file of the assertion, if not that of the test
    instance: str = ""              # pattern of the parameters
    each: bool = False              # shows every parameter instead of the largest value
    below: bool = True              # the value must be below the bound


class Row(NamedTuple):
    case: str
    reference: str
    test: str  # the name, or a pattern with *
    checks: list


NEWTON = Check("EXPECT_LT(worst.force, {});", "newton_(force|moment)", file="tests/support/newton_law.cpp",
               what="Newton's law for every body")
CONVERGENCE = "tests/support/convergence.hpp"
FREQUENCY = Check("scatter = 0.1, error = {}, limit", "error", file=CONVERGENCE)


def number(figures, name):
    return float(figures[name]) if name in figures else None


def order_in_time(figures):
    return math.log2(number(figures, "error_1") / number(figures, "error_2"))


def order_in_space(figures):
    return math.log2(number(figures, "error_6") / number(figures, "error_48")) / 3.0


def over_tolerance(name, tolerances):
    return lambda figures: max(number(figures, f"{name}_{t}") / float(t) for t in tolerances)


def over_accuracy(figures, left_out=()):
    """The largest error over the accuracy, of deflections, and of all other quantities down to an accuracy of 1e-3."""
    parts = [(*name.rsplit("_", 1), abs(float(value))) for name, value in figures.items()]
    return max(error / float(wanted) for quantity, wanted, error in parts
               if quantity not in left_out and (quantity == "deflection" or float(wanted) > 5e-4))


def over_accuracy_but_acceleration(figures):
    return over_accuracy(figures, ("acceleration",))


def over_the_turns(figures):
    turned = float(figures["turns_with_and_without"].split()[0]) * 6.283
    return max(number(figures, "implicit_error"), number(figures, "explicit_error")) / turned
