"""The paths of the program and its library, the error of both, and the warning about unusual input."""

import os
import pathlib
import shutil


class Error(RuntimeError):
    """A failure of the program or its library, with its message.

    `status`: 2 for invalid input, 3 if the equations cannot be solved, 4 for a file, 5 for memory, 70 for an internal
    error; 128 + n if signal n ended the program.
    """

    def __init__(self, message, status):
        super().__init__(message)
        self.status = status


class UnusualInput(UserWarning):
    """A line of the program on input that is valid but probably not intended, such as a value in another unit."""


def program():
    """The path of the program: TRAVERSE_BINARY, in the checkout or installation of this package, or in PATH."""
    named = os.environ.get("TRAVERSE_BINARY")
    if named:
        return named
    found = _beside_package("build/traverse", "bin/traverse") or shutil.which("traverse")
    if found is None:
        raise Error("the program traverse is not there: build it (./run.sh), or name it in TRAVERSE_BINARY", 4)
    return str(found)


def shared_library():
    """The path of libtraverse.so: beside the program of TRAVERSE_BINARY, in the checkout, or installed."""
    named = os.environ.get("TRAVERSE_BINARY")
    beside_program = pathlib.Path(named).parent / "libtraverse.so" if named else None
    if beside_program is not None and beside_program.is_file():
        return str(beside_program)
    found = _beside_package("build/libtraverse.so", "lib/*/libtraverse.so*", "lib/libtraverse.so*")
    return str(found) if found else "libtraverse.so"  # in the library path of the system


def _beside_package(in_checkout, *installed):
    """The first existing file: in the checkout of this package, or under its installation prefix."""
    package = pathlib.Path(__file__).resolve().parent
    checkout, prefix = package.parents[1], package.parents[3]
    places = [checkout / in_checkout] if (checkout / "CMakeLists.txt").is_file() else []
    places += [path for pattern in installed for path in sorted(prefix.glob(pattern))]
    return next((path for path in places if path.is_file()), None)
