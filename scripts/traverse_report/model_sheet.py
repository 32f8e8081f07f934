"""The page of the model: drawings of bridge and train to scale."""

import numpy as np
from engineering_units import shown
from picture_model import draw_forces, draw_foundation, draw_supports, draw_vehicle, vertical_reach

from .language import num, t
from .page import GREY, INK, LEFT, RIGHT

MOST_TRAIN_ROWS = 10
TALLEST = 3.0  # inches, of a drawn vehicle


SYMBOLS = {"pinned": "△", "roller": "○", "clamped": "□", "guided": "◇", "hinge": "∘", "crack": "≀", "separate": "‖"}
KINDS = {"pinned": "pinned support", "roller": "roller support", "clamped": "clamped support",
         "guided": "guided support: moves vertically", "vertical": "vertical spring",
         "gap": "vertical spring below a gap",
         "longitudinal": "longitudinal spring", "rotational": "rotational spring", "hinge": "hinge",
         "crack": "crack, a rotational spring", "free": "free end", "separate": "joint between two decks"}


def draw_bridge(page, source, height=0.42):
    """Draws the bridge with its supports, springs and hinges; spans to scale."""
    model = source.model
    ends = model.span_ends
    ax = page.axes(height, left=0.2, right=0.2, above=0.25, below=0.35)
    ax.axis("off")
    ax.set(xlim=(ends[0] - 0.02 * model.length(), ends[-1] + 0.02 * model.length()), ylim=(-1.0, 1.0))
    ax.plot([ends[0], ends[-1]], [0, 0], color=INK, lw=3.0, solid_capstyle="butt")
    kinds = draw_foundation(ax, model, ends[0], ends[-1]) | draw_supports(ax, model, ends[0], ends[-1])
    spans = np.diff(ends)
    if len(spans) <= 12:
        for left, span in zip(ends[:-1], spans):
            ax.text(left + 0.5 * span, 0.35, f"{num(span)} m", ha="center", va="bottom", fontsize=8, color=INK)
    else:
        ax.text(0.5 * (ends[0] + ends[-1]), 0.35, t("{count} spans, {length} m in total", count=len(spans),
                                                    length=num(model.length(), ".5g")), ha="center",
                va="bottom", fontsize=8, color=INK)
    if kinds:
        said = [f"{SYMBOLS.get(kind, '')} {t(words)}".strip() for kind, words in KINDS.items() if kind in kinds]
        page.text(LEFT, "    ".join(said), size=7.5, colour=GREY)
    page.y -= 0.08


def scale_bar(ax, length, y):
    nice = [step * 10.0 ** power for power in range(0, 5) for step in (1, 2, 5)]
    bar = max([one for one in nice if one <= 0.25 * length] or [length])
    left = ax.get_xlim()[0]
    ax.plot([left, left + bar], [y, y], color=GREY, lw=1.5, solid_capstyle="butt", clip_on=False)
    ax.text(left + bar, y, f"  {bar:.0f} m", color=GREY, fontsize=7, va="center", clip_on=False)


def draw_train(page, source):
    """Draws the whole train to scale, the first vehicle of each type larger; or the forces of each train."""
    model = source.model
    if len(model.train):
        draw_vehicles(page, source)
    elif model.forces:
        draw_force_trains(page, model, source.hslm_trains or model.forces)


def draw_vehicles(page, source):
    model = source.model
    places = [(x + wheel[0], wheel[2]) for index, x in model.train for wheel in model.rows(index, "wheels", 3)]
    if not places:
        return
    low, high = min(x for x, _ in places) - 6.0, max(x for x, _ in places) + 6.0
    width = RIGHT - LEFT - 0.4
    reaches = [vertical_reach(model, index) for index in {int(index) for index, _ in model.train}]
    bottom, top = min(0.0, *(1.05 * low for low, _ in reaches)), max(5.0, *(1.05 * high for _, high in reaches))  # m
    tall = top - bottom
    if len(model.train) > 1:
        page.text(LEFT, t("Train to scale, front on the right: {train}", train=source.train_in_words()), size=8)
        ax = page.axes(max(tall * width / (high - low), 0.12), left=0.2, right=0.2, above=0.05, below=0.3)
        ax.set(xlim=(low, high), ylim=(bottom, top))
        ax.axis("off")
        ax.set_aspect("equal", adjustable="datalim")
        ax.plot([low, high], [0, 0], color=GREY, lw=0.7)
        for index, x in model.train:
            draw_vehicle(ax, model, index, x)
        scale_bar(ax, high - low, bottom - 0.5 * tall)
    for index in list(dict.fromkeys(int(i) for i, _ in model.train))[:2]:
        wheels = model.rows(index, "wheels", 3)
        reach = max(wheels[:, 0].max(), -wheels[:, 0].min()) + 4.0
        page.text(LEFT, t("{vehicle}, to scale; masses {masses}", vehicle=model.type_name(index),
                          masses=masses_in_words(model, index)), size=8)
        inches = min(width, 2.0 * reach / 5.0 * 1.1, 2.0 * reach / tall * TALLEST)
        ax = page.axes(tall * inches / (2.0 * reach), left=0.2 + 0.5 * (width - inches),
                       right=0.2 + 0.5 * (width - inches), above=0.05, below=0.3)
        ax.set(xlim=(-reach, reach), ylim=(bottom, top))
        ax.set_aspect("equal", adjustable="datalim")
        ax.axis("off")
        ax.plot([-reach, reach], [0, 0], color=GREY, lw=0.8)
        draw_vehicle(ax, model, index, 0.0, springs=True)
        scale_bar(ax, 2.0 * reach, bottom - 0.07 * tall)


def masses_in_words(model, index):
    masses = model.rows(index, "bodies", 3)[:, 2]
    unit, factor = shown("mass")
    return " + ".join(f"{num(factor * mass, '.3g')} {unit}" for mass in masses[:8]) + (" + ..." if len(masses) > 8
                                                                                       else "")


def draw_force_trains(page, model, trains):
    names = list(trains)[:MOST_TRAIN_ROWS]
    longest = max(np.ptp(trains[name][:, 0]) for name in names)
    longest = max(longest, 0.5 * model.length(), 1.0)
    some = t("{count} of {all}", count=len(names), all=len(trains))
    left_out = "" if len(names) == len(trains) else f" ({some})"
    page.text(LEFT, t("Moving forces to scale, front on the right; the thick line is the bridge") + left_out, size=8)
    unit, factor = shown("force")
    ax = page.axes(0.27 * (len(names) + 1), left=0.35, right=0.9, above=0.05, below=0.35)
    ax.set(xlim=(-longest, 0.0), ylim=(-1.0, len(names)))
    ax.axis("off")
    for i, name in enumerate(names):
        places, forces = trains[name].T
        y = len(names) - 1.0 - i
        ax.plot([places.min() - places.max(), 0.0], [y, y], color=GREY, lw=0.4)
        draw_forces(ax, places - places.max(), forces, 0.62, y)
        greatest = f"{num(factor * forces.max())} {unit}"
        kilonewtons = f"{len(forces)} × {greatest}" if np.ptp(forces) == 0 else f"{len(forces)} ≤ {greatest}"
        ax.text(0.0, y, f"  {kilonewtons}", fontsize=7, va="bottom", clip_on=False)
        ax.text(-longest, y, f"{'' if name == 'load' else name}  ", fontsize=7.5, va="bottom", ha="right",
                clip_on=False)
    length = min(model.length(), longest)
    ax.plot([-length, 0.0], [-0.5, -0.5], color=INK, lw=3.0, solid_capstyle="butt")
    scale_bar(ax, longest, -0.5)
