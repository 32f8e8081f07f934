"""The texts of the page itself, in the language of the report."""

from traverse_report.language import Chosen, capital, t


def words(along):
    """{name: text} for page.html and the scripts. along: the heading of charts that are not over time."""
    return {
        "language": Chosen.language,
        "decimal": "." if Chosen.language == "en" else ",",
        "kept": t("complied with"), "broken": t("exceeded"), "not judged": t("not evaluated"),
        "verdicts": capital(t("verdicts")), "result": t("result"), "value": t("value"), "limit": t("limit"),
        "requirement": t("requirement"), "utilisation": t("utilisation"),
        "beyond": t("beyond this axis: {limits}"), "skip": t("Go to the results"),
        "drawing": t("Drawing"), "play": t("Play"), "pause": t("Pause"), "playKey": t("Play or pause (space)"),
        "back": t("One sample back (left arrow)"), "forth": t("One sample forward (right arrow)"), "time": t("time"),
        "speedOfPlaying": t("Speed of playing"), "realTime": t("{factor} × real time"),
        "frames": t("Drawn: {count} of {all} samples, straight lines between them."),
        "samples": t("Drawn: {count} of {all} samples, with the extremes of each interval."),
        "runs": t("Results of the runs"), "runBack": t("Run before (left arrow)"),
        "runForth": t("Next run (right arrow)"), "ended": t("{count} of {all} runs have ended."),
        "choose": t("Click a point to see its run; drag across a chart to zoom."),
        "differ": t("The curves differ in: {names}."),
        "someRuns": t("Drawn: {count} of {all} runs, with the extremes of each interval."),
        "chosenRun": t("Chosen run: {run}"), "numbered": t("run {number}"), "chosen": t("chosen run"),
        "largest": t("largest of all runs"), "variedOption": t("varied option"), "at": t("at x"),
        "bridge": t("position along the bridge"), "histories": t("Over time"),
        "along": along, "point": t("Point at a pair to see its ratio."),
        "reset": t("Reset zoom"),
        "chartsNote": t("Drag across a chart to zoom in all of them, click to go to an instant, click a name to hide "
                        "its curve. The numbers beside the names are the values at the instant of the drawing."),
        "notes": t("Notes of the program (in English)"), "find": t("Find"),
        "keys": t("Keys: space plays, the arrows step, + and − zoom the charts about the instant, 0 resets the zoom."),
        "caveat": t("Only the limits listed here were evaluated. All other requirements need a separate verification."),
    }
