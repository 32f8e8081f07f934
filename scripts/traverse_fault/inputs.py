"""The texts of a scene: those that a results file holds, which are what the program has read, or those that its files name.

Each text gets a name in the folder input/ of the report, so that the scene can be run there: relative names stay as they are.
"""

import os
import pathlib
import re
import stat
import tempfile
from typing import NamedTuple

import input_files

MOST_BYTES, MOST_FILES = 5_000_000, 200  # of a text; of texts that are looked for
LEVELS = 2                               # folders above that of a scene to which names in the report may lead
OUTSIDE = "is no ordinary file in the folders of the scene"
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


def of_results(file, folder, scenes):
    """The input that a results file holds, without the files of this machine that do not belong to the scene; names of its files
    are relative to `folder`."""
    if "input/options" not in file:
        return Input({}, [], [], folder)
    pairs = {name: file[f"input/{name}"].asstr()[()] for name in ("options", "sources", "files") if f"input/{name}" in file}
    texts = {os.path.normpath(os.path.join(folder, name)): text for name, text in pairs.get("files", ())}
    options = [(name, value, f"{source}:{line}" if line != "0" else source)
               for (name, value), (source, line) in zip(pairs["options"], pairs.get("sources", ()))]
    given = [*map(os.path.abspath, scenes)]
    places = places_of([folder, *map(os.path.dirname, given or list(texts)[:1])])
    outside = [path for path in texts if path not in given and os.path.lexists(path) and not may_be_packed(path, places)]
    return Input({path: text for path, text in texts.items() if path not in outside}, options,
                 [(path, OUTSIDE) for path in outside], folder)


def places_of(folders):
    """The folders whose files belong to scenes in `folders`: these, the ones above them, the working directory and the library."""
    here = [pathlib.Path(os.path.realpath(folder)) for folder in folders]
    above = [folder.parent for folder in here if not holds_more(folder.parent)]
    return [*here, *above, pathlib.Path.cwd(), LIBRARY / "options"]


def holds_more(folder):
    """Whether a folder is or contains the home or that of temporary files, so that its folders may belong to other things."""
    return any(is_within(os.path.realpath(one), folder) for one in (os.path.expanduser("~"), tempfile.gettempdir()))


def may_be_packed(path, places):
    """Whether a file that a scene names is an ordinary one in the folders of the scene, no hidden one, nor behind a link that
    leads out of them."""
    real = pathlib.Path(os.path.realpath(path))
    beneath = [real.relative_to(place).parts for place in places if is_within(real, place)
               and (real.parent == place or not holds_more(place))]
    try:
        ordinary = stat.S_ISREG(os.stat(real).st_mode)
    except (OSError, ValueError):
        return False
    return ordinary and any(not any(part.startswith(".") for part in parts) for parts in beneath)


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
    found, left_out = {}, []
    waiting = [pathlib.Path(os.path.abspath(scene)) for scene in scenes]
    given, places = set(waiting), places_of([scene.parent for scene in waiting])
    while waiting:
        path = waiting.pop(0)
        if str(path) in found or any(str(path) == name for name, _ in left_out):
            continue
        if path not in given and not may_be_packed(path, places):
            left_out.append((str(path), OUTSIDE))
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
    above = (one for one in own[0].parents[:LEVELS] if not holds_more(one))
    for base in (folder, own[0], *above):
        if base.name and all(is_within(one, base) for one in own):
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
