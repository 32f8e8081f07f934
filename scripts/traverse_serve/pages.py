"""The pages of the server as HTML. Every text from outside goes through html.escape."""

import json
import pathlib
import re
from html import escape

from traverse_report.language import LANGUAGES, capital, known, num, t

from .forms import examples, forms

PARTS = pathlib.Path(__file__).resolve().parent
NAMES = {"en": "English", "de": "Deutsch", "fr": "Français"}
STATES = {"waiting": "waits", "running": "is being computed", "stopping": "is being stopped", "done": "finished",
          "failed": "failed", "stopped": "stopped"}


def json_element(data):
    """Data for the scripts of a page; nothing in it can end its element."""
    text = json.dumps(data, ensure_ascii=False).replace("<", "\\u003c")
    return f'<script type="application/json" id="data">{text}</script>'


def said(text):
    return escape(capital(t(text)))


def page(root, language, here, title, content, data, scripts=("serve.js",)):
    """A whole page. root: the address up to the token; here: the path behind the language."""
    links = "".join(f'<a href="{root}{language}/{name}"{current(name, here)}>{said(form.title)}</a>'
                    for name, form in forms().items())
    links += f'<a href="{root}{language}/runs"{current("runs", here)}>{said("runs")}</a>'
    languages = "".join(f'<a href="{root}{other}/{here}" hreflang="{other}" lang="{other}" aria-label="{NAMES[other]}"'
                        f'{current(other, language)}>{other.upper()}</a>' for other in LANGUAGES)
    parts = {"language": language, "title": escape(title), "root": root, "links": links, "languages": languages,
             "skip": said("Go to the results") if here.startswith("run") else said("Go to the fields"),
             "menu": said("kinds of computation"), "of_language": said("language"), "content": content,
             "data": json_element(data | {"root": f"{root}{language}/"}), "no_script": said("This page needs JavaScript."),
             "scripts": "".join(f'<script src="{root}asset/{name}"></script>' for name in ("menu.js", *scripts))}
    template = (PARTS / "page.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], template)


def current(name, here):
    return ' aria-current="page"' if name == here or (name == "check" and here == "") else ""


def in_words(text):
    return capital(known(text))


def options_of(choices, chosen, words=in_words):
    """The options of a choice, {value: text}, whose texts `words` translates."""
    return "".join(f'<option value="{escape(value)}"{" selected" if value == chosen else ""}>{escape(words(text))}</option>'
                   for value, text in choices.items())


def control(field, values, option):
    """The element of a field and that of its unit."""
    name = escape(field.name)
    about = f'id="{name}" name="{name}" aria-describedby="about-{name} error-{name}"'
    tip = f' title="{escape(f"-{field.option}: {option.text}; {option.allowed}")}"' if option else ""
    value = values.get(field.name, field.preset)
    if field.kind == "choice":
        return f"<select {about}{tip}>{options_of(field.choices, value)}</select>"
    if field.kind == "flag":
        return f'<input type="checkbox" value="true" {about}{tip}{" checked" if value == "true" else ""}>'
    numeric = ' inputmode="decimal"' if field.kind == "number" and not field.many else ""
    made = (f'<input type="text" autocomplete="off" spellcheck="false" maxlength="200" value="{escape(value)}" '
            f"{about}{tip}{numeric}>")
    if len(field.units) > 1:
        units = {unit: unit.replace("m2", "m²") for unit in field.units}
        chosen = values.get(f"{field.name}:unit", field.units[0])
        made += (f'<select name="{name}:unit" aria-label="{said("unit")}: {said(field.label)}">'
                 f"{options_of(units, chosen, str)}</select>")
    elif field.units:
        made += f'<span class="unit">{escape(field.units[0])}</span>'
    return made


def row(field, values, table):
    """A field with its label, its hint and the place of its message."""
    name = escape(field.name)
    hint = escape(t(field.hint)) if field.hint else ""
    flag = " flag" if field.kind == "flag" else ""
    return (f'<div class="field{flag}" data-field="{name}"><label for="{name}">{said(field.label)}</label>'
            f'<span class="control">{control(field, values, table.get(field.option))}</span>'
            f'<span class="hint" id="about-{name}">{hint}</span>'
            f'<span class="error" id="error-{name}" role="status"></span></div>')


def fields_of(form, values, table):
    made, folded = [], {}
    for heading, fields in form.groups:
        usual = "".join(row(field, values, table) for field in fields if not field.more)
        if usual:
            made.append(f"<fieldset><legend>{said(heading)}</legend>{usual}</fieldset>")
        more = [field for field in fields if field.more]
        folded.setdefault("further fields" if usual else heading, []).extend(more)
    for heading, fields in folded.items():
        if fields:
            opened = " open" if any(values.get(field.name, field.preset) != field.preset for field in fields) else ""
            rows = "".join(row(field, values, table) for field in fields)
            made.append(f"<details{opened}><summary>{said(heading)}</summary>{rows}</details>")
    return "".join(made)


def own_fields(values):
    """The fields of a scene of one's own: its text, its tables, and the scenes of the library."""
    choices = {"": t("example of the library"), **{name: f"{name}: {words}" for name, words in examples().items()}}
    return (f'<div class="field wide-field" data-field="text"><label for="text">{said("scene")}</label>'
            f'<select id="example" aria-label="{said("example of the library")}">{options_of(choices, "", str)}</select>'
            f'<textarea id="text" name="text" rows="22" spellcheck="false" aria-describedby="error-text">'
            f'{escape(values.get("text", ""))}</textarea><span class="error" id="error-text" role="status"></span></div>'
            f'<div class="field wide-field" data-field="files"><label for="files">{said("tables and further files")}</label>'
            '<input type="file" id="files" multiple accept=".csv,.txt,.yml,.yaml" aria-describedby="error-files">'
            '<ul id="sent"></ul><span class="error" id="error-files" role="status"></span></div>')


def form_page(root, language, form, values, table, words):
    inside = own_fields(values) if form.name == "scene" else fields_of(form, values, table)
    content = (f"<h1>{said(form.title)}</h1><p class=\"lead\">{escape(t(form.words))}</p>"
               f'<div class="two"><form id="form" novalidate>{inside}<p id="general" class="error" role="alert"></p>'
               f'<p class="go"><button id="go" type="submit" class="main">{said(form.verb)}</button>'
               f'<span id="cost" class="hint"></span></p></form>'
               f'<section id="side" aria-label="{said("preview")}"><div id="stage" class="card"><canvas id="drawing" role="img" '
               f'aria-label="{said("drawing")}"></canvas></div><p id="drawn" class="hint"></p>'
               f'<dl id="facts" aria-live="polite"></dl><div id="unusual" aria-live="polite"></div>'
               f'<details id="described" hidden><summary>{said("description by the program (in English)")}</summary><pre></pre>'
               "</details></section></div>")
    here = "" if form.name == "check" else form.name
    return page(root, language, here, t(form.title), content, {"form": form.name, "words": words,
                                                               "files": values.get("files", {}) or {}},
                ("format.js", "symbols.js", "places.js", "stage.js", "form.js"))


def links_of(root, language, job, results, report):
    """The buttons of a finished run."""
    base = f"{root}{language}/run/{job.number}/"
    name = f"traverse_{job.form}_{job.number}"
    made = [f'<a class="button" href="{base}scene.zip" download="{name}.zip">{said("download scene")}</a>']
    for kind, words in (("pdf", "report (PDF)"), ("xlsx", "table (XLSX)")):
        ready = "" if report else ' data-make="report"'
        made.append(f'<a class="button" href="{base}file/report.{kind}" download="{name}.{kind}"{ready}>{said(words)}</a>')
    made += [f'<a class="button" href="{base}file/{one}.html" target="_blank">{said("open page")}'
             + (f" ({escape(one.replace('_', ' '))})" if len(results) > 1 else "") + "</a>" for one in results]
    return "".join(made)


def run_page(root, language, job, results, files):
    """The page of a run: its progress, or its results. results: names that have a page; files: names of all its files."""
    title = f"{t(forms()[job.form].title)}, {t('run {number}', number=job.number)}"
    head = f"<h1>{escape(title)}</h1>"
    again = f'<a class="button" href="{root}{language}/{job.form}?from={job.number}">{said("change the input")}</a>'
    if job.state == "done":
        content = f'<div class="run framed">{finished(root, language, job, results, files, head, again)}</div>'
    else:
        content = f'<div class="run"><div class="bar">{head}</div>{unfinished(job, again)}</div>'
    return page(root, language, f"run/{job.number}", title, content, {"run": job.number, "state": job.state, "words": {
        "making": t("The report is being made ..."), "failed": t("The report could not be made: {message}")}})


def finished(root, language, job, results, files, head, again):
    """The bar with the buttons of a run, and the pages of its results."""
    base = f"{root}{language}/run/{job.number}/file/"
    frames = "".join(f'<iframe src="{base}{one}.html" sandbox="allow-scripts" title="{said("result")} {escape(one)}"'
                     f'{"" if i == 0 else " hidden"}></iframe>' for i, one in enumerate(results))
    several = ""
    if len(results) > 1:
        choices = options_of({one: one for one in results}, results[0], str)
        several = f'<label>{said("results")} <select id="which">{choices}</select></label>'
    report = {"report.pdf", "report.xlsx"} <= set(files)
    return (f'<div class="bar">{head}<p class="buttons">{several}{links_of(root, language, job, results, report)}{again}</p>'
            f'<p id="making" role="status"></p>{details(base, job, files)}</div>'
            + (frames or f'<p class="card wait">{escape(job.message())}</p>'))


def unfinished(job, again):
    """The state of a run without results, its button to stop it, and what it has printed."""
    ends = job.state in ("failed", "stopped")
    stop = f'<button id="stop" type="button">{said("stop")}</button>' if job.state in ("waiting", "running") else ""
    lines = escape("\n".join(list(job.lines)[-30:]))
    return (f'<div class="card wait"><p id="state" role="status">{escape(state_in_words(job))}</p>'
            f'<progress id="progress" max="100" aria-label="{said("progress")}"{" hidden" if ends else ""}></progress>'
            f'<p id="line" class="hint"></p><p class="buttons">{stop}{again}</p>'
            f'<pre id="lines"{"" if lines else " hidden"}>{lines}</pre></div>')


def details(base, job, files):
    """What gives the same results on the command line, all files, and what the program has printed."""
    name = "check bridge.yml" if job.form == "check" else "-options_file scene.yml"
    return (f'<details class="small"><summary>{said("on the command line")}</summary><p>'
            f'{escape(t("The same results, in the folder of the downloaded scene:"))} <code>traverse {name}</code></p>'
            f'<p>{said("files")}: ' + ", ".join(f'<a href="{base}{escape(file)}">{escape(file)}</a>' for file in files) + "</p>"
            f'<pre>{escape(chr(10).join(job.lines))}</pre></details>')


def state_in_words(job):
    """One sentence on the state of a run."""
    doing = f"{t(job.what)}, {job.seconds():.0f} s" if job.state == "running" and job.what else t(STATES[job.state])
    said_of = t("run {number}", number=job.number) + f": {doing}"
    if job.verdict:
        said_of += f" ({t(job.verdict)})"
    if job.state == "failed":
        said_of += f". {job.message()}"
    return capital(said_of)


def runs_page(root, language, jobs):
    rows = "".join(
        f'<tr><td><a href="{root}{language}/run/{job.number}">{job.number}</a></td><td>{said(forms()[job.form].title)}</td>'
        f'<td>{said(STATES[job.state])}{f" ({escape(t(job.verdict))})" if job.verdict else ""}</td>'
        f'<td class="number">{num(job.seconds(), ".1f")} s</td></tr>' for job in jobs)
    head = "".join(f"<th>{said(name)}</th>" for name in ("run", "computation", "result", "time"))
    content = f"<h1>{said('runs')}</h1>" + (
        f'<div class="table"><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>' if rows else
        f"<p>{escape(t('Nothing has been computed yet.'))}</p>")
    return page(root, language, "runs", t("runs"), content, {"words": {}})
