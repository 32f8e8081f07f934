#!/usr/bin/python3
"""Bridges that twist as three-dimensional bodies, by CalculiX, and as beams.
/usr/bin/python3 benchmarks/solid_bridge.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest]

Frequencies and static values of a bridge with two tracks on one and two spans, of a slab on skew bearings and of a girder
whose torsion is that of warping, and passages of HSLM-A5: on two meshes of quadratic hexahedra (ccx of Debian's
calculix-ccx), and by beams of Traverse, without warping and with it.
Prints both, and writes solid_bridge.csv (values by CalculiX on both meshes), solid_bridge_beams.csv (values by beams, and
their difference) and solid_bridge_trains.csv (deflections in mm and accelerations in m/s2 over the last quarter of each
passage, by CalculiX's modes) to OUT_FOLDER. Takes three and a half minutes of one core. doc/solid_bridge.md has more.
"""

import os
import tempfile
import time

import numpy as np
import runs
import solid_beams
import solid_cases
import solid_ccx
import solid_traverse
from solid_train import Train, hslm

HSLM_A = 5
AXLES, AXLE_FORCE = hslm(HSLM_A)
# The first speed excites the first mode of bending with each coach, the second one the first of torsion thrice per coach.
SLOW = Train("LEFT", 53.2, 0.0, AXLES, AXLE_FORCE)
FAST = Train("LEFT", 88.1, 0.0, AXLES, AXLE_FORCE)
OPPOSITE = Train("RIGHT", -88.1, 3.0, AXLES, AXLE_FORCE)
PASSAGES = {"53.2 m/s": [SLOW], "88.1 m/s": [FAST], "two trains": [SLOW, OPPOSITE]}
PLACES = {"LEFT": "the left track", "AXIS": "the axis", "EDGE": "the right edge"}
NO_POISSON = "one span without Poisson's ratio"
STORED = 30  # instants of a passage in the table, over its last quarter


def until(trains):
    """When the last axle has left."""
    return max(one.enters + (one.positions[-1] + solid_cases.Cross.span) / abs(one.speed) for one in trains)


def peaks(deflections, accelerations):
    """Largest values at the places in both."""
    return {(f"{what} of {word}: peak", unit): scale * np.abs(found[place]).max()
            for what, unit, scale, found in (("deflection", "mm", 1e3, deflections),
                                             ("acceleration below 30 Hz", "m/s2", 1.0, accelerations))
            for place, word in PLACES.items() if place in found}


class Passages:
    """histories: {name: (t, {place: deflections}, {place: accelerations})} of one mesh; values: their peaks."""

    def __init__(self, frequencies, shapes, x):
        self.modes = frequencies, shapes, x
        self.histories = {name: solid_cases.passage(frequencies, shapes, x, trains, until(trains))
                          for name, trains in PASSAGES.items()}
        self.values = {name: peaks(*histories[1:]) for name, histories in self.histories.items()}

    def by_traverse(self, bridge, words):
        """Peaks; prints the largest differences of histories in parts of the largest value."""
        values = {}
        for name, trains in PASSAGES.items():
            t, deflections, accelerations = self.histories[name]
            moved, shaken = bridge.passage(trains, HSLM_A, t)
            values[name] = peaks(moved, shaken)
            for what, ours, theirs in (("deflections", moved, deflections), ("accelerations", shaken, accelerations)):
                off = [np.abs(ours[place] - theirs[place]).max() / np.abs(theirs[place]).max() for place in ours]
                if off:
                    print(f"{name}: {what} by Traverse with {words} differ by {max(off):.1e} of the peak")
        return values

    def table(self):
        """Rows of passage, time, deflections, accelerations."""
        for name, (t, deflections, accelerations) in self.histories.items():
            for i in np.linspace(0.75 * (len(t) - 1), len(t) - 1, STORED).astype(int):
                yield [name, f"{t[i]:.4f}", *(f"{1e3 * deflections[place][i]:.4f}" for place in PLACES),
                       *(f"{accelerations[place][i]:.4f}" for place in PLACES)]


