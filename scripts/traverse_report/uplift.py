"""The least bearing force over time of all runs of a sweep or a study, which store no bearing forces. The peaks of the
acceleration bound them; runs are repeated in the order of their bounds until no other run can have a smaller force.

Each deck of separate spans has bearings of its own, two at a joint. Therefore all forces are those of one deck end, and
the decisive one is the least together with the force of the mass of the bridge at this end."""

from typing import NamedTuple, Optional

import numpy as np
from picture_words import weighs

from .language import num, t
from .quantities import unit_of_si

MOST_REPEATED = 6
DRAG = 1.01  # the damping forces on the bridge, in quadrature with its inertia, for ratios up to 7 %
SLICES = 400  # of a span


class Bearing(NamedTuple):
    value: float  # N, least force on the bridge, upward positive
    load: str
    x: float
    own: Optional[float] = None  # N, of the mass of the bridge at the same bearing, if the value does not contain it
    is_bound: bool = False       # no run has a smaller force

    def words(self):
        return t("{value} ({load}, x = {x} m)", value=force_in_words(self.value), load=self.load, x=num(self.x))

    def lifts(self):
        return self.value + (self.own or 0.0) <= 0.0


def force_in_words(force):
    unit, factor = unit_of_si("N")
    return f"{num(factor * force)} {unit}"


def joints_are(source, kind):
    return all(joint == kind for _, joint in source.model.supports[1:-1])


def of_deck_ends(source, load):
    """[spans, 2]: the forces at both ends of each simple span, N. load(x, left, right): N/m, at stations of this span."""
    share, found = (np.arange(SLICES) + 0.5) / SLICES, []
    for left, right in zip(source.model.span_ends[:-1], source.model.span_ends[1:]):
        force = load(left + share * (right - left), left, right) * (right - left) / SLICES
        found.append([np.sum(force * (1.0 - share)), np.sum(force * share)])
    return np.array(found)


def mass_of(source, x):
    return np.interp(x, *source.model.group["mass"][:].T)


def permanent_forces(source):
    """[spans, 2]: the bearing forces of the mass of simple spans, N; None of other bridges."""
    simple = joints_are(source, "separate") and {kind for kind, _ in source.model.supports} <= {"pinned", "roller"}
    if "mass" not in source.model.group or not simple:
        return None
    return of_deck_ends(source, lambda x, *_: float(source.options.get("gravity", 9.81)) * mass_of(source, x))


def decisive(source, forces, load, own, is_bound=False):
    """The Bearing with the least sum of two forces [spans, 2] at a deck end."""
    span, right = np.unravel_index(int(np.argmin(forces + own)), forces.shape)
    return Bearing(float(forces[span, right]), load, float(source.model.span_ends[span + right]),
                   float(own[span, right]), is_bound)


def forces_of_deck_ends(source):
    """[times, spans, 2]: the bearing forces of a run with separate spans, N; None if a joint has no station. There the
    reaction is that of both decks, and the shear force is that of one of them, on which the station is."""
    results, x = source.results, source.model.span_ends
    sums = results.over_time(source.file["supports/reaction"])[:, :, 1]
    found = np.stack([sums[:, :-1], sums[:, 1:]], axis=2)
    for joint in range(1, len(x) - 1):
        near = np.flatnonzero(np.abs(results.probes - x[joint]) < 1e-6)
        if not len(near) or "probes/shear" not in source.file:
            return None
        shear = results.over_time(source.file["probes/shear"])[:, near[0]]
        of_right = shear if results.probes[near[0]] >= x[joint] else sums[:, joint] + shear
        found[:, joint, 0], found[:, joint - 1, 1] = of_right, sums[:, joint] - of_right
    return found


def least_over_time(source, name):
    """The least bearing force of a run in a file; None without bearing forces."""
    if "supports/reaction" not in source.file:
        return None
    own = permanent_forces(source)
    if own is not None:
        forces = forces_of_deck_ends(source)
        counted = 0.0 if weighs(source.options) else 1.0
        return None if forces is None else decisive(source, forces.min(axis=0), name, counted * own)
    forces = source.results.over_time(source.file["supports/reaction"])[:, :, 1]
    return Bearing(float(forces.min()), name, float(source.results.supports[int(forces.min(axis=0).argmin())]))


def inertia_bounds(source):
    """[runs, spans, 2]: for each run bounds of its least bearing forces at the ends of separate simple spans, N. Under
    downward loads only the inertia of a span lifts it: at most the peaks of its acceleration times the mass and the lever."""
    peaks, found = np.abs(source.runs.values["peak_acceleration"]), []
    for run in range(source.runs.count):
        stations = source.runs.probes[run] if source.runs.probes.ndim == 2 else source.runs.probes

        def inertia(x, left, right, stations=stations, peaks=peaks[run]):
            own = [i for i in np.argsort(stations) if left <= stations[i] <= right]
            sizes = np.concatenate([[0.0], peaks[own], [0.0]])
            part = np.clip(np.searchsorted(np.concatenate([[left], stations[own], [right]]), x) - 1, 0, len(own))
            return mass_of(source, x) * np.maximum(sizes[part], sizes[part + 1])

        found.append(-DRAG * of_deck_ends(source, inertia))
    return np.array(found)


def least_of_runs(source, repeat):
    """The least bearing force of all runs of separate simple spans, or a bound of it if too many runs might have it.
    repeat(run): the source of a repeated run, None if that fails. None if it is not known."""
    bounds, own, least = inertia_bounds(source), permanent_forces(source), None
    sums = (bounds + own).min(axis=(1, 2))
    for count, run in enumerate(np.argsort(sums)):
        if least is not None and sums[run] >= least.value + least.own:
            break
        if np.isnan(sums[run]):
            continue
        words = source.runs.run_in_words(run)
        one = repeat(run) if count < MOST_REPEATED else None
        found = least_over_time(one, words) if one is not None else None
        if found is None:
            return least if least is not None and least.lifts() else \
                decisive(source, bounds[run], t("bound of {run}", run=words), own, is_bound=True)
        if least is None or found.value + found.own < least.value + least.own:
            least = found
    return least
