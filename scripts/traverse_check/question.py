"""What the user asks: words of the command line and of a YAML file, which are the same."""

import argparse
import difflib
import os
import pathlib
from typing import NamedTuple, Optional

from input_files import InputError, yaml_of

from . import flow_chart, units
from .rules import CheckError, rule

TYPES = {"steel": "steel", "composite": "composite", "prestressed": "prestressed", "reinforced": "reinforced",
         "filler": "filler_beam"}
VALUES = {
    "span": "span lengths, such as 28 m or 25,30,25 m; several spans are continuous",
    "EI": "bending stiffness, such as 260 GN.m2; two values: lower and upper bound, EN 1991-2 6.4.6.3.3",
    "frequency": "first natural frequency instead of EI, such as 4.1 Hz; two values: bounds",
    "mass": "mass per length with ballast and track, such as 19 t/m; two values: lower and upper bound, 6.4.6.3.2",
    "type": f"damping by EN 1991-2 table 6.6: {', '.join(TYPES)}",
    "line-speed": "maximum line speed at the site, such as 250 km/h",
    "track": "ballast (default) or direct: limits of acceleration and rotation",
    "alpha": "classification factor of LM71 and SW/0; default 1",
    "torsional-frequency": "first natural frequency of torsion, for figure 6.9",
    "GJ": "torsional stiffness between forks instead of this frequency, such as 90 GN.m2",
    "polar-inertia": "with GJ: polar moment of inertia of the mass per length, such as 160 t.m",
    "eccentricity": "with GJ: distance of the track under the trains from the axis, such as 2.25 m; the bridge twists",
    "tracks": "1 (default) or 2: with eccentricity, load models stand on a second track on the other side of the axis too",
    "hslm-b": "number N of forces and their distance d in m, from the chart of HSLM-B: simple spans below 7 m",
    "load-spread": "sleeper spacing: each axle force acts on three sleepers",
    "limits": "file of limits, such as those of a national annex; default: options/limits/en1991_2.yml",
    "folder": "folder of all files; default: results/check, or the name of the YAML file in results",
}
FLAGS = {
    "simply-supported": "several spans are separate beams",
    "complex": "no simple structure by figure 6.9: skew, flexible supports, torsion",
    "careful": "carefully maintained track: Phi2",
    "additional-damping": "additional damping of 6.4.6.4, spans below 30 m",
    "always": "dynamic analysis even if figure 6.9 requires none",
    "no-report": "neither report nor picture nor page",
}
TITLE = ("project", "structure", "line", "author", "checker", "revision", "date", "note", "logo", "material",
         "cross-section", "drawings", "norm-edition", "national-annex", "language")


class Question(NamedTuple):
    spans: list
    EI: list                  # N m2; empty with frequencies
    masses: list              # kg/m
    type: str                 # word of the option model_damping_bound
    line_speed: float         # m/s
    frequencies: tuple = ()   # Hz; empty with EI
    track: str = "ballast"
    alpha: float = 1.0
    torsional_frequency: Optional[float] = None  # Hz
    GJ: Optional[float] = None                   # N m2
    polar_inertia: Optional[float] = None        # kg m
    eccentricity: Optional[float] = None         # m; None: the bridge does not twist
    tracks: int = 1
    hslm_b: Optional[tuple] = None   # N, d in m
    load_spread: Optional[float] = None
    limits: Optional[str] = None     # a file
    folder: pathlib.Path = pathlib.Path()
    simply_supported: bool = False
    complex: bool = False
    careful: bool = False
    additional_damping: bool = False
    always: bool = False
    report: bool = True
    title: dict = {}                 # options report_...
    program: Optional[str] = None

    @property
    def torsional_wave_speed(self):
        """In m/s, as the flow chart asks."""
        return flow_chart.torsional_wave_speed(self.GJ, self.polar_inertia, self.torsional_frequency)

    @property
    def separate(self):
        """Whether every span is a simply supported beam."""
        return len(self.spans) == 1 or self.simply_supported


