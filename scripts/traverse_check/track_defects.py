"""The increase of computed effects by track defects and vehicle imperfections: EN 1991-2 6.4.6.4 and annex C."""

import math

from .rules import rule

# Effects of computed trains, without load models: their limits have the factor.
QUANTITIES = ("deck_acceleration", "deflection_over_span", "end_rotation", "joint_rotation")


def phi_of_track(length, n0, speed):
    """phi'' of EN 1991-2 annex C for a determinant length in m, a first frequency in Hz and a speed in m/s."""
    c = rule("track_defects")
    reached = min(speed / c["full_speed"], 1.0)
    of_short = c["short"] * math.exp(-(length / 10.0) ** 2)
    of_long = c["long"] * (length * n0 / 80.0 - 1.0) * math.exp(-(length / 20.0) ** 2)
    return max(0.0, reached / 100.0 * (of_short + of_long))


def factor(parts, speed, careful):
    """1 + phi'', or 1 + phi''/2 of a carefully maintained track: the largest one of all parts of the bridge."""
    share = 0.5 if careful else 1.0
    return 1.0 + share * max(phi_of_track(part.length, part.n0, speed) for part in parts)


def with_factor(limits, value):
    """Rows of limits with this factor for the effects of trains, unless a row has its own."""
    more = {} if value == 1.0 else {"factor": f"{value:.6g}"}
    return [more | row if row["quantity"] in QUANTITIES else row for row in limits]
