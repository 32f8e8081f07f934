"""Conversion of a scene and options of Python into YAML files and options of the command line."""

import contextlib
import os
import pathlib
import tempfile

import numpy as np
import yaml

from . import places


def plain(value):
    """The value in types of YAML: arrays as lists, numbers of numpy as those of Python, paths as texts."""
    if isinstance(value, dict):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, (list, tuple, range)):
        return [plain(inner) for inner in value]
    if value is None or isinstance(value, (str, bool, int, float)):
        return value
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise places.Error(f"{value!r} of a scene is of the type {type(value).__name__}; allowed: numbers, texts, booleans, paths, "
                       "lists, arrays and dictionaries", 2)


def text(value):
    """A number, a text, a boolean or a list as the program reads it."""
    value = plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    return ",".join(map(text, value)) if isinstance(value, list) else str(value)


def of_options(options):
    """{"train_speed": 70.0} as ["-train_speed", "70.0"]; a value may be a number, a text, a boolean or a list."""
    return [word for name, value in options.items() for word in (f"-{name}", text(value))]


@contextlib.contextmanager
def of_scenes(*scenes):
    """The command-line words of scenes: paths, or dictionaries, which are temporary files within this context."""
    with tempfile.TemporaryDirectory(prefix="traverse-") as folder:
        words = []
        for number, scene in enumerate(scenes):
            if isinstance(scene, dict):
                path = pathlib.Path(folder, f"scene{number or ''}.yml")
                path.write_text(yaml.safe_dump(plain(scene), sort_keys=False), encoding="utf-8")
                scene = path
            words += ["-options_file", os.fspath(scene)]
        yield words, folder


def unusual_input(printed):
    """The lines on unusual input that the program has printed."""
    found, inside = [], False
    for line in printed.splitlines():
        if inside and line.startswith("  "):
            found.append(line.strip())
        else:
            inside = line == "unusual input"
    return found