class Parser(argparse.ArgumentParser):
    def error(self, message):
        """A wrong command line as one line, without the list of all options."""
        raise CheckError(f"{message}; traverse check -h lists all words")


def parser():
    reader = Parser(
        prog="traverse check", allow_abbrev=False, usage="traverse check [BRIDGE.yml] --span 28 m --EI 260 GN.m2 ...",
        description="Checks a railway bridge by EN 1991-2 and EN 1990.",
        epilog="BRIDGE.yml has the same words as keys (span: 28 m). Exit status: 0 all limits are complied with, 2 "
               "invalid input, 3 no solution, 4 a file failed, 5 a limit is exceeded, 6 a limit could not be evaluated")
    reader.add_argument("file", nargs="?", metavar="BRIDGE.yml")
    for name, words in VALUES.items():
        reader.add_argument(f"--{name}", nargs="+", metavar="VALUE", help=words)
    for name, words in FLAGS.items():
        reader.add_argument(f"--{name}", action="store_const", const="true", help=words)
    for name in TITLE:
        reader.add_argument(f"--report-{name}", metavar="TEXT", help="title page of the report")
    reader.add_argument("--program", metavar="FILE", help="the program traverse; default: the one beside this command")
    return reader


def known_words():
    return [*VALUES, *FLAGS, *(f"report-{name}" for name in TITLE)]


