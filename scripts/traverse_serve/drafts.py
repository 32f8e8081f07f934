"""What is shown while a form is filled in: messages beside its fields, the drawing, and what the program says of it."""

import contextlib
import pathlib
import re
import tempfile
import threading

import h5py
from picture_data import Results
from traverse_check import flow_chart, question, runs, scene, units
from traverse_check import main as checking
from traverse_check.rules import MARKS, CheckError, clause
from traverse_page import stage
from traverse_report.language import capital, decimal, num, t

from . import fields, inputs, options, scenes
from .jobs import kept_process

SECONDS, LONGEST = 30.0, 1_000_000  # of one process, and bytes of what it prints
AT_REST = (("modes", "-modes_count", "1"), ("static",))  # analyses whose files have the model
MANY = ("sweep", "study", "find", "fit", "limits")  # blocks of scenes that ask for more than one run
OUTPUT = ("-output_file", "results.h5", "-skip_petscrc")


class Failed(Exception):
    """The program does not accept a scene; its message."""


class Drafts:
    """One draft at a time."""

    def __init__(self, program, folder, scratch, table):
        self.program, self.folder, self.scratch, self.table, self.lock = program, folder, scratch, table, threading.Lock()

    def check_ranges(self, form, values):
        """InputError for a number that its field does not allow."""
        for field in form.fields if form.name != "scene" else ():
            kind = units.KINDS.get(field.name) if form.name == "check" else None
            allowed = field.range or ((*kind.of_bridges, False) if kind else None)
            if not allowed and field.option in self.table and field.kind == "number":
                allowed = self.table[field.option].range
            if allowed:
                fields.check_range(field, values, allowed)

    def run(self, folder, *words):
        """What the program prints about scene.yml of a folder."""
        process = kept_process(folder, self.folder, self.program, self.scratch,
                               [self.program, "-options_file", "scene.yml", *OUTPUT, *words])
        late = threading.Timer(SECONDS, process.stdin.close)
        late.start()
        with process:
            lines = process.stdout.read(LONGEST).decode("utf-8", "replace")
            status = process.wait()
        expired = late.finished.is_set()
        late.cancel()
        if expired:
            raise Failed(t("the program did not answer in time"))
        if status != 0:
            raise Failed(lines.strip().splitlines()[-1].removeprefix("traverse: ") if lines.strip() else "")
        return lines

    @contextlib.contextmanager
    def written(self, files):
        """A folder with these files, for the moment."""
        with tempfile.TemporaryDirectory(prefix="draft_", dir=self.scratch, ignore_cleanup_errors=True) as name:
            for file, text in files.items():
                pathlib.Path(name, file).write_text(text, encoding="utf-8", errors="replace")
            yield pathlib.Path(name)

    def drawing(self, files):
        """The drawing of the model, for stage.js; None if the program gives none."""
        for analysis, *words in AT_REST:
            with self.written(files) as folder, contextlib.suppress(Failed, OSError, ValueError, LookupError, TypeError):
                self.run(folder, "-scene_analysis", analysis, *words, "-output_quiet")
                with h5py.File(folder / "results.h5", "r", locking=False) as file:
                    results = Results(file)
                    return stage.still(results) or stage.moving(results)
        return None

    def described(self, files):
        """What -describe prints about a scene."""
        with self.written(files) as folder:
            return self.run(folder, "-describe")

    def draft(self, form, values, language, draw=True):
        """{errors, general, facts, unusual, stage, cost, described} of a form; without `draw` no stage."""
        answer = {"errors": {}, "general": "", "facts": [], "unusual": [], "stage": None, "cost": "", "described": ""}
        with self.lock:
            try:
                self.check_ranges(form, values)
                if form.name == "check":
                    drawn = self.examine_check(form, values, language, answer)
                else:
                    files, drawn = scene_of(form, values, language)
                    self.add_description(self.described(files), answer, form.name)
                    self.add_factor(form, values, answer)
                explain_marks(answer["facts"])
                answer["stage"] = self.drawing(drawn) if draw else None
            except inputs.InputError as error:
                tell(answer, error.field, str(error))
            except CheckError as error:
                words = re.findall(r"^(\w[\w-]*) |--([\w-]+)", str(error))
                tell(answer, named(form, [first or other for first, other in words]), str(error).replace("--", ""))
            except Failed as error:
                option = options.named_in(str(error), [field.option for field in form.fields])
                field = "text" if form.name == "scene" else named(form, [option])
                tell(answer, field, re.sub(r" \(scene\.yml:\d+\)", "", str(error)) if field != "text" else str(error))
        return answer

    def add_description(self, printed, answer, form):
        answer["unusual"] = list(dict.fromkeys(of_speed(line) for line in runs.unusual_input(printed) if line != "nothing"))
        parts = dict(re.findall(r"^  (\S+(?: \S+)*) {2,}(.*)$", printed, re.MULTILINE))
        case = f" ({t('least EI of the search')})" if form == "find" else ""
        if "first frequencies" in parts:
            value = decimal(parts["first frequencies"].replace(",", ";"))
            answer["facts"].append([capital(t("natural frequencies")) + case, value])
        if "deflection" in parts:
            value = decimal(parts["deflection"].split(",")[0].replace(" at", ";"))
            answer["facts"].append([capital(t("static deflection under the moving loads")) + case, value])
        if "time" in parts:
            answer["cost"] = t("expected: {time}", time=decimal(parts["time"].split(" on ")[0].removeprefix("about ")))
        answer["described"] = printed if form == "scene" else ""

    def add_factor(self, form, values, answer):
        if (factor := factor_of(form, values, self.program)) is not None:
            speed = num(3.6 * fields.read(form.fields, values)["sweep_speed.to"])
            words = "{factor} at {speed} km/h and the greatest EI of the search" if form.name == "find" else \
                "{factor} at {speed} km/h"
            answer["facts"].append([f"1 + φ″, {clause('track_defects')}", t(words, factor=num(factor), speed=speed)])

    def examine_check(self, form, values, language, answer):
        """Adds the need for a dynamic analysis, with the steps of the first combination of bounds that needs one. Returns the
        files of the drawing."""
        with self.written({}) as folder:
            file = folder / "bridge.yml"
            file.write_text(check_text(form, values, language), encoding="utf-8")
            try:
                asked = question.ask([str(file), "--folder", str(folder / "results")])
            except CheckError as error:
                raise CheckError(str(error).replace(f"{file}: ", "")) from None
        cases = scene.cases(asked, checking.stiffnesses_of(asked, self.program))
        decided = [(case, [flow_chart.answer(part, asked) for part in checking.parts_of_a_bridge(asked, case, self.program)])
                   for case in cases]
        needing = [one for one in decided if any(found.needed for found in one[1])]
        needed = bool(needing)
        case, shown = (needing or decided)[0]
        answer["facts"] += [list(step) for found in shown for step in found.steps]
        first, last, _ = scene.speeds(asked)
        words = "yes: {first} to {last} km/h" if needed else "no" if not asked.always else \
            "no; the analysis runs because it was asked for: {first} to {last} km/h"
        answer["facts"].insert(0, [capital(t("need for a dynamic analysis")),
                                   t(words, first=num(3.6 * first), last=num(3.6 * last))])
        if asked.frequencies or len(asked.EI) > 1:
            answer["facts"].append([capital(t("bending stiffness EI")), units.in_words("EI", case.EI)])
        if len(asked.masses) > 1:
            answer["facts"].append([capital(t("mass per length")), units.in_words("mass", case.mass)])
        return {"scene.yml": scene.beam_text(asked.spans, case, asked) + "load: {hslm_a: 1, speed: 50.0}\n"}


