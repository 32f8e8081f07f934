"""Runs of problems in this process, without a file."""

import contextlib
import ctypes
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import warnings

import numpy as np
import xarray

from . import places
from .dataset import in_km_per_hour
from .shared_library import GO_ON, check, library, results_of
from .passage import Passage
from .problem import Problem, within
from .program import environment, number_of_ranks


def simulate(problems, observers=(), *, ranks=1, progress=None):
    """Computes problems in this process, and returns the greatest results of each run as an xarray.Dataset.

    problems: one Problem (or a scene: a path, a dictionary), or a list. Problems that differ in the values of options
        only are computed together, with one numerical model and in the lanes of the processor. If they differ in one
        number, it is their dimension and coordinate; otherwise the dimension is `case`, with a coordinate for each
        option that differs.
    observers: functions of a `Passage`, called at t = 0 and at each sample (output_interval); they may read it and set
        forces. A function that returns False ends the run. Then problems are computed one after another, their vehicles
        as mechanisms.
    ranks: processes that share the runs; the results are the same. Under mpirun or srun, all processes call `simulate` and
        share the runs, with the default.
    progress: a function of the share that is done (0 to 1), called about twenty times a second; False ends the runs.

    Variables: those of a study (peak_deflection, peak_acceleration, ..., with their times), judged for the limits of the
    problems, and diagnostics of runs by themselves: energy_residual, linearisation_residual, steps. attrs["model"]: how
    the first run was computed. Warns with UnusualInput. Raises Error, whose `results` are those computed before.
    """
    single = isinstance(problems, (Problem, dict, str, os.PathLike))
    given = [_problem(one) for one in ([problems] if single else problems)]
    if not given:
        raise places.Error("there is no problem to simulate", 2)
    if observers:
        functions = [observers] if callable(observers) else list(observers)
        results = [_observed(problem, functions) for problem in given]
        results = xarray.concat(results, "run")
    elif number_of_ranks(ranks) > 1:
        results = _on_ranks(given, ranks)
    else:
        results = _together(given, progress)
    return results.isel(run=0) if single else _with_options(results, given)


def _problem(one):
    """A Problem, or the problem of a scene: a path or a dictionary."""
    if isinstance(one, Problem):
        return one
    if isinstance(one, (dict, str, os.PathLike)):
        return Problem(one)
    raise places.Error(f"{one!r} is not a problem; wanted: a Problem, the path of a scene file, or a dictionary", 2)


def _together(problems, progress):
    """The results of all problems by one call of the library."""
    raised = []

    @GO_ON
    def go_on(_, done):  # an exception cannot pass through the library
        try:
            return 1 if not interrupts and (progress is None or progress(done) is not False) else 0
        except Exception as failure:  # noqa: BLE001
            raised.append(failure)
            return 0

    with contextlib.ExitStack() as stack:
        interrupts = stack.enter_context(_deferred_interrupts())
        folders = {problem.folder for problem in problems}
        if len(folders) > 1:
            raise places.Error("the problems of one call have one folder", 2)
        stack.enter_context(within(*folders))
        handles = [stack.enter_context(problem.handle()) for problem in problems]
        made = ctypes.c_void_p()
        status = library().traverse_simulate(len(handles), (ctypes.c_void_p * len(handles))(*handles),
                                             int(_has_launcher()), go_on, None, ctypes.byref(made))
        results = results_of(made) if made else None
    if raised:
        raise raised[0]
    try:
        check(status)
    except places.Error as failure:
        failure.results = results
        raise
    return results


@contextlib.contextmanager
def _deferred_interrupts():
    """A list that gets an entry when SIGINT arrives; what it does without this context, it does at the end of it."""
    interrupts = []
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(before):
        yield interrupts
        return
    signal.signal(signal.SIGINT, lambda *arguments: interrupts.append(arguments))
    try:
        yield interrupts
    finally:
        signal.signal(signal.SIGINT, before)
    if interrupts:
        before(*interrupts[0])


def _has_launcher():
    """Whether mpirun, or another launcher that speaks PMIx, as Slurm's srun, has started this process."""
    return "OMPI_COMM_WORLD_RANK" in os.environ or "PMIX_RANK" in os.environ


def _observed(problem, functions):
    with Passage(problem) as passage:
        goes_on = all([function(passage) is not False for function in functions])
        while goes_on and passage.time < passage.end:
            passage.advance()
            goes_on = all([function(passage) is not False for function in functions])
        return passage.results()


def _on_ranks(problems, ranks):
    """The results by processes of their own, started by mpirun."""
    with tempfile.TemporaryDirectory(prefix="traverse-") as folder:
        asked, answered = pathlib.Path(folder, "problems"), pathlib.Path(folder, "results")
        asked.write_bytes(pickle.dumps(problems))
        code = "import sys; from traverse.simulation import serve; serve(*sys.argv[1:])"
        package = str(pathlib.Path(__file__).resolve().parents[1])
        paths = os.pathsep.join([package, *filter(None, [os.environ.get("PYTHONPATH")])])
        ended = subprocess.run(["mpirun", "-n", str(ranks), sys.executable, "-B", "-c", code, str(asked), str(answered)],
                               capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL,
                               env=environment() | {"PYTHONPATH": paths})
        if not answered.exists():
            raise places.Error((ended.stderr.strip().splitlines() or ["mpirun gave no results"])[-1], 70)
        results, unusual, failure = pickle.loads(answered.read_bytes())
    for line in unusual:
        warnings.warn(line, places.UnusualInput, stacklevel=3)
    if failure is not None:
        error = places.Error(*failure)
        error.results = results
        raise error
    return results


def serve(asked, answered):
    """On each process of mpirun: computes the problems of one file; the first process writes the results to another."""
    problems = pickle.loads(pathlib.Path(asked).read_bytes())
    results = failure = None
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            results = _together(problems, None)
        except places.Error as error:
            results, failure = getattr(error, "results", None), (str(error), error.status)
    if os.environ.get("OMPI_COMM_WORLD_RANK", "0") == "0":
        pathlib.Path(answered).write_bytes(pickle.dumps((results, [str(one.message) for one in caught], failure)))


def _with_options(results, problems):
    """The results with the options in which the problems differ as coordinates."""
    names = {name for problem in problems for name in problem.options}
    varied = {}
    for name in sorted(names):
        texts = [problem.options.get(name) for problem in problems]
        if len(set(texts)) > 1:
            varied[name] = _numbers(texts)
    numbers = [name for name, values in varied.items() if isinstance(values, np.ndarray)]
    dimension = numbers[0] if len(varied) == 1 and numbers else "case"
    results = results.rename_dims(run=dimension)
    return in_km_per_hour(results.assign_coords(
        {name: (dimension, values, {"units": "m/s"} if name.endswith("_speed") and name in numbers else {})
         for name, values in varied.items()}))


def _numbers(texts):
    try:
        return np.array([float(text) for text in texts])
    except (TypeError, ValueError):
        return texts
