"""Timoshenko's beam with torsion on bearings beside its axis, by finite elements, for solid_bridge.py.

At each node: deflection v (up), rotation r (of dv/dx without shear), twist a (left side up) and its rate b = da/dx, which
warps the section. A bearing at the distance y to the left holds v + y a. With E C_w the torsion is Vlasov's by Hermite's
shapes, without it Saint-Venant's by linear ones, which have no b.
"""

from typing import NamedTuple

import numpy as np
import scipy.linalg as solvers


class Beam(NamedTuple):
    """Stiffnesses, and inertia per length."""
    EI: float
    GA: float      # with the shear area
    GJ: float
    ECw: float     # of warping; 0: Saint-Venant's torsion
    mass: float
    rotary: float  # about the horizontal axis
    polar: float   # about x
    warping: float  # rho C_w


def of_section(section, material):
    elastic, poisson, density = material
    shear = elastic / (2 + 2 * poisson)
    return Beam(elastic * section.I, shear * section.shear_area, shear * section.J, elastic * section.Cw,
                density * section.area, density * section.I, density * section.polar, density * section.Cw)


def without_warping(beam):
    return beam._replace(ECw=0.0, warping=0.0)


def element(beam, h):
    """(stiffness, mass) of v, r, a, b at the left end and at the right one."""
    stiffness, mass = np.zeros((8, 8)), np.zeros((8, 8))
    phi = 12 * beam.EI / (beam.GA * h * h)
    torsion = np.ix_([2, 3, 6, 7], [2, 3, 6, 7])
    bending = np.ix_([0, 1, 4, 5], [0, 1, 4, 5])
    stiffness[bending] = beam.EI / (h**3 * (1 + phi)) * np.array([
        [12, 6 * h, -12, 6 * h], [6 * h, (4 + phi) * h * h, -6 * h, (2 - phi) * h * h],
        [-12, -6 * h, 12, -6 * h], [6 * h, (2 - phi) * h * h, -6 * h, (4 + phi) * h * h]])
    for s, w in zip(*np.polynomial.legendre.leggauss(4)):
        x, w = (1 + s) / 2, w * h / 2
        deflection, rotation = timoshenko(x, h, phi)
        mass[bending] += w * (beam.mass * np.outer(deflection, deflection) + beam.rotary * np.outer(rotation, rotation))
        if beam.ECw:
            twist, rate = timoshenko(x, h, 0.0)
            curvature = np.array([12 * x - 6, h * (6 * x - 4), 6 - 12 * x, h * (6 * x - 2)]) / h**2
            stiffness[torsion] += w * beam.ECw * np.outer(curvature, curvature)
        else:
            twist, rate = np.array([1 - x, 0, x, 0]), np.array([-1, 0, 1, 0]) / h
        stiffness[torsion] += w * beam.GJ * np.outer(rate, rate)
        mass[torsion] += w * (beam.polar * np.outer(twist, twist) + beam.warping * np.outer(rate, rate))
    return stiffness, mass


def timoshenko(x, h, phi):
    """Deflection and rotation at the part x of an element, of the displacements of its ends; Hermite's for phi = 0."""
    deflection = np.array([1 - 3 * x**2 + 2 * x**3 + phi * (1 - x), h * (x - 2 * x**2 + x**3 + phi * (x - x**2) / 2),
                           3 * x**2 - 2 * x**3 + phi * x, h * (x**3 - x**2 + phi * (x**2 - x) / 2)]) / (1 + phi)
    rotation = np.array([6 * (x**2 - x) / h, 1 - 4 * x + 3 * x**2 + phi * (1 - x),
                         6 * (x - x**2) / h, 3 * x**2 - 2 * x + phi * x]) / (1 + phi)
    return deflection, rotation


class OnBearings:
    """A beam from x[0] to x[-1] with these nodes; bearings: (x, y) at nodes."""

    def __init__(self, beam, x, bearings):
        self.x, size = np.asarray(x, float), 4 * len(x)
        self.stiffness, self.mass = np.zeros((size, size)), np.zeros((size, size))
        for i, h in enumerate(np.diff(self.x)):
            here = np.ix_(range(4 * i, 4 * i + 8), range(4 * i, 4 * i + 8))
            for whole, part in zip((self.stiffness, self.mass), element(beam, h)):
                whole[here] += part
        self.held = np.zeros((len(bearings), size))
        for row, (at, y) in zip(self.held, bearings):
            row[4 * self.node(at)], row[4 * self.node(at) + 2] = 1.0, y
        self.unknowns = np.arange(size) if beam.ECw else np.flatnonzero(np.arange(size) % 4 != 3)

    def node(self, at):
        found = int(np.abs(self.x - at).argmin())
        assert abs(self.x[found] - at) < 1e-9, at
        return found

    def modes(self, count):
        """(frequencies, deflections [mode, node], twists) of the lowest ones."""
        stiffness, mass = (whole[np.ix_(self.unknowns, self.unknowns)] for whole in (self.stiffness, self.mass))
        free = solvers.null_space(self.held[:, self.unknowns])
        values, vectors = solvers.eigh(free.T @ stiffness @ free, free.T @ mass @ free, subset_by_index=[0, count - 1])
        moved = np.zeros((count, len(self.stiffness)))
        moved[:, self.unknowns] = (free @ vectors).T
        return np.sqrt(values) / (2 * np.pi), moved[:, ::4], moved[:, 2::4]

    def spread(self, low, high, y, force):
        """Forces at the nodes from low to high, which have equal distances, with the whole of a uniform one upwards."""
        at = self.x[(self.x > low - 1e-9) & (self.x < high + 1e-9)]
        shares = np.ones(len(at))
        shares[[0, -1]] = 0.5
        return [(x, y, force * share) for x, share in zip(at, shares / shares.sum())]

    def static(self, forces):
        """forces: (x, y, force upwards) at nodes. (deflections, twists, reactions upwards)"""
        load = np.zeros(len(self.stiffness))
        for at, y, force in forces:
            load[4 * self.node(at)] += force
            load[4 * self.node(at) + 2] += force * y
        scale, held = self.stiffness.max(), self.held[:, self.unknowns]
        system = np.block([[self.stiffness[np.ix_(self.unknowns, self.unknowns)], scale * held.T],
                           [scale * held, np.zeros((len(held), len(held)))]])
        solution = np.linalg.solve(system, np.append(load[self.unknowns], np.zeros(len(held))))
        moved = np.zeros(len(load))
        moved[self.unknowns] = solution[:-len(held)]
        return moved[::4], moved[2::4], -scale * solution[-len(held):]
