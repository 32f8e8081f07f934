#!/usr/bin/python3
"""Times VBI-2D and TTB-2D under Octave on this machine: processor seconds of their time loops and of their whole runs.
/usr/bin/python3 benchmarks/peers_here.py VBI_2D_FOLDER TTB_2D_FOLDER [OUT_FOLDER] [ROUNDS]; writes peers_here.csv,
which benchmarks/peers.py takes the peers' seconds from when it is in its own OUT_FOLDER.

The folders hold the peers' own sources (github.com/DanielCanteroNTNU/VBI-2D and TTB-2D), which are run as they are,
with the inputs of the scenes R3 and R8 and without their pictures. A round runs every case once; the median is taken.
The whole run is that from the first line of input to the last result, without the start of Octave.
"""

import argparse
import os
import shutil
import statistics
import subprocess
import tempfile

import runs

# The sprung mass of options/scenes/r3_sprung_mass.yml, at {elements} elements and 1,000 steps a second.
SPRUNG_MASS = """
Veh(1).Model.type = 'Sprung_mass';
Veh(1).Prop.mGj = 5750; Veh(1).Prop.kTk = 1595e3; Veh(1).Prop.cTk = 0;
Veh(1).Pos.x0 = 0; Veh(1).Pos.vel = 25;
Beam.Prop.Lb = 25; Beam.Prop.rho = 18358; Beam.Prop.E = 3.5e10; Beam.Prop.I = 1.3901; Beam.Prop.damp_per = 0;
Beam.BC.loc = [0, Beam.Prop.Lb]; Beam.BC.vert_stiff = [Inf, Inf]; Beam.BC.rot_stiff = [0, 0];
Beam.Mesh.Ele.num = {elements};
Calc.Profile.type = 0; Calc.Solver.t_steps_per_second = 1000;
Calc.Opt.verbose = 0; Calc.Opt.show_progress_every_s = 1e9; Calc.Plot = struct();
"""
ELEMENTS = (60, 960)
# options/scenes/r8_ballasted_bridge.yml is the peer's own example but for the smooth rail.
COACH = """
A01_Train; A02_Track; A03_Bridge; A04_Options;
Calc = rmfield(Calc, {'Profile', 'Plot'});
Calc.Profile.Type = 0; Calc.Profile.minL_Approach = 30; Calc.Profile.minL_After = 30; Calc.Plot = struct();
"""


# What MATLAB has and Octave 7 has not: digits of round, where progress is shown, and another name of fieldnames.
MISSING = {
    "round.m": "function y = round(x, varargin)\n  y = builtin('round', x);\nend\n",
    "fields.m": "function names = fields(of)\n  names = fieldnames(of);\nend\n",
}
# The rail has no supports; Octave gives an index that is empty another shape than MATLAB does.
NO_RAIL_SUPPORTS = ("B55_ModelBC(", "Track.Rail.BC.DOF_fixed = zeros(1, 0);")


def driver(folder, inputs, calculations, loop, left_out, before=()):
    """Octave's text: the inputs, then the peer's own calculations with clocks about the call of `loop`.

    left_out: calls of pictures; before: a call, and the line that goes before it."""
    with open(os.path.join(folder, calculations), encoding="latin-1") as file:
        lines = [line for line in file.read().splitlines() if not any(name in line for name in left_out)]
    calls = [i for i, line in enumerate(lines) if loop + "(" in line and not line.lstrip().startswith("%")]
    if len(calls) != 1:
        raise SystemExit(f"peers_here.py: {calculations} of {folder} calls {loop} {len(calls)} times, once is expected: another version?")
    lines.insert(calls[0] + 1, "our_loop = cputime() - our_loop;")
    lines.insert(calls[0], "our_loop = cputime();")
    if before:
        lines = [text for line in lines for text in ([before[1]] if before[0] in line else []) + [line]]
    return "\n".join([
        "warning('off', 'all'); more off;", f"cd('{os.path.abspath(folder)}'); addpath(fullfile(pwd, 'Functions'));",
        "our_start = cputime();", inputs, *lines,
        r"fprintf('\nour seconds %.6g %.6g %d\n', our_loop, cputime() - our_start, %STEPS%);"])


def seconds(text, steps):
    """Of the loop and of the whole run, and the number of instants."""
    with tempfile.TemporaryDirectory() as folder:
        for name, lines in (MISSING | {"run_the_peer.m": text.replace("%STEPS%", steps)}).items():
            with open(os.path.join(folder, name), "w", encoding="latin-1") as file:
                file.write(lines)
        ran = subprocess.run(["octave-cli", "--no-history", "--norc", "--path", folder,
                              os.path.join(folder, "run_the_peer.m")], capture_output=True, text=True,
                             errors="replace", env=os.environ | {"OMP_NUM_THREADS": "1"})
    told = [line.split() for line in ran.stdout.splitlines() if line.startswith("our seconds")]
    if ran.returncode != 0 or not told:
        raise SystemExit(f"peers_here.py: Octave could not run the peer:\n{ran.stderr[-2000:]}")
    return float(told[0][2]), float(told[0][3]), int(told[0][4])


def cases(vbi, ttb):
    for elements in ELEMENTS:
        yield (f"R3, {elements} elements", "VBI-2D", "numel(Calc.Solver.t)",
               driver(vbi, SPRUNG_MASS.format(elements=elements), "A02_Calculations.m", "B49_Coup_solver", []))
    yield ("R8, ballasted bridge", "TTB-2D", "Calc.Solver.num_t",
           driver(ttb, COACH, "B00_Calculations.m", "B65_DynamicCalcCoupledFaster", ["B67_Plot", "B57_Plot"],
                  NO_RAIL_SUPPORTS))


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("vbi", metavar="VBI_2D_FOLDER")
    arguments.add_argument("ttb", metavar="TTB_2D_FOLDER")
    arguments.add_argument("out", nargs="?", default="results", metavar="OUT_FOLDER")
    arguments.add_argument("rounds", nargs="?", type=int, default=3, metavar="ROUNDS")
    given = arguments.parse_args()
    for folder, file in (given.vbi, "A02_Calculations.m"), (given.ttb, "B00_Calculations.m"):
        if not os.path.isfile(os.path.join(folder, file)):
            raise SystemExit(f"peers_here.py: {folder} holds no {file}: it is not the peer's folder")
    if shutil.which("octave-cli") is None:
        raise SystemExit("peers_here.py: octave-cli is missing; Debian has it in the package octave")
    os.makedirs(given.out, exist_ok=True)
    rows = []
    for name, program, steps, text in cases(given.vbi, given.ttb):
        taken = [seconds(text, steps) for _ in range(given.rounds)]
        loop, whole = (statistics.median(values) for values in list(zip(*taken))[:2])
        rows.append([name, program, loop, whole, taken[0][2]])
        print(f"{name:24}{program:8}{loop:9.3f} s in the loop{whole:9.3f} s in all, {taken[0][2]} instants", flush=True)
    runs.write_table(os.path.join(given.out, "peers_here.csv"),
                     ["case", "peer", "seconds of the loop", "seconds in all", "instants"], rows)


if __name__ == "__main__":
    main()
