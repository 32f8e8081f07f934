"""Texts of scenes for the benchmarks, written or drawn at random: bridges, vehicles and speeds as they are built."""

import math
import os
import random

import runs


def beam(spans, EI, mass, supports, damping=None, more=""):
    ratios = f"  damping_ratios: {damping}\n" if damping else ""
    return f"beam:\n  spans: {spans}\n  EI: {EI:g}\n  mass: {mass:g}\n{ratios}{more}support:\n  types: {supports}\n"


def coaches(name, count, speed):
    file = os.path.join(runs.ROOT, "options", "vehicles", name + ".yml")
    return f"vehicle:\n  coach: {{file: {file}}}\ntrain:\n  vehicles: coach*{count}\n  speed: {speed:g}\n"


def car(law, stiffness, body, axle, spring, damper, speed, start=0.0):
    """A mass on a spring and a damper on one wheel: what crosses a bridge in most papers."""
    return f"""vehicle:
  car:
    bodies:  [body, axle]
    joints:  [guide]
    springs: [suspension]
    wheels:  [wheel]
    drivers: [level]
    body:    {{mass: {body:g}, inertia: 1.0, position: [0.0, 2.0]}}
    axle:    {{mass: {axle:g}, inertia: 1.0, position: [0.0, 0.46]}}
    guide:   {{type: prismatic, bodies: [body, axle], point: [0.0, 0.46], axis: [0.0, 1.0]}}
    suspension: {{bodies: [body, axle], from: [0.0, 2.0], to: [0.0, 0.46], stiffness: {spring:g}, damping: {damper:g}}}
    wheel:   {{body: axle, radius: 0.46, law: {law}, stiffness: {stiffness:g}}}
    level:   {{body: body, coordinate: phi}}
train:
  vehicles: car
  positions: {start:g}
  speed: {speed:g}
"""


def with_stop(text, stiffness, gap):
    """The car's scene with a stop beside its spring, which is touched where that is pressed by the gap."""
    return text.replace("springs: [suspension]", "springs: [suspension, stop]").replace(
        "    wheel:   {", f"    stop: {{bodies: [body, axle], from: [0.0, 2.0], to: [0.0, 0.46], stiffness: {stiffness:g}, "
                         f"side: compression, gap: {gap:g}}}\n    wheel:   {{")


def forces(draw, speed):
    """Two to six axles of 50 to 250 kN, 2 to 12 m apart."""
    count = draw.randint(1, 6)
    positions = [0.0]
    for _ in range(count - 1):
        positions.append(round(positions[-1] - draw.uniform(2.0, 12.0), 2))
    weight = draw.uniform(5e4, 2.5e5)
    return f"load:\n  forces: {weight:.4g}*{count}\n  positions: {positions}\n  speed: {speed:g}\n"


def drawn(seed):
    """Name and text of the scene with this number; always the same."""
    draw = random.Random(seed)
    count = draw.choice([1, 1, 1, 2, 3, 4])
    apart = count > 1 and draw.random() < 0.3
    length = math.exp(draw.uniform(math.log(10.0), math.log(60.0)))
    spans = [round(length * (draw.uniform(0.7, 1.3) if count > 1 and not apart else 1.0), 1) for _ in range(count)]
    # First frequency within the band of railway bridges (EN 1991-2, fig. 6.10), mass of a deck of steel to concrete.
    lowest = 80.0 / length if length < 20.0 else 23.58 * length**-0.592
    highest = 94.76 * length**-0.748
    frequency = math.exp(draw.uniform(math.log(min(lowest, highest)), math.log(max(lowest, highest))))
    mass = math.exp(draw.uniform(math.log(2e3), math.log(3e4)))
    EI = mass * (2.0 * frequency * length**2 / math.pi) ** 2
    damping = draw.choice([None, draw.uniform(0.003, 0.02), draw.uniform(0.01, 0.05)])
    ends = ["pinned"] + ["roller"] * count
    if draw.random() < 0.2 and not apart:
        ends[0] = "clamped"
    more = "  continuity: simply_supported\n" if apart else ""
    speed = round(math.exp(draw.uniform(math.log(12.0), math.log(110.0))), 1)
    kind = draw.choice(["coaches", "coaches", "car", "car", "mass", "forces"])
    name = f"{seed}: {count} x {length:.0f} m, "
    if kind == "coaches":
        vehicle, many = draw.choice(["velaro", "s300", "manchester"]), draw.choice([1, 1, 2, 3])
        load = coaches(vehicle, many, speed)
        name += f"{many} {vehicle}"
    elif kind == "forces":
        load = forces(draw, speed)
        name += "forces"
    else:
        hertz = draw.random() < 0.5
        body = math.exp(draw.uniform(math.log(5e3), math.log(4e4)))
        axle = body * math.exp(draw.uniform(math.log(0.02), math.log(0.5)))
        bounce = 2.0 * math.pi * draw.uniform(0.8, 4.0)
        spring = body * bounce**2
        damper = draw.choice([0.0, 2.0 * draw.uniform(0.05, 0.3) * body * bounce])
        if kind == "mass":
            spring *= 1e3
        stiffness = math.exp(draw.uniform(math.log(1e10), math.log(2e11)) if hertz else
                             draw.uniform(math.log(2e6), math.log(2e9)))
        load = car("hertz" if hertz else "linear", stiffness, body, axle, spring, damper, speed,
                   draw.choice([0.0, -2.0, -6.0]))
        name += ("stiff " if kind == "mass" else "") + f"car, {'Hertz' if hertz else 'linear'}"
    tail = draw.choice([0.0, 0.3, 1.0])
    text = beam(spans, EI, mass, "[" + ", ".join(ends) + "]", f"{damping:.4f}" if damping else None, more)
    return f"{name}, {speed:.0f} m/s", text + load + f"scene: {{tail: {tail}}}\n"
