#!/usr/bin/python3
"""Draws the model of doc/theory.md, a vehicle on a bridge with its symbols: model_picture.py [OUT.png]"""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
import output_files  # noqa: E402
from matplotlib.patches import Circle, FancyBboxPatch, Polygon  # noqa: E402

BLUE, ORANGE, GREEN, GREY, DARK = "#0072B2", "#D55E00", "#007A59", "#666666", "#222222"
LENGTH = 20.0  # both spans, in units of the picture


def deflection(x):
    """The deflected neutral axis, exaggerated: downward under the vehicle, upward in the other span."""
    return np.where(x < 10.0, -0.55 * np.sin(np.pi * x / 10.0), 0.22 * np.sin(np.pi * (x - 10.0) / 10.0))


def zigzag(ax, start, end, width=0.14, turns=6, colour=DARK):
    start, end = np.array(start), np.array(end)
    along = (end - start) / np.linalg.norm(end - start)
    across = np.array([-along[1], along[0]])
    t = np.linspace(0.0, 1.0, 2 * turns + 3)
    side = np.array([0.0, 0.0] + [(-1.0) ** i for i in range(2 * turns - 1)] + [0.0, 0.0])
    points = start + np.outer(t, end - start) + np.outer(side * width, across)
    ax.plot(points[:, 0], points[:, 1], color=colour, lw=1.2)


def damper(ax, start, end, width=0.13):
    (x, low), high = start, end[1]
    middle = 0.5 * (low + high)
    ax.plot([x, x], [low, middle - 0.1], color=DARK, lw=1.2)
    ax.plot([x - width, x - width, x + width, x + width], [middle + 0.15, middle - 0.1, middle - 0.1, middle + 0.15],
            color=DARK, lw=1.2)
    ax.plot([x - 0.8 * width, x + 0.8 * width], [middle + 0.05] * 2, color=DARK, lw=1.6)
    ax.plot([x, x], [middle + 0.05, high], color=DARK, lw=1.2)


def ground(ax, x, y, width=0.9):
    ax.plot([x - 0.5 * width, x + 0.5 * width], [y, y], color=GREY, lw=1.2)
    for place in np.arange(x - 0.45 * width, x + 0.5 * width, 0.16):
        ax.plot([place, place - 0.1], [y, y - 0.16], color=GREY, lw=0.8)


def arrow(ax, start, end, colour, text="", at=None, **words):
    ax.annotate("", xy=end, xytext=start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.8})
    if text:
        ax.text(*(at or end), text, color=colour, **words)


def draw_bridge(ax):
    x = np.linspace(0.0, LENGTH, 400)
    y = deflection(x)
    ax.plot([-3.5, 0.0], [0.0, 0.0], color=GREY, lw=3)
    ax.plot([LENGTH, LENGTH + 3.0], [0.0, 0.0], color=GREY, lw=3)
    ax.plot([0.0, LENGTH], [0.0, 0.0], color=GREY, lw=0.8, ls=(0, (5, 4)))
    ax.plot(x, y, color=BLUE, lw=5, solid_capstyle="butt")
    for node in np.linspace(0.0, LENGTH, 11):
        ax.plot(node, deflection(node), "o", color="white", mec=BLUE, ms=5, zorder=3)
    ax.add_patch(Polygon([(0.0, -0.1), (-0.35, -0.7), (0.35, -0.7)], fc="white", ec=DARK, zorder=4))
    for place in (10.0, LENGTH):
        ax.add_patch(Circle((place, -0.4), 0.28, fc="white", ec=DARK, zorder=4))
    for place in (0.0, 10.0, LENGTH):
        ground(ax, place, -0.72)
    ax.text(0.0, -1.35, "pinned: held\n$R_c$, eq. 18", ha="center", va="top", fontsize=10)
    ax.text(10.0, -1.35, "roller", ha="center", va="top", fontsize=10)
    place = 3.0
    zigzag(ax, (place - 0.25, -1.9), (place - 0.25, float(deflection(place - 0.25))))
    damper(ax, (place + 0.25, -1.9), (place + 0.25, float(deflection(place + 0.25))))
    ground(ax, place, -1.9, 1.2)
    ax.text(place, -2.2, "$k_p, c_p$ at $x_p$\neqs. 22-24", ha="center", va="top", fontsize=10)
    for place in np.linspace(12.6, 18.0, 7):
        zigzag(ax, (place, -1.5), (place, float(deflection(place))), 0.1)
    ground(ax, 15.3, -1.5, 6.2)
    ax.text(15.3, -1.8, "bed $k_f(x), c_f(x)$, eqs. 26-30", ha="center", va="top", fontsize=10)
    ax.text(15.9, 0.55, "$v(x,t)$ bending, $u(x,t)$ along $x$: $EI(x), EA(x), \\rho A(x)$", color=BLUE, ha="center",
            va="bottom", fontsize=10)
    ax.text(7.6, -0.95, "node: $u, v, \\theta$", color=BLUE, fontsize=10, ha="center", va="top")


