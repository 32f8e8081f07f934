"""Checks that includes between the folders of the sources point down the layers: includes.py [--limit-rooms] [ROOT]

A room is a folder of src together with the folder of include/traverse of the same name. The check fails, with one line
for each place, if
  - a room includes a header of a room above it, or belongs to no layer,
  - files include each other in a cycle,
  - a public header (include/traverse) includes a header of src,
  - a room without PETSc includes a header of PETSc or SLEPc, directly or through another header.
The check lists rooms that exceed their share of all lines; with --limit-rooms they are an error too.
"""
import argparse
import pathlib
import re
import sys

# From the top layer down: a room includes headers of the rooms after it only.
# The options are above the objects that they describe: their tables use the names of joints and foundations.
LAYERS = ["app", "check", "study", "fit", "screen", "error_control", "ensemble", "run", "scene", "norm", "rail", "results", "modal_engine", "integrate", "coupling", "engine", "structure",
          "train", "options", "contact", "multibody", "track", "modes", "recovery", "beam", "solve", "base"]
WITHOUT_PETSC = {"multibody", "contact", "track"}
GREATEST_SHARE = 0.10  # of all lines, per room

INCLUDE = re.compile(r'\s*#\s*include\s*[<"]([^>"]+)[>"]')
PETSC = re.compile(r"(petsc|slepc)")


class Sources:
    """The files of src and include/traverse with their includes."""

    def __init__(self, root):
        self.root = root
        self.lines = {}  # number of lines of every file
        self.includes = {}  # of every file: (line number, name as written, file of the project or None)
        for folder in (root / "include" / "traverse", root / "src"):
            for path in sorted(folder.rglob("*.[ch]pp")):
                self.read(path)

    def read(self, path):
        text = path.read_text(encoding="utf-8").splitlines()
        self.lines[path] = len(text)
        found = ((number, INCLUDE.match(line)) for number, line in enumerate(text, 1))
        self.includes[path] = [(number, match[1], self.resolve(path, match[1])) for number, match in found if match]

    def resolve(self, path, name):
        """The included file if it belongs to the project, otherwise None."""
        for folder in (path.parent, self.root / "include", self.root / "src"):
            file = folder / name
            if file.is_file():
                return self.root / file.resolve().relative_to(self.root)
        return None

    def room(self, path):
        """The folder of a file in src or include/traverse; empty for other files. Headers of no folder belong to app."""
        for folder in (self.root / "include" / "traverse", self.root / "src"):
            if path.is_relative_to(folder):
                return "app" if path.parent == folder else path.relative_to(folder).parts[0]
        return ""

    def place(self, path, number):
        return f"{path.relative_to(self.root)}:{number}"


def upward_includes(sources):
    """Yields a line for every room without a layer and for every upward include."""
    layer = {room: depth for depth, room in enumerate(LAYERS)}
    for room in sorted({sources.room(path) for path in sources.lines} - set(layer)):
        yield f"The folder {room} stands in no layer: give it its place in LAYERS of scripts/includes.py."
    for path, found in sources.includes.items():
        above = layer.get(sources.room(path))
        for number, name, file in found:
            below = layer.get(sources.room(file)) if file else None
            if above is not None and below is not None and below < above:
                yield (f'{sources.place(path, number)}: "{name}" points up, from {LAYERS[above]} to {LAYERS[below]}: '
                       "move what is needed to the lower of the two or below it.")


def private_in_public(sources):
    """Yields a line for every include of a header of src in a header of include/traverse."""
    public = sources.root / "include"
    for path, found in sources.includes.items():
        for number, name, file in found:
            if path.is_relative_to(public) and file and not file.is_relative_to(public):
                yield (f'{sources.place(path, number)}: "{name}" is not installed: move it to include/traverse, or what '
                       "needs it out of there.")


def circles(sources):
    """Yields a line for every cycle of files."""
    done, said = set(), set()

    def follow(path, way):
        if path in way:
            circle = way[way.index(path):]
            if frozenset(circle) not in said:
                said.add(frozenset(circle))
                yield "Files include one another: " + " -> ".join(
                    str(file.relative_to(sources.root)) for file in [*circle, path]) + ": divide one of them."
            return
        if path in done:
            return
        for _, _, file in sources.includes.get(path, []):
            if file:
                yield from follow(file, [*way, path])
        done.add(path)

    for path in sources.includes:
        yield from follow(path, [])


def petsc_where_none_belongs(sources):
    """Yields a line for every include that brings a header of PETSc into a room without PETSc."""
    sees = {}

    def sees_petsc(path):
        if path not in sees:
            sees[path] = False  # until it is determined; circles() reports cycles
            sees[path] = any(sees_petsc(file) if file else PETSC.match(name)
                             for _, name, file in sources.includes.get(path, []))
        return sees[path]

    for path, found in sources.includes.items():
        if sources.room(path) not in WITHOUT_PETSC:
            continue
        for number, name, file in found:
            if sees_petsc(file) if file else PETSC.match(name):
                yield (f"{sources.place(path, number)}: {name} brings headers of PETSc into {sources.room(path)}, which "
                       "knows none: hand over plain numbers instead.")


def shares(sources):
    """The share of every room in all lines, the largest first."""
    total = sum(sources.lines.values())
    rooms = {}
    for path, lines in sources.lines.items():
        rooms[sources.room(path)] = rooms.get(sources.room(path), 0) + lines
    return sorted(((lines / total, room) for room, lines in rooms.items()), reverse=True)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--limit-rooms", action="store_true",
                           help=f"fail where a room has more than {GREATEST_SHARE:.0%}% of all lines")
    arguments.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent)
    chosen = arguments.parse_args()
    sources = Sources(chosen.root.resolve())
    if not sources.lines:
        sys.exit(f"There are no sources in {chosen.root}: name the project's folder.")

    errors = [*upward_includes(sources), *private_in_public(sources), *circles(sources), *petsc_where_none_belongs(sources)]
    large = ", ".join(f"{room} {share:.1%}" for share, room in shares(sources) if share > GREATEST_SHARE)
    above = f"Rooms with more than {GREATEST_SHARE:.0%} of all lines: {large}." if large else ""
    if above and chosen.limit_rooms:
        errors.append(above + " Divide them.")
    if errors:
        sys.exit("\n".join(errors))
    print(f"All includes point down the {len(LAYERS)} layers." + (" " + above if above else ""))


if __name__ == "__main__":
    main()
