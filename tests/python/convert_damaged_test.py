"""scripts/convert.py on files changed, cut and lengthened at random: each ends with a table or with one line."""

import contextlib
import io
import json
import pathlib
import resource
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from converted import MODELS, SKEW_TRACK, convert, dataset, head_58, rows, universal_of, units_164, write_hdf5  # noqa: E402

MUTANTS, MEMORY = 40, 3 << 30  # of each file; bytes of the process
WORDS = [b"nan", b"-1", b"99999999999", b"1e999", b"-inf", b"", b"\xff\x00", b"0", b"1.0E+40", b"\n", b"   -3", b",", b"GRID,",
         b"58b"]
SLAB, PUNCH = MODELS / "skew_slab.frd", [MODELS / "skew_slab.pch", MODELS / "skew_slab.bdf"]
MODES = ["--damping", "0.01", "--modal-mass", "1", "--track", *SKEW_TRACK]


def files(folder):
    """[(name of the file that is damaged, its content, words of the command with {} for it)]"""
    from scipy.io import savemat
    times = 0.01 * np.arange(60)
    content = {"t": times, "acc": np.sin(times), "both": np.outer(times, [1.0, 2.0])}
    savemat(folder / "s.mat", {"run": content, "text": "note"})
    savemat(folder / "c.mat", content, do_compression=True)
    write_hdf5(folder / "h.mat", content)
    data = np.sin(times).astype("<f4").tobytes()
    text = dataset(58, head_58(2, 60, 1, 0.0, 0.01) + rows(np.sin(times), 13, 5, 6))
    binary = "\r\n".join(["    -1", f"    58b{1:6d}{2:6d}{11:12d}{len(data):12d}", *head_58(2, 60, 1, 0.0, 0.01), ""]).encode()
    yield "r.unv", (units_164(1000.0, 1.0) + text).encode(), ["records", "{}"]
    yield "b.unv", binary + data + b"\r\n    -1\r\n", ["records", "{}"]
    for name in ("s.mat", "c.mat", "h.mat"):
        yield name, (folder / name).read_bytes(), ["records", "{}"]
    yield "m.unv", universal_of(SLAB).encode(), ["modes", "{}", *MODES]
    yield "c.unv", universal_of(SLAB, 0.4).encode(), ["modes", "{}", *MODES]
    yield "n.unv", universal_of(SLAB, 0.4, newer=True).encode(), ["modes", "{}", *MODES]
    yield "m.frd", SLAB.read_bytes(), ["modes", "{}", *MODES]
    yield "m.dat", (MODELS / "skew_slab.dat").read_bytes(), ["modes", str(SLAB), "{}", *MODES, "--output", "a=SECTION:MY@MID"]
    yield "b.frd", (MODELS / "beam.frd").read_bytes(), ["modes", "{}", "--damping", "0.01", "--track", "1", "21"]
    yield "m.pch", PUNCH[0].read_bytes(), ["modes", "{}", str(PUNCH[1]), *MODES]
    yield "m.bdf", PUNCH[1].read_bytes(), ["modes", str(PUNCH[0]), "{}", *MODES]


def mutated(content, random):
    """A copy with one to four changes, more of them where the file begins."""
    content = bytearray(content)
    for _ in range(random.integers(1, 5)):
        at = int(len(content) * random.random() ** 2)
        kind, size = random.integers(6), int(random.integers(1, 60))
        if kind == 0:
            content[at:at + 1] = bytes([random.integers(256)])
        elif kind == 1:
            content[at:at] = WORDS[random.integers(len(WORDS))]
        elif kind == 2:
            word = WORDS[random.integers(len(WORDS))]
            content[at:at + len(word)] = word
        elif kind == 3:
            del content[at:at + size]
        elif kind == 4:
            content[at:at] = content[at:at + size]
        elif random.random() < 0.3:
            del content[at:]
    return bytes(content)


def run_all():
    """Runs all mutants in this process. Prints how they ended, and ends with 1 at the first one that ended otherwise."""
    random, counts = np.random.default_rng(2026), {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for file, content, words in files(folder):
            path = folder / f"damaged_{file}"
            out = folder / ("t.csv" if words[0] == "records" else "t.txt")
            call = [str(path) if word == "{}" else word for word in words] + ["-o", str(out)]
            for number in range(MUTANTS + 1):
                path.write_bytes(mutated(content, random) if number else content)
                printed, error = io.StringIO(), io.StringIO()
                with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(error):
                    status = convert.main(call)
                lines = error.getvalue().splitlines()
                good = (status == 0 and not lines and out.exists()) or (status == 2 and len(lines) == 1 and number)
                if not good or len(error.getvalue()) > 1000:
                    sys.exit(f"{file}, mutant {number}: status {status}, {error.getvalue()[:500]}")
                counts.setdefault(file, [0, 0])[status // 2] += 1
                for left in folder.glob("t*.*"):
                    left.unlink()
    print(json.dumps(counts))


class Damaged(unittest.TestCase):
    def test_each_ends_with_a_table_or_with_one_line(self):
        """In a process with limited memory, so that neither a signal nor a traceback is overlooked."""
        done = subprocess.run([sys.executable, "-B", __file__, "--run"], capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)))
        self.assertEqual((done.returncode, done.stderr[-3000:]), (0, ""))
        for ended in json.loads(done.stdout).values():
            self.assertEqual(sum(ended), MUTANTS + 1)
            self.assertGreater(ended[1], MUTANTS // 10)  # the changes matter


if __name__ == "__main__":
    run_all() if sys.argv[1:] == ["--run"] else unittest.main()
