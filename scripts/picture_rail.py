"""Panels of scene_analysis rail: effects of temperature, weight and braking along the rails."""

from engineering_units import shown
from picture_axes import COLOURS, LABEL_SIZE, PALE, RED
from picture_table import draw_curve

CASES = {"temperature": "temperature", "bending": "the train's weight", "braking": "braking", "traction": "traction",
         "in_sequence": "one after the other", "at_once": "all at once"}


def draw_envelopes(ax, results, quantity, kind, at):
    """Draws least and greatest values of every case along the track, over all positions of the train, in the unit of a
    row of engineering_units.csv."""
    unit, factor = shown(kind)
    ax.set(ylabel=unit, xlabel="place along the track (m)")
    x = results.values(f"rail_forces/{at}")
    for i, (case, words) in enumerate(CASES.items()):
        for side in ("least", "greatest"):
            values = results.values(f"rail_forces/{case}/{side}_{quantity}")
            if values is not None:
                draw_curve(ax, x, factor * values, f"{words}, {side}", color=COLOURS[i % len(COLOURS)],
                           lw=2.2 if case == "in_sequence" else 1.0, label=None if side == "least" else words)
    ax.axhline(0.0, color=PALE, lw=1.0)
    ends = results.values("supports/x")
    for end in (ends[0], ends[-1]):
        ax.axvline(end, color=PALE, lw=1.0)
    beyond = 1.0 * (ends[-1] - ends[0])
    ax.set(xlim=(max(x[0], ends[0] - beyond), min(x[-1], ends[-1] + beyond)))
    ax.legend(loc="center left", bbox_to_anchor=(1.03, 0.5), frameon=False, fontsize=LABEL_SIZE)


def draw_limits(ax, results, signs, factor):
    """Draws the limits of the verdicts. signs: {quantity: 1 or -1}."""
    if "verdicts/limit" not in results.file:
        return
    rows = zip(results.file["verdicts/quantity"].asstr()[:, 0], results.values("verdicts/limit"),
               results.file["verdicts/clause"].asstr()[:, 0])
    for quantity, limit, clause in rows:
        if quantity in signs:
            value = signs[quantity] * factor * limit
            number = f"{value:.4g}".replace("-", "−")
            ax.axhline(value, color=RED, lw=1.2, ls=(0, (6, 2)))
            ax.text(0.008, value, f"limit {number} {ax.get_ylabel()} ({clause})", color=RED, fontsize=8,
                    va="top" if value > 0.0 else "bottom", transform=ax.get_yaxis_transform(),
                    bbox={"fc": "white", "ec": "none", "alpha": 0.8, "pad": 0.6})


def draw_stress(ax, results):
    draw_envelopes(ax, results, "stress", "stress", "x")
    draw_limits(ax, results, {"rail_tension": 1.0, "rail_compression": -1.0}, shown("stress")[1])
    ax.set(title="Additional stress of the rails, least and greatest")


def draw_slip(ax, results):
    draw_envelopes(ax, results, "slip", "displacement", "sleeper_x")
    ax.set(title="Rail relative to deck or ground, least and greatest")


PANELS = (draw_stress, draw_slip)
