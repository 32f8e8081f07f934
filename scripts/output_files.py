"""Files that the scripts write: each is new, or Traverse has written it before; never a link, a folder or an input.

Every file is written under another name in its folder and renamed when it is complete. Traverse recognises its files by
their content: pictures, pages and workbooks name it as their program, texts begin with a line that names it and has a digest
of the other lines, and a table has the head that is written now, apart from numbers.
"""

import contextlib
import csv
import errno
import hashlib
import io
import mmap
import os
import pathlib
import re
import secrets
import signal
import stat
import sys
import zipfile

import checked_results

PROGRAM = "Traverse"
WRITER = f"{PROGRAM} {checked_results.VERSION}"
ANY = rb"Traverse( [\d.]+)?"  # the writer of a file by any version
TEXTS = ("txt", "yml")
TEXT = f"# Written by {WRITER}, digest"  # the beginning of a text
GENERATOR = f'<meta name="generator" content="{WRITER}">'
METADATA = {"png": {"Software": WRITER}, "pdf": {"Creator": WRITER}, "svg": {"Creator": WRITER}}
# The first bytes of a kind of file, and what Traverse writes into it.
CONTENTS = {
    "png": (rb"\x89PNG\r\n", rb"Software\0" + ANY),
    "pdf": (rb"%PDF-", rb"/Creator \((traverse-report|" + ANY + rb")\)"),
    "svg": (rb"<\?xml", rb"<dc:title>" + ANY + rb"</dc:title>"),
    "html": (rb"<!DOCTYPE html>", rb'<meta name="generator" content="' + ANY + rb'">'),
    "xdmf": (rb"<\?xml", rb'<Information Name="program" Value="' + ANY + rb'"'),
    "gif": (rb"GIF8", rb"\x21\xfe.Traverse( [\d.]+)?\x00\x3b\Z"),
    "mp4": (rb"....ftyp", rb"Traverse"),
    "md": (rb"# Gallery\n", rb"`/usr/bin/python3 scripts/gallery\.py` writes this page"),
}
FAULT = f"Fault report, written by {WRITER}"  # the comment of a ZIP file
# Kinds of HDF5 files, and the program that they name.
RESULTS = {"results": "traverse", "exported": "traverse export"}
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
unfinished = set()  # files that are being written under another name
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # errors of a file for which there is no room
TAKEN = ("is there already, without the mark that Traverse leaves in such a file: it is another program's, was changed since, "
         "or is of a version without marks; remove or rename it, or name another file or folder")


class OutputError(ValueError):
    """A file that must not be written, in one line that names it."""


def kind_of(path, allowed):
    """The kind of a file by the ending of its name."""
    kind = pathlib.Path(path).suffix[1:].lower()
    if kind not in allowed:
        raise OutputError(f"{path}: allowed: {', '.join('.' + one for one in allowed)}")
    return kind


def digest_of(text):
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def first_line(text):
    """The first line of a text that has the other lines."""
    return f"{TEXT} {digest_of(text)}\n"


def same_head(line, head):
    """Whether a line is the head of a table, apart from numbers: stations and speeds may differ."""
    def bare(names):
        return {re.sub(r"[-+]?\d[\d.,]*(e[-+]?\d+)?", "#", name) for name in names}
    return bare(next(csv.reader([line]), [])) == bare(map(plain_cell, head))


def is_of_traverse(path, kind, head):
    """Whether Traverse has written an ordinary file as an output of this kind."""
    try:
        if kind == "csv":
            with open(path, encoding="utf-8", newline="") as file:
                return head is None or same_head(file.readline(1 << 20).rstrip("\r\n"), head)
        if kind in TEXTS:
            with open(path, encoding="utf-8", newline="") as file:
                first, digest = file.readline(100), digest_of(file.read())
                return bool(re.fullmatch(rf"# Written by {ANY.decode()}, digest {digest}\n", first))
        if kind == "xlsx":
            with zipfile.ZipFile(path) as book, book.open("docProps/core.xml") as about:
                return bool(re.search(b">" + ANY + b"</dc:creator>", about.read(1 << 16)))
        if kind == "zip":
            with zipfile.ZipFile(path) as archive:
                return bool(re.fullmatch(b"Fault report, written by " + ANY, archive.comment))
        if kind in RESULTS:
            with checked_results.opened(path) as file:
                return file.attrs.get("program") == RESULTS[kind]
        first, content = CONTENTS[kind]
        with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            return bool(re.match(first, data, re.DOTALL)) and bool(re.search(content, data))
    except (OSError, ValueError, KeyError, csv.Error, zipfile.BadZipFile):
        return False


def identity(path):
    """What tells whether another file has been put there; None: there is none."""
    try:
        found = os.lstat(path)
    except FileNotFoundError:
        return None
    return found.st_dev, found.st_ino, found.st_mtime_ns, found.st_size


