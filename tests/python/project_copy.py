"""A copy of the project without what it has built, for tests that write where the project is."""

import os
import pathlib
import shutil

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2])).resolve()


def copy_project(target):
    for path in SOURCE.iterdir():
        if path.name.startswith((".", "build")) or path.name == "results":
            continue
        if path.is_dir():
            shutil.copytree(path, target / path.name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(path, target)
    (target / "build").mkdir()
