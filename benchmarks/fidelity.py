#!/usr/bin/python3
"""What simpler models of a train miss, and what each costs: forces, masses, sprung masses, coaches of 10 freedoms.
/usr/bin/python3 benchmarks/fidelity.py [BUILD_FOLDER] [OUT_FOLDER] [--quick] [--smallest]

Writes fidelity.csv, fidelity_limits.csv and fidelity.png to OUT_FOLDER. --quick takes two speeds and two mass ratios,
--smallest two speeds, one mass ratio, one coach and a coarse mesh and step.

Four Velaro coaches cross a simply supported bridge of 30 m, 3.2 Hz, 1 % damping, over speed, mass ratio (the train's
mass a metre over the bridge's, whose EI goes with its mass, so that its frequencies stay) and roughness. Errors are
those of the peaks of deflection and moment in the middle, and of acceleration at the quarters and the middle, relative
to the multibody coach; above 0: too large. All models take the same mesh and steps; the bridge by modes, exact in time,
samples ten times as long. At the end: up to which mass ratio each model is good enough.
"""

import os
import tempfile
from concurrent.futures import ThreadPoolExecutor

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import runs  # noqa: E402

SPAN, FREQUENCY = 30.0, 3.2  # m, Hz
COACHES, LENGTH = 4, 25.835  # m of a coach
AXLES = [9.9375, 7.4375, -7.4375, -9.9375]  # m from its middle
WHEELSET, HALF_BOGIE, QUARTER_CAR = 1800.0, 1750.0, 11950.0  # kg
GRAVITY = 9.81
RESONANCE = FREQUENCY * LENGTH  # m/s: coaches pass as often as the bridge vibrates
SPEEDS = [30.0, RESONANCE / 2, 60.0, 72.0, RESONANCE, 95.0]
RATIOS = [0.05, 0.1, 0.15, 0.2, 0.3, 0.5]
ROUGHNESS = ["none", "german_low", "german_high"]
WAVES = "3.0,80.0"  # m; shorter ones belong to the wheels' and rails' surfaces
RUN_UP = 40.0  # m before the bridge
STEP, ELEMENTS = 5e-4, 20
SMALLEST = (2e-3, 4, 1)  # step, elements and coaches of the smallest runs
QUANTITIES = ["deflection", "moment", "acceleration"]
BOTH = ["deflection", "moment"]
LOW = 0.2  # what mass ratios of railway bridges of concrete hardly exceed
LIMITS = [(BOTH, 0.05), (BOTH, 0.1), (BOTH, 0.2), (["acceleration"], 0.1), (["acceleration"], 0.2)]

HERTZ = "wheel: {body: axle, radius: 0.46, law: hertz, stiffness: 1.721e11}"
AXLE = {  # each as a vehicle of its own under every axle
    "masses": f"""
    bodies: [axle]
    drivers: [level]
    wheels: [wheel]
    axle: {{mass: {WHEELSET + HALF_BOGIE + QUARTER_CAR}, inertia: 1.0, position: [0.0, 0.46]}}
    level: {{body: axle, coordinate: phi}}
    wheel: {{body: axle, radius: 0.46, law: linear, stiffness: 1.0e10, damping: 2.5e6}}""",
    "sprung masses": f"""
    bodies: [axle, frame]
    joints: [guide]
    springs: [primary]
    drivers: [level]
    actuators: [car]
    wheels: [wheel]
    axle:  {{mass: {WHEELSET}, inertia: 1.0, position: [0.0, 0.46]}}
    frame: {{mass: {HALF_BOGIE}, inertia: 1.0, position: [0.0, 1.0]}}
    guide: {{type: prismatic, bodies: [axle, frame], point: [0.0, 1.0], axis: [0.0, 1.0]}}
    primary: {{bodies: [axle, frame], from: [0.0, 0.46], to: [0.0, 1.0], stiffness: 2.4e6, damping: 2.0e4}}
    level: {{body: axle, coordinate: phi}}
    car:   {{body: frame, force: [0.0, {-QUARTER_CAR * GRAVITY}]}}
    {HERTZ}""",
}
MODELS = {  # name: the train, more options
    "forces, 6 modes": ("forces", {"model_modes": 6}),
    "forces": ("forces", {}),
    "masses": ("masses", {}),
    "sprung masses": ("sprung masses", {}),
    "coaches": ("coaches", {}),
}
SHORT = {"none": "smooth", "german_low": "low", "german_high": "high"}


def text_of(train, coaches):
    """The scene of so many coaches, without bridge, speed and roughness."""
    front = -RUN_UP - AXLES[0]
    places = [front - k * LENGTH + a for k in range(coaches) for a in AXLES]
    text = "support: {types: [pinned, roller]}\nscene: {tail: 0.6}\n"
    if train == "forces":
        weight = (WHEELSET + HALF_BOGIE + QUARTER_CAR) * GRAVITY
        return text + f"load: {{forces: {weight}, positions: {places}}}\n"
    if train == "coaches":
        file = os.path.join(runs.ROOT, "options", "vehicles", "velaro.yml")
        text += f"vehicle: {{coach: {{file: {file}}}}}\n"
        return text + f"train: {{vehicles: coach*{coaches}, positions: {front}}}\n"
    return text + f"vehicle:\n  one:{AXLE[train]}\ntrain: {{vehicles: one*{len(places)}, positions: {places}}}\n"


