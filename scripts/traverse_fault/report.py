"""The report as a ZIP file: its parts, what is said of them before it is written, and the search for what is private in it."""

import re
import zipfile

import h5py
import output_files

from . import results_copy

SAME_TIME = (1980, 1, 1, 0, 0, 0)  # of all parts: the hour of a report is no part of it
OWN = re.compile(r"[^\w.@+ -]")    # what no name of a part contains, apart from slashes


class LeakError(Exception):
    """A part has something private after all."""


def plain(name):
    """A name that leaves no folder and that every system can unpack."""
    parts = [OWN.sub("_", part) for part in name.split("/") if part not in ("", ".", "..")]
    return "/".join(part.lstrip(".-") or "_" for part in parts) or "_"


class Report:
    """Parts of a report, cleaned when they are added."""

    def __init__(self, privacy):
        self.privacy, self.parts, self.left_out = privacy, {}, []

    def free_name(self, name):
        name = plain(self.privacy.clean(name))
        folder, _, last = name.rpartition("/")
        while name in self.parts:
            last = f"other_{last}"
            name = f"{folder}/{last}".lstrip("/")
        return name

    def add_text(self, name, text, what=""):
        name = self.free_name(name)
        self.parts[name] = (self.privacy.clean(text).encode("utf-8", errors="replace"), what)
        return name

    def add_results(self, name, file, scratch, most):
        """A copy of an open results file."""
        path = scratch / "copy.h5"
        said = results_copy.copied(file, path, self.privacy, most)
        with h5py.File(path, "r") as copy:
            if any(map(self.privacy.found_in_text, results_copy.texts_of(copy))):
                raise LeakError(name)
        name = self.free_name(name)
        self.parts[name] = (path.read_bytes(), said)
        path.unlink()
        return name

    def leave_out(self, name, why):
        self.left_out.append(self.privacy.clean(f"{name}: {why}"))

    def lines(self):
        """What the report contains, one line for each part."""
        yield from (f"  {name}  {len(content):,} bytes{what and '  ' + what}" for name, (content, what) in self.parts.items())
        yield from (f"  left out: {line}" for line in self.left_out)

    def check(self):
        """LeakError if a part or its name has something private."""
        for name, (content, _) in self.parts.items():
            text = not name.endswith(".h5")
            if self.privacy.found_in_text(name) or self.privacy.found_in_bytes(content) or text and self.privacy.found_in_text(
                    content.decode()):
                raise LeakError(name)

    def write(self, path, inputs):
        """Writes the file; LeakError before if one of its parts, or what is in the file, has something private."""
        self.check()
        with output_files.written(path, "zip", inputs) as temporary:
            with zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
                for name, (content, _) in self.parts.items():
                    part = zipfile.ZipInfo(name, SAME_TIME)
                    part.compress_type, part.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
                    archive.writestr(part, content)
                archive.comment = output_files.FAULT.encode()
            with zipfile.ZipFile(temporary) as archive:
                for part in archive.infolist():
                    if archive.read(part) != self.parts[part.filename][0]:
                        raise LeakError(part.filename)
            return temporary.stat().st_size
