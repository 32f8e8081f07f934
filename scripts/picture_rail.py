"""Panels of scene_analysis rail: effects of temperature, weight and braking along the rails."""

from picture_axes import COLOURS, LABEL_SIZE, PALE

CASES = {"temperature": "temperature", "bending": "the train's weight", "braking": "braking", "traction": "traction",
         "in_sequence": "one after the other", "at_once": "all at once"}


def draw_envelopes(ax, results, quantity, factor, at):
    """Draws least and greatest values of every case along the track, over all positions of the train."""
    x = results.values(f"rail_forces/{at}")
    for i, (case, words) in enumerate(CASES.items()):
        for side in ("least", "greatest"):
            values = results.values(f"rail_forces/{case}/{side}_{quantity}")
            if values is not None:
                ax.plot(x, factor * values, color=COLOURS[i % len(COLOURS)], label=None if side == "least" else words)
    ax.axhline(0.0, color=PALE, lw=1.0)
    ends = results.values("supports/x")
    for end in (ends[0], ends[-1]):
        ax.axvline(end, color=PALE, lw=1.0)
    beyond = 1.0 * (ends[-1] - ends[0])
    ax.set(xlim=(max(x[0], ends[0] - beyond), min(x[-1], ends[-1] + beyond)), xlabel="place along the track (m)")
    ax.legend(loc="center left", bbox_to_anchor=(1.03, 0.5), frameon=False, fontsize=LABEL_SIZE)


def draw_stress(ax, results):
    draw_envelopes(ax, results, "stress", 1e-6, "x")
    ax.set(title="Additional stress of the rails, least and greatest", ylabel="MPa")


def draw_slip(ax, results):
    draw_envelopes(ax, results, "slip", 1e3, "sleeper_x")
    ax.set(title="Rail relative to deck or ground, least and greatest", ylabel="mm")


PANELS = (draw_stress, draw_slip)
