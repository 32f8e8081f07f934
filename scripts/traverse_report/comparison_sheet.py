"""The comparison of several results files: the utilisation of each limit in each file, with its page."""

from . import assumptions_sheet, checks_sheet
from .bounds import structure_of
from .front_sheet import COLOURS, WORDS, outcome, outcome_of
from .language import capital, percent, t
from .limits import key_of
from .page import AMBER, GREEN, GREY, LEFT, RED, RIGHT, Reference, table
from .quantities import shown_value, words_of

SEVERITY = (GREEN, GREY, AMBER, RED)
FILES_A_TABLE = 4
FIRST_COLUMN = 2.2  # inches


def worst_of(entries):
    """(verdict, source) with the greatest utilisation of all; None without evaluated limits. entries: (source,
    verdicts)."""
    judged = [(verdict, source) for source, verdicts in entries for verdict in verdicts if verdict.word != "not judged"]
    return max(judged, key=lambda found: found[0].utilisation, default=None)


def headline(entries):
    """(lines of the result, colour) of the title page; the first line is the main one."""
    worst = worst_of(entries)
    said, colour = outcome([verdict for _, verdicts in entries for verdict in verdicts])
    own = [outcome_of(source, verdicts) for source, verdicts in entries]
    lines = [own[0][0] if len(entries) == 1
             else t("Of {count} results files: {outcome}", count=len(entries), outcome=said)]
    if worst is not None:
        verdict, source = worst
        place = source.title() if len(entries) == 1 else f"{source.title()} ({source.path.name})"
        lines.append(t("Greatest utilisation: {share}, {place}: {quantity}, {result}.",
                       share=percent(verdict.utilisation),
                       place=t("; ").join(filter(None, (place, verdict.run))), result=t(WORDS[verdict.word]),
                       quantity=t("; ").join(filter(None, (verdict.limit.words, verdict.limit.clause)))))
    alarms = list(dict.fromkeys(said for source, _ in entries if source.is_verification
                                for said in checks_sheet.alarms(source)))
    lines += alarms
    if any(source.is_verification for source, _ in entries):
        lines.append(t("The result covers only the requirements that the section Scope of verification marks as "
                       "verified."))
    colours = [colour for _, colour in own] + ([AMBER] if alarms else [])
    return lines, max(colours, key=SEVERITY.index)


def sheet(report, entries, first_pages, shortened):
    """Adds the comparison at the end of the report, one column for each file. entries: (source, verdicts); shortened: some
    of them have one page."""
    page = report.page(t("Comparison of the results"), numbered=False)
    page.text(LEFT, t("Utilisation: value over limit. An empty cell: the results file does not contain the value."),
              colour=GREY, size=8)
    if shortened:
        page.text(LEFT, t("Of the files of one structure, the one with the greatest utilisation has all pages and "
                          "each other one has one page. The workbook has all numbers of all files."), colour=GREY,
                  size=8)
    differing = differences([source for source, _ in entries])
    for start in range(0, len(entries), FILES_A_TABLE):
        some = entries[start:start + FILES_A_TABLE]
        limits = list(dict.fromkeys(key_of(verdict.limit) for _, verdicts in some for verdict in verdicts
                                    if verdict.word != "not judged"))
        width = (RIGHT - LEFT - FIRST_COLUMN) / len(some)
        columns = [("", FIRST_COLUMN, "left")] + [(str(start + i), width, "left") for i in range(1, len(some) + 1)]
        page.y -= 0.08
        page = table(report, page, columns, rows_of(some, limits, first_pages[start:start + FILES_A_TABLE],
                                                      [[words, *cells[start:start + FILES_A_TABLE]]
                                                       for words, *cells in differing]), size=7)


def rows_of(entries, limits, first_pages, differing):
    """Rows of the comparison: what the files are and how they differ, then the utilisation of each limit."""
    sources, worst = [source for source, _ in entries], [worst_of([entry]) for entry in entries]
    rows = [[t("structure"), *(source.title() for source in sources)],
            [t("results file"), *(source.path.name for source in sources)],
            [t("page"), *(Reference(first) for first in first_pages)],
            [t("traffic load"), *(source.train_in_words() for source in sources)],
            [t("computation"), *(source.kind_in_words() for source in sources)],
            *differing,
            [t("result"), *(outcome_of(*entry) for entry in entries)],
            [t("run with the greatest utilisation"), *(found[0].run or found[0].where if found else "" for found in worst)],
            [t("greatest utilisation"), *(utilisation_cell(found[0]) if found else "" for found in worst)]]
    for key in limits:
        clause, quantity, value = key
        found = [next((verdict for verdict in verdicts if key_of(verdict.limit) == key
                       and verdict.word != "not judged"), None)
                 for _, verdicts in entries]
        rows.append([f"{words_of(quantity)} ≤ {shown_value(value, quantity)} ({clause})",
                     *(utilisation_cell(verdict) if verdict else "" for verdict in found)])
    return [[capital(row[0]), *row[1:]] for row in rows]


def differences(sources):
    """Rows of the assumptions that differ between files of one structure."""
    if len({structure_of(source) for source in sources}) > 1 or structure_of(sources[0]) is None:
        return []
    own = [{words: said for words, said, _ in assumptions_sheet.rows_of(source)} for source in sources]
    known_ones = dict.fromkeys(words for one in own for words in one)
    rows = [(words, *(one.get(words, "") for one in own)) for words in known_ones]
    return [list(row) for row in rows if len(set(row[1:])) > 1 and row[0] != t("traffic load")]


def utilisation_cell(verdict):
    return percent(verdict.utilisation), COLOURS[verdict.word]
