"""Text files that the scripts read: ordinary files of a limited size; a pipe is not waited for."""

import os
import stat

import yaml

LARGEST = 100_000          # bytes of a file of words, such as limits
LARGEST_TABLE = 1 << 30    # bytes of a table


class InputError(ValueError):
    """A file that cannot be read, in one line that names it."""


def bytes_of(path, most, whole=True):
    """The content of a file of at most so many bytes, or its beginning."""
    try:
        handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        with open(handle, "rb") as file:
            if not stat.S_ISREG(os.fstat(handle).st_mode):
                raise InputError(f"{path}: is no ordinary file")
            content = file.read(most + 1 if whole else most)
    except IsADirectoryError:
        raise InputError(f"{path}: is no ordinary file") from None
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    if len(content) > most:
        raise InputError(f"{path}: is too large; allowed: at most {most:,} bytes")
    return content


def text_of(path, most=LARGEST, encoding="utf-8-sig"):
    """The text of a file of at most so many bytes."""
    content = bytes_of(path, most)
    try:
        return content.decode(encoding)
    except UnicodeDecodeError as error:
        line = content[:error.start].count(b"\n") + 1
        raise InputError(f"{path}:{line}: is no text in UTF-8") from None


class TwiceError(yaml.constructor.ConstructorError):
    """A key that occurs twice in a map."""


class OnceLoader(yaml.SafeLoader):
    """Reads YAML in which each key of a map occurs once."""

    def construct_mapping(self, node, deep=False):
        known = set()
        for key, _ in node.value if isinstance(node, yaml.MappingNode) else ():
            if key.value in known:
                raise TwiceError(None, None, f"{key.value} is given twice", key.start_mark)
            if isinstance(key.value, str):
                known.add(key.value)
        return super().construct_mapping(node, deep)


def yaml_of(path, what):
    """The content of a YAML file. what: its form in words, for the message of a file with another one."""
    try:
        return yaml.load(text_of(path), OnceLoader)
    except TwiceError as error:
        raise InputError(f"{path}:{error.problem_mark.line + 1}: {error.problem}") from None
    except InputError:
        raise
    except (yaml.YAMLError, ValueError, RecursionError):
        raise InputError(f"{path} is no {what}") from None
