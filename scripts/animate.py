#!/usr/bin/python3
"""Draws a train that crosses a deflecting bridge: animate.py RESULTS.h5 [-o FILE.gif|.mp4] [--space-time FILE.png]

Bridge, vehicles and moving forces are to scale. Vertical displacements of bridge and vehicles are exaggerated; the
picture contains the factor. Cubic splines connect the stations with stored deflections. An MP4 needs ffmpeg, a GIF
needs no other program. --space-time draws the deflection over position and time, with the path of every wheel.
"""

import argparse
import pathlib
import shutil
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
import output_files  # noqa: E402
from checked_results import in_one_line, opened  # noqa: E402
from matplotlib.animation import FFMpegWriter, PillowWriter  # noqa: E402
from matplotlib.patches import Circle, Polygon  # noqa: E402
from output_files import WRITER, OutputError  # noqa: E402
from picture_axes import COLOURS, GREY, PALE  # noqa: E402
from picture_data import Results  # noqa: E402
from picture_model import BODY, DARK, body_boxes, draw_forces, draw_foundation, draw_supports, vertical_reach  # noqa: E402
from picture_motion import Motion, outline, wheel_places  # noqa: E402
from picture_words import millimetres  # noqa: E402

WIDEST = 260.0      # m, greatest length of track in a picture
MARGIN = 0.15       # ground on either side, as a fraction of the bridge
DRAWN, SWAY = 0.03, 0.08  # greatest deflection and vehicle motion as fractions of the width
FRAMES, RATE = 120, 20  # default number of frames; frames per second
MOST_INSTANTS, MOST_PLACES = 1500, 1000  # of a space-time picture
KINDS = ("gif", "mp4", "png")  # the last one: the first frame alone
SIZE, DPI = (11.0, 4.2), 100
AXES = (10.12, 2.604)  # inches; higher for bodies far below or above the bridge


def rounded(value):
    """The number 1, 2 or 5 times a power of ten below the value, at least 1."""
    if not value > 1.0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= value * (1.0 + 1e-12)))


def chosen_rows(time, start, end, frames):
    """The samples nearest to at most `frames` equidistant instants from start to end."""
    inside = np.flatnonzero((time >= start - 1e-12) & (time <= end + 1e-12))
    if not len(inside):
        raise ValueError(f"--from and --to: no sample there; the run is stored from {time[0]:.6g} to {time[-1]:.6g} s")
    return inside[np.unique(np.linspace(0, len(inside) - 1, frames).round().astype(int))]


