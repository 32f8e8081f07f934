#!/usr/bin/python3
"""Time of a screen of a random stock with a random fleet, and its check by all passages of a sample.
/usr/bin/python3 benchmarks/screen.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest]

300 bridges (simple and continuous, 6 to 45 m, frequencies between the bounds of EN 1991-2, figure 6.10, damping 0.5 to
2 %) under 2,000 formations (passenger, freight and multiple-unit trains with random coaches), at 10 to 250 km/h by 1
km/h, three modes, on two ranks. 1,000 pairs, drawn at random, are checked by passages at all speeds. Prints a table and
writes it to screen.csv in OUT_FOLDER.
"""

import math
import os
import random
import tempfile

import h5py
import runs

SIZES = {"bridges": 300, "formations": 2000, "audit": 1000, "speeds": "10 km/h,250 km/h,1 km/h"}
SMALLEST = {"bridges": 6, "formations": 8, "audit": 12, "speeds": "60 km/h,250 km/h,10 km/h"}
LIMITS = os.path.join(runs.ROOT, "options", "limits", "en1990.yml")


def stock(file, count):
    draw = random.Random(1)
    file.write("name,spans,mass,f1,damping,speed\n")
    for i in range(count):
        length = math.exp(draw.uniform(math.log(6.0), math.log(45.0)))
        spans = draw.choice([[length], [length], [length, length], [0.8 * length, length, 0.8 * length]])
        low = 80.0 / length if length < 20.0 else 23.58 * length**-0.592
        frequency = draw.uniform(low, 94.76 * length**-0.748)
        file.write(f"bridge {i},{' '.join(f'{span:.2f}' for span in spans)},{draw.uniform(8e3, 2.5e4):.0f},"
                   f"{frequency:.3f},{draw.uniform(0.005, 0.02):.4f},{draw.uniform(100, 250):.0f} km/h\n")


def coach(length, bogies, wheelbase):
    """Places of the four axles behind the front of a coach."""
    first = 0.5 * (length - bogies - wheelbase)
    return length, [first, first + wheelbase, first + bogies, first + bogies + wheelbase]


def train(draw):
    """(speed in km/h, coaches with their axle load in kN)."""
    locomotive = (*coach(19.5, 10.4, 2.8), draw.uniform(180.0, 220.0))
    kind = draw.randrange(3)
    if kind == 0:
        one = (*coach(round(draw.uniform(24.0, 27.5), 1), round(draw.uniform(16.0, 19.5), 1), 2.5), draw.uniform(100.0, 180.0))
        return draw.uniform(160, 300), [locomotive, *[one] * draw.randint(6, 15), locomotive]
    if kind == 1:
        wagons = [(*coach(length, length - 6.0, 1.8), draw.uniform(60.0, 225.0))
                  for length in (round(draw.uniform(12.0, 20.0), 2) for _ in range(draw.randint(15, 34)))]
        return draw.uniform(80, 120), [locomotive, *wagons]
    length = round(draw.uniform(17.0, 20.0), 1)
    return draw.uniform(120, 200), [(*coach(length, length - 7.0, 2.2), draw.uniform(110.0, 170.0))] * draw.randint(3, 8)


def fleet(file, count):
    draw = random.Random(2)
    file.write("name,speed,position,load_kN\n")
    for i in range(count):
        (speed, coaches), start = train(draw), 0.0
        for length, axles, load in coaches:
            for axle in axles:
                file.write(f"train {i},{speed:.0f} km/h,{start + axle:.3f},{load:.1f}\n")
            start += length


def screened(build, folder, sizes, ranks):
    """Attributes of the summary, and the seconds without the audit."""
    for name, write, count in (("stock", stock, sizes["bridges"]), ("fleet", fleet, sizes["formations"])):
        with open(os.path.join(folder, name + ".csv"), "w") as file:
            write(file, count)
    options = {"scene_analysis": "screen", "screen_stock": os.path.join(folder, "stock.csv"), "limits": LIMITS,
               "screen_fleet": os.path.join(folder, "fleet.csv"), "screen_speeds": sizes["speeds"],
               "screen_audit": sizes["audit"]}
    run = runs.Run(build, options, os.path.join(folder, "screen.h5"), ranks)
    with h5py.File(run.file) as file:
        return dict(file["summary"].attrs)


def main():
    given = runs.given(runs.parser(__doc__))
    sizes = SMALLEST if given.smallest else SIZES
    with tempfile.TemporaryDirectory() as folder:
        found = screened(given.build, folder, sizes, 2)
    pairs = found["pairs_by_bound"] + found["pairs_by_passages"]
    rows = [("bridges", sizes["bridges"]), ("formations", sizes["formations"]), ("pairs", int(pairs)),
            ("seconds", found["wall_seconds"]), ("microseconds a pair", 1e6 * found["wall_seconds"] / pairs),
            ("decided by the bound", found["pairs_by_bound"] / pairs),
            ("decided by passages", found["pairs_by_passages"] / pairs),
            ("restricted", found["pairs_restricted"] / pairs), ("pairs checked", int(found["audit_pairs"])),
            ("speeds checked", int(found["audit_speeds"])), ("exceedances missed", int(found["audit_missed"])),
            ("verdicts different", int(found["audit_different"])), ("bounds below the value", int(found["audit_below"])),
            ("median of bound over value", found["audit_median_bound_over_value"]),
            ("median at each speed", found["audit_median_bound_over_value_at_a_speed"])]
    for name, value in rows:
        print(f"{name:30}{value:12.4g}" if isinstance(value, float) else f"{name:30}{value:12}")
    runs.write_table(os.path.join(given.out, "screen.csv"), ["quantity", "value"], rows)


if __name__ == "__main__":
    main()
