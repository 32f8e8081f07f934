#!/usr/bin/python3
"""Errors of peaks over seconds: every integrator at many steps or tolerances and meshes, by elements and by modes, and
where -accuracy lands among them.
/usr/bin/python3 benchmarks/work_precision.py [BUILD_FOLDER] [OUT_FOLDER] [SCENE...] [--quick] [--smallest]

Writes work_precision.csv (all runs), work_precision_accuracy.csv (the table) and work_precision.png to OUT_FOLDER. SCENE
is the name of a file, such as r3_sprung_mass; left out: all of them. --quick takes fewer meshes and steps of each,
--smallest one scene on two meshes. Of a way by modes "elements" are its modes, of an adaptive one "step" is its tolerance.

An error is that of the worst of the greatest deflection, acceleration, moment and wheel force, each relative to its own
peak, of those that -accuracy promises; against a run of esdirk4 with a quarter of the finest element (R8, rail on pads:
half) and a quarter of the finest step below. What doubling its step and elements changes is printed; errors below ten
times that are written and drawn as that, and where it is more than a quarter of the accuracy of something that is
promised, that is not judged ("unsettled") and nothing is compared. So that no setting wins by chance, where errors of
two signs cancel, a fixed run's error is the largest among the runs with its mesh and its step or a shorter one. Seconds
are minima over rounds in turn.

The cheapest of these is known afterwards only. "surely" is the cheapest one that keeps the accuracy at six speeds within
3 % as well, and what is not promised to ten times it, or 1e-3, as -accuracy does.
"""

import os
import re
import statistics
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import runs  # noqa: E402
from work_precision_scenes import (  # noqa: E402
    ADAPTIVE, BY_MODES, LOOSEST, MODES, SCENES, SMALLEST, TIGHTER, WAYS, opened, speed_of)

SETTLED = 10.0  # times what doubling the reference's step and elements changes: errors below are shown as that
JUDGED = 0.25   # of an accuracy may be in doubt
BESIDE = (0.97, 0.98, 0.99, 1.01, 1.02, 1.03)  # times the speed
BEST_EFFORT, LEAST_EFFORT = 10.0, 1e-3  # times the accuracy, at least: what is not promised keeps that
LEAST_ROUNDS, MOST_ROUNDS = 3, 20
SECONDS = 8.0   # of a scene's rounds, where that allows more than the least
LONG = 10.0     # s of a process that is timed once


class Point:
    """A setting: its run's peaks, and the least seconds of its time loop and process so far."""

    def __init__(self, build, folder, options):
        self.build, self.folder, self.options = build, folder, options
        self.seconds = self.process_seconds = float("inf")
        self.run()

    def run(self):
        handle, file = tempfile.mkstemp(suffix=".h5", dir=self.folder)
        os.close(handle)
        try:
            run = runs.Run(self.build, self.options, file)
            self.peaks = runs.peaks(file)
        finally:
            os.remove(file)
        self.steps, self.unknowns, self.text = run.steps, run.unknowns, run.text
        self.seconds = min(self.seconds, run.seconds)
        self.process_seconds = min(self.process_seconds, run.process_seconds)
        return self


