#!/usr/bin/python3
"""Draws a results file on one page: picture.py RESULTS.h5 OUT.png [--formats png,svg,pdf,csv] [--panels LIST]

The page contains the parts that are in the file: the shape of the bridge at the largest deflection, deflections, wheel
forces, accelerations and sensors over time; or mode shapes; or the peaks of a sweep or a study over the speed and the
varied options, with their limits; or the answers of a search; or the effects of uncertain options; or the measurements
of a fit with their computed counterparts. Each curve has a name. The CSV file contains the curves of the picture.
"""

import argparse
import sys

import matplotlib

matplotlib.use("Agg")
import checked_results  # noqa: E402
import output_files  # noqa: E402
import picture_find  # noqa: E402
import picture_fit  # noqa: E402
import picture_page  # noqa: E402
import picture_screen  # noqa: E402
import picture_sensitivity  # noqa: E402
from output_files import OutputError  # noqa: E402
from picture_data import Results  # noqa: E402
from picture_modes import draw_modes  # noqa: E402
from picture_panels import MAY_BE_ASKED, panels  # noqa: E402
from picture_words import method_in_words, speed_in_words, summary_in_words, sweep_in_words  # noqa: E402


def heading_in_words(results, modes_only):
    """The title and the text below it."""
    speed, summary = results.speed(), results.summary
    title = results.scene()
    if modes_only:
        title += ": natural shapes of the bridge"
    elif results.options.get("scene_analysis") == "static":
        title += ", at rest"
    elif results.options.get("scene_analysis") == "envelope":
        title += ", largest static effects"
    elif results.options.get("scene_analysis") == "rail":
        title += ", rail and bridge together (UIC 774-3)"
    elif results.options.get("scene_analysis") == "screen":
        title += ", bridges under trains"
    elif "sweep/speed" in results.file:
        title += f", {sweep_in_words(results)}"
    elif "find/ratio" in results.file:
        words = picture_find.Words(results)
        return f"{title}: {words.title()}", words.intervals(words.search.answers[-1])
    elif "sensitivity/units" in results.file:
        return f"{title}, a sensitivity analysis", picture_sensitivity.method_in_words(results)
    elif "study/finished" in results.file:
        title += f", a study of {len(results.file['study/finished']):,} runs"
    elif "fit" in results.file:
        title += ", a fit to measurements"
    elif speed:
        title += f", {speed_in_words(speed)}"
    said = summary_in_words(results)
    if "fit" in results.file:
        said += picture_fit.fit_in_words(results)
    elif "screen/ratio" in results.file:
        said = [picture_screen.in_words(results)]
    if not summary and results.rows:
        said.append(f"the run did not reach its end; drawn up to {results.time[-1]:.4g} s")
    if modes_only and "modes/shape" in results.file:
        said = ["each scaled to the same height; circles, triangles and squares are supports, zigzags springs"]
    return title, "; ".join(said)


def foot_in_words(results):
    """Program and cost of the run, and the numerical model of a sweep."""
    attrs = results.file.attrs
    foot = f"{attrs.get('program', 'traverse')} {attrs.get('version', '')}"
    for what in ("steps", "runs"):
        if attrs.get(what):
            foot += f", {attrs[what]} {what} in {attrs['wall_seconds']:.3g} s"
    return f"{method_in_words(results)}   {foot}" if "sweep" in results.file else foot


def draw(results, out, asked=(), formats=()):
    """Draws the picture into `out`, or into files of this name with the endings of the formats."""
    found = panels(results, asked)
    modes_only = not found and "modes/frequency" in results.file
    if not found and not modes_only:
        raise ValueError("contains nothing that can be drawn")
    figure, texts = picture_page.new_figure(), (*heading_in_words(results, modes_only), foot_in_words(results))
    if modes_only:
        draw_modes(figure, results)
        picture_page.heading(figure, *texts)
    else:
        picture_page.draw_panels(figure, found, *texts)
    picture_page.save(figure, out, formats)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", help="a results file (HDF5)")
    parser.add_argument("out", help="the picture: .png, .pdf or .svg")
    picture_page.add_formats(parser)
    parser.add_argument("--panels", default="", metavar="LIST",
                        help=f"what the picture shows besides, with commas between: {', '.join(MAY_BE_ASKED)}")
    arguments = parser.parse_args()
    formats = picture_page.listed("picture.py", "formats", arguments.formats, picture_page.FORMATS)
    asked = picture_page.listed("picture.py", "panels", arguments.panels, MAY_BE_ASKED)
    try:
        picture_page.check(arguments.out, formats, [arguments.results])
        with checked_results.opened(arguments.results) as file:
            draw(Results(file), arguments.out, asked, formats)
    except OutputError as error:
        sys.exit(f"picture.py: {error}")
    except Exception as error:
        sys.exit(f"picture.py: {arguments.results}: {checked_results.in_one_line(error)}")


if __name__ == "__main__":
    output_files.run(main)
