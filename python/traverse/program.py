"""Runs of the program: each in a separate process, so that no failure ends the interpreter."""

import operator
import os
import pathlib
import signal
import subprocess
import warnings

from . import places, words
from .dataset import open_results

MOST_RANKS = 1024
LAST_SECONDS = 10.0  # in which an interrupted program ends its results file


def run(scene, *, folder=None, ranks=1, output=None, **options):
    """Computes a scene and returns its results, an xarray.Dataset like that of `open`.

    scene: the path of a scene file, or a dictionary with the same structure.
    folder: the folder of files named in a dictionary and of a relative `output`; default: the working directory.
    ranks: the number of MPI ranks, from 1 to 1024.
    output: the results file; None: the file is deleted.
    options: options of the program, with priority over the scene: train_speed=70.0, output_probes=[12.5, 40.0]. The
        program reads neither .petscrc nor PETSC_OPTIONS.
    Warns with UnusualInput about each value that is probably not intended. Raises Error with the last message of the
    program.
    """
    return _computed([scene], folder, ranks, output, options)


def study(scene, vary=None, *, folder=None, ranks=1, output=None, **options):
    """Computes a study, with the arguments of `run`. Each varied option is a coordinate.

    scene: that of a study, or any scene with vary={"train_speed": {"from": 40, "to": 80, "step": 5}, "beam_EI": [7e9,
    8e9]}, with values as in `study: vary:` of a scene file.
    """
    scenes = [scene] if vary is None else [scene, {"study": {"vary": vary}}]
    return _computed(scenes, folder, ranks, output, options, ["study"])


def find(scene, option, between, keep="limits", quantity=None, equals=None, *, folder=None, ranks=1, output=None,
         **options):
    """Searches the values of an option with which all runs keep their limits, with the arguments of `run`.

    option: the name of the option, such as "beam_EI" or "load_speed".
    between: the least and the greatest value, in the unit of the option; texts such as "250 km/h" for speeds in km/h.
    keep: "limits" for all limits of runs (limits="FILE"), or the quantity of one of them.
    quantity, equals: instead of limits a quantity, such as "peak_deflection", and the value in its SI unit that it does
        not exceed.
    options: also those of the search: find_for_each=["load_hslm_a"], find_points=50, find_accuracy=1e-4, ...

    Returns the Dataset of the study of all v searched values, which are the coordinate `find_value` and, like every
    varied option, a coordinate by the name of the option. Coordinate `answer` [a]: the values of find_for_each, and
    last "all". Variables:
    find_ratio [a, v]: the greatest ratio of a run to its bound, 1; NaN: unknown.
    find_run, find_limit [a, v]: numbers of the run and the limit of this ratio.
    find_interval [i, 2]: first and last value of each interval within the bound, in the unit of the option;
        find_interval_answer [i]: number of its answer; find_interval_at_end [i, 2]: 1 where the search ends.
    attrs: find_option, find_condition, find_accuracy. Raises Error if the intervals are not known to find_accuracy.
    """
    asked = {"find_option": option, "find_between": between, "find_keep": keep, "find_quantity": quantity,
             "find_equals": equals}
    if quantity is not None and keep == "limits":
        del asked["find_keep"]  # its default
    given = {name: value for name, value in asked.items() if value is not None}
    return _computed([scene], folder, ranks, output, given | options)


