"""The measures of a sensitivity analysis (study_sensitivity) in a results file, each with its interval."""

from typing import NamedTuple

import numpy as np


class Measure(NamedTuple):
    """A measure of each factor; low, high: its interval, equal to the value where there is none."""
    value: np.ndarray
    low: np.ndarray
    high: np.ndarray


class Analysis:
    """The measures of each quantity in the units of the file. units: {quantity: unit}; method: local, morris, sobol."""

    def __init__(self, results):
        self.file, self.group = results.file, results.file["sensitivity"]
        self.method, self.confidence = str(self.group.attrs["method"]), float(self.group.attrs["confidence"])
        self.samples = int(self.group.attrs["base_samples"])
        self.factors = list(self.file["factor"].asstr()[:])
        self.units = dict(self.group["units"].asstr()[:])
        self.has_ratios = self.method == "sobol"

    def main(self, quantity):
        """The measure that ranks the factors: total index, size of the effects, or change for one deviation."""
        if self.method == "local":
            change, slope = self._row("effect_of_deviation", quantity), self._row("derivative", quantity)
            error = self._row("derivative_error", quantity) * np.abs(change)
            error = np.divide(error, np.abs(slope), out=np.zeros(len(slope)), where=slope != 0.0)
            return Measure(change, change - error, change + error)
        return self._measure("total" if self.method == "sobol" else "effect_magnitude", quantity)

    def second(self, quantity):
        """The measure beside it: first index, standard deviation of the effects, or None."""
        if self.method == "local":
            return None
        if self.method == "sobol":
            return self._measure("first", quantity)
        deviation = self._row("effect_deviation", quantity)
        return Measure(deviation, deviation, deviation)

    def order(self, quantity):
        """The numbers of the factors, that with the largest main measure first."""
        return np.argsort(-np.abs(self.main(quantity).value), kind="stable")

    def _row(self, name, quantity):
        return self.group[name][list(self.units).index(quantity)]

    def _measure(self, name, quantity):
        return Measure(*(self._row(f"{name}{end}", quantity) for end in ("", "_low", "_high")))
