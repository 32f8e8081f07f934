"""Computes the search of the form "Least stiffness" in the current folder: least.py PROGRAM LANGUAGE VALUES

The limits have the factor 1 + phi'' of the greatest EI, where it is greatest. If the bridge keeps them from a smaller EI on,
the search is repeated up to that one, with its factor, until this is the factor of the answer. Then a sweep with the least
EI of the answer, which adds speeds wherever a peak may be between the given ones, must keep the limit too. If it does not,
the search begins again with half the step of the speeds.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checked_results  # noqa: E402
from traverse_check import outcome  # noqa: E402
from traverse_report.language import choose, t  # noqa: E402
from traverse_serve import fields, inputs, scenes  # noqa: E402
from traverse_serve.forms import HSLM, forms  # noqa: E402

CLOSE = 5e-3  # relative difference of a factor from that of the answer, on the safe side
NEAR = 1e-2   # relative error of peaks over the speed
MOST_HALVINGS = 4
GREATEST = "find_between.to"


def compute(program, folder, files, *words, output=None):
    """Writes the files of a scene and computes it. Returns the place of its results. output: as in subprocess."""
    for name, text in inputs.checked(files).items():
        pathlib.Path(folder, name).write_text(text, encoding="utf-8")
    subprocess.run([program, "-options_file", "scene.yml", "-output_file", "results.h5", "-skip_petscrc", *words], cwd=folder,
                   stdout=output, check=True)
    return pathlib.Path(folder, "results.h5")


def search(program, language, given):
    """[(least, greatest)] of EI within the limit, N m2. The greatest EI of the search becomes that of the last one."""
    while True:
        factor = scenes.factor_for_track(given, program)
        with checked_results.opened(compute(program, ".", scenes.scene_files("find", given, language, factor))) as file:
            found = file["find/interval"][:].tolist()
        if not found or found[-1][1] < given[GREATEST] or found[-1][0] <= given["find_between.from"]:
            return found
        closer = given | {GREATEST: found[-1][0]}
        if factor - scenes.factor_for_track(closer, program) <= CLOSE * factor:
            return found
        given.update(closer)


def is_proven(program, language, given, stiffness):
    """Whether the limit is kept at all speeds, within the error of their peaks."""
    bridge = given | {"beam_EI": stiffness, "train_vehicles": HSLM}
    files = scenes.scene_files("sweep", bridge, language, scenes.factor_for_track(given, program))
    with tempfile.TemporaryDirectory() as folder:
        results = compute(program, folder, files, "-sweep_refine", str(NEAR), output=subprocess.DEVNULL)
        return all(verdict.utilisation <= 1.0 + NEAR for verdict in outcome.verdicts(results)
                   if verdict.word != "not judged" and given["find_keep"] in ("", verdict.limit.quantity))


def main():
    program, language, values = sys.argv[1:]
    choose(language)
    given = fields.read(forms()["find"].fields, json.loads(values))
    try:
        for halving in range(MOST_HALVINGS + 1):
            tried = given | {"sweep_speed.step": given["sweep_speed.step"] / 2 ** halving}
            found = search(program, language, tried)
            if not found or is_proven(program, language, tried, found[0][0]):
                return 0
        print(t("allowed: a smaller step; between the speeds the limit is exceeded at the least EI of the answer"))
    except inputs.InputError as error:
        print(error)
    except subprocess.CalledProcessError as error:
        return error.returncode
    return 1


if __name__ == "__main__":
    sys.exit(main())
