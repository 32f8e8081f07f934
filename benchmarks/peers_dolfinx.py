#!/usr/bin/python3
"""Two scenes by DOLFINx and by Traverse: values and processor seconds side by side.
/usr/bin/python3 benchmarks/peers_dolfinx.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest] [--write]

A constant force on a continuous beam of three spans, and the frequencies of a haunched bridge. DOLFINx (Debian's
python3-dolfinx) assembles bending by a C0 interior penalty method with cubic Lagrange elements; the code here solves for
frequencies and steps by the trapezoidal rule. Prints the table, writes peers_dolfinx.csv to OUT_FOLDER and, with --write,
the table to doc/comparison.md. The seconds of DOLFINx are without its start and without the compilation of its forms.
Traverse chooses mesh and step for an error of 1e-4. Takes a quarter of a minute.
"""

import importlib.util
import logging
import os
import sys
import tempfile
import time

import numpy as np
import peers_rows
import runs
import scipy.sparse
import scipy.sparse.linalg

PENALTY = 10.0  # of jumps of the slope, times EI over the length of an element
DEGREE = 3


def dolfinx_modules(folder):
    """DOLFINx compiles what it assembles; the folder takes that."""
    if importlib.util.find_spec("dolfinx") is None:
        sys.exit("peers_dolfinx.py: dolfinx is missing; install it with: apt-get install python3-dolfinx")
    os.environ |= runs.environment() | {"XDG_CACHE_HOME": folder}
    logging.disable(logging.INFO)  # it tells each command of the compiler
    import dolfinx.fem.petsc
    import dolfinx.mesh
    import ufl
    from mpi4py import MPI
    return dolfinx, ufl, MPI.COMM_SELF


class Beam:
    """Stiffness and mass of a bridge (peers_rows.Bridge) without the unknowns that its supports hold."""

    def __init__(self, modules, bridge, elements):
        dolfinx, ufl, comm = modules
        fem, self.length = dolfinx.fem, bridge.ends[-1]
        mesh = dolfinx.mesh.create_interval(comm, elements, [0.0, self.length])
        space = getattr(fem, "functionspace", fem.FunctionSpace)  # the name since version 0.7
        self.space = space(mesh, ("Lagrange", DEGREE))
        linear = space(mesh, ("Lagrange", 1))
        EI, mass = fem.Function(linear), fem.Function(linear)
        for function, values in ((EI, bridge.EI), (mass, bridge.mass)):
            function.interpolate(lambda x, values=values: values(x[0]))
        u, v, n = ufl.TrialFunction(self.space), ufl.TestFunction(self.space), ufl.FacetNormal(mesh)
        bent = [EI * w.dx(0).dx(0) for w in (u, v)]
        slope = [ufl.jump(ufl.grad(w), n) for w in (u, v)]
        forms = (bent[0] * v.dx(0).dx(0) * ufl.dx - ufl.avg(bent[0]) * slope[1] * ufl.dS - ufl.avg(bent[1]) * slope[0] * ufl.dS
                 + PENALTY * elements / self.length * ufl.avg(EI) * slope[0] * slope[1] * ufl.dS, mass * u * v * ufl.dx)
        forms = [fem.form(form) for form in forms]
        self.assembled_from = time.process_time()
        self.x = self.space.tabulate_dof_coordinates()[:, 0]
        self.free = np.flatnonzero(np.abs(self.x[:, None] - bridge.ends).min(axis=1) > 1e-9)
        self.stiffness, self.mass = (self.matrix(fem.petsc.assemble_matrix(form)) for form in forms)

    def matrix(self, assembled):
        assembled.assemble()
        starts, columns, values = assembled.getValuesCSR()
        return scipy.sparse.csr_matrix((values, columns, starts))[self.free][:, self.free].tocsc()

    def frequencies(self, count):
        squares = scipy.sparse.linalg.eigsh(self.stiffness, count, self.mass, sigma=0.0, return_eigenvectors=False)
        return np.sqrt(np.sort(squares)) / (2 * np.pi)

    def shares(self, places):
        """[place, unknown]: what unit forces at the places are on the unknowns, and what these are in deflections there."""
        cells = [self.space.dofmap.cell_dofs(i) for i in range(len(self.x) // DEGREE)]
        ends = np.array([self.x[cell[:2]] for cell in cells])  # the first two are those of its ends
        order = np.argsort(ends.min(axis=1))
        rows = np.zeros((len(places), len(self.x)))
        for row, place in zip(rows, places):
            at = order[min(int(place / self.length * len(order)), len(order) - 1)]
            inside = (place - ends[at, 0]) / (ends[at, 1] - ends[at, 0])
            row[cells[at]] = self.space.element.basix_element.tabulate(0, np.array([[inside]])).ravel()
        return rows[:, self.free]

    def passage(self, force, speed, step, probes):
        """(t, deflections [instant, probe]) while a force moves from end to end, by the trapezoidal rule."""
        t = step * np.arange(int(self.length / speed / step) + 1)
        forces = -force * self.shares(speed * t)
        solve = scipy.sparse.linalg.splu(self.mass + step**2 / 4 * self.stiffness).solve
        u = np.zeros((len(t), len(self.free)))
        v, a = np.zeros((2, len(self.free)))  # the force starts on a support
        for i in range(1, len(t)):
            there = u[i - 1] + step * v + step**2 / 4 * a
            v = v + step / 2 * a
            a = solve(forces[i] - self.stiffness @ there)
            u[i], v = there + step**2 / 4 * a, v + step / 2 * a
        return t, u @ self.shares(probes).T


def moving_force(modules, build, folder, smallest):
    bridge = peers_rows.Bridge("scenes", "r6_three_spans")
    load = bridge.options["load"]
    beam = Beam(modules, bridge, 12 if smallest else 96)
    t, moved = beam.passage(float(load["forces"]), load["speed"], 4e-3 if smallest else 1e-4, bridge.middles)
    used = time.process_time() - beam.assembled_from
    ours = peers_rows.Ours(build, folder, {"options_file": bridge.file})
    return peers_rows.of_peaks("a moving force, `r6_three_spans`", bridge.middles, t, moved, used, ours)


def frequencies(modules, build, folder, smallest):
    bridge, count = peers_rows.Bridge("bridges", "haunched"), 5
    beam = Beam(modules, bridge, 48 if smallest else 192)
    theirs = beam.frequencies(count)
    used = time.process_time() - beam.assembled_from
    return peers_rows.of_modes(build, folder, bridge, theirs, used)


def main():
    given = runs.given(peers_rows.parser(__doc__))
    with tempfile.TemporaryDirectory() as folder:
        modules = dolfinx_modules(folder)
        rows = [row for scene in (moving_force, frequencies) for row in scene(modules, given.build, folder, given.smallest)]
    peers_rows.tell("peers_dolfinx", "DOLFINx", rows, given)


if __name__ == "__main__":
    main()
