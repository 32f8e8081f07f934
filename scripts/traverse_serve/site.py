"""What the server answers: pages, drafts, runs and files."""

import io
import json
import os
import pathlib
import re
import stat
import sys
import zipfile

import output_files
from traverse_check import question, runs
from traverse_report.language import LANGUAGES, choose, t

from . import drafts, inputs, options, pages
from .forms import examples, forms
from .jobs import Job, Queue, QueueFull, Step
from .server import RESULTS_POLICY, Answer, as_json

HERE, SCRIPTS = pathlib.Path(__file__).resolve().parent, pathlib.Path(__file__).resolve().parents[1]
ASSETS = {"page.css": "traverse_page", "serve.css": "traverse_serve", "serve.js": "traverse_serve", "form.js": "traverse_serve",
          "menu.js": "traverse_serve",
          "format.js": "traverse_page", "symbols.js": "traverse_page", "places.js": "traverse_page",
          "stage.js": "traverse_page"}
KINDS = {".css": "text/css", ".js": "text/javascript", ".html": "text/html", ".pdf": "application/pdf", ".png": "image/png",
         ".xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet", ".yml": "text/plain",
         ".csv": "text/csv", ".txt": "text/plain", ".h5": "application/x-hdf5"}
REPORT = ("report.pdf", "report.xlsx")


def with_charset(kind):
    return f"{kind}; charset=utf-8" if kind.startswith("text/") else kind


