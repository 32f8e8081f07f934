#!/usr/bin/python3
"""Runs the scenes of the gallery, draws their pictures and writes the page.

    gallery.py [--program FILE] [--folder FOLDER SCENE ...]

Without arguments the script uses build/traverse and all scenes of the gallery, and writes the committed page
doc/gallery.md. With named scenes, scenes/NAME or studies/NAME, it writes a separate page into another folder.
A table on the page lists every other scene of options/ with the text of its header.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import output_files
from PIL import Image
from PIL.PngImagePlugin import PngInfo
from picture_words import weighs

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHOWN = ["scenes/three_span_train", "scenes/fifty_metre_train", "scenes/r2_sprung_mass", "scenes/r8_ballasted_bridge",
         "scenes/ballasted_viaduct", "scenes/articulated_train", "scenes/braking_train", "scenes/freight_wagon",
         "scenes/wheel_over_a_bump", "scenes/tapered_jib", "scenes/overhead_crane", "scenes/escalator", "scenes/launcher",
         "scenes/precision_stage", "scenes/prop_with_gap", "studies/hslm_envelope"]
PICTURE_WIDTH, COLOURS = 1200, 256  # of the stored pictures, which must be small

# What the tests compare the scene with, and how closely it agrees.
CHECKS = {"scenes/overhead_crane":
          "`Applications.OverheadCrane` of `tests/verification/applications_test.cpp` integrates a pendulum on a rope whose "
          "length changes. On a rigid girder, sway and rope force agree within 0.2 mm and 0.1 % of the weight.",
          "scenes/escalator":
          "`Chains.PolygonDrive` of `tests/verification/chains_test.cpp` has the closed form of twenty steps on a rigid track. "
          "The forces in the links agree within 1e-5 of their static values. No reference is known for the flexible guide.",
          "scenes/launcher":
          "`Applications.Launcher` of `tests/verification/applications_test.cpp` integrates missile and rail by modes. "
          "The instant agrees within 0.01 ms, the speeds within 1 mm/s, angle, rate of rotation and deflection of the tip within "
          "1e-3 of their values.",
          "scenes/precision_stage":
          "`Applications.PrecisionStage` of `tests/verification/applications_test.cpp` integrates the motion along the beam. "
          "The following error agrees within 0.05 µm."}

# Figures of a run: the attribute of /summary, its label, unit, the factor to this unit, and the peak that must have an
# error estimate if the run has any.
FIGURES = [("deflection", "greatest deflection", "mm", 1e3, "deflection"),
           ("static_deflection", "greatest static deflection at this probe", "mm", 1e3, "deflection"),
           ("amplification", "amplification", "", 1.0, "deflection"),
           ("moment", "greatest bending moment", "kN m", 1e-3, "moment"),
           ("acceleration", "greatest acceleration of the bridge", "m/s²", 1.0, "acceleration"),
           ("acceleration_lowpass", "greatest low-passed acceleration", "m/s²", 1.0, "acceleration"),
           ("least_wheel_force", "least wheel force", "kN", 1e-3, "wheel_force"),
           ("greatest_wheel_force", "greatest wheel force", "kN", 1e-3, "wheel_force"),
           ("contact_losses", "losses of contact", "", 1.0, "wheel_force"),
           ("longest_loss", "longest loss of contact", "ms", 1e3, "wheel_force")]


def names():
    """All scenes and studies of options/, as scenes/NAME and studies/NAME."""
    return sorted(f"{path.parent.name}/{path.stem}" for kind in ("scenes", "studies")
                  for path in (ROOT / "options" / kind).glob("*.yml"))


def header(name):
    """The first three lines of the scene's file: what, source, expected."""
    lines = (ROOT / "options" / f"{name}.yml").read_text(encoding="utf-8").splitlines()[:3]
    said = [re.fullmatch(r"# (?:What|Source|Expected): (.*)", line) for line in lines]
    if len(said) < 3 or not all(said):
        sys.exit(f"options/{name}.yml: does not open with its three lines: what, source, expected.")
    return [match[1] for match in said]


def sentence(text):
    return text[0].upper() + text[1:]


def compute(program, name, folder):
    """Runs the scene and returns the results file."""
    results = folder / f"{pathlib.Path(name).name}.h5"
    run = subprocess.run([program, "-options_file", ROOT / "options" / f"{name}.yml", "-output_file", results,
                          "-output_quiet"], cwd=ROOT, capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"options/{name}.yml could not be computed: {run.stderr.strip() or run.stdout.strip()}")
    return results


