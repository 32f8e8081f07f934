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
    """The verdicts of the first file; where another file has a greater utilisation or another limit, its verdict with
    the name of the file."""
    worst = list(group[0][2])
    for source, _, verdicts, _ in group[1:]:
        others = {key_of(verdict.limit): verdict for verdict in verdicts if verdict.word != "not judged"}
        for i, known in enumerate(worst):
            other = others.get(key_of(known.limit))
            if other is not None and (known.word == "not judged" or other.utilisation > known.utilisation):
                worst[i] = other._replace(file=source.path.name)
        listed = {key_of(verdict.limit) for verdict in worst}
        worst += [verdict._replace(file=source.path.name) for key, verdict in others.items() if key not in listed]
    return worst