class Stage:
    """The common figure of all frames."""

    def __init__(self, motion, exaggeration):
        self.motion = motion
        length = motion.high - motion.low
        self.width = min((1.0 + 2.0 * MARGIN) * length, WIDEST)
        self.factor = exaggeration or rounded(self.width * min(DRAWN / max(motion.greatest(), 1e-12),
                                                               SWAY / max(motion.sway(), 1e-12)))
        self.height = self.width * AXES[1] / AXES[0]
        reach = [vertical_reach(motion.model, kind) for kind, _ in motion.model.train]
        self.low = min([-0.42 * self.height] + [1.1 * low - 0.03 * self.width for low, _ in reach])
        self.high = max([0.58 * self.height] + [1.1 * high for _, high in reach])
        tall = AXES[0] * (self.high - self.low) / self.width  # inches
        self.figure = plt.figure(figsize=(SIZE[0], SIZE[1] - AXES[1] + tall), dpi=DPI)
        inches = self.figure.get_figheight()
        self.ax = self.figure.add_axes([0.05, 0.672 / inches, AXES[0] / SIZE[0], tall / inches])
        self.tall = tall
        results = motion.results
        speed = results.speed()
        self.heading = results.scene() + (f", {3.6 * speed:.4g} km/h" if speed else "")

    def left(self, row):
        """The left end of the picture. It follows the train if the bridge is longer than the picture."""
        motion, middle = self.motion, 0.5 * (self.motion.low + self.motion.high)
        if (1.0 + 2.0 * MARGIN) * (motion.high - motion.low) > self.width:
            places = [body.position[row, 0] for body in motion.bodies] + list(motion.forces(row)[:, 0])
            if places:
                middle = np.clip(0.5 * (min(places) + max(places)), motion.low + 0.35 * self.width,
                                 max(motion.high - 0.35 * self.width, motion.low + 0.35 * self.width))
        return middle - 0.5 * self.width

    def draw(self, row):
        ax, motion = self.ax, self.motion
        ax.clear()
        left = self.left(row)
        right = left + self.width
        ax.set_xlim(left, right)
        ax.set_ylim(self.low, self.high)
        ax.set_yticks([])
        ax.grid(False)
        ax.spines["left"].set_visible(False)
        ax.set_xlabel("place along the track (m)")
        for start, end in ((left, motion.low), (motion.high, right)):
            if end > start:
                ax.plot([start, end], [0.0, 0.0], color=GREY, lw=2.2, solid_capstyle="butt")
        ax.plot([motion.low, motion.high], [0.0, 0.0], color=PALE, lw=0.8, ls=(0, (4, 3)))
        ax.plot(motion.x, self.factor * motion.deflection(row), color=COLOURS[0], lw=3.0, solid_capstyle="butt",
                zorder=5.5)
        for track in range(1, len(motion.tracks)):
            ax.plot(motion.x, self.factor * motion.deflection(row, track), color=COLOURS[0], lw=1.2, zorder=5.4)
        draw_foundation(ax, motion.model, left, right)
        draw_supports(ax, motion.model, left, right)
        self.draw_vehicles(row, left, right)
        forces = motion.forces(row)
        forces = forces[(forces[:, 0] >= left) & (forces[:, 0] <= right)]
        line = np.nan_to_num(motion.deflection(row))
        foot = self.factor * np.interp(forces[:, 0], motion.x, line, left=0.0, right=0.0)
        for place, force, y in zip(forces[:, 0], forces[:, 1], foot):
            draw_forces(ax, [place], [force], 0.2 * self.height, y)
        self.say(row)

    def draw_vehicles(self, row, left, right):
        for shape in outline(self.motion, row, self.factor):
            if shape.points[:, 0].max() < left or shape.points[:, 0].min() > right:
                continue
            if len(shape.points) == 2:
                self.ax.plot(*shape.points.T, color=DARK, lw=1.2, zorder=4)
            elif shape.radius:
                self.ax.add_patch(Circle(shape.points[0], shape.radius, fc="white", ec=DARK, lw=0.8, zorder=6))
            else:
                self.ax.add_patch(Polygon(shape.points, fc=BODY, ec=DARK, lw=0.7, zorder=5, joinstyle="round"))

    def say(self, row):
        ax, motion = self.ax, self.motion
        deepest = max(motion.at_stations[row], key=abs)
        moves = abs(deepest) > 1e-4 * np.abs(motion.at_stations).max()
        where = f"at a station {millimetres(deepest)} {'up' if deepest > 0.0 else 'down'}" if moves else "at rest"
        moved = " of bridge and vehicles" if motion.bodies else ""
        times = f"{self.factor:,.6g} times too large" if self.factor != 1.0 else "to scale"
        for x, y, side, words, looks in (
                (0.0, 0.52, "left", self.heading, {"fontsize": 15, "weight": "bold", "color": "black"}),
                (1.0, 0.52, "right", f"{motion.time[row]:.3f} s", {"fontsize": 15, "color": "black"}),
                (0.0, 0.31, "left", f"Vertical displacements{moved} are drawn {times}; all other dimensions are to scale.", {}),
                (0.0, 0.13, "left", f"Drawn {motion.in_words()}.", {}),
                (1.0, 0.31, "right", where, {"color": COLOURS[0]})):  # y: inches above the axes
            ax.text(x, 1.0 + y / self.tall, words, transform=ax.transAxes, ha=side, va="bottom",
                    **{"fontsize": 9, "color": GREY, **looks})


def writer_of(path, rate):
    if path.suffix == ".gif":
        return PillowWriter(fps=rate)
    if path.suffix == ".png":
        return None
    if not shutil.which("ffmpeg"):
        raise ValueError(f"{path}: an .mp4 needs ffmpeg, which is not installed; a .gif does not")
    return FFMpegWriter(fps=rate, metadata={"comment": WRITER})


def add_name(path):
    """Adds a comment with the name of the program before the end of a GIF file."""
    content = path.read_bytes()
    path.write_bytes(content[:-1] + b"\x21\xfe" + bytes([len(WRITER)]) + WRITER.encode() + b"\x00" + content[-1:])


def animate(motion, path, rows, exaggeration):
    kind = output_files.kind_of(path, KINDS)
    writer = writer_of(path, RATE)
    stage = Stage(motion, exaggeration)
    if writer is None:
        stage.draw(rows[0])
        output_files.save_figure(stage.figure, path, dpi=DPI)
    else:
        with output_files.written(path, kind) as temporary:
            with writer.saving(stage.figure, str(temporary), DPI):
                for row in rows:
                    stage.draw(row)
                    writer.grab_frame()
            if kind == "gif":
                add_name(temporary)
    plt.close(stage.figure)


