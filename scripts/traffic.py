#!/usr/bin/python3
"""Fatigue of a bridge under traffic: traffic.py SCENE.yml --mix MIX.csv --fleet FLEET | --weighed RECORD.csv --of SERIES

Each passage is a run of the scene with the forces of the axles, of which the cycles of a series over time are counted
by rainflow (fatigue.py). The table lists the passages with the largest damage, with their share, and the sums of a day.
A mix has the columns name, count (a day) and speed, with the formations of a fleet in the format of screen_fleet. A
weigh-in-motion record has the columns time (s, or ISO 8601), speed (m/s or km/h), loads_kN or loads_t, and spacings (m);
the last two are lists separated by blanks.
"""

import argparse
import concurrent.futures
import os
import pathlib
import sys
import tempfile
import warnings
from typing import NamedTuple

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import axle_tables  # noqa: E402
import fatigue  # noqa: E402
import output_files  # noqa: E402
import traverse  # noqa: E402

MOST_LISTED = 20
HEAD = ["series", "passage", "speed", "count a day", "damage a day", "largest range"]  # of the table of passages


class Share(NamedTuple):
    """A passage with its results of a day for one series."""
    passage: axle_tables.Passage
    cycles: list  # of one passage
    damage: float  # a day


def merged(passages):
    """Passages with the same axles and speed as one, with the sum of their counts."""
    found = {}
    for one in passages:
        key = one[1:4]
        found[key] = one._replace(count=one.count + found[key].count, name=found[key].name) if key in found else one
    return list(found.values())


def cycles_of(scene, passage, series, factor):
    """{series: cycles} of one passage."""
    with tempfile.TemporaryDirectory(prefix="traverse-") as folder:
        results = pathlib.Path(folder, "results.h5")
        traverse.run(scene, output=results, load_forces=list(passage.loads), load_speed=passage.speed,
                     load_positions=[0.0 - distance for distance in passage.distances])
        return fatigue.counted([(results, 1.0)], series, factor)


def cycles_of_all(given, passages, said):
    """The cycles of each passage. Prints what is unusual in the tables, `said`, and in the scene of the first one."""
    with warnings.catch_warnings(record=True) as noted:
        warnings.simplefilter("always", traverse.UnusualInput)
        first = cycles_of(given.scene, passages[0], given.of, given.factor)
        said = [*said, *(str(one.message) for one in noted)]
        if said:
            print("\n  ".join(["unusual input", *said]), flush=True)
        with concurrent.futures.ThreadPoolExecutor(given.processes) as pool:
            others = pool.map(lambda one: cycles_of(given.scene, one, given.of, given.factor), passages[1:])
            return [first, *others]


def shares_of(passages, found, name, line):
    """The passages by falling damage in a series."""
    shares = [Share(passage, cycles[name], passage.count * line.damage(cycles[name]))
              for passage, cycles in zip(passages, found)]
    return sorted(shares, key=lambda share: -share.damage)


def table(name, shares, line, repeated):
    total = sum(share.damage for share in shares)
    lines = [f"{name}", f"{'passage':32}{'km/h':>8}{'a day':>10}{'largest range':>15}{'damage a day':>14}{'share':>8}"]
    for share in shares[:MOST_LISTED]:
        largest = max((cycle.range for cycle in share.cycles), default=0.0)
        part = share.damage / total if total > 0.0 else 0.0
        lines.append(f"{share.passage.name[:31]:32}{3.6 * share.passage.speed:8.1f}{share.passage.count:10.4g}"
                     f"{largest:15.6g}{share.damage:14.4e}{part:8.1%}")
    if len(shares) > MOST_LISTED:
        lines.append(f"and {len(shares) - MOST_LISTED} others")
    days = [c._replace(count=c.count * share.passage.count) for share in shares for c in share.cycles]
    years = f"{1.0 / (total * fatigue.DAYS_A_YEAR):.4g} years" if total > 0.0 else "no end"
    lines.append(f"damage a day {total:.4e}, life {years}, equivalent range of a day at {repeated:g} cycles "
                 f"{fatigue.equivalent_range(days, line.slope, repeated):.6g}")
    return lines


def write(path, found):
    output_files.write_table_or_exit("traffic.py", path, HEAD, (
        [name, s.passage.name, s.passage.speed, s.passage.count, s.damage, max((c.range for c in s.cycles), default=0.0)]
        for name, shares in found.items() for s in shares))


def asked():
    arguments = argparse.ArgumentParser(prog="traffic.py", description=__doc__,
                                        formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("scene", help="a scene with a bridge, without loads")
    arguments.add_argument("--mix", metavar="MIX.csv")
    arguments.add_argument("--fleet", help="the formations of the mix: a table of axles, or a folder of tables")
    arguments.add_argument("--weighed", metavar="RECORD.csv", help="a weigh-in-motion record")
    arguments.add_argument("--days", type=float, help="the duration of the record; left out: from first to last time")
    arguments.add_argument("--of", required=True, metavar="SERIES", help="a dataset over time, or a column of it")
    arguments.add_argument("--factor", type=fatigue.number, default=1.0, help="the stress that a unit of the series makes")
    arguments.add_argument("--line", type=fatigue.line_of, required=True, help="en1993:CATEGORY, or slope:M,RANGE,CYCLES")
    arguments.add_argument("--cycles", type=float, default=2e6, help="of the equivalent range; left out: 2e6")
    arguments.add_argument("--processes", type=int, default=os.cpu_count() or 1, help="runs at a time")
    arguments.add_argument("--csv", metavar="OUT.csv", help="every passage with its damage a day")
    given = arguments.parse_args()
    if bool(given.mix) == bool(given.weighed) or bool(given.mix) != bool(given.fleet):
        arguments.error("allowed: --mix with --fleet, or --weighed")
    if not given.cycles > 0.0 or given.processes < 1 or (given.days is not None and not given.days > 0.0):
        arguments.error("--cycles, --processes and --days: allowed: numbers above 0")
    return given


def main():
    given = asked()
    if given.csv:
        read = [path for path in (given.scene, given.mix, given.fleet, given.weighed) if path]
        output_files.check_or_exit("traffic.py", given.csv, "csv", read, HEAD)
    try:
        passages = merged(axle_tables.mix(given.mix, axle_tables.formations(given.fleet)) if given.mix
                          else axle_tables.weighed(given.weighed, given.days))
        said = axle_tables.unusual(passages, axle_tables.FAST_TRAIN if given.mix else axle_tables.FAST_LORRY)
        found = cycles_of_all(given, passages, said)
    except (OSError, ValueError, traverse.Error) as error:
        sys.exit(f"traffic.py: {error}")
    shares = {name: shares_of(passages, found, name, given.line) for name in found[0]}
    print(f"damage by {given.line.name}; {len(passages)} different passages, "
          f"{sum(one.count for one in passages):.6g} a day")
    for name, list_of_shares in shares.items():
        print("\n".join(table(name, list_of_shares, given.line, given.cycles)))
    if given.csv:
        write(given.csv, shares)


if __name__ == "__main__":
    output_files.run(main)
