#!/usr/bin/python3
"""Three scenes by CalculiX and by Traverse: values and processor seconds side by side.
/usr/bin/python3 benchmarks/peers_calculix.py [BUILD_FOLDER] [OUT_FOLDER] [--smallest] [--write]

A train of moving forces on two continuous spans by modes, a sprung mass in contact with its bridge by direct integration,
and the frequencies of a haunched bridge of three spans. CalculiX (ccx of Debian's calculix-ccx) has each bridge as a thin
strip of quadratic hexahedra. Prints the table, writes peers_calculix.csv to OUT_FOLDER and, with --write, the table to
doc/comparison.md. Traverse chooses mesh and step for an error of 1e-4. Takes half a minute of one core.
"""

import tempfile

import peers_rows
import peers_strip
import runs
import solid_ccx
import solid_train

# HSLM-A8 at 456 km/h, where its scene has the largest deflection. Since Traverse adds the static response of the modes that
# it omits and CalculiX does not, both have twelve modes, up to 198 Hz, in place of the scene's three.
TRAIN, SPEED, MODES, STEP = 8, 126.6666667, 12, 5e-4


def forces_by_traverse(build, folder, bridge, until):
    beam = bridge.options["beam"]
    return peers_rows.Ours(build, folder, {
        "beam_spans": "20.0,20.0", "beam_EI": beam["EI"], "beam_mass": beam["mass"], "support_types": "pinned,roller,roller",
        "model_modes": MODES, "model_damping_ratios": bridge.options["model"]["damping_ratios"], "load_hslm_a": TRAIN,
        "load_speed": SPEED, "ts_max_time": until, "output_interval": STEP,
        "output_probes": ",".join(f"{x:g}" for x in bridge.middles)})


def moving_forces(build, folder, smallest):
    bridge = peers_rows.Bridge("scenes", "hslm_two_spans")
    axles, force = solid_train.hslm(TRAIN)
    until = 0.5 if smallest else round((axles[-1] + bridge.ends[-1]) / SPEED, 2)
    strip = peers_strip.Strip(bridge, 40 if smallest else 160)
    used = runs.processor_seconds()
    t, moved = solid_ccx.histories(strip, peers_strip.modal_passage(
        strip, axles, force, SPEED, MODES, bridge.options["model"]["damping_ratios"], STEP, until), folder)
    used = runs.processor_seconds() - used
    moved = moved["ROAD"][:, [strip.at(x) for x in bridge.middles], 2]
    ours = forces_by_traverse(build, folder, bridge, until)
    return peers_rows.of_peaks("HSLM-A8 at 456 km/h, `hslm_two_spans`", bridge.middles, t, moved, used, ours)


def sprung_mass(build, folder, smallest):
    bridge = peers_rows.Bridge("scenes", "r3_sprung_mass")
    vehicle, speed = bridge.options["vehicle"]["sprung_mass"], bridge.options["train"]["speed"]
    until = 0.1 if smallest else 0.998  # within the passage, a multiple of the step
    strip = peers_strip.Strip(bridge, 20)
    mass = peers_strip.SprungMass(strip, vehicle["body"]["mass"], float(vehicle["spring"]["stiffness"]), speed)
    used = runs.processor_seconds()
    t, moved = solid_ccx.histories(strip, mass.passage(4e-3 if smallest else 1e-3, until), folder)
    used = runs.processor_seconds() - used
    moved = moved["ROAD"][:, [strip.at(bridge.middles[0])], 2]
    ours = peers_rows.Ours(build, folder, {"options_file": bridge.file, "ts_max_time": until})
    return peers_rows.of_peaks("a sprung mass, `r3_sprung_mass`", bridge.middles, t, moved, used, ours)


def frequencies(build, folder, smallest):
    bridge = peers_rows.Bridge("bridges", "haunched")
    strip = peers_strip.Strip(bridge, 48 if smallest else 192)
    used = runs.processor_seconds()
    theirs, _ = solid_ccx.modes(strip, 5, folder)
    return peers_rows.of_modes(build, folder, bridge, theirs, runs.processor_seconds() - used)


def main():
    given = runs.given(peers_rows.parser(__doc__))
    solid_ccx.program()
    rows = []
    for scene in (moving_forces, sprung_mass, frequencies):
        with tempfile.TemporaryDirectory() as folder:
            rows += scene(given.build, folder, given.smallest)
    peers_rows.tell("peers_calculix", "CalculiX", rows, given)


if __name__ == "__main__":
    main()
