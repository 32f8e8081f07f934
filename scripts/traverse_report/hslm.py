"""The trains of load model HSLM-A of EN 1991-2 6.4.6.1.1, for results files with the forces of their first train only."""

import numpy as np

# Table 6.3: number of intermediate coaches, coach length and distance of the axles of a bogie in m, axle force in N.
TRAINS = {1: (18, 18.0, 2.0, 170e3), 2: (17, 19.0, 3.5, 200e3), 3: (16, 20.0, 2.0, 180e3), 4: (15, 21.0, 3.0, 190e3),
          5: (14, 22.0, 2.0, 170e3), 6: (13, 23.0, 2.0, 180e3), 7: (13, 24.0, 2.0, 190e3), 8: (12, 25.0, 2.5, 190e3),
          9: (11, 26.0, 2.0, 210e3), 10: (11, 27.0, 2.0, 210e3)}
POWER_CAR = np.array([0.0, 3.0, 14.0, 17.0])  # m, its axles behind its first one
COUPLING = 3.525  # m, from the last axle of a power car to the first one of the end coach


def name_of(number):
    return f"A{number:.0f}"


def forces_of(number):
    """[axles, 2]: places in m, the first axle at 0, and forces in N."""
    coaches, length, bogie, force = TRAINS[int(number)]
    middles = POWER_CAR[-1] + 0.5 * COUPLING + length * np.arange(1, coaches + 2)  # of the bogies between two coaches
    head = np.concatenate([POWER_CAR, POWER_CAR[-1] + COUPLING + np.array([0.0, bogie])])
    whole = 2.0 * POWER_CAR[-1] + COUPLING + (coaches + 2) * length
    behind = np.sort(np.concatenate([head, middles - 0.5 * bogie, middles + 0.5 * bogie, whole - head]))
    return np.column_stack([-behind, np.full(len(behind), force)])