def check(path, kind, inputs=(), head=None):
    """OutputError unless a file may be written: it is no link and none of the inputs, and it is new, empty or of
    Traverse. head: of a table; None if it is not known yet: write_table() will compare it."""
    try:
        found = os.lstat(path)
    except FileNotFoundError:
        found = None
    except OSError as error:
        raise OutputError(f"{path}: {error.strerror}") from None
    folder = pathlib.Path(path).parent
    if found is None and not folder.is_dir():
        raise OutputError(f"{path}: there is no folder {folder}")
    if found is not None and stat.S_ISLNK(found.st_mode):
        raise OutputError(f"{path} is a link: name an ordinary file")
    if found is not None and not stat.S_ISREG(found.st_mode):
        raise OutputError(f"{path} is no ordinary file: name another one")
    if not os.access(folder, os.W_OK | os.X_OK) or (found is not None and not os.access(path, os.W_OK)):
        raise OutputError(f"{path}: {os.strerror(errno.EACCES)}")
    if found is None:
        return
    for name in inputs:
        with contextlib.suppress(OSError):
            if os.path.samestat(os.stat(name), found):
                raise OutputError(f"{path} is read by this command: name another file")
    if found.st_size > 0 and not is_of_traverse(path, kind, head):
        raise OutputError(f"{path} {TAKEN}")


def check_or_exit(script, *words):
    """Like check(), for a script that ends with the message."""
    try:
        check(*words)
    except OutputError as error:
        sys.exit(f"{script}: {error}")


def put_in_place(temporary, path, before):
    """Renames a complete file, unless another one has been put there meanwhile."""
    if before is None:
        with contextlib.suppress(OSError):
            os.link(temporary, path)  # fails if there is a file
            os.unlink(temporary)
            return
    if identity(path) != before:
        raise OutputError(f"{path} was made or changed meanwhile by another program")
    os.replace(temporary, path)


def run(main):
    """Runs a script. A signal ends it as an exception does, without a message and with its usual status. It can come at any
    point, also where no block would remove a file: no unfinished file remains."""
    ended = []

    def end(number, frame):
        ended.append(number)
        sys.stderr = io.StringIO()  # what fails from now on fails because of the signal
        sys.exit()

    for number in SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, end)
    try:
        sys.exit(main())
    finally:
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)
        for temporary in list(unfinished):
            remove_unfinished(temporary)
        if ended:
            sys.exit(128 + ended[0])


def remove_unfinished(temporary):
    with contextlib.suppress(FileNotFoundError):
        os.unlink(temporary)
    unfinished.discard(temporary)


@contextlib.contextmanager
def with_room(path):
    """Raises OutputError instead of any exception that follows from a full disk or quota."""
    try:
        yield
    except Exception as error:
        cause = error
        while cause is not None and not (isinstance(cause, OSError) and cause.errno in FULL):
            cause = cause.__cause__ or cause.__context__
        if cause is None:
            raise
        raise OutputError(f"{path}: {os.strerror(cause.errno)}") from None


@contextlib.contextmanager
def written(path, kind, inputs=(), head=None):
    """Gives the name of a new file in the same folder, which becomes `path` after the block has ended without an
    error."""
    check(path, kind, inputs, head)
    before = identity(path)
    mode = stat.S_IMODE(os.stat(path).st_mode) if before else 0o666 & ~current_umask()
    with with_room(path):
        temporary = pathlib.Path(path).parent / f".traverse_{secrets.token_hex(8)}.{kind}"  # a name that no file has
        unfinished.add(temporary)
        try:
            os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))
            yield temporary
            os.chmod(temporary, mode)
            put_in_place(temporary, path, before)
        finally:
            remove_unfinished(temporary)


def current_umask():
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


def write_text(path, text):
    """Writes a text, .txt or .yml, under a first line that names Traverse."""
    with written(path, kind_of(path, TEXTS)) as temporary:
        temporary.write_bytes((first_line(text) + text).encode())


def plain_cell(value):
    """A cell that no spreadsheet takes for a formula: a text that begins as one has an apostrophe before it."""
    if isinstance(value, str) and value[:1] in ("=", "+", "-", "@", "\t", "\r"):
        try:
            float(value)
        except ValueError:
            return "'" + value
    return value


def write_table(path, head, rows, inputs=()):
    """Writes a CSV file."""
    with written(path, "csv", inputs, head) as temporary, open(temporary, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(map(plain_cell, head))
        table.writerows([plain_cell(value) for value in row] for row in rows)


def write_table_or_exit(script, *words):
    """Like write_table(), for a script that ends with the message."""
    try:
        write_table(*words)
    except OutputError as error:
        sys.exit(f"{script}: {error}")


def save_figure(figure, path, inputs=(), **how):
    """Writes a picture in the format of its ending."""
    kind = kind_of(path, METADATA)
    with written(path, kind, inputs) as temporary:
        figure.savefig(temporary, format=kind, metadata=METADATA[kind], **how)
