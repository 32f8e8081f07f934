"""EN 1991-2: static effects along the bridge, and the verdict of 6.4.6.5."""

import numpy as np
from picture_axes import COLOURS, PALE

from .language import digits, known, num, t
from .page import GREY, LEFT, table
from .quantities import speed_in_words, unit_of_si

COLUMNS = ("phi_dyn", "phi_dyn_speed", "train_static", "train_dynamic", "train_x", "model_static", "model_with_phi",
           "model_x",
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


def trains_govern(source):
    """Whether the trains govern over the load models in an effect."""
    return any(row["governs"] == "train" for row in verdict_rows(source))


def sentence(source):
    """The governing load in one line; empty without a comparison."""
    rows = verdict_rows(source)
    if not rows:
        return ""
    worst = max(rows, key=lambda row: row["train_over_model"])
    by_train = [row["effect"] for row in rows if row["governs"] == "train"]
    if not by_train:
        return t("EN 1991-2 6.4.6.5: {model} with Φ governs all effects; {train} reaches at most {ratio} of it "
                 "({effect}).",
                 ratio=num(worst["train_over_model"], ".3f"), effect=known(worst["effect"]), model=worst["model"],
                 train=worst["train"])
    return t("EN 1991-2 6.4.6.5: the trains govern these effects: {effects}. The greatest ratio to {model} with Φ is "
             "{ratio} ({effect}, {train} at {speed}).", effects=", ".join(map(known, by_train)), model=worst["model"],
             ratio=num(worst["train_over_model"], ".3f"), effect=known(worst["effect"]), train=worst["train"],
             speed=speed_in_words(worst["phi_dyn_speed"]))


def scaled(value, unit):
    name, factor = unit_of_si(unit)
    return f"{digits(factor * value)} {name}"


def place(x):
    return f"x = {num(round(x, 3))} m"


def draw_effect(page, source, name, words, row):
    """Draws least and greatest values along the bridge: static load model and train, and both with their factors."""
    file = source.file
    loads = [text[0] for text in file["static/load"].asstr()[:]]
    x, values = file["static/x"][:], file[f"static/{name}"][:]
    unit, factor = unit_of_si(file[f"static/{name}"].attrs["unit"])
    ax = page.axes(2.0, right=0.1)
    for load, colour, with_factor, said in (
            (row["model"], COLOURS[0], row["model_with_phi"] / row["model_static"], t("with α and Φ")),
            (row["train"], COLOURS[1], row["train_dynamic"] / row["train_static"],
             t("with {factor}", factor="1 + φ′dyn + φ″/2"))):
        least, greatest = factor * values[loads.index(load)].T
        for curve in (least, greatest):
            ax.plot(x, curve, color=colour, lw=1.0, ls=(0, (4, 2)), label=f"{load} {t('static')}" if curve is least
                    else None)
            ax.plot(x, with_factor * curve, color=colour, lw=1.5, label=f"{load} {said}" if curve is least else None)
    ax.axhline(0.0, color=PALE, lw=0.8)
    ax.set(title=words, ylabel=unit, xlabel=t("position along the bridge (m)"), xlim=(x[0], x[-1]))
    low, high = ax.get_ylim()
    downward = -low > high
    ax.set_ylim((1.35 * low, high) if downward else (low, 1.35 * high))
    ax.legend(fontsize=7, frameon=False, ncol=2, loc="lower center" if downward else "upper center")


def sheet(report, source):
    rows = verdict_rows(source)
    if not rows:
        return
    page = report.page(t("Dynamic verdict by EN 1991-2, 6.4.6.5"))
    report.anchor("norm")
    page.text(LEFT, t("The design value is the larger of (1 + φ′dyn + φ″/2) times the static effect of a train and Φ · "
                      "α times the effect of LM71, or of SW/0 on continuous bridges, over all positions of the load."))
    page.text(LEFT, t("Statement of the program: {words}", words=source.file["norm"].attrs["words"]), colour=GREY)
    page.y -= 0.1
    cells = [[known(row["effect"]), row["train"],
              f"{num(row['phi_dyn'], '.3f')}, {speed_in_words(row['phi_dyn_speed'])}",
              scaled(row["train_static"], row["unit"]),
              f"{scaled(row['train_dynamic'], row['unit'])}, {place(row['train_x'])}",
              row["model"], f"{scaled(row['model_with_phi'], row['unit'])}, {place(row['model_x'])}",
              num(row["train_over_model"], ".3f"), row["train"] if row["governs"] == "train" else row["model"]]
             for row in rows]
    page = table(report, page,
                 [(t("effect"), 0.8, "left"), (t("train"), 0.38, "left"), (t("φ′dyn, speed"), 1.0, "left"),
                  (t("static"), 0.65, "right"), (t("with dynamic increment"), 1.26, "left"),
                  (t("model"), 0.43, "left"),
                  (t("with α and Φ"), 1.2, "left"), (t("ratio"), 0.53, "right"),
                  (t("governs"), 0.55, "left")],
                 cells, size=6.5)
    page.text(LEFT, t("φ′dyn is the greatest value of all speeds and of the stations with at least a quarter of the "
                      "greatest static effect. Shear forces, bearing forces and rotations have the factor of the "
                      "deflection."), size=8,
              colour=GREY)
    page.y -= 0.1
    found = {row["effect"]: row for row in rows}
    for name, words in (("deflection", "Deflection, upward positive"),
                        ("moment", "Bending moment, positive in sagging")):
        if name in found:
            draw_effect(page, source, name, t(words), found[name])


def workbook_rows(source):
    """Head and rows of the verdict of EN 1991-2 6.4.6.5; the row of each effect is in its own unit."""
    head = [t("effect"), t("unit"), t("train"), t("load model"), t("governs"), "φ′dyn",
            f"{t('speed')} ({unit_of_si('m/s')[0]})",
            t("train, static"), t("train, with dynamic increment"), t("train, position x (m)"), t("load model, static"),
            t("load model, with α and Φ"), t("load model, position x (m)"), t("ratio")]
    found = []
    for row in verdict_rows(source):
        unit, factor = unit_of_si(row["unit"])
        factors = {"phi_dyn_speed": unit_of_si("m/s")[1],
                   **dict.fromkeys(("train_static", "train_dynamic", "model_static", "model_with_phi"), factor)}
        found.append([known(row["effect"]), unit, row["train"], row["model"], row[row["governs"]],
                      *(factors.get(name, 1.0) * row[name] for name in COLUMNS)])
    return head, found


def static_rows(source):
    """Head and rows: least and greatest deflection, moment and shear of every load along the bridge."""
    file = source.file
    if "static/x" not in file:
        return [], []
    loads, names = [text[0] for text in file["static/load"].asstr()[:]], ("deflection", "moment", "shear")
    units = {name: unit_of_si(file[f"static/{name}"].attrs["unit"]) for name in names}
    head = ["x (m)"] + [t(": ").join((load, f"{t(side)}, {known(name)} ({units[name][0]})")) for load in loads for name in names
                        for side in ("least", "greatest")]
    columns = [units[name][1] * file[f"static/{name}"][load, :, side] for load in range(len(loads)) for name in names
               for side in (0, 1)]
    return head, np.column_stack([file["static/x"][:], *columns]).tolist()
