"""The texts of a scene: those that a results file holds, which are what the program has read, or those that its files name.

Each text gets a name in the folder input/ of the report, so that the scene can be run there: relative names stay as they are.
"""

import os
import pathlib
import re
import stat
from typing import NamedTuple

import input_files

MOST_BYTES, MOST_FILES = 5_000_000, 200  # of a text; of texts that are looked for
LEVELS = 2                               # folders above that of a scene whose files are those of the scene
LIBRARY = pathlib.Path(__file__).resolve().parents[2]  # the folder of options/
# What may name a file: a word, or a value of YAML with blanks.
WORD = re.compile(r"[^\s\"'`,;:\[\]{}()=]+\.[A-Za-z]\w*")
VALUE = re.compile(r"[:,\[{]\s+[\"']?([^,:{}\[\]#\n\"']* [^,:{}\[\]#\n\"']*\.[A-Za-z]\w*)")


class Input(NamedTuple):
    """What is known of the input of a run."""
    texts: dict  # absolute path: text
    options: list  # (name, value, source)
    left_out: list  # (name, why)
    folder: pathlib.Path  # of relative names


def is_within(path, folder):
    return pathlib.PurePath(path).is_relative_to(folder)


def of_results(file, folder):
    """The input that a results file holds; names of its files are relative to `folder`."""
    if "input/options" not in file:
        return Input({}, [], [], folder)
    pairs = {name: file[f"input/{name}"].asstr()[()] for name in ("options", "sources", "files") if f"input/{name}" in file}
    texts = {os.path.normpath(os.path.join(folder, name)): text for name, text in pairs.get("files", ())}
    options = [(name, value, f"{source}:{line}" if line != "0" else source)
               for (name, value), (source, line) in zip(pairs["options"], pairs.get("sources", ()))]
    return Input(texts, options, [], folder)


def places_of(folder):
    """The folders whose files belong to a scene in `folder`: not the whole home, nor a folder of the root."""
    found = [pathlib.Path(folder)]
    home = pathlib.Path(os.path.expanduser("~")).resolve()
    for parent in pathlib.Path(folder).parents[:LEVELS]:
        if len(parent.parts) > 2 and not is_within(home, parent):
            found.append(parent)
    return [found[-1], pathlib.Path.cwd(), LIBRARY / "options"]


def may_be_packed(path, places):
    """Whether a file that a scene names is an ordinary one in the folders of the scene, and no hidden one."""
    real = pathlib.Path(os.path.realpath(path))
    beneath = [real.relative_to(place) for place in places if is_within(real, place)]
    try:
        ordinary = stat.S_ISREG(os.stat(real).st_mode)
    except (OSError, ValueError):
        return False
    return ordinary and any(not any(part.startswith(".") for part in one.parts) for one in beneath)


def named_in(text, folder):
    """The existing files that words of a text name, where the program looks for them."""
    for word in dict.fromkeys(WORD.findall(text) + VALUE.findall(text)):
        for place in (folder, pathlib.Path.cwd(), LIBRARY):
            path = pathlib.Path(os.path.normpath(place / word))
            if os.path.lexists(path) and not path.is_dir():
                yield path
                break


def looked_for(scenes):
    """The input of scenes that the program could not read: their texts, and those that they name."""
    found, left_out, places = {}, [], []
    waiting = [pathlib.Path(os.path.abspath(scene)) for scene in scenes]
    for scene in waiting:
        places += places_of(scene.parent)
    given = set(waiting)
    while waiting:
        path = waiting.pop(0)
        if str(path) in found or any(str(path) == name for name, _ in left_out):
            continue
        if path not in given and not may_be_packed(path, places):
            left_out.append((str(path), "is no ordinary file in the folders of the scene"))
        elif len(found) >= MOST_FILES:
            left_out.append((str(path), f"is more than the {MOST_FILES}th file"))
        else:
            try:
                found[str(path)] = input_files.text_of(path, MOST_BYTES)
                waiting += named_in(found[str(path)], path.parent)
            except input_files.InputError as error:
                left_out.append((str(path), str(error).removeprefix(f"{path}: ")))
    return Input(found, [], left_out, pathlib.Path.cwd())


def base_of(paths, folder):
    """The folder of all files that are not of the library: that of relative names, or one at most a few folders above the
    first file."""
    own = [pathlib.PurePath(path).parent for path in paths if not is_within(path, LIBRARY / "options")]
    if not own:
        return None
    for base in (folder, own[0], *own[0].parents[:LEVELS]):
        if all(is_within(one, base) for one in own):
            return base
    return own[0]


def names_in_report(paths, base):
    """{path: name beneath input/} without what is above the folder `base`."""
    names = {}
    for path in paths:
        if is_within(path, LIBRARY / "options"):
            name = pathlib.PurePath(path).relative_to(LIBRARY)
        elif base is not None and is_within(path, base):
            name = pathlib.PurePath(path).relative_to(base)
        else:
            name = pathlib.PurePath("elsewhere", pathlib.PurePath(path).name)
        while str(name) in names.values():
            name = name.with_name(f"other_{name.name}")
        names[path] = str(name)
    return names
