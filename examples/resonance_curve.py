#!/usr/bin/python3
"""The resonance curve of a bridge under a train of EN 1991-2: PYTHONPATH=python /usr/bin/python3 examples/resonance_curve.py [PICTURE]"""

import sys

import matplotlib.pyplot as plt
import numpy as np
import traverse

bridge = {"spans": [28.0], "EI": 2.6e10, "mass": 1.9e4, "damping_ratios": 0.01}
problems = [traverse.Problem(beam=bridge, load={"hslm_a": 1, "speed": speed}, model_modes=6, output_probes=[7.0, 14.0])
            for speed in np.arange(30.0, 84.0, 0.1)]
curve = traverse.simulate(problems)["peak_acceleration"]
worst = curve.max("x").idxmax().item()
print(f"{curve.max().item():.3f} m/s2 at {worst:.1f} m/s")
curve.plot.line(x="load_speed", hue="x")
plt.savefig(sys.argv[1] if len(sys.argv) > 1 else "resonance_curve.png")
