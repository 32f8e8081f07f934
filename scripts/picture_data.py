"""Data for picture.py: a results file, positions and vehicles as text, and the selection of curves."""

import re

import numpy as np
from traverse_report.language import num, span_of, t

MOST_CURVES = 6
MOST_WHEELS = 4
MOST_POINTS = 4000


class Results:
    """The data of a results file for the picture; missing parts are None or empty."""

    def __init__(self, file):
        self.file = file
        self.time = self.values("time")
        # Other datasets of a killed run may have more rows: the length of /time is valid.
        self.rows = 0 if self.time is None else len(self.time)
        self.options = {}
        if "options" in file and file["options"].ndim == 2:
            self.options = {key.lstrip("-"): value for key, value in file["options"].asstr()[:]}
        self.summary = dict(file["summary"].attrs) if "summary" in file else {}
        self.supports = self.values("supports/x")
        self.probes = self.values("probes/x")
        self.eccentricities = self.values("probes/eccentricity")  # of each probe's track, m to the left
        vehicles = file["vehicles"] if "vehicles" in file else {}
        self.vehicles = [vehicles[k] for k in sorted(vehicles, key=int)]

    def values(self, name):
        return self.file[name][()] if name in self.file else None

    def probes_of_tracks(self):
        """{eccentricity in m, or None if no tracks have names: whether each probe is on this track}"""
        if self.eccentricities is None:
            return {None: np.full(len(self.probes), True)}
        return {e: self.eccentricities == e for e in dict.fromkeys(self.eccentricities.tolist())}

    def beside_axis(self, probe):
        """The eccentricity of a probe's track as text, empty if no tracks have names."""
        return "" if self.eccentricities is None else f", e = {num(self.eccentricities[probe], '+.4g')} m"

    def over_time(self, dataset):
        return dataset[: self.rows]

    def scene(self):
        name = self.file.attrs.get("scene", "") or "Run"
        return re.sub(r"\.ya?ml$", "", str(name).split("/")[-1]).replace("_", " ")

    def speed(self):
        for key in ("train_speed", "load_speed"):
            try:
                return speed_of(self.options[key])
            except (KeyError, ValueError):
                continue
        return None

    def support_types(self):
        types = self.options.get("support_types", "").replace(" ", "").split(",")
        count = 0 if self.supports is None else len(self.supports)
        return types if len(types) == count else types[:1] * count


def speed_of(text):
    """The speed in m/s of an option in m/s or km/h; ValueError for other text."""
    text = str(text).strip()
    if text.endswith("km/h"):
        return float(text[:-4]) / 3.6
    return float(text.removesuffix("m/s"))


def natural(name):
    """Sort key: wheel_2 before wheel_10, and front before rear."""
    front = 0 if "front" in name else 2 if "rear" in name else 1
    return [front] + [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]


def ordinal(k, count, noun):
    if count == 1:
        return f"the {noun}"
    return f"first {noun}" if k == 0 else f"last {noun}" if k == count - 1 else f"{noun} {k + 1} of {count}"


def place_in_words(x, supports):
    """A position as text: 'middle of span 1 (12.5 m)'."""
    at, inside = f"{num(x, '.6g')} m", span_of(x, supports)
    if inside is None or (inside[1] is None and len(supports) == 2):
        return t("at {value}", value=at)
    number, part = inside
    if part is None:
        return t("span {number}, at {place}", number=number, place=at)
    words = {0.0: "left end", 0.25: "quarter", 0.5: "middle", 0.75: "three quarters", 1.0: "right end"}
    template = "{part} of the span ({place})" if len(supports) == 2 else "{part} of span {number} ({place})"
    return t(template, part=t(words[part]), number=number, place=at)


def thin(time, values):
    """At most MOST_POINTS points with all peaks: the least and the greatest of each interval."""
    if len(time) <= 2 * MOST_POINTS:
        return time, values
    size = -(-len(time) // (MOST_POINTS // 2))
    starts = range(0, len(time), size)
    keep = sorted({s + int(f(values[s:s + size])) for s in starts for f in (np.nanargmin, np.nanargmax)})
    return time[keep], values[keep]


def spread(wanted, gap, low, high):
    """Positions near the wanted ones, with a distance of at least `gap`, within [low, high]."""
    order = np.lexsort((-np.arange(len(wanted)), np.round(wanted, 1)))  # of equal ones, the first on top
    placed = np.array(wanted, dtype=float)[order]
    for _ in range(200):
        placed = np.clip(placed, low, high)
        for i in range(len(placed) - 1):
            lack = gap - (placed[i + 1] - placed[i])
            if lack > 1e-9:
                placed[i] -= lack / 2
                placed[i + 1] += lack / 2
    result = np.empty_like(placed)
    result[order] = placed
    return result


def choose(count, most, weights):
    """Indices of at most `most` curves: the greatest one, and others at even distances."""
    if count <= most:
        return list(range(count))
    chosen = {int(np.argmax(weights))}
    for i in np.linspace(0, count - 1, most).round().astype(int):
        if len(chosen) < most:
            chosen.add(int(i))
    return sorted(chosen)


def choose_probes(results, peaks):
    """Indices of probes; if there are too many, those at midspans."""
    everywhere = np.arange(len(peaks))
    inside = [span_of(x, results.supports) for x in results.probes] if len(peaks) > MOST_CURVES else []
    middles = np.array([i for i, found in enumerate(inside) if found and found[1] == 0.5], dtype=int)
    candidates = middles if len(middles) > 1 else everywhere
    return [int(candidates[i]) for i in choose(len(candidates), MOST_CURVES, peaks[candidates])]


def envelope(results, series):
    least, greatest = np.full(results.rows, np.inf), np.full(results.rows, -np.inf)
    for values in series:
        np.minimum(least, values, out=least)
        np.maximum(greatest, values, out=greatest)
    return least, greatest


CAR = re.compile("car|body|coach|box")
CALLED_CAR = re.compile(r"\b(car|coach|box)\b")  # but no carriage of a machine, and no body as such


def spaced(name):
    """The name of a part as text: 'front wheel', 'step 41'."""
    return re.sub(r"(?<=[a-z])(\d+)$", r" \1", name.replace("_", " "))


def part_name(vehicle, count, name):
    """The name of a part of a vehicle as text, with the vehicle if there are several: 'first vehicle, front wheel'."""
    return spaced(name) if count == 1 else f"{ordinal(vehicle, count, 'vehicle')}, {spaced(name)}"


def listed_names(results, model, kind, parts):
    """The names of the `parts` (springs, ropes) of a vehicle type."""
    names = results.options.get(f"vehicle_{model.type_name(kind)}_{parts}", "").split(",")
    return [name.strip() for name in names if name.strip()]


def spring_names(results, model, kind):
    """The names of the springs of a vehicle type, in the order of its rows; empty if they are unknown."""
    names = listed_names(results, model, kind, "springs")
    return names if len(names) == len(model.rows(kind, "springs", 6)) else []


def spring_gaps(results):
    """[(x, gap)] of the vertical foundation springs below a gap, m."""
    rows = results.values("model/foundation/vertical")
    return [] if rows is None else [(row[0], row[3]) for row in rows if row[3] > 0.0]


def bodies_of(vehicle):
    return [name for name in vehicle if "acceleration" in vehicle[name] and len(vehicle[name]["position"])]


def car_body(vehicle):
    """The body with a name of a car, otherwise the highest body; None in a vehicle without bodies."""
    bodies = bodies_of(vehicle)
    named = [name for name in bodies if CAR.search(name)]
    return max(named or bodies, key=lambda name: vehicle[name]["position"][0, 1], default=None)
