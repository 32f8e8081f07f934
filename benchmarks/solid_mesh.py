"""A prismatic body of hexahedra with 20 nodes, and shares of its nodes in regions, for solid_bridge.py.

x runs along the body, y to the left, z upwards. A region is a box ((x0, x1), (y0, y1), (z0, z1)) of whole elements.
"""

import numpy as np

CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
EDGES = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2),
         (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
PLACES = np.array(CORNERS + EDGES)  # of the nodes in an element, in the order of CalculiX, in half elements
PARTS = np.array(8 * [-1 / 8] + 12 * [1 / 6])  # of the volume of a box, by its shape functions
ALL = (-np.inf, np.inf)


def divided(lines, parts):
    """Lines of a grid with so many parts in each interval."""
    lines = np.asarray(lines, float)
    return np.append(np.concatenate([np.linspace(a, b, parts, endpoint=False) for a, b in zip(lines, lines[1:])]),
                     lines[-1])


class Body:
    """nodes: coordinates of all nodes; elements: rows of 20 indices into them; solid(y, z): where the section is."""

    def __init__(self, x, y, z, solid):
        lines = [divided(one, 2) for one in (x, y, z)]
        middle = [one[1::2] for one in lines]
        cells = [(2 * i, 2 * j, 2 * k) for i in range(len(middle[0])) for j in range(len(middle[1]))
                 for k in range(len(middle[2])) if solid(middle[1][j], middle[2][k])]
        places = np.array(cells)[:, None, :] + PLACES
        found, inverse = np.unique(places.reshape(-1, 3), axis=0, return_inverse=True)
        self.nodes = np.stack([line[found[:, axis]] for axis, line in enumerate(lines)], axis=1)
        self.elements = inverse.reshape(-1, 20)
        box = self.nodes[self.elements]
        self.sizes = np.ptp(box, axis=1)
        self.centres = 0.5 * (box.min(axis=1) + box.max(axis=1))

    def where(self, x=None, y=None, z=None):
        """Indices of the nodes with these coordinates, along x, then y, then z."""
        chosen = np.ones(len(self.nodes), bool)
        for axis, value in enumerate((x, y, z)):
            if value is not None:
                chosen &= np.abs(self.nodes[:, axis] - value) < 1e-6
        return np.flatnonzero(chosen)

    def shares(self, region):
        """(indices of nodes, their shares of the mean over the region)"""
        inside = np.all([(low < self.centres[:, axis]) & (self.centres[:, axis] < high)
                         for axis, (low, high) in enumerate(region)], axis=0)
        volumes = self.sizes[inside].prod(axis=1)
        total = np.zeros(len(self.nodes))
        np.add.at(total, self.elements[inside], volumes[:, None] * PARTS / volumes.sum())
        nodes = np.flatnonzero(total)
        return nodes, total[nodes]
