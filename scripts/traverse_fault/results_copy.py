"""A copy of a results file, or of its beginning, without what is private: written anew, so that nothing of the original stays
in unused parts of the file."""

import collections

import h5py
import numpy as np

MOST_TEXT, MOST_CELLS = 4_000_000, 400_000  # characters and cells of a dataset of texts
SCALES = {"CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST", "_Netcdf4Dimid"}  # attributes that HDF5 writes again


def datasets_of(group, path=""):
    """(path, dataset) of all datasets but those of /input, whose texts are in the report; not through soft links."""
    for name in group:
        if isinstance(group.get(name, getlink=True), h5py.HardLink) and f"{path}/{name}" != "/input":
            item = group[name]
            yield f"{path}/{name}", item
            if isinstance(item, h5py.Group):
                yield from datasets_of(item, f"{path}/{name}")


def is_text(item):
    return isinstance(item, h5py.Dataset) and item.shape is not None and h5py.check_string_dtype(item.dtype) is not None


def cut_to(items, most):
    """(length, rows): datasets of this first length are cut to so many rows, so that all have at most so many bytes."""
    bytes_of = collections.Counter()
    for item in items:
        bytes_of[item.shape[0] if item.shape else 0] += item.size * item.dtype.itemsize
    longest, size = max(bytes_of.items(), key=lambda pair: pair[1], default=(0, 0))
    rest = sum(bytes_of.values()) - size
    if rest + size <= most or longest == 0:
        return 0, 0
    return longest, max(1, int(longest * max(0, most - rest) / size))


class Copy:
    """Copies into `target`; afterwards `left_out` and `said` tell what is missing."""

    def __init__(self, source, target, privacy, most):
        self.privacy, self.left_out, self.said = privacy, [], ""
        items = list(datasets_of(source))
        numbers = [item for _, item in items if isinstance(item, h5py.Dataset) and item.dtype.kind in "fiu"]
        self.length, self.rows = cut_to(numbers, most)
        self.room, self.known = most, {}
        self.attributes(source, target)
        for path, item in items:
            self.add(path, item, target)
        self.attach_scales(source, target)
        if self.length:
            self.said = f"the first {self.rows:,} of {self.length:,} rows"

    def name_of(self, path):
        return "/".join(self.privacy.clean(part) for part in path.split("/"))

    def add(self, path, item, target):
        place, name = h5py.h5o.get_info(item.id).addr, self.name_of(path)
        if place in self.known:
            target[name] = target[self.known[place]]  # a second name
        elif isinstance(item, h5py.Group):
            self.attributes(item, target.require_group(name))
        elif isinstance(item, h5py.Dataset) and not self.write(name, item, target):
            self.left_out.append(name)
            return
        self.known[place] = name

    def write(self, name, item, target):
        """Whether a dataset is written: numbers, or texts in the usual form, while there is room."""
        text = is_text(item)
        rows = self.rows if item.shape and item.shape[0] == self.length else None
        if item.shape is None or item.dtype.kind not in "fiu" and not text or text and item.size > MOST_CELLS:
            return False
        if not text:
            size = item.dtype.itemsize * item.size * (rows / self.length if rows else 1)
            if size > self.room:
                return False
            self.room -= size
            values = item[:rows] if rows else item[()]
        else:
            values = np.array(item.asstr(errors="replace")[()], dtype=object)
            if sum(map(len, values.flat)) > MOST_TEXT:
                return False
            values = np.vectorize(self.privacy.clean, otypes=[object])(values) if values.size else values
        made = target.create_dataset(name, data=values, dtype=h5py.string_dtype() if text else item.dtype)
        self.attributes(item, made)
        return True

    def attributes(self, item, made):
        for name, value in item.attrs.items():
            if name in SCALES:
                continue
            if isinstance(value, (bytes, np.bytes_)):
                value = value.decode(errors="replace")
            array = np.asarray(value)
            if array.dtype.kind in "fiub":
                made.attrs[self.privacy.clean(name)] = value
            elif all(isinstance(one, str) for one in array.flat):
                cleaned = [self.privacy.clean(one) for one in array.flat]
                made.attrs[self.privacy.clean(name)] = cleaned[0] if array.ndim == 0 else cleaned

    def attach_scales(self, source, target):
        """Gives the copies the dimensions of the originals."""
        for path, item in datasets_of(source):
            name = self.name_of(path)
            if name not in target or not isinstance(item, h5py.Dataset):
                continue
            if h5py.h5ds.is_scale(item.id):
                if not h5py.h5ds.is_scale(target[name].id):
                    label = self.privacy.clean(h5py.h5ds.get_scale_name(item.id).decode(errors="replace"))
                    target[name].make_scale(label)
                continue
            for axis, dimension in enumerate(item.dims):
                for scale in dimension.values():
                    place = self.known.get(h5py.h5o.get_info(scale.id).addr)
                    if place in target and place != name:
                        if not h5py.h5ds.is_scale(target[place].id):
                            target[place].make_scale(self.privacy.clean(
                                h5py.h5ds.get_scale_name(scale.id).decode(errors="replace")))
                        target[name].dims[axis].attach_scale(target[place])


def texts_of(file):
    """The texts of an open file: names, attributes and datasets that are not too large to be copied."""
    for path, item in (("", file), *datasets_of(file)):
        yield from path.split("/")
        for key, value in item.attrs.items():
            yield key
            yield from (one.decode(errors="replace") if isinstance(one, bytes) else one
                        for one in np.asarray(value, dtype=object).flat if isinstance(one, (str, bytes)))
        if is_text(item) and item.size <= MOST_CELLS:
            yield from np.asarray(item.asstr(errors="replace")[()], dtype=object).flat


def copied(source, path, privacy, most):
    """Writes a copy of an open results file with at most so many bytes of numbers; returns its words on what is missing."""
    with h5py.File(path, "w") as target:
        copy = Copy(source, target, privacy, most)
    return "; ".join(filter(None, [copy.said, copy.left_out and "without " + ", ".join(copy.left_out)]))