def draw(results, picture):
    with h5py.File(results, "a") as file:  # the picture must not contain the computing time
        for name in ("steps", "runs"):
            file.attrs.pop(name, None)
    large = results.with_suffix(".png")
    subprocess.run([sys.executable, ROOT / "scripts" / "picture.py", results, large], check=True,
                   stdout=subprocess.DEVNULL)
    with Image.open(large) as page:
        height = round(page.height * PICTURE_WIDTH / page.width)
        small = page.convert("RGB").resize((PICTURE_WIDTH, height), Image.Resampling.LANCZOS)
    about = PngInfo()
    about.add_text("Software", output_files.WRITER)
    with output_files.written(picture, "png") as temporary:
        small.quantize(COLOURS, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(temporary, optimize=True,
                                                                                          pnginfo=about)


def in_figures(value):
    """Four significant digits, without powers of ten for large values: 16,170."""
    text = f"{value:.4g}"
    return f"{float(text):,.0f}" if "e+" in text else text


def exit_figures(file):
    """(value, label, unit, factor) of the first body when it leaves the beam."""
    if "exit" not in file:
        return []
    time, velocity = file["exit/time"][0], file["exit/velocity"][0]
    return [(time, "instant at which the vehicle leaves the beam", "ms", 1e3),
            (velocity[0], "its speed along the beam then", "m/s", 1.0), (velocity[2], "its rate of rotation then", "rad/s", 1.0)]


def figures(results):
    """Rows of a table with the main figures; empty for a mechanism, which has none of them."""
    with h5py.File(results, "r") as file:
        summary, options, exits = dict(file["summary"].attrs), dict(file["options"].asstr()[:]), exit_figures(file)
    known = [key.removeprefix("expected_error_") for key in summary if key.startswith("expected_error_")]
    # Where forces drive a vehicle from rest, the static deflection is that of the start.
    from_rest = options.get("train_drive") == "free" and re.fullmatch(r"0(\.0*)?\D*", options.get("train_speed", "0"))
    left_out = ("static_deflection", "amplification") if from_rest else ()
    weight = {"amplification": ", of deflections with the weight of the bridge"} if weighs(options) else {}
    found = [(float(summary[key]), words + weight.get(key, ""), unit, factor) for key, words, unit, factor, peak in FIGURES
             if summary.get(key) and (not known or peak in known) and key not in left_out]
    rows = [f"| {words} | {in_figures(factor * abs(value))} {unit} |".replace("  |", " |")
            for value, words, unit, factor in found + exits]
    if rows and summary.get("energy_scale"):
        share = abs(float(summary["energy_residual"] / summary["energy_scale"]))
        rows.append(f"| energy residual over the largest term of the energy balance | {share:.0e} |")
    return ["| figure | computed |", "| --- | --- |", *rows, ""] if rows else []


def shown(name, folder, program, scratch):
    """The section of a scene."""
    what, source, expected = header(name)
    short = pathlib.Path(name).name
    results = compute(program, name, scratch)
    draw(results, folder / f"{short}.png")
    return [f"## {short.replace('_', ' ').capitalize()}", "", f"![{sentence(what)}]({short}.png)", "", sentence(what), "",
            f"- Source: {source}", f"- Expected: {expected}", f"- Command: `./run.sh -options_file options/{name}.yml`",
            *([f"- Check: {CHECKS[name]}"] if name in CHECKS else []), "", *figures(results)]


def table_of(others):
    rows = ["| scene | what | source | expected |", "| --- | --- | --- | --- |"]
    for name in others:
        rows.append(" | ".join([f"| `{name}`", *(text.replace("|", "\\|") for text in header(name))]) + " |")
    return ["## All other scenes", "", "`./run.sh -options_file options/NAME.yml` runs the scene of each row.", "", *rows, ""]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--program", default=os.environ.get("TRAVERSE_BINARY", str(ROOT / "build" / "traverse")))
    arguments.add_argument("--folder", type=pathlib.Path, help="where page and pictures go (default: doc)")
    arguments.add_argument("scenes", nargs="*", metavar="SCENE", help="scenes/NAME or studies/NAME")
    given = arguments.parse_args()
    unknown = [name for name in given.scenes if name not in names()]
    if unknown:
        sys.exit(f"{unknown[0]}: no scene of options/; allowed: scenes/NAME and studies/NAME of the files there.")
    if given.scenes and given.folder is None:
        sys.exit("A page of some scenes wants a --folder of its own: doc/gallery.md shows them all.")
    folder, chosen = given.folder or ROOT / "doc", given.scenes or SHOWN
    folder.mkdir(parents=True, exist_ok=True)
    page = ["# Gallery", "", "This page shows the scenes in `options`, with their sources and results. "
            "`/usr/bin/python3 scripts/gallery.py` writes this page and its pictures. The expected values are those in the file "
            "of the scene; the tables contain the values of the run that drew the picture.", ""]
    with tempfile.TemporaryDirectory() as scratch:
        for name in chosen:
            print(name, flush=True)
            page += shown(name, folder, given.program, pathlib.Path(scratch))
    page += table_of([name for name in names() if name not in chosen])
    with output_files.written(folder / "gallery.md", "md") as temporary:
        temporary.write_text("\n".join(page).rstrip() + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