def bridge(ratio):
    mass = (WHEELSET + HALF_BOGIE + QUARTER_CAR) * len(AXLES) / LENGTH / ratio
    stiffness = mass * (2.0 * FREQUENCY * SPAN**2 / 3.141592653589793) ** 2
    return {"beam_spans": SPAN, "beam_mass": mass, "beam_EI": stiffness, "beam_damping_ratios": 0.01,
            "output_probes": f"{0.25 * SPAN},{0.5 * SPAN},{0.75 * SPAN}"}


class Passages:
    def __init__(self, build, folder, step=STEP, elements=ELEMENTS, coaches=COACHES):
        self.build, self.folder, self.step, self.elements = build, folder, step, elements
        for train, _ in MODELS.values():
            with open(self.file(train), "w") as file:
                file.write(text_of(train, coaches))

    def file(self, train):
        return os.path.join(self.folder, train.replace(" ", "_") + ".yml")

    def options(self, model, speed, ratio, roughness):
        train, more = MODELS[model]
        options = {"options_file": self.file(train)} | bridge(ratio) | more
        if train == "forces":
            return options | {"load_speed": speed}
        return options | {"train_speed": speed, "track_profile": roughness, "track_wavelengths": WAVES}

    def run(self, options):
        handle, file = tempfile.mkstemp(suffix=".h5", dir=self.folder)
        os.close(handle)
        run = runs.Run(self.build, options, file)
        run.peaks = runs.peaks(file)
        os.remove(file)
        return run

    def fixed(self, model, speed, ratio, roughness, finer=1):
        step, elements = self.step / finer, self.elements * finer
        resolved = {"output_interval": 10 * step} if "modes" in model else {"ts_dt": step, "step_probes": "true"}
        return self.run(self.options(model, speed, ratio, roughness) | resolved | {"beam_elements_per_span": elements})


def try_all(passages, speeds, ratios):
    """{(model, roughness, ratio, speed): run}; forces feel no roughness and run once."""
    keys = [(m, r, ratio, v) for r in ROUGHNESS for ratio in ratios for v in speeds for m in MODELS
            if not m.startswith("forces") or r == "none"]
    with ThreadPoolExecutor(2) as pool:
        found = dict(zip(keys, pool.map(lambda k: passages.fixed(k[0], k[3], k[2], k[1]), keys)))
    for (model, _, ratio, speed), run in list(found.items()):
        if model.startswith("forces"):
            found |= {(model, r, ratio, speed): run for r in ROUGHNESS}
    return found


def errors_of(found):
    """{(model, roughness, ratio, speed): {quantity: error against the coaches}}."""
    return {k: {q: run.peaks[q] / found["coaches", *k[1:]].peaks[q] - 1.0 for q in QUANTITIES}
            for k, run in found.items() if k[0] != "coaches"}


def doubt(passages, found, ratio, roughness):
    """What half the step and elements change in the coaches' peaks, at resonance."""
    fine = passages.fixed("coaches", RESONANCE, ratio, roughness, finer=2).peaks
    rough = found["coaches", roughness, ratio, RESONANCE].peaks
    return {q: abs(rough[q] / fine[q] - 1.0) for q in QUANTITIES}


def costs(passages, rounds):
    """Seconds of the time loop of a passage at resonance, minima: {(model, roughness): seconds}."""
    taken = {}
    for _ in range(rounds):
        for roughness in ROUGHNESS:
            for model in MODELS:
                if model.startswith("forces") and roughness != "none":
                    continue
                run = passages.fixed(model, RESONANCE, 0.1, roughness)
                taken[model, roughness] = min(taken.get((model, roughness), 1e9), run.seconds)
    return taken


def is_slow(speed):
    return speed < 0.8 * RESONANCE


def limit(errors, model, roughness, names, good, ratios, speeds):
    """The largest of the mass ratios up to which all errors of the quantities named are good; None: not the least."""
    best = None
    for ratio in ratios:
        if max(abs(errors[model, roughness, ratio, v][q]) for v in speeds for q in names) > good:
            break
        best = ratio
    return best


def least(errors, model, roughness, names, ratios, speeds):
    return min(errors[model, roughness, r, v][q] for r in ratios for v in speeds for q in names)


def show_errors(errors, ratios, speeds):
    print("errors in %, the least and the greatest over all speeds, at each mass ratio")
    print(f"{'':16}{'track':8}{'':14}" + "".join(f"{r:>16g}" for r in ratios))
    for model in MODELS:
        for roughness in ROUGHNESS:
            for q in QUANTITIES:
                some = [[errors[model, roughness, r, v][q] for v in speeds if (model, roughness, r, v) in errors]
                        for r in ratios]
                if any(some):
                    print(f"{model:16}{SHORT[roughness]:8}{q:14}"
                          + "".join(f"{100 * min(e):+8.1f}{100 * max(e):+8.1f}" if e else f"{'':16}" for e in some))


