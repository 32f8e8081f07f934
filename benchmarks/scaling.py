#!/usr/bin/python3
"""Prints what a step takes on 1 to 1,000 ranks by the model of doc/scaling.md, from what it measures on this machine.
/usr/bin/python3 benchmarks/scaling.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest]

Writes scaling.csv and scaling.png to OUT_FOLDER. Of measured tables there (step_parts.csv of step_parts.py, machine_1.csv
and machine_2.csv) those that are missing are measured, with the programs step_parts_benchmark and machine_benchmark.
"""

import csv
import math
import os
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
import runs  # noqa: E402

PROGRAMS = ["step_parts_benchmark", "machine_benchmark"]
RANKS = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1000]
NETWORK_LATENCY = 1.5e-6    # s, assumed: 1 to 2 us of today's networks
NETWORK_BANDWIDTH = 1.0e10  # B/s, assumed
STAGES = 5                  # of esdirk4
BYTES = 650.0               # moved an unknown and step, doc/scaling.md
KEPT = 110.0                # bytes of an unknown that a step comes back to: its vectors and the factor
CACHE, SHARERS = 3.2e7, 8   # B of the last cache, and the cores that share it: of an EPYC
SPAN_UNKNOWNS = 22          # of an isolated span of ten elements
FREEDOM = 10                # of a coach
ELEMENTS_A_COACH = 4        # under its wheels; 4 unknowns each, v and w of them are summed over the ranks
ELEMENTS_ENTERED = 0.1      # by a coach's wheels in a step of 1 ms at 83 m/s with elements of 3.2 m
CASES = [  # name, unknowns, bridge, coaches
    ("200,000 unknowns, continuous, 8 coaches", 200_000, "continuous", 8),
    ("10,000,000 unknowns, continuous, 8 coaches", 10_000_000, "continuous", 8),
    ("5,150 isolated spans, 16 coaches", 5150 * SPAN_UNKNOWNS, "simply supported", 16),
]


def measured(build, out, smallest):
    """The tables, measured where they are missing."""
    parts, machine = (runs.benchmark_program(build, name) for name in PROGRAMS)
    sizes, rounds = (["10000", "10000", "1"], ["1"]) if smallest else ([], [])
    made = {  # program, ranks, what follows the table's name
        "step_parts.csv": (parts, 1, sizes),
        "machine_1.csv": (machine, 1, rounds),
        "machine_2.csv": (machine, 2, rounds),
    }
    tables = {}
    for name, (program, ranks, words) in made.items():
        file = os.path.join(out, name)
        if not os.path.exists(file):
            subprocess.run(runs.on_ranks(ranks) + [program, file] + words, check=True, stdout=subprocess.DEVNULL,
                           env=runs.environment())
        with open(file, newline="") as table:
            tables[name] = list(csv.DictReader(table))
    machine = [{r["what"]: float(r["value"]) for r in tables[f"machine_{n}.csv"]} for n in (1, 2)]
    return tables["step_parts.csv"], machine


