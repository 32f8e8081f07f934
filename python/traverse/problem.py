"""Problems as values: what `simulate` and `Passage` compute."""

import contextlib
import ctypes
import os

import numpy as np

from . import words
from .shared_library import NUMBERS, check, library

BESIDE_TABLES = ("columns", "unit", "factor", "shift", "decimal")  # options beside the name of a table, in its block


class Problem:
    """A bridge and what crosses it, as a value: nothing is read or computed before `simulate`.

    scene: the path of a scene file, or a dictionary with its structure; None: nothing. folder: the folder of files named
    in options; default: the working directory.
    options: blocks such as beam={"spans": [28.0], "EI": 2.6e11}, or single options such as train_speed=70.0, with
    priority over the scene; None removes an option. An array with several columns stands for the file of a table:
    load={"table": array}.
    """

    def __init__(self, scene=None, *, folder=None, **options):
        self.folder = os.path.abspath(folder or ".")
        self.file = None if scene is None or isinstance(scene, dict) else os.fspath(scene)
        self.tables = {}
        self.options = self._flat(scene if isinstance(scene, dict) else {}) | self._flat(options)

    def with_options(self, **options):
        """A problem with these options in place of, or in addition to, those of this one."""
        other = Problem.__new__(Problem)
        other.__dict__ = self.__dict__ | {"tables": dict(self.tables)}
        other.options = self.options | other._flat(options)
        return other

    def _content(self):
        tables = tuple((name, table.shape, table.tobytes()) for name, table in sorted(self.tables.items()))
        return self.folder, self.file, tuple(sorted(self.options.items())), tables

    def __eq__(self, other):
        return isinstance(other, Problem) and self._content() == other._content()

    def __hash__(self):
        return hash(self._content())

    def __repr__(self):
        options = "".join(f", {name}={value!r}" for name, value in self.options.items())
        return f"Problem({self.file!r}, folder={self.folder!r}{options})"

    def _flat(self, block, prefix=""):
        """The options of nested blocks by their names; tables are kept by the names of their options."""
        found = {}
        is_table = {"name"} < set(block) <= {"name", *BESIDE_TABLES}
        for key, value in block.items():
            name = prefix.removesuffix("_") if key == "name" and is_table else f"{prefix}{key}"
            if isinstance(value, dict):
                found |= self._flat(value, f"{name}_")
            elif _is_table(value):
                found[name] = f"{name}.csv"
                self.tables[found[name]] = np.ascontiguousarray(value, dtype=float)
            else:
                found[name] = None if value is None else words.text(value)
        return found

    @contextlib.contextmanager
    def handle(self):
        """The problem in the library, within this context."""
        made = ctypes.c_void_p()
        if self.file is None:
            check(library().traverse_problem_new(None, ctypes.byref(made)))
        else:
            check(library().traverse_problem_read(self.file.encode(), ctypes.byref(made)))
        try:
            for name, value in self.options.items():
                check(library().traverse_problem_set(made, name.encode(), None if value is None else value.encode()))
            for name, table in self.tables.items():
                check(library().traverse_problem_table(made, name.encode(), *table.shape,
                                                       table.ctypes.data_as(NUMBERS)))
            yield made.value
        finally:
            library().traverse_problem_free(made)


def _is_table(value):
    if isinstance(value, np.ndarray):
        return value.ndim == 2
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(v, (list, tuple)) for v in value)


@contextlib.contextmanager
def within(folder):
    """Changes the working directory, to which the files of a scene are relative, within this context."""
    before = os.getcwd()
    if folder is not None:
        os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)
