"""The page of each results file of a run: documents.py FOLDER [JUDGED]

A file that has nothing to show has no page, and a line says so. The exit status is that of the verdicts of the file JUDGED.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import page  # noqa: E402
from checked_results import in_one_line  # noqa: E402
from traverse_check import outcome  # noqa: E402


def main():
    status = 0
    for results in sorted(pathlib.Path(sys.argv[1]).glob("*.h5")):
        try:
            page.write(results, results.with_suffix(".html"))
            if results.name in sys.argv[2:] and (found := outcome.verdicts(results)):
                status = outcome.status(found)
        except Exception as error:
            print(f"{results.name}: {in_one_line(error)}", flush=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
