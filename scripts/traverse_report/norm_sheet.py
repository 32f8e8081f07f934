"""EN 1991-2: static effects along the bridge, and the verdict of 6.4.6.5."""

import numpy as np
from picture_axes import COLOURS, PALE

from .page import GREY, LEFT, table
from .source import digits

SCALES = {"m": ("mm", 1e3), "N m": ("kN m", 1e-3), "N": ("kN", 1e-3), "rad": ("mrad", 1e3)}
COLUMNS = ("phi_dyn", "phi_dyn_speed", "train_static", "train_dynamic", "train_x", "model_static", "model_with_phi", "model_x",
           "train_over_model")


def verdict_rows(source):
    """The rows of /norm, in SI units: one dictionary for each effect."""
    if "norm/effect" not in source.file:
        return []
    group = source.file["norm"]
    names = zip(*(group[name].asstr()[:].tolist() for name in ("effect", "train", "model", "governs")))
    return [{"effect": effect[0].replace("_", " "), "unit": effect[1], "train": train[0], "model": model[0],
             "governs": governs[0], **{name: float(group[name][i]) for name in COLUMNS}}
            for i, (effect, train, model, governs) in enumerate(names)]


def sentence(source):
    """The governing load in one line; empty without a comparison."""
    rows = verdict_rows(source)
    if not rows:
        return ""
    worst = max(rows, key=lambda row: row["train_over_model"])
    by_train = [row["effect"] for row in rows if row["governs"] == "train"]
    if not by_train:
        return (f"EN 1991-2 6.4.6.5: {worst['model']} with Phi governs all effects; {worst['train']} reaches at most "
                f"{worst['train_over_model']:.3g} of it ({worst['effect']}).")
    return (f"EN 1991-2 6.4.6.5: trains govern {', '.join(by_train)}; at most {worst['train_over_model']:.3g} times "
            f"{worst['model']} with Phi ({worst['effect']}, {worst['train']} at {3.6 * worst['phi_dyn_speed']:.4g} km/h).")


def scaled(value, unit):
    name, factor = SCALES[unit]
    return f"{digits(factor * value)} {name}"


def place(x):
    return f"x = {round(x, 3):.4g} m"


def draw_effect(page, source, name, words, row):
    """Draws least and greatest values along the bridge: static load model and train, and both with their factors."""
    file = source.file
    loads = [text[0] for text in file["static/load"].asstr()[:]]
    x, values = file["static/x"][:], file[f"static/{name}"][:]
    unit, factor = SCALES[file[f"static/{name}"].attrs["unit"]]
    ax = page.axes(2.0, right=0.1)
    for load, colour, with_factor, said in (
            (row["model"], COLOURS[0], row["model_with_phi"] / row["model_static"], "with alpha and Phi"),
            (row["train"], COLOURS[1], row["train_dynamic"] / row["train_static"], "with 1 + φ'dyn + φ''/2")):
        least, greatest = factor * values[loads.index(load)].T
        for curve in (least, greatest):
            ax.plot(x, curve, color=colour, lw=1.0, ls=(0, (4, 2)), label=f"{load} at rest" if curve is least else None)
            ax.plot(x, with_factor * curve, color=colour, lw=1.5, label=f"{load} {said}" if curve is least else None)
    ax.axhline(0.0, color=PALE, lw=0.8)
    ax.set(title=words, ylabel=unit, xlabel="place along the bridge (m)", xlim=(x[0], x[-1]))
    low, high = ax.get_ylim()
    downward = -low > high
    ax.set_ylim((1.35 * low, high) if downward else (low, 1.35 * high))
    ax.legend(fontsize=7, frameon=False, ncol=2, loc="lower center" if downward else "upper center")


def sheet(report, source):
    rows = verdict_rows(source)
    if not rows:
        return
    page = report.page("Trains and load models: EN 1991-2, 6.4.6.5")
    page.text(LEFT, "The larger of (1 + φ'dyn + φ''/2) times the static effect of a train and of Phi times alpha times that "
                    "of LM71, or of SW/0 on continuous bridges, over all positions of the load.", size=8.5)
    page.text(LEFT, str(source.file["norm"].attrs["words"]), size=8.5, colour=GREY)
    page.y -= 0.1
    cells = [[row["effect"], row["train"], f"{row['phi_dyn']:.3f} at {3.6 * row['phi_dyn_speed']:.4g} km/h",
              scaled(row["train_static"], row["unit"]), f"{scaled(row['train_dynamic'], row['unit'])}, {place(row['train_x'])}",
              row["model"], f"{scaled(row['model_with_phi'], row['unit'])}, {place(row['model_x'])}",
              f"{row['train_over_model']:.3f}", row["train"] if row["governs"] == "train" else row["model"]] for row in rows]
    page = table(report, page, [("effect", 0.7, "left"), ("train", 0.4, "left"), ("φ'dyn", 1.15, "left"),
                                ("static", 0.75, "right"), ("dynamic", 1.3, "left"), ("model", 0.45, "left"),
                                ("with Phi", 1.15, "left"), ("ratio", 0.4, "right"), ("governs", 0.5, "left")], cells, size=7)
    page.text(LEFT, "φ'dyn is the greatest of all speeds, and of the probes with at least a quarter of the greatest static "
                    "effect; shear, reactions and rotations have the factor of the deflection.", size=8, colour=GREY)
    page.y -= 0.1
    known = {row["effect"]: row for row in rows}
    for name, words in (("deflection", "Deflection, upward positive"), ("moment", "Bending moment, positive in sagging")):
        if name in known:
            draw_effect(page, source, name, words, known[name])


def workbook_rows(source):
    """Head and rows of the verdict of EN 1991-2 6.4.6.5."""
    rows = verdict_rows(source)
    head = ["effect", "unit", "train", "model", "governs", *COLUMNS]
    return head, [[row[name] for name in head] for row in rows]


def static_rows(source):
    """Head and rows: least and greatest deflection, moment and shear of every load along the bridge."""
    file = source.file
    if "static/x" not in file:
        return [], []
    loads, names = [text[0] for text in file["static/load"].asstr()[:]], ("deflection", "moment", "shear")
    head = ["x (m)"] + [f"{side} {name} of {load} ({file[f'static/{name}'].attrs['unit']})" for load in loads for name in names
                        for side in ("least", "greatest")]
    columns = [file[f"static/{name}"][load, :, side] for load in range(len(loads)) for name in names for side in (0, 1)]
    return head, np.column_stack([file["static/x"][:], *columns]).tolist()