def draw_vehicle(ax):
    wheels, radius = (4.2, 7.4), 0.62
    car = FancyBboxPatch((3.2, 3.3), 5.2, 1.25, boxstyle="round,pad=0.08", fc="#F1F1F1", ec=DARK, lw=1.4)
    ax.add_patch(car)
    ax.text(5.8, 3.95, "bodies: mass matrix $N$\ncoordinates $q$", ha="center", va="center", fontsize=10)
    for place in wheels:
        centre = float(deflection(place)) + radius
        ax.add_patch(Circle((place, centre), radius, fc="white", ec=DARK, lw=1.5, zorder=3))
        ax.plot(place, centre, "o", color=DARK, ms=4, zorder=4)
        zigzag(ax, (place - 0.22, centre + 0.05), (place - 0.22, 3.25))
        damper(ax, (place + 0.22, centre + 0.05), (place + 0.22, 3.25))
    ax.text(2.9, 3.0, "joints: $\\Phi(q, t) = 0$,\nreactions $\\lambda$ (eqs. 42-44)\nsprings, actuators: $g$", ha="right",
            va="center", fontsize=10)
    place = wheels[1]
    foot = (place, float(deflection(place)))
    arrow(ax, foot, (foot[0], foot[1] + 1.45), ORANGE, "$f_n$", (foot[0] + 0.75, foot[1] + 1.0), fontsize=13, zorder=6)
    arrow(ax, foot, (foot[0] - 1.2, foot[1] + 0.02), GREEN, "$f_t$", (foot[0] - 1.5, foot[1] + 0.2), fontsize=13,
          zorder=6)
    ax.text(9.3, 2.6, "contact at $x_c$: penetration $\\alpha$, sliding $\\dot\\beta$\n"
            "$f_n$ (eq. 45) and $f_t$ (eq. 49) on the wheel,\nopposite ones on the beam through $S(x_c), T(x_c)$",
            fontsize=10, va="center")
    arrow(ax, (8.7, 4.6), (10.2, 4.6), DARK, "train's speed", (10.35, 4.6), va="center", fontsize=10)


def draw(out):
    figure, ax = plt.subplots(figsize=(14, 6))
    draw_bridge(ax)
    draw_vehicle(ax)
    arrow(ax, (-3.3, 1.2), (-2.0, 1.2), DARK, "$x$", (-1.9, 1.1), fontsize=12)
    arrow(ax, (-3.3, 1.2), (-3.3, 2.5), DARK, "$y$", (-3.25, 2.55), fontsize=12)
    ax.text(-3.5, -0.2, "rigid ground,\nprofile $h(x)$", fontsize=10, color=GREY, va="top")
    ax.set_xlim(-3.8, 23.3)
    ax.set_ylim(-3.2, 5.2)
    ax.set_aspect("equal")
    ax.axis("off")
    output_files.save_figure(figure, out, dpi=110, bbox_inches="tight")
    plt.close(figure)


if __name__ == "__main__":
    draw(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[1] / "doc" / "model.png")
