"""The command traverse fault: packs what is necessary to understand a fault into one file, without private names."""

import argparse
import contextlib
import pathlib
import re
import shlex
import sys
import tempfile

import checked_results
import output_files
from traverse_check import runs
from traverse_check.rules import CheckError, printable

from . import inputs, machine, repeat, results_copy
from .privacy import Privacy
from .report import LeakError, Report

ABOUT = """Report of a fault of Traverse. Nothing has been sent: this file is for you to read, and to send if you wish.

versions.txt  versions of program, libraries and system; processor
command.txt   the command as given, and the one that was run again
messages.txt  what the second run has printed
options.txt   all options of the run, with their sources
input/        the scene and the files that it names, as the program has read them
results/      results files, or their first rows

To repeat it, run the words of command.txt in the folder input/.
HOME, USER, HOST, FOLDER, PROGRAM, SCRATCH and MAIL stand for what is private on the machine of the sender.
"""
HEAD = 2  # MB


def arguments_of(words):
    parser = argparse.ArgumentParser(
        prog="traverse fault", usage="traverse fault SCENE.yml|RESULTS.h5... [-option value]... [--out FILE.zip] ...",
        description="Packs a scene or results with the versions, the messages of a second run and the results into one file, to "
        "report a fault. Home folder, names of user and machine and folders are taken out. Nothing is sent.",
        epilog="Words with one dash are options of the program: write `fault` behind `traverse` in the command that fails.",
        allow_abbrev=False)
    parser.add_argument("--out", metavar="FILE.zip", default="fault.zip", help="default: fault.zip")
    parser.add_argument("--results", choices=("none", "head", "whole"), default="head",
                        help="of results files; head, the default: the first rows, up to the limit of --most")
    parser.add_argument("--most", type=float, default=HEAD, metavar="MB", help=f"of numbers of each results file; default: {HEAD}")
    parser.add_argument("--seconds", type=float, default=60.0, help="after which the second run is ended; default: 60")
    parser.add_argument("--describe", action="store_true", help="reads the scene (-describe) instead of running it again")
    parser.add_argument("--ranks", type=int, default=1, help="runs again under mpirun")
    parser.add_argument("--about", metavar="TEXT", default="", help="what happens, and what you expected instead")
    parser.add_argument("--list", action="store_true", help="says what the file would contain, and does not write it")
    parser.add_argument("--program", metavar="FILE", help="the program traverse; default: the one beside this command")
    given, rest = parser.parse_known_args(words)
    unknown = [word for word in rest if word.startswith("--")]
    if unknown:
        raise CheckError(f"{unknown[0]}: there is no such option of traverse fault; --help lists them")
    if not rest:
        raise CheckError("name a scene, a results file or options of the program; --help shows how")
    if not (given.most >= 0.0 and given.seconds > 0.0 and 1 <= given.ranks <= 1024):
        raise CheckError("allowed: --most from 0, --seconds above 0, --ranks from 1 to 1024")
    return given, rest


def sorted_words(rest):
    """(scenes, results files, words of the program) of the words that are no options of this command."""
    first = next((i for i, word in enumerate(rest) if word.startswith("-")), len(rest))
    files, words, scenes, results = rest[:first], rest[first:], [], []
    verb = [files.pop(0)] if files and re.fullmatch("[a-z]+", files[0]) and not pathlib.Path(files[0]).exists() else []
    for name in files:
        if not pathlib.Path(name).is_file():
            raise CheckError(f"{name}: there is no such file", 4)
        with open(name, "rb") as file:
            begin = file.read(8)
        (results if begin == b"\x89HDF\r\n\x1a\n" else scenes).append(name)
    named = [words[i + 1] for i, word in enumerate(words[:-1]) if word.lstrip("-") == "options_file"]
    of_scenes = [part for name in scenes for part in ("-options_file", name)]
    return scenes + named, results, [*verb, *(of_scenes or results[:1]), *words]


def opened(name, report, stack):
    """A results file; None, with a line in the report, if it cannot be read."""
    try:
        return stack.enter_context(checked_results.opened(name))
    except checked_results.ResultsError as error:
        report.leave_out(name, str(error))
        return None


def attempt(name, report, read, *words):
    """read(*words); None, with a line in the report, if a results file is not what a program of Traverse writes."""
    try:
        return read(*words)
    except LeakError:
        raise
    except Exception as error:  # a damaged file can raise every kind
        report.leave_out(name, checked_results.in_one_line(error))
        return None


def input_of(files, scenes, report):
    """The input of the run: of the first results file that holds its texts, otherwise of the files of the scene."""
    for file, folder in files:
        found = attempt(f"the scene in {file.filename}", report, inputs.of_results, file, folder, scenes)
        if found is not None and found.options:
            return found
    return inputs.looked_for(scenes)


