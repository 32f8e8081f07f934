"""Texts of people: scenes and tables, whose names of files stay in the folder of their run.

Files of the library (options/) that a scene names are copied beside it, so that the folder is complete: whoever downloads
it computes the same anywhere.
"""

import pathlib
import re

import yaml

OPTIONS = pathlib.Path(__file__).resolve().parents[2] / "options"
MOST_BYTES, MOST_FILES = 2_000_000, 20  # of all files of a run together
MOST_YAML = 300_000  # characters of one
NAME = re.compile(r"[A-Za-z0-9][\w-]{0,60}\.(csv|txt|yml|yaml)")
OWN = ("scene.yml", "bridge.yml", "limits.yml")  # names of the files that the forms write
BREAKS = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\x85\u2028\u2029]")  # line ends for some readers of YAML only
# A path that leaves its folder; a slash after a letter, a digit or a bracket is that of km/h, 1/600 or options/loads.
OUTSIDE = re.compile(r"(^|[^\w)\]²³])/(?!\s)|\\|(^|[^\w.])\.\.($|[^\w.])|^~")


class InputError(ValueError):
    """A text that is not taken, in one line. `field`: of the form, whose text it is."""

    def __init__(self, message, field=""):
        super().__init__(" ".join(message.split()))
        self.field = field


def scalars(text, name):
    """The nodes of all scalars of a YAML text, keys too, as they are written."""
    if BREAKS.search(text):
        raise InputError(f"{name}: has control characters")
    if len(text) > MOST_YAML:
        raise InputError(f"{name}: allowed: at most {MOST_YAML:,} characters of YAML")
    try:
        nodes = [yaml.compose(text, yaml.SafeLoader)]
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        line = f":{mark.line + 1}" if mark else ""
        raise InputError(f"{name}{line}: is no YAML ({getattr(error, 'problem', '') or 'too deep'})") from None
    found, known = [], set()
    while nodes:
        node = nodes.pop()
        if node is None or id(node) in known:
            continue
        known.add(id(node))
        if isinstance(node, yaml.ScalarNode):
            found.append(node)
        else:
            nodes += [part for pair in node.value for part in (pair if isinstance(pair, tuple) else (pair,))]
    return found


def without_blocks(text, names):
    """A text of a scene without its outermost blocks of these names."""
    root = yaml.compose(text, yaml.SafeLoader)
    for key, value in reversed(root.value if isinstance(root, yaml.MappingNode) and not root.flow_style else []):
        if key.value in names:
            text = text[:key.start_mark.index] + text[value.end_mark.index:]
    return text


def library_file(word):
    """The file of the library that a word of a scene names, as scenes of the library do; None if it names none."""
    path = re.sub(r"^(\.\./|options/)+", "", word)
    if not re.fullmatch(r"[\w-]+/[\w-]+\.(yml|csv|txt)", path) or path == word:
        return None
    file = OPTIONS / path
    return file if file.is_file() else None


def with_library(text, name, files, beside=None):
    """The text with the names of copies instead of those of files of the library, which become a part of `files`.
    beside: the folder of the library in which the text is."""
    for node in sorted(scalars(text, name), key=lambda node: node.start_mark.index, reverse=True):
        own = beside / node.value if beside and re.fullmatch(r"[\w-]+\.\w+", node.value) else None
        found = own if own and own.is_file() else library_file(node.value)
        if found is None:
            continue
        if found.name not in files:
            copied = found.read_text(encoding="utf-8")
            files[found.name] = copied
            if found.suffix == ".yml":
                files[found.name] = with_library(copied, found.name, files, found.parent)
        text = text[:node.start_mark.index] + found.name + text[node.end_mark.index:]
    return text


def check_text(name, text, field=""):
    """InputError for a YAML text that names a file outside of its folder."""
    for node in scalars(text, name):
        if OUTSIDE.search(node.value):
            raise InputError(f"{name}:{node.start_mark.line + 1}: {node.value[:80]}: allowed: names of files that are sent "
                             "with the scene, or of the library as options/vehicles/velaro.yml", field)


def checked(files):
    """The files of a run, {name: text}, if none of them is too much, has another's name, or leads elsewhere."""
    if len(files) > MOST_FILES or sum(len(text.encode("utf-8", "replace")) for text in files.values()) > MOST_BYTES:
        raise InputError(f"allowed: at most {MOST_FILES} files of together {MOST_BYTES:,} bytes", "files")
    for name, text in files.items():
        if not NAME.fullmatch(name):
            raise InputError(f"{name[:80]}: allowed: a name of letters, digits, _ and -, with the ending csv, txt, yml or "
                             "yaml", "files")
        if name.endswith((".yml", ".yaml")):
            check_text(name, text, "" if name in OWN else "files")
        elif "options_file" in text or re.search(r"^\s*-[A-Za-z]", text, re.MULTILINE):
            raise InputError(f"{name}: allowed: a table of numbers; options are in YAML files", "files")
    return files
