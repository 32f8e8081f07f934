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

MODES = 12  # up to 198 Hz


def moving_forces(build, folder, smallest):
    """HSLM-A8 at 456 km/h, where the scene has its largest deflection. Since Traverse adds the static response of the modes
    that it omits and CalculiX does not, both have MODES in place of the scene's three."""
    bridge = peers_rows.Bridge("scenes", "hslm_two_spans")
    train, speed = 8, 126.6666667
    axles, force = solid_train.hslm(train)
    ratio, middles = bridge.options["model"]["damping_ratios"], (bridge.ends[1:] + bridge.ends[:-1]) / 2
    until = 0.5 if smallest else round((axles[-1] + bridge.ends[-1]) / speed, 2)
    strip = peers_strip.Strip(bridge, 40 if smallest else 160)
    used = runs.processor_seconds()
    t, moved = solid_ccx.histories(
        strip, peers_strip.modal_passage(strip, axles, force, speed, MODES, ratio, 5e-4, until), folder)
    used = runs.processor_seconds() - used
    moved = moved["ROAD"][:, [strip.at(x) for x in middles], 2]
    ours = peers_rows.Ours(build, folder, {
        "beam_spans": "20.0,20.0", "beam_EI": bridge.options["beam"]["EI"], "beam_mass": bridge.options["beam"]["mass"],
        "support_types": "pinned,roller,roller", "model_modes": MODES, "model_damping_ratios": ratio, "load_hslm_a": train,
        "load_speed": speed, "ts_max_time": until, "output_interval": 5e-4,
        "output_probes": ",".join(f"{x:g}" for x in middles)})
    return peers_rows.of_peaks("HSLM-A8 at 456 km/h, `hslm_two_spans`", middles, t, moved, used, ours)


def sprung_mass(build, folder, smallest):
    bridge = peers_rows.Bridge("scenes", "r3_sprung_mass")
    vehicle, speed = bridge.options["vehicle"]["sprung_mass"], bridge.options["train"]["speed"]
    until = 0.1 if smallest else 0.998  # within the passage, a multiple of the step
    strip = peers_strip.Strip(bridge, 20)
    mass = peers_strip.SprungMass(strip, vehicle["body"]["mass"], float(vehicle["spring"]["stiffness"]),
                                  speed)
    used = runs.processor_seconds()
    t, moved = solid_ccx.histories(strip, mass.passage(4e-3 if smallest else 1e-3, until), folder)
    used = runs.processor_seconds() - used
    middle = bridge.ends[-1] / 2
    moved = moved["ROAD"][:, [strip.at(middle)], 2]
    ours = peers_rows.Ours(build, folder, {"options_file": bridge.file, "ts_max_time": until})
    return peers_rows.of_peaks("a sprung mass, `r3_sprung_mass`", [middle], t, moved, used, ours)


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
