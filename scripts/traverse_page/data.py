"""All that a page shows, collected from a results file."""

from numpy.linalg import LinAlgError
from picture_data import Results, opened
from picture_model import Model
from picture_words import speed_in_words, summary_in_words
from traverse_report.source import ReportError, Source

from . import along, histories, runs, stage, tables
from .packing import packed_chart, packed_charts


def kind_in_words(results):
    """What the file contains, in words."""
    analysis = results.options.get("scene_analysis", "")
    if "sweep/speed" in results.file or "study/finished" in results.file or "rail_forces/x" in results.file:
        return Source(results.file.filename).kind_in_words()
    if analysis == "modes":
        return f"{len(results.values('modes/frequency'))} natural modes"
    if results.rows > 1:
        speed = results.speed()
        return ("one run" + (f" at {speed_in_words(speed)}" if speed else "") + f", {results.time[-1]:.5g} s, "
                f"{results.rows:,} samples")
    return {"static": "at rest", "envelope": "largest static effects"}.get(analysis, "one run")


def about(results):
    attrs, said = results.file.attrs, []
    said.append(f"{attrs.get('program', 'traverse')} {attrs.get('version', '')}".strip())
    for what in ("steps", "runs"):
        if attrs.get(what) and "wall_seconds" in attrs:
            said.append(f"{attrs[what]} {what} in {attrs['wall_seconds']:.3g} s")
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
    if not any(found[name] for name in ("stage", "charts", "along", "runs")):
        raise ValueError("contains nothing that can be shown")
    return found


def collected(results):
    limits = tables.limits(results)
    verdicts = tables.verdicts(results, limits)
    shown = [verdicts, *(table(results) for table in (tables.norm, tables.rail, tables.rest, tables.envelope)),
             *tables.pairs(results)]
    return {"title": results.scene(), "kind": kind_in_words(results), "about": about(results),
            "said": unfinished(results) or "; ".join(summary_in_words(results)), "verdict": overall(verdicts),
            "stage": stage.moving(results) if results.rows > 1 else stage.still(results),
            "charts": packed_charts(histories.charts(results), results.time),
            "along": [packed_chart(chart, None) for chart in along.charts(results)],
            "runs": runs.packed_runs(results, limits), "limits": limits, "notes": Model(results).notes,
            "tables": [table for table in shown if table]}


def unfinished(results):
    if results.summary or not results.rows:
        return ""
    return f"the run did not reach its end; shown up to {results.time[-1]:.4g} s"


def overall(verdicts):
    """The verdict on all limits together: its word and a sentence; empty without limits."""
    words = [row[0] for row in verdicts["rows"]] if verdicts else []
    kept, broken = words.count("kept"), words.count("broken")
    open_ones = f", {len(words) - kept - broken} not judged" if kept + broken < len(words) else ""
    if broken:
        return ["broken", f"{broken} of {len(words)} limits broken{open_ones}"]
    if kept:
        return ["kept", f"{kept} of {len(words)} limits kept{open_ones}"]
    return ["not judged", "no limit is judged"] if words else ["", ""]