def space_time(motion, path, rows):
    """Draws deflections over time and position as colours, and wheels and moving forces as lines."""
    figure, ax = plt.subplots(figsize=(11.0, 6.2))
    time = motion.time[rows]
    shown = slice(None, None, -(-len(motion.x) // MOST_PLACES))
    values = 1e3 * (motion.at_stations[rows] @ motion.matrix[shown].T + motion.settled[shown])
    most = max(np.nanmax(np.abs(values)), 1e-12)
    mesh = ax.pcolormesh(time, motion.x[shown], values.T, cmap="RdBu", vmin=-most, vmax=most, shading="nearest",
                         rasterized=True)
    for places in wheel_places(motion, rows):
        ax.plot(time, places, color=DARK, lw=0.6)
    for end in motion.model.span_ends:
        ax.axhline(end, color=GREY, lw=0.9, ls=(0, (4, 3)))
    ax.plot(np.full(len(motion.stations), 1.0), motion.stations, "<", color=DARK, ms=5, clip_on=False,
            transform=ax.get_yaxis_transform())
    ax.grid(False)
    ax.set_facecolor("#D8D8D8")  # spans without a station
    ax.set(xlabel="time (s)", ylabel="place along the bridge (m)", ylim=(motion.low, motion.high))
    if len(time) > 1:
        ax.set_xlim(time[0], time[-1])
    figure.colorbar(mesh, ax=ax, pad=0.03, label="deflection (mm), upward positive")
    what = " and ".join(words for words, there in (("wheels", motion.bodies), ("forces", len(motion.forces(0))))
                        if there)
    lines = f"Thin lines: {what}; " if what else ""
    ax.set_title(f"{motion.results.scene()}: deflection of the bridge over place and time", pad=26)
    ax.text(0.0, 1.02, f"{lines}dashed: span ends; triangles: stations, {motion.in_words()}", transform=ax.transAxes,
            fontsize=9, color=GREY, va="bottom")
    output_files.save_figure(figure, path, dpi=130, bbox_inches="tight")
    plt.close(figure)


def make(given):
    path = pathlib.Path(given.o or pathlib.Path(given.results).with_suffix(".gif"))
    moving = bool(given.o) or not given.space_time
    for one, kinds in ((path, KINDS),) * moving + ((given.space_time, ["png"]),) * bool(given.space_time):
        output_files.check(one, output_files.kind_of(one, kinds), [given.results])
    with opened(given.results) as file:
        motion = Motion(Results(file))
        start = motion.time[0] if given.start is None else given.start
        end = motion.time[-1] if given.end is None else given.end
        written = []
        if given.space_time:
            space_time(motion, given.space_time, chosen_rows(motion.time, start, end, MOST_INSTANTS))
            written.append(given.space_time)
        if moving:
            animate(motion, path, chosen_rows(motion.time, start, end, given.frames), given.exaggeration)
            written.append(path)
        return written


def positive(kind):
    def read(text):
        value = kind(text)
        if not 0 < value < float("inf"):
            raise ValueError
        return value
    read.__name__ = "number above 0"
    return read


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="RESULTS.h5")
    parser.add_argument("-o", metavar="FILE", help=".gif, .mp4, or .png for the first frame; left out: RESULTS.gif")
    parser.add_argument("--exaggeration", type=positive(float), metavar="X", help="of vertical displacements; "
                        f"left out: deflections take {100 * DRAWN:g} %% of the width at most, motions of vehicles "
                        f"{100 * SWAY:g} %%")
    parser.add_argument("--from", dest="start", type=float, metavar="T", help="s; left out: the start")
    parser.add_argument("--to", dest="end", type=float, metavar="T", help="s; left out: the end")
    parser.add_argument("--frames", type=positive(int), default=FRAMES, metavar="N", help=f"left out: {FRAMES}")
    parser.add_argument("--space-time", metavar="FILE.png", help="deflection over place and time; without -o alone")
    given = parser.parse_args()
    try:
        print(*make(given), sep="\n")
    except OutputError as error:
        print(f"animate.py: {error}", file=sys.stderr)
        return 2
    except Exception as error:
        print(f"animate.py: {given.results}: {in_one_line(error)}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    output_files.run(main)
