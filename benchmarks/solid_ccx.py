"""One run of CalculiX (Debian's calculix-ccx) with a body of solid_mesh.py: its input, and what it printed."""

import os
import re
import shutil
import subprocess
import sys

import numpy as np
import runs

sys.path.insert(0, os.path.join(runs.ROOT, "scripts"))
import convert_calculix  # noqa: E402

NUMBER = r"[-+]?\d\.\d+E[-+]\d+"


def program():
    found = shutil.which("ccx")
    if not found:
        sys.exit(f"{os.path.basename(sys.argv[0])}: ccx is missing; install it with: apt-get install calculix-ccx")
    return found


def rows(words, width=8):
    """Lines of at most so many words."""
    words = [str(word) for word in words]
    return [", ".join(words[i:i + width]) + ("," if i + width < len(words) else "") for i in range(0, len(words), width)]


class Model:
    """Lines of the model of a body; displacements held at nodes, or their mean over a region.

    Directions are 1, 2, 3 along x, y, z.
    """
    share = 1.0  # of the whole body

    def __init__(self, body):
        self.body, self.sets, self.materials = body, {}, 0
        self.lines = ["*NODE, NSET=EVERY"]
        self.lines += [f"{i + 1}, {x:.9g}, {y:.9g}, {z:.9g}" for i, (x, y, z) in enumerate(body.nodes)]
        self.lines.append("*ELEMENT, TYPE=C3D20R, ELSET=BODY")
        for i, element in enumerate(body.elements):
            self.lines += rows([i + 1, *(element + 1)])

    def made_of(self, elements, elastic, poisson, density):
        """Elements, by their indices, of a material."""
        self.materials += 1
        name = f"MATERIAL{self.materials}"
        self.lines += [f"*ELSET, ELSET={name}", *rows(np.asarray(elements) + 1), f"*MATERIAL, NAME={name}",
                       "*ELASTIC", f"{elastic:.9g}, {poisson:.9g}", "*DENSITY", f"{density:.9g}",
                       f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"]

    def name(self, name, nodes):
        self.sets[name] = np.asarray(nodes)
        self.lines += [f"*NSET, NSET={name}", *rows(np.asarray(nodes) + 1)]

    def hold(self, nodes, *directions):
        self.lines += ["*BOUNDARY", *(f"{node + 1}, {way}" for node in nodes for way in directions)]

    def hold_mean(self, region, direction):
        """The mean displacement over a region is 0."""
        nodes, shares = self.body.shares(region)
        first = np.argmax(np.abs(shares))  # the dependent one
        order = np.r_[first, np.delete(np.arange(len(nodes)), first)]
        terms = [word for i in order for word in (nodes[i] + 1, direction, f"{shares[i]:.12g}")]
        self.lines += ["*EQUATION", str(len(nodes)), *rows(terms, 12)]

    def force(self, region, direction, total):
        """Lines of a force with an equal part in each part of the volume of a region."""
        nodes, shares = self.body.shares(region)
        return [f"{node + 1}, {direction}, {total * self.share * share:.12g}" for node, share in zip(nodes, shares)]


class UpperHalf(Model):
    """The upper half of a body that is symmetric about z = 0, as are the vertical forces and what holds it.

    In bending and in torsion the points of this plane move vertically only. Forces, reactions and modes are those of the
    whole body. material: (E, nu, rho).
    """
    share = 0.5

    def __init__(self, body, material):
        super().__init__(body)
        self.made_of(range(len(body.elements)), *material)
        self.hold(body.where(z=0), 1, 2)


def statics(model, loads, folder):
    """For each load, given as lines of forces: {name of a set: displacements of its nodes}, {name: sum of reactions}."""
    steps = []
    for load in loads:
        steps += ["*STEP", "*STATIC", "*CLOAD, OP=NEW", *load]
        for name in model.sets:
            steps += [f"*NODE PRINT, NSET={name}", "U", f"*NODE PRINT, NSET={name}, TOTALS=ONLY", "RF"]
        steps.append("*END STEP")
    text = run(model.lines + steps, folder)
    moved = displacements(text)
    held = re.findall(rf" total force \(fx,fy,fz\) for set (\w+) and time\s+\S+\n\n"
                      rf"\s+({NUMBER})\s+({NUMBER})\s+({NUMBER})", text)
    count = len(model.sets)
    if len(moved) != count * len(loads) or len(held) != len(moved):
        raise RuntimeError(f"{len(moved)} tables of displacements of CalculiX in place of {count * len(loads)}")
    results = []
    for i in range(0, len(moved), count):
        fields = {name: in_order(model.sets[name], block) for name, _, block in moved[i:i + count]}
        results.append((fields, {name: np.array(force, float) / model.share for name, *force in held[i:i + count]}))
    return results


def displacements(text):
    """(name of a set, time, lines of its nodes), in the order in which CalculiX printed them."""
    return re.findall(r" displacements \(vx,vy,vz\) for set (\w+) and time\s+(\S+)\n\n((?:\s+\d+"
                      + 3 * rf"\s+{NUMBER}" + r"\n)+)", text)


def histories(model, steps, folder):
    """(instants, {name of a set: displacements [instant, node, direction]}) of steps, given as lines, that print each set."""
    moved = {name: [] for name in model.sets}
    for name, time, block in displacements(run(model.lines + steps, folder)):
        moved[name].append((float(time), in_order(model.sets[name], block)))
    t = [time for time, _ in next(iter(moved.values()))]
    return np.array(t), {name: np.array([field for _, field in fields]) for name, fields in moved.items()}


def in_order(nodes, block):
    """Displacements in the order of the set's nodes: CalculiX prints them by number."""
    table = np.array([line.split() for line in block.splitlines()], float)
    by_number = dict(zip(table[:, 0].astype(int), table[:, 1:]))
    return np.array([by_number[node + 1] for node in nodes])


def modes(model, count, folder):
    """(frequencies, {name of a set: displacements [mode, node, direction] of modes with the modal mass 1})"""
    wanted = sorted({node for nodes in model.sets.values() for node in nodes})
    lines = ["*NSET, NSET=WRITTEN", *rows(np.array(wanted) + 1), "*STEP", "*FREQUENCY", str(count),
             "*NODE FILE, NSET=WRITTEN", "U", "*END STEP"]
    run(model.lines + lines, folder)
    _, _, found = convert_calculix.read_frd(os.path.join(folder, "body.frd"))
    shapes = {name: [] for name in model.sets}
    for mode in found:
        field = mode.fields["DISP"]
        values = dict(zip(field.ids, field.values / np.sqrt(mode.mass / model.share)))
        for name, nodes in model.sets.items():
            shapes[name].append([values[node + 1] for node in nodes])
    return np.array([mode.frequency for mode in found]), {name: np.array(rows) for name, rows in shapes.items()}


def run(lines, folder):
    """Runs the model in a folder; what it printed in its .dat file."""
    with open(os.path.join(folder, "body.inp"), "w") as file:
        file.write("\n".join(lines) + "\n")
    done = subprocess.run([program(), "body"], cwd=folder, capture_output=True, text=True,
                          env=os.environ | {"OMP_NUM_THREADS": "1"})
    if done.returncode != 0 or "*ERROR" in done.stdout:
        raise RuntimeError("CalculiX failed:\n" + done.stdout[-2000:])
    with open(os.path.join(folder, "body.dat")) as file:
        return file.read()
