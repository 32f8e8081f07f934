#!/usr/bin/python3
"""Kills a run at random moments and goes on from its last checkpoint, time and again: nothing may be lost.
/usr/bin/python3 benchmarks/kills.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest] [--kills N]

A train crosses three spans, with linear vehicles and with mechanisms, and is killed (SIGKILL) 100 times in all while it
computes or starts, with checkpoints as often as they may be written. After every kill the results file has to open,
with all rows of every series that its times say; the checkpoint, where there is one, has to be taken up. Once the run
has reached its end its series have to be those of a run that nobody touched, bit for bit. A study is killed as often
while it is resumed: the runs that it finds may never become fewer. Writes kills.csv to OUT_FOLDER.
"""

import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np
import runs


def words(build, model, file, end):
    return [runs.traverse(build), "-options_file", runs.scene("three_span_train"), "-model_vehicles", model,
            "-beam_elements_per_span", "6", "-ts_dt", "5e-4", "-ts_max_time", str(end), "-output_file", file, "-output_quiet",
            "-output_interval", "2e-3"]


def series(file):
    """All numbers of a file by the name of their dataset; dimensions without coordinates have none."""
    found = {}

    def take(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and b"netCDF" not in item.attrs.get("NAME", b""):
            found[name] = item[()]

    with h5py.File(file) as results:
        results.visititems(take)
    return found


def rows_in(file):
    """Instants in a file that a kill has left, whose series all have to have them."""
    if not os.path.exists(file) or os.path.getsize(file) == 0:
        return 0
    with h5py.File(file) as results:
        if "time" not in results:
            return 0
        rows = len(results["time"])
        short = [name for name in results["probes"] if name != "x" and len(results["probes"][name]) < rows]
        if short or not np.isfinite(results["probes/deflection"][:rows]).all():
            sys.exit(f"{file}: {short} have fewer rows than there are times")
        return rows


def killed_run(command, checkpoint, generator, kills, file, longest):
    """Starts it anew or from its checkpoint until it has been killed so often, each time within `longest` s, then lets it
    end. Rows that were there after each kill, and how often it went on from a checkpoint."""
    rows, restarts = [], 0
    while True:
        again = ["-restart", checkpoint] if os.path.exists(checkpoint) else []
        restarts += bool(again)
        child = subprocess.Popen(command + ["-checkpoint_interval", "1e-3"] + again, stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, text=True)
        if len(rows) < kills:
            time.sleep(generator.uniform(0.0, longest))
            child.send_signal(signal.SIGKILL)
        _, complaint = child.communicate()
        if child.returncode not in (0, -signal.SIGKILL):
            sys.exit(f"status {child.returncode}: {complaint}")
        if child.returncode == 0:
            return rows, restarts
        rows.append(rows_in(file))


def killed_study(build, folder, generator, kills):
    """Kills a study that is resumed again and again; returns how often runs were found in its file."""
    command = [runs.traverse(build), "-options_file", os.path.join(runs.ROOT, "options/studies/truck_class_c.yml"),
               "-output_file", os.path.join(folder, "study.h5"), "-study_resume"]
    found, known, longest = 0, 0, 0.5
    for _ in range(kills):
        child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(generator.uniform(0.0, longest))
        child.send_signal(signal.SIGKILL)
        said, complaint = child.communicate()
        if child.returncode not in (0, -signal.SIGKILL):
            sys.exit(f"study: status {child.returncode}: {complaint}")
        now = re.search(r"(\d+) of them are read from the existing", said)
        if now and int(now[1]) < known or (not now and known and "contains no finished run" in said):
            sys.exit(f"study: {known} runs were finished before, {now[1] if now else 0} are found")
        known = int(now[1]) if now else known
        found += bool(now)
    return found


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("--kills", type=int, default=100, help="in all")
    given = runs.given(arguments)
    kills, end = (4, 0.5) if given.smallest else (given.kills, 3.0)
    generator = random.Random(1)
    table = []
    with tempfile.TemporaryDirectory() as folder:
        for model in ("linear", "full"):
            whole, broken = os.path.join(folder, model + ".h5"), os.path.join(folder, model + "_killed.h5")
            begin = time.perf_counter()
            subprocess.run(words(given.build, model, whole, end), check=True, stdout=subprocess.DEVNULL)
            longest = time.perf_counter() - begin
            left = kills // 2
            restarts = done = 0
            while left > 0:
                rows, more = killed_run(words(given.build, model, broken, end), broken + ".checkpoint", generator, left,
                                        broken, longest)
                left -= len(rows)
                done += len(rows)
                restarts += more
                one, other = series(whole), series(broken)
                same = one.keys() == other.keys() and all(np.array_equal(one[k], other[k], equal_nan=True) for k in one)
                if not same:
                    sys.exit(f"{model}: the results differ after {done} kills")
            table.append([model, done, restarts, len(one)])
            print(f"{model}: {done} kills, {restarts} restarts, {len(one)} series the same bit for bit")
        found = killed_study(given.build, folder, generator, kills)
        print(f"study: {kills} kills, {found} times with runs in its file")
    runs.write_table(os.path.join(given.out, "kills.csv"), ["vehicles", "kills", "restarts", "series"], table)


if __name__ == "__main__":
    main()
