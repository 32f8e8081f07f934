"""All that a page shows, collected from a results file."""

from checked_results import opened
from numpy.linalg import LinAlgError
from picture_data import Results
from picture_model import Model
from picture_words import speed_in_words, summary_in_words
from traverse_report import language
from traverse_report.front_sheet import outcome
from traverse_report.language import num, t
from traverse_report.limits import stored
from traverse_report.source import ReportError, Source

from . import along, heat, histories, runs, stage, tables
from .packing import packed_chart, packed_charts
from .words import words


def kind_in_words(results):
    """What the file contains, in words."""
    analysis = results.options.get("scene_analysis", "")
    if any(name in results.file for name in ("sweep/speed", "study/finished", "rail_forces/x", "fit/estimate",
                                             "screen/ratio")):
        return Source(results.file.filename).kind_in_words()
    if analysis == "modes":
        return t("{count} natural modes", count=len(results.values("modes/frequency")))
    if results.rows > 1:
        speed = results.speed()
        run = t("one run at {speed}", speed=speed_in_words(speed)) if speed else t("one run")
        return t("{run}, {time} s, {count} samples", run=run, time=num(results.time[-1], ".5g"), count=results.rows)
    return {"static": t("at rest"), "envelope": t("largest static effects")}.get(analysis, t("one run"))


def about(results):
    attrs, said = results.file.attrs, []
    said.append(f"{attrs.get('program', 'traverse')} {attrs.get('version', '')}".strip())
    for what in ("steps", "runs"):
        if attrs.get(what) and "wall_seconds" in attrs:
            said.append(t("{count} steps in {time} s" if what == "steps" else "{count} runs in {time} s", count=attrs[what],
                          time=num(attrs["wall_seconds"], ".3g")))
    return ", ".join(said)


def collect(path):
    """The data of the page of a results file; ValueError if there is nothing to show or the file cannot be read."""
    with opened(path) as file:
        if file.attrs.get("program", "traverse") != "traverse":
            raise ValueError("is no results file of traverse")
        try:
            found = collected(Results(file))
        except ReportError as error:
            raise ValueError(str(error)) from None
        except (LookupError, TypeError, AttributeError, ValueError, LinAlgError) as error:
            raise ValueError(f"contains data of another form than traverse writes ({error})") from None
    if not any(found[name] for name in ("stage", "charts", "along", "runs", "heat")):
        raise ValueError("contains nothing that can be shown")
    return found


def collected(results):
    asked = results.options.get("report_language", "en")
    language.choose(asked if asked in language.LANGUAGES else "en")
    limits, verdicts = tables.limits(results), stored(results.file)
    shown = [tables.verdicts(results, limits, verdicts),
             *(table(results) for table in (tables.search, tables.statistics, tables.sensitivity, tables.fit,
                                            tables.screen, tables.norm, tables.rail, tables.rest, tables.envelope)),
             *tables.pairs(results)]
    of_runs = runs.packed_runs(results, limits)
    travels = of_runs is not None and of_runs["speeds"] is not None
    return {"title": results.options.get("report_structure") or results.scene(), "kind": kind_in_words(results),
            "about": about(results), "said": unfinished(results) or t("; ").join(summary_in_words(results)), "verdict": overall(verdicts),
            "words": words(along.heading(results)), "heat": heat.heat(results),
            "stage": stage.moving(results) if results.rows > 1 else stage.still(results, travels),
            "charts": packed_charts(histories.charts(results), results.time),
            "along": [packed_chart(chart, None) for chart in along.charts(results)],
            "runs": of_runs, "limits": limits, "notes": Model(results).notes,
            "tables": [table for table in shown if table]}


def unfinished(results):
    if results.summary or not results.rows:
        return ""
    return t("the run did not reach its end; shown up to {time} s", time=num(results.time[-1]))


def overall(verdicts):
    """The verdict on all limits together: its word and a sentence; empty without limits."""
    words = [verdict.word for verdict in verdicts]
    word = next((word for word in ("broken", "kept", "not judged") if word in words), "")
    return [word, outcome(verdicts)[0] if word else ""]
