"""The natural shapes of a bridge in a picture."""

import numpy as np
from picture_axes import COLOURS, GREY, PALE
from picture_bridge import draw_symbols
from picture_data import MOST_CURVES
from picture_table import draw_curve, keep
from picture_words import modes_in_words


def draw_modes(figure, results):
    """The first mode shapes, two per row; or the frequencies only."""
    frequency, shapes = results.values("modes/frequency"), results.values("modes/shape")
    figure.text(0.06, 0.16 / figure.get_figheight(), modes_in_words(frequency, shapes), fontsize=8.5, color=GREY)
    if shapes is None:
        ax = figure.add_axes([0.1, 0.12, 0.85, 0.7])
        numbers = np.arange(1, len(frequency) + 1)
        ax.set(title="Natural frequencies", ylabel="Hz", xlabel="in ascending order")
        draw_curve(ax, numbers, frequency, "frequency", marker="o", ls="none", color=COLOURS[0])
        return
    axial = results.values("modes/axial")
    x = results.values("modes/x")
    x = np.arange(shapes.shape[1], dtype=float) if x is None else x
    count = min(len(shapes), MOST_CURVES)
    rows = (count + 1) // 2
    for i in range(count):
        ax = figure.add_axes([0.06 + 0.485 * (i % 2), 0.1 + 0.76 * (rows - 1 - i // 2) / rows, 0.43, 0.76 / rows - 0.1])
        ax.axhline(0.0, color=PALE, lw=1.0)
        ax.plot(x, shapes[i], color=COLOURS[0], lw=2.6)
        keep(ax, "shape", x, shapes[i], "1")
        ax.set_ylim(-1.25, 1.25)
        ax.set_yticks([])
        ax.set_xlim(x[0] - 0.02 * np.ptp(x), x[-1] + 0.02 * np.ptp(x))
        draw_symbols(ax, results, x[0], x[-1])
        along = ", along the track" if axial is not None and axial[i] else ""
        ax.set_title(f"{frequency[i]:.4g} Hz{along}" if frequency[i] > 0.0 else f"free motion{along}")
        ax.set_xlabel("place along the track (m)" if "modes/x" in results.file else "node")
        ax.xaxis.label.set_visible(i >= count - 2)
