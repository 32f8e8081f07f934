"""Traverse from Python: vehicles that cross flexible beams.

    import traverse

    results = traverse.run("options/scenes/three_span_train.yml", train_speed=70.0)
    results["deflection"].sel(x=12.5).plot()

`run` computes a scene and `study` many of its runs, `open` reads a results file, each as an xarray.Dataset;
`Passage` goes through a scene step by step. What cannot be computed raises `Error` with the program's own line.
doc/python.md has examples.
"""

from .dataset import open_results as open  # noqa: A004
from .passage import Passage
from .places import Error
from .program import run, study

__all__ = ["Error", "Passage", "open", "run", "study"]
