"""Names and dimensions of the datasets of a results file (doc/results_file.md), which the file does not contain.

The name of a dataset is its path with "_" for "/", without the leading groups probes, sweep and study:
/probes/deflection is `deflection`, /vehicles/0/car/position `vehicles_0_car_position`. Dimensions have the names of
their coordinates.
"""

import re

_BARE = re.compile(r"^/?(?:probes|sweep|study)/")

# Patterns of paths with their dimensions; the first match is used. \1 is the group of the pattern.
_ROWS = [(re.compile(pattern + "$"), tuple(dimensions.split())) for pattern, dimensions in (
    (r"time", "time"),
    (r"probes/x", "x"),
    (r"(?:probes|rail)/\w+", "time x"),
    (r"vehicles/\d+/\w+/(?:position|velocity|acceleration)", "time coordinate"),
    (r"vehicles/\d+/\w+/reaction", "time component"),
    (r"vehicles/\d+/\w+/\w+|energy/\w+", "time"),
    (r"couplers/(\w+)/gap", r"couplers_\1_gap"),
    (r"couplers/(\w+)/\w+", r"time couplers_\1_gap"),
    (r"supports/reaction", "time supports_x component"),
    (r"foundation/(\w+)_bed/\w+", "time span"),
    (r"foundation/(\w+)/(?:force|moment)", r"time foundation_\1_x"),
    (r"outputs/\w+", "time"),
    (r"track/hanging/(?:force|gap)", "time track_hanging_x"),
    (r"track/sleepers/\w+_force", "time track_sleepers_x"),
    (r"balance/\w+", "time direction"),
    (r"envelope/static_deflection", "x"),
    (r"envelope/\w+", "x extreme"),
    (r"shape/\w+", "shape_x"),
    (r"modes/(?:frequency|axial|modal_\w+)", "mode"),
    (r"modes/(?:shape|slope)", "mode modes_x"),
    (r"modes/damped_shape", "damped_mode modes_x part"),
    (r"modes/damp\w+|modes/decay_rate", "damped_mode"),
    (r"(?:supports|modes|foundation/\w+|track/\w+|static)/((?:\w+_)?x)", "own"),
    (r"sweep/(?:speed|added)", "speed"),
    (r"sweep/hslm_a", "hslm_a"),
    (r"sweep/static_deflection", "hslm_a x"),
    (r"sweep/(?:peak_\w+|amplification)", "hslm_a speed x"),
    (r"sweep/judged\w*", "hslm_a speed limit"),
    (r"sweep/\w+", "hslm_a speed"),
    (r"study/(?:peak_\w+|static_deflection|amplification|probes_x)", "run x"),
    (r"study/judged\w*", "run limit"),
    (r"study/statistics/quantiles", "quantile"),
    (r"study/\w+", "run"),
    (r"verdicts/\w+", "limit word"),
    (r"quantities/(peaks|limits)", r"quantity_of_\1 word"),
    (r"(separations|passages|resonances|cancellations)/\w+", r"\1 word"),
    (r"static/load", "static_load word"),
    (r"static/(\w+rotation|reaction)", r"static_load static_\1_x extreme"),
    (r"static/\w+", "static_load static_x extreme"),
)]

# The values along a dimension.
MEANINGS = {
    "coordinate": ["x", "y", "angle"],
    "component": ["fx", "fy", "moment"],
    "direction": ["x", "y"],
    "extreme": ["least", "greatest"],
    "part": ["real", "imaginary"],
}


def name_of(path):
    """The name of the dataset at a path of the results file."""
    return _BARE.sub("", path).strip("/").replace("/", "_")


def dimensions_of(path, rank):
    """The names of the `rank` dimensions of a dataset."""
    path = path.strip("/")
    for row, dimensions in _ROWS:
        fits = row.match(path)
        if fits:
            named = [name_of(path) if d == "own" else fits.expand(d) for d in dimensions][:rank]
            break
    else:
        named = []
    return tuple(named + [f"{name_of(path)}_{i}" for i in range(len(named), rank)])
