#!/usr/bin/python3
"""Prints what an hour of a line of 1,300 km with 1,000 trains a day takes on each number of ranks: the time of the command, the
greatest memory of a rank, and the processor time of a train in a step.
/usr/bin/python3 benchmarks/line.py [BUILD_FOLDER] [OUT_FOLDER] [MINUTES] [--smallest]

MINUTES (60) of the line by options/scenes/hour_on_a_line.yml, on two ranks and on one. Writes line.csv to OUT_FOLDER.
"""

import os
import resource
import tempfile

import h5py
import runs

RANKS = (2, 1)
SMALLEST = {"beam_spans": "32.0*60", "up_times": "28795,28800", "down_times": 28798, "ts_max_time": 1.0, "output_interval": 0.5}


def line(build, folder, ranks, minutes, smallest):
    """Seconds of the command, MB, trains, and processor seconds of a train in a step, of a run on so many ranks."""
    file = os.path.join(folder, f"line_{ranks}.h5")
    options = {"options_file": runs.scene("hour_on_a_line"), "ts_max_time": 60.0 * minutes}
    run = runs.Run(build, options | (SMALLEST if smallest else {}), file, ranks)
    with h5py.File(file) as results:
        on_bridge, end = results["trains/on_bridge"][()], float(results["summary"].attrs["end_time"])
    on_bridge = on_bridge.clip(0.0, end)
    train_steps = (on_bridge[:, 1] - on_bridge[:, 0]).sum() / end * run.steps
    megabytes = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024.0
    return run.process_seconds, megabytes, len(on_bridge), ranks * run.seconds / train_steps


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("minutes", nargs="?", type=float, default=60.0, metavar="MINUTES")
    given = runs.given(arguments)
    rows = []
    print(f"{'ranks':>6}{'seconds':>10}{'MB a rank':>11}{'trains':>8}{'us a train and step':>21}")
    with tempfile.TemporaryDirectory() as folder:
        for ranks in RANKS:
            seconds, megabytes, trains, each = line(given.build, folder, ranks, given.minutes, given.smallest)
            rows.append([ranks, seconds, megabytes, trains, each])
            print(f"{ranks:6}{seconds:10.1f}{megabytes:11.0f}{trains:8}{1e6 * each:21.1f}", flush=True)
    runs.write_table(os.path.join(given.out, "line.csv"),
                     ["ranks", "seconds", "greatest MB of a rank", "trains", "s of a train and step"], rows)


if __name__ == "__main__":
    main()