def sensitivity(scene, vary=None, method="sobol", draws=None, *, folder=None, ranks=1, output=None, **options):
    """Computes the effects of uncertain options on the peaks, with the arguments of `study`.

    vary: distributions of the options, {"beam_EI": {"normal": [2.5e10, 2.0e9]}, "load_spread": {"uniform": [0.5, 0.7]}},
        and lists of others, over whose runs each quantity is the greatest. None: those of the scene.
    method: "local": derivatives at the means; "morris": elementary effects; "sobol": indices of variances.
    draws: the number of trajectories ("morris") or of base samples ("sobol"); None: that of the scene.

    Returns the Dataset of the study, with the coordinates `quantity` [q] and `factor` [f], the options with a
    distribution. Variables [q, f]:
    sobol: sensitivity_first, sensitivity_total, 1, with ..._low and ..._high, the ends of their intervals.
    morris: sensitivity_mean_effect, sensitivity_effect_deviation, sensitivity_effect_magnitude (with ..._low and
        ..._high), in the unit of the quantity over the range of the factor.
    local: sensitivity_derivative, sensitivity_derivative_error, in the unit of the quantity over that of the factor;
        sensitivity_elasticity, 1; sensitivity_effect_of_deviation, in the unit of the quantity.
    sensitivity_units [q, 2]: each quantity and its unit. attrs: sensitivity_method, sensitivity_base_samples,
    sensitivity_confidence. Raises Error with the last message of the program.
    """
    asked = {"study_sensitivity": method} | ({} if draws is None else {"study_draws": draws})
    return study(scene, vary, folder=folder, ranks=ranks, output=output, **asked, **options)


def fit(scene, vary=None, to=None, *, folder=None, ranks=1, output=None, **options):
    """Estimates options of a scene from measurements, with the arguments of `run`.

    scene: that of a fit, or any scene with vary={"beam_EI": [5e9, 2e10], ...}, the bounds of each estimated option, and
    to={"first": {"frequency": 1, "value": 4.1, "sd": 0.02}, "midspan": {"series": "midspan.csv", ...}}, the
    measurements as in `fit: to:` of a scene file.
    Returns a Dataset with estimate, standard_error and correlation along the dimension unknown, and the measured and
    computed values: series_NAME_measured, series_NAME_computed, frequencies_measured, frequencies_computed.
    """
    given = {key: value for key, value in (("vary", vary), ("to", to)) if value is not None}
    return _computed([scene, {"fit": given}] if given else [scene], folder, ranks, output, options, ["fit"])


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


def number_of_ranks(ranks):
    """The number of ranks, a whole number from 1 to MOST_RANKS; Error otherwise."""
    try:
        number = 0 if isinstance(ranks, bool) else operator.index(ranks)
    except TypeError:
        number = 0
    if not 1 <= number <= MOST_RANKS:
        raise places.Error(f"ranks = {ranks!r}: allowed: a whole number from 1 to {MOST_RANKS}", 2)
    return number


def _version_of(path):
    """What distinguishes two versions of a file; None if it does not exist."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_ino, found.st_size, found.st_mtime_ns


def _computed(scenes, folder, ranks, output, options, verb=()):
    """verb: the word before the scene, with which the program refuses a scene that asks for something else."""
    ranks = number_of_ranks(ranks)
    with words.of_scenes(*scenes) as (files, scratch):
        kept = pathlib.Path(folder or ".", output) if output is not None else pathlib.Path(scratch, "results.h5")
        asked = [places.program(), *verb, *files, *words.of_options(options), "-output_quiet", "true",
                 "-skip_petscrc"]
        if ranks != 1:
            asked = ["mpirun", "-n", str(ranks), *asked]
        earlier = _version_of(kept)
        ended = _ended([*asked, "-output_file", str(kept.resolve())], folder)
        for line in words.unusual_input(ended.stdout):
            warnings.warn(line, places.UnusualInput, stacklevel=3)
        if ended.returncode != 0:
            raise places.Error(_reason(ended).replace(scratch + os.sep, ""), _status(ended.returncode))
        if _version_of(kept) == earlier:
            raise places.Error("the program has ended without results: with options such as check, help or version it "
                               "computes nothing; leave them out, or give them to the program in a terminal", 2)
        return open_results(kept)


def _ended(asked, folder):
    """The ended process of a command. If an exception, such as KeyboardInterrupt, ends the wait for it, the program first
    ends its results file."""
    with subprocess.Popen(asked, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, errors="replace", env=environment()) as process:
        try:
            printed = process.communicate()
        except BaseException:
            process.send_signal(signal.SIGINT)
            try:
                process.communicate(timeout=LAST_SECONDS)
            except subprocess.TimeoutExpired:
                process.kill()
            raise
    return subprocess.CompletedProcess(asked, process.returncode, *printed)


def environment():
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
