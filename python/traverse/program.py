"""Runs of the program: each in a process of its own, so that nothing it meets ends the interpreter."""

import os
import pathlib
import subprocess

from . import places, words
from .dataset import open_results


def run(scene, *, folder=None, ranks=1, output=None, **options):
    """Computes a scene and returns its results, an xarray.Dataset as `open` gives it.

    scene: the path of a scene's file, or a dictionary of the same shape.
    folder: where files that a dictionary names are looked for, and what a relative `output` counts from; the working
        directory where it is left out.
    ranks: of MPI.
    output: the results file to keep; None: none is kept.
    options: options of the program, which win over the scene: train_speed=70.0, output_probes=[12.5, 40.0]. Nothing is
        taken from .petscrc and PETSC_OPTIONS.
    Raises Error with the line that the program ends with.
    """
    return _computed([scene], folder, ranks, output, options)


def study(scene, vary=None, *, folder=None, ranks=1, output=None, **options):
    """Runs a study as `run` runs a scene: one coordinate for each option that is varied.

    scene: of a study, or any scene with vary={"train_speed": {"from": 40, "to": 80, "step": 5}, "beam_EI": [7e9, 8e9]},
    values as in `study: vary:` of a scene's file.
    """
    return _computed([scene] if vary is None else [scene, {"study": {"vary": vary}}], folder, ranks, output, options)


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
    """More ranks than processors are allowed, and mpirun as root, as run.sh does; without options of PETSc's."""
    defaults = {"OMPI_MCA_rmaps_base_oversubscribe": "1", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}
    if os.geteuid() == 0:
        defaults |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    own = {name: value for name, value in os.environ.items() if not name.startswith("PETSC_OPTIONS")}
    return defaults | own


def _status(code):
    return code if code >= 0 else 128 - code


def _reason(ended):
    """The program's own line, or the last one that was written."""
    lines = ended.stderr.strip().splitlines()
    own = [line.removeprefix("traverse: ") for line in lines if line.startswith("traverse: ")]
    return (own or lines or [f"the program ended with status {_status(ended.returncode)}"])[-1]
