"""Summarises a log of CTest: test_summary.py [--slow SECONDS] LOG, such as build/Testing/Temporary/LastTest.log

Each case of GoogleTest is counted separately, also if several cases share a process. A case that such a process did not
finish has failed. The script prints the twenty slowest cases, the names of the failed ones, and as its last line
`N passed, N failed`.

With --slow it prints lines of tests/slow.txt instead: the slowest cases, until all others take SECONDS together.
"""
import argparse
import pathlib
import re

SHOWN = 20
TEST = re.compile(r"^\d+/\d+ Testing: (.+)$", re.MULTILINE)
# CTest writes "Test Passed." also if there is no program to be started; then its command is empty.
END = re.compile(r"^(Test Passed|Test Failed|Skip regular expression found in output)\.", re.MULTILINE)
NO_PROGRAM = re.compile(r'^Command: ""$', re.MULTILINE)
CASES = re.compile(r'^Command: .*"--gtest_filter=([^"]*)"', re.MULTILINE)
STARTED = re.compile(r"\[ RUN      \] (\S+)")
ENDED = re.compile(r"\[(       OK |  SKIPPED |  FAILED  )\] ([^\s,]+).*\((\d+) ms\)")
USED = re.compile(r"\[ SECONDS  \] (\S+) ([\d.]+)")
SECONDS = re.compile(r"^Test time =\s+([\d.]+) sec$", re.MULTILINE)
PASSED, SKIPPED, FAILED = "passed", "skipped", "failed"
RESULTS = {"OK": PASSED, "SKIPPED": SKIPPED, "FAILED": FAILED}
ENDS = {"Test Passed": PASSED, "Test Failed": FAILED, "Skip regular expression found in output": SKIPPED}


def cases_of_program(name, text, wanted):
    """Yields (name, result, seconds, remark) of every case of a GoogleTest program."""
    kind = name.split(".")[0]
    ended = {case: (RESULTS[word.strip()], int(milliseconds) / 1000) for word, case, milliseconds in ENDED.findall(text)}
    started, used = STARTED.findall(text), dict(USED.findall(text))
    for case in wanted:
        result, seconds = ended.get(case, (FAILED, 0.0))
        seconds = float(used.get(case, seconds))
        remark = "" if case in ended else "did not end" if case in started else "did not start"
        yield f"{kind}.{case}", result, seconds, remark


def cases_in(log):
    """Yields (name, result, seconds, remark) of every case in a log of CTest."""
    starts = list(TEST.finditer(log))
    for test, after in zip(starts, starts[1:] + [None]):
        name, text = test[1], log[test.end():after.start() if after else len(log)]
        wanted = CASES.search(text)
        if wanted:
            yield from cases_of_program(name, text, wanted[1].split(":"))
            continue
        end, seconds, missing = END.search(text), SECONDS.search(text), NO_PROGRAM.search(text)
        result = ENDS[end[1]] if end and not missing else FAILED
        yield name, result, float(seconds[1]) if seconds else 0.0, "did not start" if missing else ""


def slow_ones(cases, seconds):
    """Yields the slowest cases, until all others take at most these seconds together."""
    ordered = sorted(cases, key=lambda case: -case[2])
    left = sum(case[2] for case in ordered)
    while ordered and left > seconds:
        left -= ordered[0][2]
        yield ordered.pop(0)


def print_summary(cases):
    if len(cases) > 1:
        print("The slowest, in seconds of processor time, those of Python, of several ranks and of benchmarks by the clock:")
        for name, _, seconds, _ in sorted(cases, key=lambda case: -case[2])[:SHOWN]:
            print(f"{seconds:8.1f} {name}")
    count = {result: sum(case[1] == result for case in cases) for result in (PASSED, SKIPPED, FAILED)}
    for name, result, _, remark in cases:
        if result == FAILED:
            print(f"Failed: {name}{', which ' + remark if remark else ''}")
    if count[SKIPPED]:
        print(f"{count[SKIPPED]} skipped")
    print(f"{count[PASSED]} passed, {count[FAILED]} failed")


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--slow", type=float, metavar="SECONDS", help="print the slowest as tests/slow.txt has them")
    arguments.add_argument("log", type=pathlib.Path)
    chosen = arguments.parse_args()
    # CTest writes no log if it finds no tests.
    cases = list(cases_in(chosen.log.read_text(encoding="utf-8", errors="replace"))) if chosen.log.exists() else []
    if chosen.slow is None:
        print_summary(cases)
    else:
        for name, _, seconds, _ in slow_ones(cases, chosen.slow):
            print(f"{seconds:.1f} {name}")


if __name__ == "__main__":
    main()