class Case:
    """A scene with its reference and all its runs."""

    def __init__(self, build, folder, scene, quick, longest=None):
        self.build, self.folder, self.scene = build, folder, scene
        self.longest = longest or (0.3 if quick else 1.0)  # s of a fixed run's time loop
        self.halvings = min(scene.halvings, 4) if quick else scene.halvings
        self.meshes = scene.meshes[:2] if quick else scene.meshes
        self.options = {"options_file": opened(scene.file, folder)} | scene.options

    def setting(self, mesh, step, way):
        """Options of a run: mesh, or how many modes of the finest one; step, or tolerance, whichever the way has."""
        options = self.options | WAYS[way] | {self.scene.mesh: mesh, "ts_dt": step, "step_probes": "true"}
        if way in BY_MODES:
            options |= {self.scene.mesh: self.scene.meshes[-1], "model_modes": mesh}
        if way in ADAPTIVE:
            options |= {"ts_dt": self.scene.step, "ts_rtol": step, "ts_atol": 1e-3 * step}
        return options

    def find_reference(self):
        """Peaks, and how far each of them may be off: what doubling step and elements changes."""
        mesh, step = self.scene.denser * self.scene.meshes[-1], self.scene.step / 2 ** (self.scene.halvings + 2)
        settings = [(mesh, step), (mesh, 2 * step), (mesh // 2, step)]
        with ThreadPoolExecutor(2) as pool:
            fine, longer, coarser = pool.map(
                lambda s: Point(self.build, self.folder, self.setting(*s, "esdirk4")), settings)
        self.finest = (mesh, step)
        self.reference = fine.peaks
        name, speed = speed_of(self.options["options_file"])
        self.beside = [{name: times * speed} for times in BESIDE]
        with ThreadPoolExecutor(2) as pool:
            self.references_beside = list(pool.map(lambda s: self.at(s, mesh, 2 * step, "esdirk4").peaks, self.beside))
        self.doubt = {q: (abs(longer.peaks[q] - p) + abs(coarser.peaks[q] - p)) / p for q, p in fine.peaks.items()}

    def at(self, speed, mesh, step, way):
        return Point(self.build, self.folder, self.setting(mesh, step, way) | speed)

    def errors(self, point):
        return {q: abs(point.peaks[q] / p - 1.0) for q, p in self.reference.items()}

    def shown(self, errors):
        return {q: max(e, SETTLED * self.doubt[q]) for q, e in errors.items()}

    def sequence(self, way, mesh):
        """From the longest step or loosest tolerance on, until runs take too long or nothing but the mesh's error is left."""
        points, before, steps = {}, None, 0
        for k in range(self.halvings + 1):
            step = LOOSEST / TIGHTER**k if way in ADAPTIVE else self.scene.step / 2**k
            try:
                point = Point(self.build, self.folder, self.setting(mesh, step, way))
            except runs.Failed as failed:
                if way in BY_MODES and not failed.step_is_too_long:
                    return []  # such a scene has no modes
                if not failed.step_is_too_long and way not in ADAPTIVE:
                    raise
                continue
            points[step] = point
            errors = self.shown(self.errors(point))
            # Tolerances that the longest step keeps give the same steps.
            same = before and point.steps != steps and all(abs(errors[q] - before[q]) <= 0.03 * errors[q] for q in errors)
            if same or 2.0 * point.seconds > self.longest:
                break
            before, steps = errors, point.steps
        worst = dict.fromkeys(self.reference, 0.0)
        for step in sorted(points):
            worst = {q: max(worst[q], e) for q, e in self.errors(points[step]).items()}
            points[step].error = worst
        return [(way, mesh, step, point) for step, point in points.items()]

    def try_all(self):
        jobs = [(way, mesh) for way in WAYS
                for mesh in (MODES[:len(self.meshes)] if way in BY_MODES else self.meshes)
                if "explicit" not in way or "wheel force" in self.reference]
        with ThreadPoolExecutor(2) as pool:
            self.points = [p for some in pool.map(lambda job: self.sequence(*job), jobs) for p in some]
        self.chosen = {wanted: Point(self.build, self.folder, self.options | {"accuracy": wanted})
                       for wanted in self.scene.wanted}
        self.sure = {wanted: self.find_sure(wanted) for wanted in self.scene.wanted}

    def refused(self, wanted):
        return re.findall(r"error not estimated: (.*?): (.*)", self.chosen[wanted].text)

    def promised(self, wanted):
        refused = [q for q, _ in self.refused(wanted)]
        return [q for q in self.reference if q not in refused]

    def unsettled(self, wanted):
        return [q for q in self.promised(wanted) if self.doubt[q] > JUDGED * wanted]

    def candidates(self, wanted):
        """Fixed runs that keep what is promised, the cheapest first; none where that cannot be judged."""
        promised = self.promised(wanted)
        if not promised or self.unsettled(wanted):
            return []
        kept = [p for p in self.points if all(p[3].error[q] <= wanted for q in promised)]
        return sorted(kept, key=lambda p: p[3].seconds)

    def find_sure(self, wanted):
        """The cheapest fixed run that keeps the accuracy at all speeds beside, too, and what is refused in part."""
        effort = {q: max(BEST_EFFORT * wanted, LEAST_EFFORT) for q, why in self.refused(wanted)
                  if q in self.reference and "sum of the accelerations" not in why}
        asked = {q: limit for q, limit in (effort | dict.fromkeys(self.promised(wanted), wanted)).items()
                 if self.doubt[q] <= JUDGED * limit}
        for point in self.candidates(wanted):
            way, mesh, step, run = point
            if any(run.error[q] > limit for q, limit in asked.items()):
                continue
            for speed, reference in zip(self.beside, self.references_beside):
                try:
                    peaks = self.at(speed, mesh, step, way).peaks
                except runs.Failed:
                    break
                if any(abs(peaks[q] / reference[q] - 1.0) > limit for q, limit in asked.items()):
                    break
            else:
                return point
        return None

    def time_again(self, least_rounds=LEAST_ROUNDS, seconds=SECONDS):
        begin = time.monotonic()
        again = {id(p[3]): p[3] for wanted in self.scene.wanted
                 for p in [*self.candidates(wanted)[:3], self.sure[wanted]] if p}
        for i in range(MOST_ROUNDS):
            if i >= least_rounds and time.monotonic() - begin > seconds:
                break
            for point in list(again.values()) + list(self.chosen.values()):
                if point.process_seconds < LONG:
                    point.run()

    def rows(self):
        for wanted, point in self.chosen.items():
            promised = [q for q in self.promised(wanted) if q not in self.unsettled(wanted)]
            true = {q: abs(point.peaks[q] / self.reference[q] - 1.0) for q in promised}
            worst = max(true, key=true.get, default="")
            best = self.candidates(wanted)[:3]
            cheapest = min(best, key=lambda p: p[3].seconds, default=None)
            process = min((p[3].process_seconds for p in best), default=None)
            mesh, step = re.search(r"accuracy \S+: (\d+) elements .*steps of (\S+) s;", point.text).groups()
            row = dict.fromkeys(HEADER) | {
                "scene": self.scene.name, "accuracy": wanted, "elements": int(mesh), "step": float(step),
                "error over accuracy": true[worst] / wanted if worst else None, "worst": worst,
                "ms": 1e3 * point.seconds, "process ms": 1e3 * point.process_seconds,
                "not promised": "; ".join(f"{q}: {why}" for q, why in self.refused(wanted)),
                "unsettled": "; ".join(self.unsettled(wanted))}
            if cheapest:
                row |= {"cheapest": cheapest[0], "its elements": cheapest[1], "its step": cheapest[2],
                        "its ms": 1e3 * cheapest[3].seconds, "its process ms": 1e3 * process,
                        "ms over its": point.seconds / cheapest[3].seconds,
                        "process over its": point.process_seconds / process}
            if sure := self.sure[wanted]:
                row |= {"surely": sure[0], "sure elements": sure[1], "sure step": sure[2],
                        "sure ms": 1e3 * sure[3].seconds, "ms over sure": point.seconds / sure[3].seconds,
                        "process over sure": point.process_seconds / sure[3].process_seconds}
            yield row


HEADER = ["scene", "accuracy", "elements", "step", "error over accuracy", "worst", "ms", "process ms", "cheapest",
          "its elements", "its step", "its ms", "its process ms", "ms over its", "process over its", "surely",
          "sure elements", "sure step", "sure ms", "ms over sure", "process over sure", "not promised", "unsettled"]


def show(row):
    def cheapest(way, elements, step, *ratios):
        if not row[way]:
            return "".join(f"{'':7}" for _ in ratios) + f"  {'none of them':38}"
        return ("".join(f"{row[key]:7.2f}" for key in ratios)
                + f"  {row[way] + ', ' + str(row[elements]) + ', ' + format(row[step], '.2g') + ' s':38}")

    ratios = (cheapest("cheapest", "its elements", "its step", "ms over its", "process over its")
              + cheapest("surely", "sure elements", "sure step", "ms over sure", "process over sure"))
    error = f"{row['error over accuracy']:7.2f}" if row["worst"] else f"{'-':>7}"
    left_out = ", ".join(dict.fromkeys(re.findall(r"(?:^|; )([a-z ]+)", row["not promised"])))
    print(f"{row['scene']:36}{row['accuracy']:8.0e}{row['elements']:5}{row['step']:9.2g}"
          f"{error} {row['worst']:13}{row['ms']:8.3g}{row['process ms']:7.4g}{ratios}{left_out}"
          + (f" (unsettled: {row['unsettled']})" if row["unsettled"] else ""), flush=True)


def front(points, promised, shown):
    """Pareto front: (seconds, error), each with no run that is both cheaper and more accurate."""
    least, found = float("inf"), []
    for seconds, error in sorted((p[3].seconds, max(shown(p[3].error)[q] for q in promised)) for p in points):
        if error < least:
            found.append((seconds, error))
            least = error
    return found


def picture(cases, file):
    columns = min(len(cases), 3)
    lines = -(-len(cases) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(5.0 * columns, 3.7 * lines), layout="constrained",
                                squeeze=False)
    for axis in axes.ravel()[len(cases):]:
        axis.axis("off")
    for axis, case in zip(axes.ravel(), cases):
        promised = case.promised(case.scene.wanted[min(2, len(case.scene.wanted) - 1)]) or ["deflection"]
        for i, way in enumerate(WAYS):
            own = front([p for p in case.points if p[0] == way], promised, case.shown)
            if own:
                style = "s--" if way in BY_MODES else "^:" if way in ADAPTIVE else "o-"
                axis.loglog(*zip(*own), style, color=f"C{i % 10}", ms=3, lw=1, label=way)
        axis.loglog(*zip(*front(case.points, promised, case.shown)), color="#BBBBBB", lw=5, zorder=0,
                    label="Pareto front")
        for wanted, point in case.chosen.items():
            kept = [q for q in case.promised(wanted) if q in promised] or promised
            axis.plot(point.seconds, max(case.shown(case.errors(point))[q] for q in kept), "*", color="black", ms=10,
                      label="where -accuracy lands" if wanted == case.scene.wanted[0] else None)
            axis.axhline(wanted, color="grey", lw=0.4, ls=":")
        axis.set_title(f"{case.scene.name}: {', '.join(promised)}", fontsize=8)
        axis.set(xlabel="seconds of the time loop", ylabel="error")
        axis.grid(True, alpha=0.3)
    max(axes.ravel(), key=lambda axis: len(axis.get_legend_handles_labels()[1])).legend(fontsize=6)
    figure.savefig(file, dpi=110)
    print(file)


def tried(given, scene, folder):
    """A scene with everything that was measured of it."""
    begin = time.monotonic()
    # The smallest runs are all made, however slow the machine is, so that their errors are always the same.
    case = Case(given.build, folder, scene, given.quick, float("inf") if given.smallest else None)
    case.find_reference()
    case.try_all()
    if given.smallest:
        case.time_again(least_rounds=1, seconds=0.0)
    else:
        case.time_again()
    mesh, step = case.finest
    print(f"{scene.name}: {time.monotonic() - begin:.0f} s; reference {mesh} elements, {step:.2g} s; doubling both: "
          + ", ".join(f"{q} {d:.0e}" for q, d in case.doubt.items()))
    return case


def chosen_scenes(given):
    if given.smallest:
        return [SMALLEST]
    known = [scene.file for scene in SCENES]
    for name in given.scenes:
        if name not in known:
            raise SystemExit(f"work_precision.py: {name}: no such scene; allowed: {', '.join(dict.fromkeys(known))}")
    return [scene for scene in SCENES if not given.scenes or scene.file in given.scenes]


def main():
    arguments = runs.parser(__doc__)
    arguments.add_argument("scenes", nargs="*", metavar="SCENE")
    arguments.add_argument("--quick", action="store_true", help="fewer meshes and steps")
    given = runs.given(arguments)
    scenes = chosen_scenes(given)
    print(f"{'':36}{'E':>8}{'el.':>5}{'step':>9}{'error/E':>21}{'ms':>8}{'process':>7}{'cost ratios':>14}"
          f"  {'over the cheapest fixed run':38}{'':14}  {'over that which surely does':38}not promised")
    cases, rows, every = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            case = tried(given, scene, folder)
            rows += list(case.rows())
            for row in rows[-len(scene.wanted):]:
                show(row)
            every += [[scene.name, p[0], p[1], p[2], p[3].unknowns, p[3].steps, p[3].seconds, p[3].process_seconds,
                       *(case.shown(p[3].error).get(q) for q in runs.PEAKS)] for p in case.points]
            cases.append(case)
    summarise(rows)
    runs.write_table(os.path.join(given.out, "work_precision.csv"),
                     ["scene", "way", "elements", "step", "unknowns", "steps", "seconds", "process seconds",
                      *("error of " + q for q in runs.PEAKS)], every)
    runs.write_table(os.path.join(given.out, "work_precision_accuracy.csv"), HEADER, [list(r.values()) for r in rows])
    picture(cases, os.path.join(given.out, "work_precision.png"))


def summarise(rows):
    def worst(key):
        row = max((r for r in rows if r[key] is not None), key=lambda r: r[key], default=None)
        return f"{row[key]:.2f} ({row['scene']}, {row['accuracy']:g})" if row else "none"

    def median(key):
        values = [r[key] for r in rows if r[key] is not None]
        return f"{statistics.median(values):.2f} over {len(values)}" if values else "none"

    print(f"error over the accuracy: median {median('error over accuracy')}, worst {worst('error over accuracy')}")
    print(f"cost over the cheapest fixed run: time loop median {median('ms over its')}, worst {worst('ms over its')}")
    print(f"of the whole process: median {median('process over its')}, worst {worst('process over its')}")
    print(f"cost over that which surely does: time loop median {median('ms over sure')}, worst {worst('ms over sure')}")
    print(f"of the whole process: median {median('process over sure')}, worst {worst('process over sure')}")


if __name__ == "__main__":
    main()
