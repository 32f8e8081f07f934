"""The page of static effects without a dynamic analysis: the largest ones of each load over all its positions."""

from typing import NamedTuple

import numpy as np

from . import curves
from .language import capital, digits, known, num, t
from .page import GREY, LEFT, table
from .quantities import unit_of_si

EFFECTS = {"deflection": "x", "moment": "x", "shear": "x", "track_twist": "x", "reaction": "reaction_x",
           "end_rotation": "end_rotation_x", "joint_rotation": "joint_rotation_x"}
DRAWN = (("deflection", "Deflection, upward positive"), ("moment", "Bending moment, positive in sagging"),
         ("shear", "Shear force, on both sides of passing loads"))


class Peak(NamedTuple):
    """The value of largest magnitude of an effect of a load, without alpha and Phi; in the unit of the file."""
    effect: str
    load: str
    value: float
    x: float
    si: str

    def shown(self, factor=1.0):
        unit, of_unit = unit_of_si(self.si)
        return f"{digits(factor * of_unit * self.value)} {unit}"

    def place(self):
        return f"x = {num(round(self.x, 3))} m"


def peaks(source):
    """The peaks of all effects and loads, in the order of the file."""
    group, found = source.file["static"], []
    for effect, stations in EFFECTS.items():
        if effect not in group or not group[effect].shape[1]:
            continue
        for load, values in zip(source.static_loads(), group[effect][:]):
            station, side = np.unravel_index(np.abs(values).argmax(), values.shape)
            found.append(Peak(effect, load, float(values[station, side]), float(group[stations][station]),
                              str(group[effect].attrs["unit"])))
    return found


def peak_rows(source):
    """Rows (quantity, value, unit, place) of the largest magnitude of each effect, in the unit."""
    rows = []
    for effect in dict.fromkeys(peak.effect for peak in peaks(source)):
        worst = max((peak for peak in peaks(source) if peak.effect == effect), key=lambda peak: abs(peak.value))
        unit, factor = unit_of_si(worst.si)
        rows.append((f"{known(effect.replace('_', ' '))}, {t('static')}", factor * abs(worst.value), unit,
                     f"{worst.load}, {worst.place()}, {t('without α and Φ')}"))
    return rows


def factor_of(source, load):
    """alpha Phi of a load model; None for trains, and if the spans have different Phi."""
    group = source.file["norm"] if "norm" in source.file else {}
    if "phi" not in group or len(np.unique(group["phi"][:])) > 1 or load not in source.load_models():
        return None
    return float(group["phi"][0]) * source.load_models()[load]


def sheet(report, source):
    if not source.is_static:
        return
    page = report.page(t("Static effects of the loads"))
    report.anchor("norm")
    page.text(LEFT, t("The values of largest magnitude over all positions of each load. The classification factor α "
                      "multiplies LM71 and SW/0, the dynamic factor Φ all load models."))
    if "norm" in source.file:
        page.text(LEFT, t("Statement of the program: {words}", words=source.file["norm"].attrs["words"]), colour=GREY)
    page.y -= 0.1
    cells = []
    for peak in peaks(source):
        factor = factor_of(source, peak.load)
        cells.append([capital(known(peak.effect.replace("_", " "))), peak.load, peak.shown(), peak.place(),
                      "" if factor is None else num(factor), "" if factor is None else peak.shown(factor)])
    page = table(report, page, [(t("effect"), 1.4, "left"), (t("load"), 0.8, "left"), (t("static"), 1.2, "right"),
                                (t("position"), 1.2, "left"), ("α · Φ", 0.8, "right"),
                                (t("with α and Φ"), 1.4, "right")], cells)
    draw(report, page, source)


def draw(report, page, source):
    """Draws least and greatest values of each load along the bridge."""
    group, loads = source.file["static"], source.static_loads()
    for name, words in DRAWN:
        if name not in group:
            continue
        page = report.page(page.heading) if page.room() < 2.5 else page
        unit, factor = unit_of_si(str(group[name].attrs["unit"]))
        ax = page.axes(1.6, right=curves.room_for(loads) + 0.6 if len(loads) > 1 else 0.1)
        series = [(load, *(factor * values.T)) for load, values in zip(loads, group[name][:])]
        curves.along_bridge(ax, source.model.span_ends, group["x"][:], series, unit, marks=False)
        ax.axhline(0.0, color=curves.PALE, lw=0.8)
        ax.set_title(f"{t(words)}, {t('without α and Φ')}")