class Model:
    """Seconds of a step of esdirk4; network: (latency, s; bandwidth, B/s) of a message, or none for shared memory."""

    def __init__(self, parts, machine, network=None):
        self.parts = parts
        together = machine[1]
        self.latency, self.bandwidth = network or (together["message of 8 B"], together["bandwidth of 8 MB messages"])
        self.memory = together["memory of each rank"]  # B/s, where all ranks read
        at_10000 = {r["part"]: r for r in parts if r["bridge"] == "continuous" and r["seconds"]
                    and abs(int(r["unknowns"]) - 10_000) < 100}
        if not at_10000:
            raise SystemExit("scaling.py: step_parts.csv in OUT_FOLDER has no line of 10,000 unknowns; remove it, and it "
                             "is measured again")
        steps = [float(at_10000[name]["seconds"]) for name in ("esdirk4 step", "esdirk4 step without vehicles")]
        # On a busy machine the step with coaches may have been measured shorter than the one without.
        self.coach = max(0.0, steps[0] - steps[1]) / int(at_10000["esdirk4 step"]["coaches"])

    def curve(self, part, bridge, unknowns):
        """Seconds of a part at this many unknowns, between those measured; beyond them in proportion."""
        points = sorted((int(r["unknowns"]), float(r["seconds"])) for r in self.parts
                        if r["part"] == part and r["bridge"] == bridge)
        sizes, seconds = np.array(points).T
        if unknowns > sizes[-1]:
            return seconds[-1] * unknowns / sizes[-1]
        return float(np.exp(np.interp(math.log(max(unknowns, sizes[0])), np.log(sizes), np.log(seconds))))

    def step(self, unknowns, bridge, coaches, ranks):
        """What it is made of: name, seconds."""
        own = unknowns / ranks
        if bridge != "continuous":  # a rank has whole spans
            own = math.ceil(unknowns / SPAN_UNKNOWNS / ranks) * SPAN_UNKNOWNS
        beam = self.curve("esdirk4 step without vehicles", bridge, own)
        if ranks > 1 and KEPT * own > CACHE / min(ranks, SHARERS):
            beam = max(beam, BYTES * own / self.memory)
        vehicles = self.coach * coaches
        if ranks == 1:
            return {"beam": beam, "separators": 0.0, "vehicles": vehicles, "messages": 0.0}
        separators = gather = 0.0
        stops = math.ceil(math.log2(ranks))
        if bridge == "continuous":
            separators = STAGES * self.curve("bare solve", bridge, 2.0 * ranks)
            gather = stops * self.latency + 32.0 * ranks / self.bandwidth
        borders = 2.0 * self.latency
        contacts = stops * (self.latency + 64.0 * ELEMENTS_A_COACH * coaches / self.bandwidth)
        entered = min(1.0, ELEMENTS_ENTERED * coaches)
        # Steps: the signal, the vehicles' coordinates; with a new element its columns' ends and their blocks.
        a_step = stops * (2.0 * self.latency + 16.0 * FREEDOM * coaches / self.bandwidth)
        columns = entered * stops * (3.0 * self.latency + 512.0 * ELEMENTS_A_COACH * coaches / self.bandwidth)
        if bridge == "continuous":
            columns += entered * 4.0 * self.curve("bare solve", bridge, 2.0 * ranks)
        return {"beam": beam, "separators": separators, "vehicles": vehicles,
                "messages": STAGES * (gather + borders + contacts) + a_step + columns}


def main():
    given = runs.given(runs.parser(__doc__), *PROGRAMS)
    parts, machine = measured(given.build, given.out, given.smallest)
    models = {"shared memory": Model(parts, machine),
              "network": Model(parts, machine, (NETWORK_LATENCY, NETWORK_BANDWIDTH))}
    print("measured:", ", ".join(f"{what} {value:.3g}" for what, value in machine[1].items()))
    print(f"          memory of one rank alone {machine[0]['memory of each rank']:.3g} B/s; "
          f"a coach {1e6 * models['network'].coach:.3g} us a step")
    print(f"assumed:  network latency {NETWORK_LATENCY:.3g} s, bandwidth {NETWORK_BANDWIDTH:.3g} B/s")
    rows = []
    figure, all_axes = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
    for axes, (name, unknowns, bridge, coaches) in zip(all_axes, CASES):
        for network, model in models.items():
            one = sum(model.step(unknowns, bridge, coaches, 1).values())
            times = []
            print(f"\n{name}; messages by {network}\n{'ranks':>7}" + "".join(
                f"{w:>13}" for w in ("step, us", "faster by", "efficiency", "beam", "separators", "vehicles", "messages")))
            for ranks in RANKS:
                made_of = model.step(unknowns, bridge, coaches, ranks)
                time = sum(made_of.values())
                times.append(time)
                rows.append([name, network, ranks, time, one / time, one / time / ranks, *made_of.values()])
                print(f"{ranks:7}{1e6 * time:13.4g}{one / time:13.3g}{one / time / ranks:13.2f}"
                      + "".join(f"{1e6 * value:13.3g}" for value in made_of.values()))
            print(f"fastest on {RANKS[int(np.argmin(times))]} ranks; half of the ranks' work is lost from "
                  f"{next((r for r, t in zip(RANKS, times) if one / t / r < 0.5), 'more than 1,000')} on")
            axes.loglog(RANKS, 1e3 * np.array(times), marker="o", markersize=3, label=f"messages by {network}")
        axes.loglog(RANKS, 1e3 * one / np.array(RANKS), ":", color="grey", label="in proportion")
        axes.set_title(name, fontsize=9)
        axes.set_xlabel("ranks")
        axes.grid(True, alpha=0.4)
    all_axes[0].set_ylabel("ms a step of esdirk4")
    all_axes[0].legend(fontsize=8)
    runs.write_table(os.path.join(given.out, "scaling.csv"),
                     ["case", "messages", "ranks", "step, s", "faster by", "efficiency", "beam, s", "separators, s",
                      "vehicles, s", "messages, s"], rows)
    figure.savefig(os.path.join(given.out, "scaling.png"), dpi=120)
    print(os.path.join(given.out, "scaling.png"))


if __name__ == "__main__":
    main()