def solids(parts, folder):
    """{case: values} by CalculiX, and the passages."""
    one_span, *modes = solid_cases.cross(1, parts, folder)
    passages = Passages(*modes)
    return {"one span": one_span, NO_POISSON: solid_cases.cross(1, parts, folder, solid_cases.WITHOUT_POISSON)[0],
            **passages.values, "two spans": solid_cases.cross(2, parts, folder)[0],
            "skew slab": solid_cases.skew(parts, folder), "girder": solid_cases.girder(parts, folder)}, passages


def beams(build, folder, passages):
    """{case: values} by Traverse without warping, and with it."""
    kinds = (solid_cases.Cross, solid_cases.Slab, solid_cases.Girder)
    of = [solid_beams.beam_of(kind) for kind in kinds] + [
        solid_beams.beam_of(solid_cases.Cross, solid_cases.WITHOUT_POISSON)]
    for kind, beam in zip(kinds, of):
        constants = ", ".join(f"{key} {value:.6g}" for key, value in beam._asdict().items())
        print(f"{kind.__name__}: {constants} (N, m, kg)")
    passages.by_traverse(solid_traverse.ByTheBody(build, folder, *passages.modes), "the body's modes")
    both = []
    for words, change in (("a beam", solid_beams.without_warping), ("a beam with warping", lambda beam: beam)):
        cross, slab, girder, plain = map(change, of)
        one, two, no_poisson = (solid_traverse.ByABeam(build, folder, beam, spans)
                                for beam, spans in ((cross, 1), (cross, 2), (plain, 1)))
        both.append({"one span": one.values(), NO_POISSON: no_poisson.values(), **passages.by_traverse(one, words),
                     "two spans": two.values(), "skew slab": solid_traverse.skew(build, folder, slab),
                     "girder": solid_traverse.girder(build, folder, girder)})
    return both


def against_beams(fine, without, warping):
    """Rows of case, quantity, unit, body; beam without warping and its difference; with warping."""
    for case, values in without.items():
        for key, value in values.items():
            body, other = fine[case][key], warping.get(case, {}).get(key)
            row = [case, *key, f"{body:.6g}", f"{value:.6g}", f"{value / body - 1:.1e}"]
            yield row + (["", ""] if other is None else [f"{other:.6g}", f"{other / body - 1:.1e}"])


def main():
    given = runs.given(runs.parser(__doc__))
    solid_ccx.program()
    meshes = []
    with tempfile.TemporaryDirectory() as folder:
        for parts in (1,) if given.smallest else (1, 2):
            begin = time.monotonic()
            values, passages = solids(parts, folder)
            meshes.append(values)
            print(f"CalculiX: {time.monotonic() - begin:.0f} s on the mesh with {parts} elements in each interval")
        coarse, fine = meshes[0], meshes[-1]
        by_beams = list(against_beams(fine, *beams(given.build, folder, passages)))
    for row in by_beams:
        print("{}: {}, {}: {}, beam {} ({}), with warping {} ({})".format(*row))
    by_bodies = [[case, *key, f"{value:.6g}", f"{coarse[case][key]:.6g}"]
                 for case in fine for key, value in fine[case].items()]
    write(given.out, "solid_bridge", ["case", "quantity", "unit", "fine mesh", "coarse mesh"], by_bodies)
    write(given.out, "solid_bridge_beams", ["case", "quantity", "unit", "body", "beam", "difference", "with warping",
                                            "its difference"], by_beams)
    write(given.out, "solid_bridge_trains", ["passage", "t", *(
        f"{what} of {place}" for what in ("deflection", "acceleration") for place in PLACES.values())], passages.table())


def write(folder, name, columns, rows):
    runs.write_table(os.path.join(folder, name + ".csv"), columns, rows)


if __name__ == "__main__":
    main()