def add_input(report, found):
    """Adds the texts, by names that lead from one to the other as the originals do."""
    base = inputs.base_of(list(found.texts), found.folder)
    names = inputs.names_in_report(list(found.texts), base)
    if base is not None:
        report.privacy.add_folder(base, "")
    for path, name in names.items():
        report.privacy.add_folder(path, name)
    for path, text in found.texts.items():
        if len(text) > inputs.MOST_BYTES:
            report.leave_out(names[path], f"has {len(text):,} characters")
        else:
            report.add_text(f"input/{names[path]}", text)
    for path, why in found.left_out:
        report.leave_out(path, why)
    if found.options:
        report.add_text("options.txt", "".join(f"{name} = {value}    ({source})\n" for name, value, source in found.options))


def learn(privacy, found, files, said):
    """Takes names of people from all texts before one of them is cleaned."""
    for text in (*found.texts.values(), *found.texts, *(value for option in found.options for value in option), said):
        privacy.learn(text)
    for file in files:
        for text in results_copy.texts_of(file):
            privacy.learn(text)


def pack(given, rest, program, scratch, stack):
    """The report of this command."""
    scenes, results, words = sorted_words(rest)
    privacy = Privacy(machine.vocabulary(program))
    for folder, stand_in in ((pathlib.Path.cwd(), ""), (scratch, "SCRATCH"), (pathlib.Path(program).parent, "PROGRAM"),
                             (inputs.LIBRARY, "PROGRAM")):
        privacy.add_folder(folder, stand_in)
    report = Report(privacy)
    print("The program runs again" + (f", at most {given.seconds:g} s" if not given.describe else " with -describe"), flush=True)
    more = ["-describe", "true"] if given.describe else []
    command, said = repeat.run(program, [*words, *more], scratch, given.seconds, given.ranks)
    files = {name: file for name in results if (file := opened(name, report, stack)) is not None}
    repeated = scratch / "repeated.h5"
    again = opened(str(repeated), report, stack) if repeated.is_file() else None
    of_run = [(again, pathlib.Path.cwd())] if again is not None else []
    of_files = [(file, pathlib.Path(name).absolute().parent) for name, file in files.items()]
    found = input_of([*of_run, *of_files] if scenes else [*of_files, *of_run], scenes, report)
    attempt("a name in a results file", report, learn, privacy, found, [*files.values(), *(file for file, _ in of_run)], said)
    report.add_text("README.txt", ABOUT + (f"\n{given.about}\n" if given.about else ""))
    add_input(report, found)
    report.add_text("versions.txt", machine.versions(program))
    report.add_text("command.txt", "".join(f"{what} {shlex.join(map(privacy.clean, line))}\n" for what, line in (
        ("given:", ["traverse", *rest]), ("run:  ", command))))
    report.add_text("messages.txt", said)
    most = float("inf") if given.results == "whole" else given.most * 1e6
    for name, file in {**files, **({"repeated.h5": again} if again is not None else {})}.items():
        if given.results != "none":
            attempt(name, report, report.add_results, f"results/{pathlib.Path(name).name}", file, scratch, most)
    return report, [*scenes, *results]


def main():
    try:
        given, rest = arguments_of(sys.argv[1:])
        out = pathlib.Path(given.out)
        output_files.kind_of(out, ("zip",))
        program = runs.program(given.program)
        with tempfile.TemporaryDirectory(prefix="traverse_fault_") as folder, contextlib.ExitStack() as stack:
            output_files.check(out, "zip", [word for word in rest if pathlib.Path(word).is_file()])
            report, read = pack(given, rest, program, pathlib.Path(folder), stack)
            print("The report contains", *report.lines(), sep="\n")
            print("Taken out everywhere: home folder, folders, names of user and machine, addresses of mail. What the scene itself "
                  "says, such as the name of a project, is in it: read it before you send it.", flush=True)
            if given.list:
                report.check()
            else:
                size = report.write(out, read)
                print(f"{printable(out)} is written ({size:,} bytes)")
        return 0
    except CheckError as error:
        return end(error, error.status)
    except (output_files.OutputError, checked_results.ResultsError) as error:
        return end(error, 4)
    except LeakError as error:
        return end(f"{error}: a private name could not be taken out; nothing is written", 70)
    except OSError as error:
        return end(f"{error.filename or 'output'}: {error.strerror}", 4)
    except KeyboardInterrupt:
        return 130


def end(message, status):
    print(f"traverse fault: {printable(message)}", file=sys.stderr)
    return status
