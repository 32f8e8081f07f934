"""Trains of moving forces on a body by its modes, for solid_bridge.py; the modal masses are 1."""

import csv
import os
from typing import NamedTuple

import numpy as np
import runs
import scipy.interpolate
import scipy.linalg


class Train(NamedTuple):
    track: str        # the name of its line of nodes
    speed: float      # m/s; negative: from the right end to the left one
    enters: float     # s, when the first axle reaches the bridge
    positions: tuple  # m behind the first axle
    force: float      # N of each axle


def hslm(number):
    """(positions, force) of train A1 to A10 of EN 1991-2."""
    with open(os.path.join(runs.ROOT, "options", "screens", "fleet", "hslm_a.csv")) as file:
        lines = [line for line in csv.reader(file) if line[0] == f"A{number}"]
    return tuple(float(line[2]) for line in lines), 1e3 * float(lines[0][3])


def modal_forces(trains, shapes, x, t):
    """[mode, instant]; shapes: {track: upward shapes [mode, node]} at the nodes x."""
    total = np.zeros((len(next(iter(shapes.values()))), len(t)))
    length = x[-1] - x[0]
    for train in trains:
        shape = scipy.interpolate.CubicSpline(x, shapes[train.track], axis=1)
        for behind in train.positions:
            way = abs(train.speed) * (t - train.enters) - behind
            on = (way > 0) & (way < length)
            total[:, on] -= train.force * shape(x[0] + way[on] if train.speed > 0 else x[-1] - way[on])
    return total


def responses(frequencies, ratio, forces, step):
    """Modal coordinates and their accelerations, from rest: exact for forces that are linear between instants."""
    omega = 2 * np.pi * np.asarray(frequencies)
    count, instants = forces.shape
    over, first, second = (np.zeros((count, 2, 2)), np.zeros((count, 2)), np.zeros((count, 2)))
    for i, w in enumerate(omega):
        rates = np.zeros((4, 4))  # of coordinate, velocity, force and its slope
        rates[0, 1] = rates[1, 2] = rates[2, 3] = 1.0
        rates[1, :2] = -w * w, -2 * ratio * w
        whole = scipy.linalg.expm(rates * step)
        over[i], second[i] = whole[:2, :2], whole[:2, 3] / step
        first[i] = whole[:2, 2] - second[i]
    state = np.zeros((instants, count, 2))
    for n in range(instants - 1):
        state[n + 1] = (np.einsum("iab,ib->ia", over, state[n]) + first * forces[:, n, None]
                        + second * forces[:, n + 1, None])
    place, velocity = state[:, :, 0].T, state[:, :, 1].T
    return place, forces - 2 * ratio * omega[:, None] * velocity - omega[:, None]**2 * place
