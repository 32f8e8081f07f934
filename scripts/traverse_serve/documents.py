"""The page of each results file of a run: documents.py FOLDER

A file that has nothing to show has no page, and a line says so.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import page  # noqa: E402
from checked_results import in_one_line  # noqa: E402


def main():
    for results in sorted(pathlib.Path(sys.argv[1]).glob("*.h5")):
        try:
            page.write(results, results.with_suffix(".html"))
        except Exception as error:
            print(f"{results.name}: {in_one_line(error)}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