def show_costs(taken):
    print("ms of the time loop a passage at resonance, all with the same mesh and steps")
    print(f"{'':20}" + "".join(f"{SHORT[r]:>10}" for r in ROUGHNESS))
    for model in MODELS:
        shown = [taken.get((model, r)) for r in ROUGHNESS]
        print(f"{model:20}" + "".join(f"{1e3 * s:10.3g}" if s else f"{'':10}" for s in shown))


def show_limits(errors, ratios, speeds):
    """The table for the wall, in Markdown; returns its header and rows."""
    slow = [v for v in speeds if is_slow(v)]
    said = {None: "never"} | {r: f"{r:g}" for r in ratios} | {ratios[-1]: "all"}
    header = ["model", "track"]
    header += [f"{' and '.join(names)} within {100 * good:g} %" for names, good in LIMITS]
    header += [f"at most too small by, mass ratio up to {LOW:g}: deflection and moment", "acceleration"]
    print(f"good up to which mass ratio (of {ratios[0]:g} to {ratios[-1]:g}) at all speeds; in brackets: at speeds "
          "below 0.8 of the resonant one")
    print("| " + " | ".join(header) + " |\n|" + " --- |" * len(header))
    rows = []
    for model in ("forces", "masses", "sprung masses"):
        for roughness in ROUGHNESS:
            row = [model, SHORT[roughness]]
            for names, good in LIMITS:
                every, some = (said[limit(errors, model, roughness, names, good, ratios, v)] for v in (speeds, slow))
                row.append(every if every == some else f"{every} ({some})")
            low = [r for r in ratios if r <= LOW]
            row += [f"{max(0.0, -100 * least(errors, model, roughness, names, low, speeds)):.0f} %"
                    for names in (BOTH, ["acceleration"])]
            print("| " + " | ".join(row) + " |")
            rows.append(row)
    return header, rows


def picture(errors, ratios, speeds, file):
    figure, axes = plt.subplots(len(QUANTITIES), len(ROUGHNESS), figsize=(13, 10), layout="constrained", sharex=True)
    for line, q in zip(axes, QUANTITIES):
        for axis, roughness in zip(line, ROUGHNESS):
            for i, model in enumerate(("forces", "masses", "sprung masses")):
                for v in speeds:
                    values = [100 * errors[model, roughness, r, v][q] for r in ratios]
                    axis.plot(ratios, values, "o-" if is_slow(v) else "^--", color=f"C{i}", ms=3, lw=0.8,
                              label=model if v == speeds[0] else None)
            axis.axhspan(-10.0, 10.0, color="#DDDDDD", zorder=0)
            axis.set(xscale="log", title=f"{q}, track {SHORT[roughness]}")
            axis.set_yscale("symlog", linthresh=10.0)
            axis.grid(True, alpha=0.3)
        line[0].set_ylabel("error, %")
    for axis in axes[-1]:
        axis.set_xlabel("mass ratio, train over bridge")
        axis.set_xticks(ratios, [f"{r:g}" for r in ratios])
    axes[0, 0].legend(fontsize=8, title="dashed: at the resonant speed and near it", title_fontsize=8)
    figure.savefig(file, dpi=110)
    print(file)


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("--quick", action="store_true", help="two speeds and two mass ratios")
    given = runs.given(arguments)
    speeds, ratios, rounds, size = SPEEDS, RATIOS, 5, (STEP, ELEMENTS, COACHES)
    if given.quick:
        speeds, ratios, rounds = [60.0, RESONANCE], [0.1, 0.2], 1
    if given.smallest:
        speeds, ratios, rounds, size = [60.0, RESONANCE], [0.1], 1, SMALLEST
    with tempfile.TemporaryDirectory() as folder:
        passages = Passages(given.build, folder, *size)
        found = try_all(passages, speeds, ratios)
        errors = errors_of(found)
        for roughness in ROUGHNESS:
            changes = doubt(passages, found, ratios[-1], roughness)
            print(f"half the step and elements change the coaches' peaks on the {SHORT[roughness]} track by "
                  + ", ".join(f"{q} {c:.0e}" for q, c in changes.items()))
        show_errors(errors, ratios, speeds)
        taken = costs(passages, rounds)
        show_costs(taken)
        header, limits = show_limits(errors, ratios, speeds)
    runs.write_table(os.path.join(given.out, "fidelity.csv"),
                     ["model", "track", "mass ratio", "speed", *("peak " + q for q in QUANTITIES),
                      *("error of " + q for q in QUANTITIES), "steps", "seconds"],
                     [[k[0], SHORT[k[1]], k[2], k[3], *(run.peaks[q] for q in QUANTITIES),
                       *(errors.get(k, dict.fromkeys(QUANTITIES, 0.0))[q] for q in QUANTITIES), run.steps, run.seconds]
                      for k, run in found.items()])
    runs.write_table(os.path.join(given.out, "fidelity_limits.csv"), header, limits)
    picture(errors, ratios, speeds, os.path.join(given.out, "fidelity.png"))


if __name__ == "__main__":
    main()
