"""Texts of picture.py about a run: its peaks, each with position, speed and train."""

from engineering_units import shown
from picture_data import MOST_CURVES, place_in_words, speed_of
from picture_runs import Runs
from traverse_report.language import num, t


def millimetres(metres):
    unit, factor = shown("deflection")
    if 0.0 < abs(metres) < 1e-5:
        unit, factor = "µm", 1e6
    return f"{num(factor * abs(metres), '.3g')} {unit}"


def speed_in_words(*speeds):
    """A speed in m/s, or a range of speeds, as text."""
    unit, factor = shown("speed")
    return f"{' to '.join(num(factor * speed) for speed in speeds)} {unit}"


def from_rest(options):
    """Whether forces drive the vehicles from rest; the static deflection of /summary is then that of the start."""
    return options.get("train_drive") == "free" and speed_of(options.get("train_speed", "0")) == 0.0


def weighs(options):
    """Whether the deflections contain the weight of the bridge."""
    return options.get("beam_self_weight", "false").lower() in ("", "true", "yes", "on", "1")


def with_run(results, name, said):
    """A text about a peak with train and speed in a sweep: 'by train A10 at 344 km/h'; with the run in a study."""
    summary, parts = results.summary, [said]
    if f"{name}_run" in summary and "study/finished" in results.file:
        run = Runs(results).run_in_words(int(summary[f"{name}_run"]))
        return t("{peak} in the run with {run}", peak=said, run=run) if run else said
    if f"{name}_train" in summary:
        parts.append(t("by train {train}", train=f"A{summary[f'{name}_train']}"))
    if f"{name}_speed" in summary:
        parts.append(t("at {value}", value=speed_in_words(summary[f"{name}_speed"])))
    return " ".join(parts)


def summary_in_words(results):
    """The peaks of /summary as text. The amplification is that of the greatest deflection."""
    summary, said = results.summary, []
    if summary.get("deflection"):
        words = "greatest deflection {value}, {place}" if "sweep" in results.file or at_worst_place(results) else \
            "greatest deflection at a probe {value}, {place}"
        peak = with_run(results, "deflection", t(words, value=millimetres(summary["deflection"]), place=place_in_words(
            summary["deflection_place"], results.supports)))
        said.append(t("{peak} relative to the supports", peak=peak) if "deflection_relative_to" in summary else peak)
    if summary.get("amplification") and not from_rest(results.options):
        words = "{factor} times the static one, both with the weight of the bridge" if weighs(results.options) else \
            "{factor} times the static one"
        said.append(t(words, factor=num(summary["amplification"], ".3g")))
    if summary.get("least_wheel_force") is not None:
        wheels = "least_wheel" in summary or "least_wheel_force_speed" in summary
        unit, factor = shown("force")
        force = f"{t('least wheel force')} {num(factor * summary['least_wheel_force'], '.3g')} {unit}"
        said += [with_run(results, "least_wheel_force", force)] if wheels else []
    if "exit/time" in results.file and len(results.file["exit/time"]):
        (time, *_), (velocity, *_) = results.values("exit/time"), results.values("exit/velocity")
        said.append(t("the vehicle leaves the beam after {time} s at {speed} m/s, turning at {rate} rad/s", time=num(time),
                      speed=num(abs(velocity[0])), rate=num(velocity[2], ".3g")))
    return said


def at_worst_place(results):
    """Whether the stored shape contains the greatest deflection of the summary, to the printed digits."""
    shape = results.values("shape/deflection")
    return shape is None or millimetres(max(shape, key=abs)) == millimetres(results.summary.get("deflection", 0.0))


def worst_in_words(results, x, deflection):
    """A deflection as text: '2.87 mm down', with the reason if it differs from the peak in the heading."""
    why = ""
    if results.summary and not at_worst_place(results):
        at_probe = abs(x - results.summary.get("deflection_place", x)) < 1e-6 * max(abs(x), 1.0)
        why = " at the nearest sample" if at_probe else f", at {x:.4g} m"
    return f"{millimetres(deflection)} {'down' if deflection < 0.0 else 'up'}{why}"


def sweep_in_words(results):
    speeds = results.values("sweep/speed")
    numbers = results.values("sweep/hslm_a")
    trains = "" if numbers is None or len(numbers) == 1 else f"{len(numbers)} trains, "
    if len(speeds) == 1:
        return f"{trains}{speed_in_words(speeds[0])}"
    return f"{trains}{len(speeds)} speeds from {speed_in_words(speeds[0], speeds[-1])}"


def method_in_words(results):
    """The numerical model of a sweep as text, and the estimated error of the deflections."""
    attrs = results.file["sweep"].attrs
    said = ""
    if attrs.get("modes"):
        said = f"by {attrs['modes']} mode{'' if attrs['modes'] == 1 else 's'}"
    elif "elements_per_span" in attrs:
        said = f"by {attrs['elements_per_span']} elements a span"
    elif "elements_per_bay" in attrs:
        said = f"by {attrs['elements_per_bay']} elements a sleeper bay"
    if "time_step" in attrs:
        said += f", steps of {1e3 * attrs['time_step']:.3g} ms"
    if "expected_error_deflection" in results.summary:
        said += f", expected error of the deflections {results.summary['expected_error_deflection']:.1g}"
    return said


def modes_in_words(frequency, shapes):
    """The number of drawn modes as text; empty if all are drawn."""
    drawn = len(frequency) if shapes is None else min(len(shapes), MOST_CURVES)
    return "" if drawn == len(frequency) else f"drawn: the first {drawn} of {len(frequency)} modes"