def explain_marks(facts):
    if any(name.endswith(MARKS) for name, _ in facts):
        facts.append([" ".join(MARKS), t("{one}: one public source confirms the number of the clause; {none}: no public source "
                                         "confirms it. Such numbers must be checked with the norm.", one=MARKS[1],
                                         none=MARKS[0])])


def of_speed(line):
    """A line on unusual input; one on a speed in km/h, without the unit of the option."""
    found = re.search(r"m/s is (\S+) km/h, faster than any train (in service|has run)", line)
    return line if not found else t("{speed} km/h is faster than any train in service" if found[2] == "in service" else
                                    "{speed} km/h is faster than any train has run", speed=num(float(found[1])))


def check_text(form, values, language):
    """The text of bridge.yml, whose numbers traverse check itself takes apart."""
    return scenes.check_file(fields.read(form.fields, values, numbers=False), language)


def named(form, names):
    """The field of the first of these options or words that has one; empty if none has."""
    return next((field.name for name in names for field in form.fields if field.option == name), "")


def tell(answer, field, message):
    if field:
        answer["errors"][field] = message
    else:
        answer["general"] = message


def factor_of(form, values, program):
    """The factor for track defects of the limits of a form; None for a form without them."""
    return scenes.factor_for_track(fields.read(form.fields, values), program) if form.name in ("sweep", "find") else None


def scene_of(form, values, language, factor=None):
    """(files of the run, files of the drawing). factor: for track defects."""
    if form.name != "scene":
        given = fields.read(form.fields, values)
        return (inputs.checked(scenes.scene_files(form.name, given, language, factor or 1.0)),
                scenes.drawn_files(form.name, given))
    text, more = values.get("text", ""), values.get("files", {})
    if not isinstance(text, str) or not isinstance(more, dict) or not all(isinstance(one, str) for one in more.values()):
        raise inputs.InputError("allowed: texts")
    if not text.strip():
        raise inputs.InputError(t("a scene is missing"), "text")
    if "scene.yml" in more:
        raise inputs.InputError("scene.yml: allowed: another name", "files")
    try:
        files = dict(more)
        files = inputs.checked({"scene.yml": inputs.with_library(text, "scene.yml", files)} | files)
    except inputs.InputError as error:
        raise inputs.InputError(str(error), error.field or "text") from None
    return files, files | {"scene.yml": inputs.without_blocks(files["scene.yml"], MANY)}

