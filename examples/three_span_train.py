# %% [markdown]
# A train crosses a bridge of three spans: one run, a study of the speed, and a passage step by step with a force. Each
# `# %%` begins a cell, for editors that show such files as notebooks; plain Python runs the file, too:
#
#     PYTHONPATH=python /usr/bin/python3 examples/three_span_train.py [FOLDER FOR THE PICTURES]

# %%
import pathlib
import sys

import matplotlib.pyplot as plt

import traverse

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "results")
folder.mkdir(exist_ok=True)
scene = "options/scenes/three_span_train.yml"

# %% One run: an xarray.Dataset whose variables have units and coordinates.
crossing = traverse.run(scene, accuracy=1e-2, output_probes=[12.5, 40.0, 67.5])
print(crossing["deflection"])
(1e3 * crossing["deflection"]).plot.line(x="time")
plt.ylabel("deflection, mm")
plt.savefig(folder / "python_crossing.png")
plt.close()

# %% A study: peaks over the speed, m/s, at every probe.
speeds = traverse.study(scene, {"train_speed": {"from": 60, "to": 90, "step": 5}}, accuracy=1e-2)
(1e3 * speeds["peak_deflection"]).plot.line(x="train_speed", marker="o")
plt.ylabel("largest deflection, mm")
plt.savefig(folder / "python_speeds.png")
plt.close()

# %% Step by step: this program applies the force of a damper, 10 MN s/m, between the ground and midspan.
with traverse.Passage(scene, accuracy=1e-2, output_interval=0.002, output_probes=40.0, ts_max_time=2.0) as passage:
    damped = []
    while passage.time < passage.end:
        damped.append(1e3 * passage.read("deflection")[0])
        passage.set_force(x=40.0, fy=-1.0e7 * passage.read("velocity")[0])
        passage.advance()
plain = 1e3 * crossing["deflection"].sel(x=40.0, time=slice(0.0, 2.0))
plain.plot(label="as it is")
plt.plot([0.002 * i for i in range(len(damped))], damped, label="with a damper")
plt.ylabel("deflection at 40 m, mm")
plt.legend()
plt.savefig(folder / "python_damper.png")
plt.close()
print(f"largest deflection at 40 m: {abs(plain).max().item():.3f} mm, with a damper {max(map(abs, damped)):.3f} mm")
