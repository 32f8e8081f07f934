"""A bridge as a strip of hexahedra in CalculiX, and what crosses it, for peers_calculix.py.

The strip is a square bar of SIDE, whose E and density give the bridge's EI and mass in each element; it is so thin that
shear and rotary inertia change the first frequencies of the scenes by little (1.2e-4 of the third one of two spans of 20 m).
One element fills the section. Supports hold its axis.
"""

import numpy as np
import solid_ccx
from solid_mesh import Body

SIDE = 0.1  # m


class Strip(solid_ccx.Model):
    """A bridge (peers_rows.Bridge) in so many elements. Its set ROAD is a line of nodes on top of it, two to an element."""

    def __init__(self, bridge, elements):
        self.x = np.linspace(0.0, bridge.ends[-1], elements + 1)
        half = SIDE / 2
        super().__init__(Body(self.x, [-half, half], [-half, half], lambda y, z: True))
        middle = (self.x[1:] + self.x[:-1]) / 2
        elastic, density = bridge.EI(middle) * 12 / SIDE**4, bridge.mass(middle) / SIDE**2
        for part in [np.arange(elements)] if bridge.uniform else np.arange(elements)[:, None]:
            self.made_of(part, elastic[part[0]], 0.0, density[part[0]])
        self.hold(range(len(self.body.nodes)), 2)
        self.hold(self.body.where(x=0, z=0), 1)
        for end in bridge.ends:
            self.hold(self.body.where(x=end, z=0), 3)
        self.left, self.right = (self.body.where(y=side, z=half) for side in (half, -half))
        self.name("ROAD", self.left)
        self.stations = self.body.nodes[self.left, 0]

    def at(self, place):
        """The index in ROAD of the node there; the mesh must have one."""
        found = int(np.abs(self.stations - place).argmin())
        if abs(self.stations[found] - place) > 1e-6:
            raise ValueError(f"the strip has no node at {place:g} m")
        return found

    def moving_forces(self, axles, force, speed):
        """(amplitudes before the steps, forces in the step): each force is shared by the two stations beside it, so that
        that of a station grows and decays linearly over time. axles: m behind the first one, which starts at 0."""
        apart = self.stations[1]
        time = (np.asarray(axles)[:, None] + np.array([-apart, 0, apart])) / speed  # when an axle is beside x = 0, and there
        amplitudes, forces = [], []
        for i, x in enumerate(self.stations):
            corners = np.unique(np.round(np.maximum(time + x / speed, 0.0).ravel(), 12))
            heights = np.maximum(1 - np.abs(speed * corners[:, None] - axles - x) / apart, 0.0).sum(axis=1)
            amplitudes += [f"*AMPLITUDE, NAME=AT{i}", *solid_ccx.rows(
                [f"{value:.9g}" for pair in zip(corners, heights) for value in pair])]
            forces += [f"*CLOAD, AMPLITUDE=AT{i}", *(f"{nodes[i] + 1}, 3, {-force / 2:.9g}"
                                                     for nodes in (self.left, self.right))]
        return amplitudes, forces


def modal_passage(strip, axles, force, speed, modes, ratio, step, until):
    """Lines of the steps: so many modes with a damping ratio, under moving forces, from rest."""
    amplitudes, forces = strip.moving_forces(axles, force, speed)
    strip.lines += amplitudes
    return ["*STEP", "*FREQUENCY, STORAGE=YES", str(modes), "*END STEP", "*STEP, INC=1000000", "*MODAL DYNAMIC",
            f"{step:.9g}, {until:.9g}", "*MODAL DAMPING", f"1, {modes}, {ratio:.9g}", *forces,
            "*NODE PRINT, NSET=ROAD", "U", "*END STEP"]


class SprungMass:
    """A mass on the spring of a contact with the road, both as CalculiX knows them.

    A node of the mass touches the strip's upper faces by node-to-surface contact with a penalty; the penalty times the
    area of a face is the stiffness of the spring, which the weight has compressed before the start. Since CalculiX finds
    its first acceleration without the forces of contact, the weight is applied within the first instant. The mass is an
    element, not a point: only elements have kinetic energy in the balance by which CalculiX judges contact.
    """
    CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]

    def __init__(self, strip, mass, stiffness, speed):
        self.weight = 9.81 * mass
        face, free = strip.x[1] * SIDE, len(strip.body.nodes) + 1
        bottom = SIDE / 2 - self.weight / stiffness
        corners = [f"{free + i}, {x * SIDE:.9g}, {y * SIDE:.9g}, {bottom + z * SIDE:.12g}"
                   for i, (x, y, z) in enumerate(self.CUBE)]
        element = len(strip.body.elements)
        strip.lines += [
            "*NODE, NSET=CAR", *corners, "*NODE, NSET=WHEEL", f"{free + 8}, 0, 0, {bottom:.12g}",
            "*ELEMENT, TYPE=C3D8, ELSET=CAR", ", ".join(str(word) for word in [element + 1, *range(free, free + 8)])]
        strip.made_of([element], 1e12, 0.0, mass / SIDE**3)  # rigid beside the spring
        strip.lines += [
            "*EQUATION", "2", f"{free + 8}, 3, 1, {free}, 3, -1", "*BOUNDARY", "CAR, 1, 2", "WHEEL, 1, 2",
            "*SURFACE, NAME=TOP", "BODY, S2", "*SURFACE, NAME=TYRE, TYPE=NODE", "WHEEL,",
            "*SURFACE INTERACTION, NAME=SPRING", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
            f"{stiffness / face:.12g}, {1e-6 * stiffness:.9g}", "*CONTACT PAIR, INTERACTION=SPRING, TYPE=NODE TO SURFACE",
            "TYRE, TOP", "*INITIAL CONDITIONS, TYPE=VELOCITY", f"CAR, 1, {speed:.12g}", f"WHEEL, 1, {speed:.12g}",
            "*AMPLITUDE, NAME=WAY", f"0, 0, 1000, {1000 * speed:.12g}", "*AMPLITUDE, NAME=WEIGHT", "0, 0, 1e-9, 1, 1000, 1"]

    def passage(self, step, until):
        """Lines of the step: direct integration without damping by the method."""
        return ["*STEP, NLGEOM, INC=1000000", "*DYNAMIC, DIRECT, ALPHA=0.", f"{step:.9g}, {until:.9g}",
                "*BOUNDARY, AMPLITUDE=WAY", "CAR, 1, 1, 1.", "WHEEL, 1, 1, 1.", "*CLOAD, AMPLITUDE=WEIGHT",
                f"CAR, 3, {-self.weight / 8:.12g}", "*EL PRINT, ELSET=BODY, TOTALS=ONLY", "ELSE",
                "*NODE PRINT, NSET=ROAD", "U", "*END STEP"]
