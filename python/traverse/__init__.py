"""Traverse from Python: vehicles that cross flexible beams.

    import traverse

    results = traverse.run("options/scenes/three_span_train.yml", train_speed=70.0)
    results["deflection"].sel(x=12.5).plot()

`run` computes a scene, `study` many runs of it, `find` the values of an option that keep limits, `sensitivity` the
effects of uncertain options, `fit` estimates options from measurements, `screen` checks a stock of bridges under a
fleet, and `open` reads a results file. Each returns an xarray.Dataset.
`simulate` computes a `Problem` or many of them in this process, without a file, and `Passage` a scene step by step. A failed computation raises `Error` with the message of the program; input
that is probably not intended causes the warning `UnusualInput`. `__version__` is the version of this package.
doc/python.md contains examples.
"""

try:
    import h5py as _h5py  # noqa: F401
    import xarray as _xarray  # noqa: F401
except ImportError as missing:
    raise ImportError(f"traverse needs h5py and xarray ({missing}): apt install python3-h5py python3-xarray") from None

from .checked_results import VERSION as __version__
from .dataset import open_results as open  # noqa: A004
from .passage import Passage
from .places import Error, UnusualInput
from .problem import Problem
from .program import find, fit, run, screen, sensitivity, study
from .simulation import simulate

__all__ = ["Error", "Passage", "Problem", "UnusualInput", "find", "fit", "open", "run", "screen", "sensitivity", "simulate", "study"]
