"""Results files of one structure in one report, such as those of the bounds of its stiffness and mass: the governing
one has all pages, each other one has one page."""

from .limits import key_of


def structure_of(source):
    """What files of one structure share; None: the file has all pages in any case."""
    if source.is_search or source.is_sensitivity or (source.runs is None and not source.is_static):
        return None
    name = source.replaced.get("report_structure") or source.title()
    return name, source.is_static, tuple(source.model.span_ends), tuple(source.model.supports)


def utilisation_of(verdicts):
    return max((verdict.utilisation for verdict in verdicts if verdict.word != "not judged"), default=0.0)


def groups_of(entries):
    """Lists of the entries of each structure, in each the governing one first. entries: (source, ..., verdicts, ...)."""
    groups = {}
    for entry in entries:
        groups.setdefault(structure_of(entry[0]) or id(entry), []).append(entry)
    for group in groups.values():
        governing = max(group, key=lambda entry: utilisation_of(entry[2]))  # the first one of several
        group.sort(key=lambda entry: entry is not governing)
    return list(groups.values())


def worst_of(group):
    """The verdict with the greatest utilisation of each limit of the first file, with the name of another file."""
    def named(verdict, source):
        return verdict if source is group[0][0] else verdict._replace(file=source.path.name)

    found = {key_of(verdict.limit): verdict for verdict in group[0][2]}
    for source, _, verdicts, _ in group[1:]:
        for verdict in verdicts:
            known = found.get(key_of(verdict.limit))
            if verdict.word != "not judged" and (known is None or known.word == "not judged"
                                                 or verdict.utilisation > known.utilisation):
                found[key_of(verdict.limit)] = named(verdict, source)
    return list(found.values())
