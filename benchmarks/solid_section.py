"""Constants of a cross-section by finite elements with nine nodes: torsion, warping and shear, for solid_bridge.py.

Warping w of a unit rate of twist: div grad w = 0 with dw/dn = z n_y - y n_z on the boundary (Saint-Venant); J is the
polar moment of area minus the integral of |grad w|^2, and C_w that of w^2 for w with the mean 0. The shear stress under a
vertical force V is V/I grad p with div grad p = -z and no flux at the boundary (for Poisson's ratio 0), and the energy
gives the shear area I^2 / integral of |grad p|^2. For double symmetry.
"""

import itertools

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as solvers
from solid_mesh import divided

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(3)


def quadratic(s):
    """The three shape functions on -1 to 1, and their slopes."""
    return np.array([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2]), np.array([s - 0.5, -2 * s, s + 0.5])


class Section:
    """area, I (about y, for bending along z), polar (moment of area), J, Cw, shear_area; solid(y, z) as of a Body."""

    def __init__(self, y, z, solid, parts=4):
        y, z = divided(y, 2 * parts), divided(z, 2 * parts)
        cells = [(i, j) for i in range(0, len(y) - 1, 2) for j in range(0, len(z) - 1, 2) if solid(y[i + 1], z[j + 1])]
        places = np.array([[(i + a, j + b) for a in range(3) for b in range(3)] for i, j in cells])
        found, inverse = np.unique(places.reshape(-1, 2), axis=0, return_inverse=True)
        elements, corner, end = inverse.reshape(-1, 9), places[:, 0], places[:, -1]
        halves = np.stack([y[end[:, 0]] - y[corner[:, 0]], z[end[:, 1]] - z[corner[:, 1]]], axis=1) / 2
        at = np.stack([y[found[:, 0]], z[found[:, 1]]], axis=1)[elements]  # [element, node, axis]
        stiffness, loads, masses = np.zeros((len(cells), 9, 9)), np.zeros((2, len(cells), 9)), np.zeros((len(cells), 9, 9))
        moments = np.zeros(3)
        for (s, ws), (t, wt) in itertools.product(zip(POINTS, WEIGHTS), repeat=2):
            (ns, ds), (nt, dt) = quadratic(s), quadratic(t)
            shape = np.outer(ns, nt).ravel()
            slopes = np.stack([np.outer(ds, nt).ravel() / halves[:, :1], np.outer(ns, dt).ravel() / halves[:, 1:]], axis=1)
            weight = ws * wt * halves.prod(axis=1)
            py, pz = (at * shape[:, None]).sum(axis=1).T
            stiffness += weight[:, None, None] * np.einsum("eai,eaj->eij", slopes, slopes)
            masses += weight[:, None, None] * np.outer(shape, shape)
            loads[0] += weight[:, None] * (slopes[:, 0] * pz[:, None] - slopes[:, 1] * py[:, None])
            loads[1] += (weight * pz)[:, None] * shape
            moments += [weight.sum(), weight @ py**2, weight @ pz**2]
        self.area, self.I, self.polar = moments[0], moments[2], moments[1] + moments[2]
        stiffness, masses = (assembled(elements, one) for one in (stiffness, masses))
        warping, shear = (potential(stiffness, np.bincount(elements.ravel(), one.ravel())) for one in loads)
        warping -= np.ones(len(warping)) @ (masses @ warping) / self.area
        self.J = self.polar - warping @ stiffness @ warping
        self.Cw = warping @ masses @ warping
        self.shear_area = self.I**2 / (shear @ stiffness @ shear)


def assembled(elements, blocks):
    size = elements.shape[1]
    rows, columns = np.repeat(elements, size, axis=1).ravel(), np.tile(elements, size).ravel()
    return sp.csc_matrix((blocks.ravel(), (rows, columns)))


def potential(stiffness, load):
    """Up to a constant: 0 at the first node."""
    return np.append(0.0, solvers.spsolve(stiffness[1:, 1:], load[1:]))