class Site:
    """program: traverse. folder: the only one that is read and written. scratch: one in it, for temporary files."""

    def __init__(self, program, folder, scratch):
        self.program, self.folder = program, folder
        self.table = options.table(program)
        self.queue = Queue(program, folder, scratch)
        self.drafts = drafts.Drafts(program, folder, scratch, self.table)
        self.root = ""  # the address up to the token, which the server sets

    def answer(self, method, parts, query, sent):
        """The answer to a permitted request: parts of its path behind the token."""
        if parts[0] == "asset" and len(parts) == 2 and method == "GET":
            return self.asset(parts[1])
        language, *rest = parts
        if language not in LANGUAGES:
            raise Answer(404, "There is no such page.")
        choose(language)  # for this thread
        routes = {("GET", 1): self.show, ("POST", 2): self.take, ("GET", 2): self.show_of, ("GET", 3): self.part_of_run,
                  ("POST", 3): self.change_run, ("GET", 4): self.file_of_run}
        route = routes.get((method, len(rest)))
        if route is None:
            raise Answer(404, "There is no such page.")
        return route(language, rest, query if method == "GET" else sent)

    def asset(self, name):
        if name not in ASSETS:
            raise Answer(404, "There is no such file.")
        path = SCRIPTS / ASSETS[name] / name
        return Answer(200, path.read_bytes(), with_charset(KINDS[path.suffix]))

    def html(self, text):
        return Answer(200, text, "text/html; charset=utf-8")

    def show(self, language, rest, query):
        """A form, filled in as an earlier run (from) if wanted; or the list of runs."""
        name = rest[0] or "check"
        if name == "runs":
            jobs = [job for job in reversed(self.queue.all()) if job.of is None]
            return self.html(pages.runs_page(self.root, language, jobs))
        form = self.form(name)
        job = self.queue.jobs.get(int(query["from"])) if re.fullmatch(r"[0-9]{1,9}", query.get("from", "")) else None
        values = job.values if job is not None and job.form == name else {}
        return self.html(pages.form_page(self.root, language, form, values, self.table, form_words(language)))

    def form(self, name):
        if name not in forms():
            raise Answer(404, "There is no such page.")
        return forms()[name]

    def take(self, language, rest, sent):
        """Values of a form: a draft of them, or their run."""
        form = self.form(rest[0])
        values = {name: value for name, value in sent.items() if isinstance(name, str)}
        if rest[1] == "draft":
            return as_json(self.drafts.draft(form, values, language))
        if rest[1] == "run":
            return self.start(form, values, language)
        raise Answer(404, "There is no such page.")

    def start(self, form, values, language):
        """Writes the files of a run and puts it into the queue."""
        answer = self.drafts.draft(form, values, language, draw=False)
        if answer["errors"] or answer["general"]:
            return as_json(answer, 422)
        files, steps = self.files_and_steps(form, values, language)
        try:
            number = self.queue.next_number()
        except QueueFull:
            return as_json({"errors": {}, "general": t("So many runs wait already that no other is taken: stop one, or try "
                                                       "again later.")}, 429)
        folder = self.folder / f"run_{number}"
        for name, text in files.items():
            place = folder / name
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(text, encoding="utf-8", errors="replace")
        self.queue.add(Job(form.name, values, folder, steps(folder), list(files)), number)
        return as_json({"run": number})

    def files_and_steps(self, form, values, language):
        """({file: text}, function of the folder that gives the steps)"""
        script = [sys.executable, "-B"]
        if form.name == "check":
            files = {"bridge/bridge.yml": drafts.check_text(form, values, language)}
            return files, lambda folder: [
                Step([*script, runs.command("traverse-check"), "bridge/bridge.yml", "--folder", ".", "--program", self.program,
                      "--no-report"], "the check is being computed", judged=True),
                Step([*script, HERE / "documents.py", folder], "the pages of results are being made")]
        files, _ = drafts.scene_of(form, values, language, drafts.factor_of(form, values, self.program))
        computing = [*script, HERE / "least.py", self.program, language, json.dumps(values)] if form.name == "find" else \
            [self.program, "-options_file", "scene.yml", "-output_file", "results.h5", "-skip_petscrc"]
        return files, lambda folder: [
            Step(computing, "the scene is being computed"),
            Step([*script, HERE / "documents.py", folder, "results.h5"], "the pages of results are being made", judged=True)]

    def job(self, number):
        job = self.queue.jobs.get(int(number)) if re.fullmatch(r"[0-9]{1,9}", number) else None
        if job is None or job.of is not None:
            raise Answer(404, "There is no such run.")
        return job

    def show_of(self, language, rest, query):
        """The page of a run, or the text of a scene of the library."""
        if rest[0] == "example" and rest[1] in examples():
            text = (inputs.OPTIONS / "scenes" / f"{rest[1]}.yml").read_text(encoding="utf-8")
            files = {}
            text = inputs.with_library(text, "scene.yml", files, inputs.OPTIONS / "scenes")
            return as_json({"text": text, "files": files})
        if rest[0] != "run":
            raise Answer(404, "There is no such page.")
        job = self.job(rest[1])
        return self.html(pages.run_page(self.root, language, job, results_of(job), files_of(job)))

    def part_of_run(self, language, rest, query):
        """The state of a run, or the archive of its scene."""
        if rest[0] != "run":
            raise Answer(404, "There is no such page.")
        job = self.job(rest[1])
        if rest[2] == "scene.zip":
            return Answer(200, archive(job), "application/zip",
                          {"Content-Disposition": f'attachment; filename="traverse_{job.form}_{job.number}.zip"'})
        if rest[2] != "state":
            raise Answer(404, "There is no such page.")
        report = next((one for one in reversed(self.queue.all()) if one.of is job), None)
        return as_json(self.state(job) | {"report": report and {"state": report.state, "message": report.message()},
                                          "has_report": has_report(job)})

    def state(self, job):
        before = self.queue.before(job)
        line = pages.state_in_words(job)
        if job.state == "waiting" and before:
            line += " (" + t("runs before it: {count}", count=before) + ")"
        return {"state": job.state, "words": line, "percent": job.percent, "line": job.lines[-1].strip() if job.lines else ""}

    def change_run(self, language, rest, sent):
        """Stops a run, or makes its report."""
        job = self.job(rest[1]) if rest[0] == "run" else None
        if job is not None and rest[2] == "stop":
            self.queue.stop(job)
            return as_json({})
        if job is None or rest[2] != "report" or job.state != "done":
            raise Answer(404, "There is no such page.")
        busy = any(one.of is job and one.state in ("waiting", "running") for one in self.queue.all())
        if not busy and not has_report(job):
            try:
                self.queue.add(Job(job.form, {}, job.folder, [self.report_step(job, language)], of=job))
            except QueueFull:
                raise Answer(429, "So many runs wait already that no other is taken.") from None
        return as_json({})

    def report_step(self, job, language):
        results = [f"{name}.h5" for name in results_of(job)]
        if job.form == "check":
            asked = question.ask([str(job.folder / "bridge/bridge.yml"), "--folder", str(job.folder)])
            words = runs.report_words(self.program, asked, results)
        else:
            words = [runs.command("traverse-report"), *results, "-o", "report", "--program", self.program, "--folder", ".",
                     "--language", language]
        return Step([sys.executable, "-B", *words], "the report is being made")

    def file_of_run(self, language, rest, query):
        """A file of the folder of a run: an ordinary one with a known ending, no link."""
        if rest[0] != "run" or rest[2] != "file":
            raise Answer(404, "There is no such page.")
        job, name = self.job(rest[1]), rest[3]
        kind = KINDS.get(pathlib.Path(name).suffix)
        try:
            handle = os.open(job.folder / name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
        except OSError:
            kind = None
        if kind is None:
            raise Answer(404, "There is no such file.")
        file = open(handle, "rb")  # the server closes it
        if not stat.S_ISREG(os.fstat(handle).st_mode):
            file.close()
            raise Answer(404, "There is no such file.")
        head = {"Content-Security-Policy": RESULTS_POLICY} if kind == "text/html" else \
            {"Content-Disposition": f'attachment; filename="{name}"'}
        return Answer(200, file, with_charset(kind), head)


def results_of(job):
    """The names of the results files of a run that have a page, without ending."""
    return sorted(path.stem for path in job.folder.glob("*.h5") if path.with_suffix(".html").is_file())


def files_of(job):
    """The names of the files of a run that the server sends."""
    return sorted(path.name for path in job.folder.iterdir() if path.suffix in KINDS and path.is_file() and
                  not path.is_symlink())


def has_report(job):
    return set(REPORT) <= set(files_of(job))


def archive(job):
    """The files of the scene as a ZIP file: those of the form, and the scenes that a check has written."""
    names = set(job.files) | ({path.name for path in job.folder.glob("*.yml")} if job.form == "check" else set())
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as file:
        for name in sorted(names):
            path = job.folder / name
            if path.is_file() and not path.is_symlink():
                file.write(path, path.name)
        file.comment = f"Written by {output_files.WRITER}".encode()
    return content.getvalue()


def form_words(language):
    """The texts of the scripts of a form."""
    return {"language": language, "decimal": "." if language == "en" else ",", "remove": t("remove"),
            "unusual": t("Unusual input (in English):"), "lost": t("The server does not answer: is it still running?")}
