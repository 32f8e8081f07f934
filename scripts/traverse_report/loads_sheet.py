"""The page of the traffic loads: the trains HSLM-A of the results file, its vehicles or forces, and the static load
models."""

import pathlib

import numpy as np
import yaml
from engineering_units import shown
from picture_model import FORCE, draw_forces

from . import model_sheet
from .language import num, t
from .page import GREY, INK, LEFT, table

ROOM = 4.0  # inches, for the drawing of the train
SAME = 0.011  # m, distances that differ by less are equal


def hslm_row(places, forces):
    """(coaches N, coach length D, axle spacing d, axle force P) of a train of HSLM-A, from its forces."""
    x = np.sort(places)
    two = x[2:] - x[:-2]
    middle = len(x) // 2
    length = two[middle - 1]
    coaches = np.count_nonzero(np.abs(two - length) < SAME) // 2
    return coaches, length, min(np.diff(x)[middle - 2:middle + 1]), np.max(forces)


def hslm_rows(source):
    """One row for each train: name, N, D in m, d in m, P in N, number of axles, total weight in N, length in m."""
    return [(name, *hslm_row(*data.T), len(data), data[:, 1].sum(), np.ptp(data[:, 0]))
            for name, data in source.hslm_trains.items()]


def arrow(ax, a, b, y, words):
    """A dimension line with its text above it."""
    ax.annotate("", xy=(a, y), xytext=(b, y), arrowprops={"arrowstyle": "<|-|>", "lw": 0.7, "color": INK, "shrinkA": 0,
                                                          "shrinkB": 0, "mutation_scale": 6})
    ax.text(0.5 * (a + b), y + 0.08, words, ha="center", va="bottom", fontsize=7)


def draw_hslm(page, source, name):
    """The head of a train to scale: its axle forces, with the coach length and the axle spacing."""
    places, forces = source.hslm_trains[name].T
    x = np.sort(places.max() - places)  # from the front
    _, length, spacing, force = hslm_row(places, forces)
    first = next(i for i in range(len(x) - 2) if abs(x[i + 2] - x[i] - length) < SAME
                 and abs(x[i + 1] - x[i] - spacing) < SAME
                 and i > 3)
    end = x[first + 3] + 3.0
    page.text(LEFT, t("Head of train {name} to scale; distances in m, axle forces in {unit}", name=name,
                      unit=shown("force")[0]), size=8)
    ax = page.axes(0.95, left=0.1, right=0.1, above=0.1, below=0.1)
    ax.axis("off")
    ax.set(xlim=(-3.0, end), ylim=(-1.5, 1.6))
    near = x <= end
    ax.plot([-3.0, end], [0, 0], color=GREY, lw=0.8)
    draw_forces(ax, x[near], np.full(np.count_nonzero(near), force), 0.8)
    ax.text(x[0], 1.0, f"P = {num(shown('force')[1] * force)}", fontsize=7, ha="left", va="bottom", color=FORCE)
    for a, b in zip(x[:first], x[1:first + 1]):
        ax.text(0.5 * (a + b), -0.15, num(b - a, ".5g"), fontsize=6, ha="center", va="top", color=GREY)
    middle = 0.5 * (x[first] + x[first + 1])
    arrow(ax, middle, middle + length, -1.0, f"D = {num(length)}")
    arrow(ax, x[first], x[first + 1], 0.95, f"d = {num(spacing)}")


def of_trains(report, page, source):
    rows = hslm_rows(source)
    if not rows:
        return page
    in_file = len(rows) == 1 or rows[0][0] in source.model.forces  # a study has the forces of its first run only
    page.text(LEFT, t("Load model HSLM-A of EN 1991-2 6.4.6.1.1, as computed; the values follow from the forces of the "
                      "results file." if in_file else
                      "Load model HSLM-A of EN 1991-2 6.4.6.1.1, as computed; the values are those of table 6.3."))
    page.y -= 0.05
    unit, factor = shown("force")
    cells = [[name, str(count), num(length), num(spacing), num(factor * force), str(axles), num(factor * weight, ".6g"),
              num(whole, ".5g")] for name, count, length, spacing, force, axles, weight, whole in rows]
    page = table(report, page,
                 [(t("train"), 0.7, "left"), (t("coaches N"), 0.8, "right"), (t("coach length D (m)"), 1.0, "right"),
                  (t("axle spacing d (m)"), 1.0, "right"),
                  (f"{t('axle force P')} ({unit})", 0.9, "right"),
                  (t("axles"), 0.6, "right"), (f"{t('total weight')} ({unit})", 0.9, "right"),
                  (t("length (m)"), 0.8, "right")], cells)
    draw_hslm(page, source, rows[0][0])
    return page


def draw_load_model(page, name, row):
    """A load model to scale with its numbers."""
    page.text(LEFT, t("{name}, {clause}; forces in kN, loads in kN/m, distances in m", name=name, clause=row["clause"]),
              size=8)
    ax = page.axes(0.75, left=0.1, right=0.1, above=0.05, below=0.1)
    ax.axis("off")
    if "forces" in row:
        at = row["spacing"] * np.arange(len(row["forces"])) - 0.5 * row["spacing"] * (len(row["forces"]) - 1)
        inner = at[-1] + row["distance"]
        loads, reach = [(-inner - 6.0, -inner), (inner, inner + 6.0)], inner + 6.0
        draw_forces(ax, at, np.array(row["forces"], dtype=float), 1.0)
        ax.text(0.0, 1.05, f"{len(row['forces'])} × {num(row['forces'][0])}", ha="center", va="bottom",
                fontsize=7, color=FORCE)
        marks = [-inner, *at, inner]
    else:
        half, (left, right) = 0.5 * row["gap"], row["lengths"]
        loads, reach, marks = [(-half - left, -half),
                               (half, half + right)], half + max(left, right), [-half - left, -half, half, half + right]
    for low, high in loads:
        ax.fill_between([low, high], 0.0, 0.35, color="#E8D3C5", lw=0.0)
        ax.text(0.5 * (low + high), 0.38, num(row["uniform"]), ha="center", va="bottom", fontsize=7, color=FORCE)
    for a, b in zip(marks[:-1], marks[1:]):
        ax.text(0.5 * (a + b), -0.1, num(b - a), ha="center", va="top", fontsize=6.5, color=GREY)
    ax.plot([-reach, reach], [0, 0], color=INK, lw=1.0)
    ax.plot(marks, np.zeros(len(marks)), "|", color=INK, ms=5)
    ax.set(xlim=(-1.08 * reach, 1.08 * reach), ylim=(-0.55, 1.35))


def sheet(report, source):
    """The loads of a file, on a page of their own if they are load models of the norm, otherwise below the
    assumptions."""
    static = source.static_loads()
    models = yaml.safe_load(pathlib.Path(__file__).with_name("load_models.yml").read_text(encoding="utf-8"))
    page = report.pages[-1]
    if static or source.hslm_trains:
        page = of_trains(report, report.page(t("Traffic loads")), source)
    for name in (name for name in models if name in static):
        page = report.page(page.heading) if page.room() < 1.4 else page
        draw_load_model(page, name, models[name])
    if page.room() < ROOM:
        page = report.page(page.heading)
    report.anchor("loads")
    model_sheet.draw_train(page, source)
