"""The least bearing force over time of all runs of a sweep or a study, which store no bearing forces. The peaks of the
acceleration bound them; runs are repeated in the order of their bounds until no other run can have a smaller force."""

from typing import NamedTuple

import numpy as np

from .language import num, t
from .quantities import unit_of_si

MOST_REPEATED = 6
DRAG = 1.01  # the damping forces on the bridge, in quadrature with its inertia, for ratios up to 7 %


class Bearing(NamedTuple):
    value: float  # N, least force on the bridge, upward positive
    load: str
    x: float

    def words(self):
        return t("{value} ({load}, x = {x} m)", value=force_in_words(self.value), load=self.load, x=num(self.x))


def force_in_words(force):
    unit, factor = unit_of_si("N")
    return f"{num(factor * force)} {unit}"


def least_over_time(source, name):
    """The least bearing force of a run in a file; None without bearing forces."""
    if "supports/reaction" not in source.file:
        return None
    forces = source.results.over_time(source.file["supports/reaction"])[:, :, 1]
    return Bearing(float(forces.min()), name, float(source.results.supports[int(forces.min(axis=0).argmin())]))


def inertia_bounds(source):
    """[runs]: for each run a bound of its least bearing force on separate simple spans, N. Under downward loads only the
    inertia of a span lifts it: at most the peaks of its acceleration times the mass and the lever."""
    ends, peaks = source.model.span_ends, np.abs(source.runs.values["peak_acceleration"])
    x_mass, mass = source.model.group["mass"][:].T
    found = np.zeros(source.runs.count)
    for run in range(source.runs.count):
        stations = source.runs.probes[run] if source.runs.probes.ndim == 2 else source.runs.probes
        order = np.argsort(stations)
        at_supports = np.zeros(len(ends))
        for span, (left, right) in enumerate(zip(ends[:-1], ends[1:])):
            own = order[(stations[order] >= left) & (stations[order] <= right)]
            edges = np.concatenate([[left], stations[own], [right]])
            sizes = np.concatenate([[0.0], peaks[run, own], [0.0]])
            middles = np.linspace(left, right, 401)[:-1] + 0.5 * (right - left) / 400
            part = np.clip(np.searchsorted(edges, middles) - 1, 0, len(edges) - 2)
            force = np.interp(middles, x_mass, mass) * np.maximum(sizes[part], sizes[part + 1]) * (right - left) / 400
            share = (middles - left) / (right - left)
            at_supports[span] += float(np.sum(force * (1.0 - share)))
            at_supports[span + 1] += float(np.sum(force * share))
        found[run] = -DRAG * at_supports.max()
    return found


def least_of_runs(source, repeat):
    """The least bearing force of all runs of separate simple spans, or a bound of it if too many runs might have it.
    repeat(run): the source of a repeated run, None if that fails. None if it is not known."""
    bounds = inertia_bounds(source)
    least = None
    for count, run in enumerate(np.argsort(bounds)):
        if least is not None and bounds[run] >= least.value:
            break
        if np.isnan(bounds[run]):
            continue
        words = source.runs.run_in_words(run)
        one = repeat(run) if count < MOST_REPEATED else None
        found = least_over_time(one, words) if one is not None else None
        if found is None:
            return Bearing(float(bounds[run]), t("bound of {run}", run=words), source.model.span_ends[0])
        if least is None or found.value < least.value:
            least = found
    return least
