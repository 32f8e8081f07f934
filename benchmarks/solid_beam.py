"""Timoshenko's beam with Saint-Venant's torsion on bearings beside its axis, by finite elements, for solid_bridge.py.

At each node: deflection v (up), rotation r (of dv/dx without shear), twist a (left side up). A bearing at the distance y
to the left holds v + y a. The elements are exact in statics; masses are consistent with their shapes.
"""

from typing import NamedTuple

import numpy as np
import scipy.linalg as solvers


class Beam(NamedTuple):
    """Stiffnesses, and inertia per length."""
    EI: float
    GA: float      # with the shear area
    GJ: float
    ECw: float     # of warping; this file does without
    mass: float
    rotary: float  # about the horizontal axis
    polar: float   # about x


def of_section(section, material):
    elastic, poisson, density = material
    shear = elastic / (2 + 2 * poisson)
    return Beam(elastic * section.I, shear * section.shear_area, shear * section.J, elastic * section.Cw,
                density * section.area, density * section.I, density * section.polar)


def element(beam, h):
    """(stiffness, mass) of v, r, a at the left end and at the right one."""
    stiffness, mass = np.zeros((6, 6)), np.zeros((6, 6))
    bending, torsion = [0, 1, 3, 4], [2, 5]
    phi = 12 * beam.EI / (beam.GA * h * h)
    stiffness[np.ix_(bending, bending)] = beam.EI / (h**3 * (1 + phi)) * np.array([
        [12, 6 * h, -12, 6 * h], [6 * h, (4 + phi) * h * h, -6 * h, (2 - phi) * h * h],
        [-12, -6 * h, 12, -6 * h], [6 * h, (2 - phi) * h * h, -6 * h, (4 + phi) * h * h]])
    stiffness[np.ix_(torsion, torsion)] = beam.GJ / h * np.array([[1, -1], [-1, 1]])
    mass[np.ix_(torsion, torsion)] = beam.polar * h / 6 * np.array([[2, 1], [1, 2]])
    for s, w in zip(*np.polynomial.legendre.leggauss(4)):
        x = (1 + s) / 2
        deflection = np.array([1 - 3 * x**2 + 2 * x**3 + phi * (1 - x), h * (x - 2 * x**2 + x**3 + phi * (x - x**2) / 2),
                               3 * x**2 - 2 * x**3 + phi * x, h * (x**3 - x**2 + phi * (x**2 - x) / 2)]) / (1 + phi)
        rotation = np.array([6 * (x**2 - x) / h, 1 - 4 * x + 3 * x**2 + phi * (1 - x),
                             6 * (x - x**2) / h, 3 * x**2 - 2 * x + phi * x]) / (1 + phi)
        mass[np.ix_(bending, bending)] += w * h / 2 * (beam.mass * np.outer(deflection, deflection)
                                                       + beam.rotary * np.outer(rotation, rotation))
    return stiffness, mass


class OnBearings:
    """A beam from x[0] to x[-1] with these nodes; bearings: (x, y) at nodes."""

    def __init__(self, beam, x, bearings):
        self.x, size = np.asarray(x, float), 3 * len(x)
        self.stiffness, self.mass = np.zeros((size, size)), np.zeros((size, size))
        for i, h in enumerate(np.diff(self.x)):
            here = np.ix_(range(3 * i, 3 * i + 6), range(3 * i, 3 * i + 6))
            for whole, part in zip((self.stiffness, self.mass), element(beam, h)):
                whole[here] += part
        self.held = np.zeros((len(bearings), size))
        for row, (at, y) in zip(self.held, bearings):
            row[3 * self.node(at)], row[3 * self.node(at) + 2] = 1.0, y

    def node(self, at):
        found = int(np.abs(self.x - at).argmin())
        assert abs(self.x[found] - at) < 1e-9, at
        return found

    def frequencies(self, count):
        free = solvers.null_space(self.held)
        values = solvers.eigh(free.T @ self.stiffness @ free, free.T @ self.mass @ free, eigvals_only=True,
                              subset_by_index=[0, count - 1])
        return np.sqrt(values) / (2 * np.pi)

    def static(self, forces):
        """forces: (x, y, force upwards) at nodes. (deflections, twists, reactions upwards)"""
        load = np.zeros(len(self.stiffness))
        for at, y, force in forces:
            load[3 * self.node(at)] += force
            load[3 * self.node(at) + 2] += force * y
        count = len(self.held)
        scale = self.stiffness.max()
        system = np.block([[self.stiffness, scale * self.held.T], [scale * self.held, np.zeros((count, count))]])
        solution = np.linalg.solve(system, np.append(load, np.zeros(count)))
        moved = solution[:-count].reshape(-1, 3)
        return moved[:, 0], moved[:, 2], -scale * solution[-count:]
