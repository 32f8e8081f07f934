"""Runs of the program: each in a separate process, so that no failure ends the interpreter."""

import os
import pathlib
import subprocess

from . import places, words
from .dataset import open_results


def run(scene, *, folder=None, ranks=1, output=None, **options):
    """Computes a scene and returns its results, an xarray.Dataset like that of `open`.

    scene: the path of a scene file, or a dictionary with the same structure.
    folder: the folder of files named in a dictionary and of a relative `output`; default: the working directory.
    ranks: the number of MPI ranks.
    output: the results file; None: the file is deleted.
    options: options of the program, with priority over the scene: train_speed=70.0, output_probes=[12.5, 40.0]. The
        program reads neither .petscrc nor PETSC_OPTIONS.
    Raises Error with the last message of the program.
    """
    return _computed([scene], folder, ranks, output, options)


def study(scene, vary=None, *, folder=None, ranks=1, output=None, **options):
    """Computes a study, with the arguments of `run`. Each varied option is a coordinate.

    scene: that of a study, or any scene with vary={"train_speed": {"from": 40, "to": 80, "step": 5}, "beam_EI": [7e9,
    8e9]}, with values as in `study: vary:` of a scene file.
    """
    return _computed([scene] if vary is None else [scene, {"study": {"vary": vary}}], folder, ranks, output, options)


def screen(stock, fleet, limits, speeds=None, *, folder=None, ranks=1, output=None, **options):
    """Screens a stock of bridges with a fleet of trains, and returns the verdicts on all pairs.

    stock: the path of the table of bridges. fleet: the path of the table of axle loads, or of a folder of such tables.
    limits: the path of the limits. speeds: (from, to, step) in m/s, or as texts such as "10 km/h"; default: 10 to
        250 km/h, every km/h. Relative paths are relative to `folder`.
    Returns a Dataset with the dimensions bridge and formation, whose coordinates are the names: ratio (largest response
    over its limit), permitted_speed (m/s), decided_by (1: bound, 2: passages) and others. The other arguments are those
    of `run`: screen_modes=3, screen_audit=100, ...
    """
    scene = {"scene": {"analysis": "screen"}}
    asked = {"screen_stock": stock, "screen_fleet": fleet, "limits": limits}
    if speeds is not None:
        asked["screen_speeds"] = list(speeds)
    return _computed([scene], folder, ranks, output, {**asked, **options})


def _computed(scenes, folder, ranks, output, options):
    with words.of_scenes(*scenes) as (files, scratch):
        kept = pathlib.Path(folder or ".", output) if output is not None else pathlib.Path(scratch, "results.h5")
        asked = [places.program(), *files, *words.of_options(options), "-output_quiet", "true",
                 "-skip_petscrc"]
        if ranks != 1:
            asked = ["mpirun", "-n", str(ranks), *asked]
        ended = subprocess.run([*asked, "-output_file", str(kept.resolve())], cwd=folder, capture_output=True,
                               text=True, errors="replace", env=_environment(), stdin=subprocess.DEVNULL)
        if ended.returncode != 0:
            raise places.Error(_reason(ended).replace(scratch + os.sep, ""), _status(ended.returncode))
        return open_results(kept)


def _environment():
    """Environment variables: more ranks than processors and mpirun as root, as in run.sh; no options of PETSc."""
    defaults = {"OMPI_MCA_rmaps_base_oversubscribe": "1", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}
    if os.geteuid() == 0:
        defaults |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    own = {name: value for name, value in os.environ.items() if not name.startswith("PETSC_OPTIONS")}
    return defaults | own


def _status(code):
    return code if code >= 0 else 128 - code


def _reason(ended):
    """The message of the program, or its last line."""
    lines = ended.stderr.strip().splitlines()
    own = [line.removeprefix("traverse: ") for line in lines if line.startswith("traverse: ")]
    return (own or lines or [f"the program ended with status {_status(ended.returncode)}"])[-1]