def scalar(value):
    """A value of YAML as the text that the command line would contain."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)


def words_of_file(path):
    """{word: text} of a YAML file."""
    try:
        read = yaml_of(path, "YAML file with one word and its value on each line")
    except InputError as error:
        raise CheckError(str(error)) from None
    if not isinstance(read, dict):
        raise CheckError(f"{path} is no YAML file with one word and its value on each line")
    words = {}
    for name, value in read.items():
        if name not in known_words():
            near = difflib.get_close_matches(str(name), known_words(), 1)
            advice = f"; did you mean {near[0]}?" if near else ""
            raise CheckError(f"{path}: {name} is not a word of this check{advice}")
        parts = value if isinstance(value, list) else [value]
        if value is None or any(isinstance(part, (dict, list)) for part in parts):
            raise CheckError(f"{path}: {name} needs a value, or a list of values")
        words[name] = ", ".join(scalar(part) for part in parts)
    folder = pathlib.Path(words.get("folder", "."))
    if folder.is_absolute() or ".." in folder.parts or not folder.resolve().is_relative_to(pathlib.Path().resolve()):
        raise CheckError(f"{path}: folder {folder}: allowed in a file: a folder below the working directory; for "
                         "others use --folder")
    return words


def words_of(given):
    """{word: text} of the command line, which replaces that of the file; the folder; the program."""
    arguments = vars(parser().parse_args(given))
    words = words_of_file(arguments["file"]) if arguments["file"] else {}
    for name in known_words():
        value = arguments[name.replace("-", "_")]
        if value is not None:
            words[name] = " ".join(value) if isinstance(value, list) else value
    for name, other in (("EI", "frequency"), ("frequency", "EI")):  # that of the command line replaces the other of the file
        if arguments[name] is not None and arguments[other] is None:
            words.pop(other, None)
    stem = pathlib.Path(arguments["file"] or "check").stem.strip(".") or "check"
    folder = pathlib.Path(words.get("folder", pathlib.Path("results", stem)))
    if arguments["file"] and pathlib.Path(arguments["file"]).resolve().parent == folder.resolve():
        raise CheckError(f"--folder {folder}: allowed: another folder than that of {arguments['file']}, which might be "
                         "overwritten")
    return words, folder, arguments["program"]


def title_of(words, folder):
    """The options report_... of the scene; pictures are beside the scene, or relative to it."""
    title = {name.replace("-", "_"): words[f"report-{name}"] for name in TITLE if f"report-{name}" in words}
    return title | {name: os.path.relpath(title[name], folder) for name in ("logo", "cross_section") if name in title}


def bounds(name, words):
    found = units.values(name, words[name]) if name in words else []
    if len(found) > 2 or sorted(set(found)) != found:
        raise CheckError(f"{name} {words[name]}: allowed: one value, or the lower and the upper bound; decimals need a "
                         "point")
    return found


def one(name, words):
    found = units.values(name, words[name]) if name in words else [None]
    if len(found) > 1:
        raise CheckError(f"{name} {words[name]}: allowed: one value")
    return found[0]


def choice(name, words, allowed, default=None):
    text = words.get(name, default)
    if text not in allowed:
        raise CheckError(f"{name} {text}: allowed: {', '.join(allowed)}" if text else
                         f"--{name} is missing; allowed: {', '.join(allowed)}")
    return text


def number(name, text):
    try:
        return float(text)
    except ValueError:
        raise CheckError(f"{name} {text}: allowed: a number") from None


def train_b(words):
    if "hslm-b" not in words:
        return None
    parts = words["hslm-b"].replace(",", " ").removesuffix("m").split()
    values = [number("hslm-b", part) for part in parts]
    if len(values) != 2 or values[0] != int(values[0]) or not 1 <= values[0] <= 100 or not 0.0 < values[1] < 100.0:
        raise CheckError(f"hslm-b {words['hslm-b']}: allowed: a whole number of forces and their distance in m, "
                         "such as 12,3.5")
    return int(values[0]), values[1]


def flag(name, words):
    return choice(name, words, ("true", "false"), "false") == "true"


def ask(given):
    """The question of the command line `given`."""
    words, folder, program = words_of(given)
    for name in ("span", "mass", "line-speed"):
        if name not in words:
            raise CheckError(f"--{name} is missing: {VALUES[name]}")
    if ("EI" in words) == ("frequency" in words):
        raise CheckError("either --EI or --frequency is necessary, but not both")
    asked = Question(
        spans=units.values("span", words["span"]), EI=bounds("EI", words), frequencies=bounds("frequency", words),
        masses=bounds("mass", words), type=TYPES[choice("type", words, TYPES)], line_speed=one("line-speed", words),
        track=choice("track", words, ("ballast", "direct"), "ballast"), alpha=number("alpha", words.get("alpha", "1")),
        torsional_frequency=one("torsional-frequency", words), GJ=one("GJ", words),
        polar_inertia=one("polar-inertia", words), eccentricity=one("eccentricity", words),
        tracks=int(choice("tracks", words, ("1", "2"), "1")), hslm_b=train_b(words), load_spread=one("load-spread", words),
        limits=words.get("limits"), folder=folder,
        simply_supported=flag("simply-supported", words), complex=flag("complex", words),
        careful=flag("careful", words), additional_damping=flag("additional-damping", words),
        always=flag("always", words), report=not flag("no-report", words),
        title=title_of(words, folder), program=program)
    _ = asked.torsional_wave_speed  # refuses what does not belong together
    if asked.eccentricity is not None and asked.GJ is None:
        raise CheckError("--eccentricity needs --GJ and --polar-inertia, by which the bridge twists")
    if asked.tracks == 2 and asked.eccentricity is None:
        raise CheckError("--tracks 2 needs --eccentricity, the distance of the tracks from the axis")
    if asked.frequencies and len(asked.masses) > 1:
        raise CheckError("a measured frequency belongs to one mass: give two masses only with --EI")
    short = asked.separate and min(asked.spans) < rule("short_span")["value"]
    if short and asked.hslm_b is None:
        raise CheckError("simple spans below 7 m need HSLM-B: read N and d from its chart in EN 1991-2 and give "
                         "--hslm-b N,d")
    if asked.hslm_b is not None and not short:
        raise CheckError("HSLM-B is for simple spans below 7 m only (EN 1991-2 table 6.4): leave out --hslm-b")
    return asked
