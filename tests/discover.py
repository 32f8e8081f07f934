"""Tells CTest the cases of a GoogleTest program, with labels: discover.py PROGRAM KIND TIMEOUT CMAKE_FILE

Each case is a test of its own, so that ctest -R finds it by its name. With `ctest -C Batches`, as ./test.sh without a
choice asks, the quick cases of a file are one test: they share one process and its start. Labels are the kind, quick or
slow (as slow.txt has it), and the rooms that rooms.txt names for the file.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

TESTS = pathlib.Path(__file__).resolve().parent


def rows(name):
    """The lines of a list in this folder, without remarks."""
    lines = (TESTS / name).read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def slow_tests():
    """{name: seconds} of the lines `SECONDS NAME`."""
    return {name: float(seconds) for seconds, name in map(str.split, rows("slow.txt"))}


def rooms():
    """{file below this folder: rooms that it tests} of the lines `FILE: ROOM, ROOM`."""
    return {file: names.split(", ") for file, names in (row.split(": ") for row in rows("rooms.txt"))}


def cases_of(program):
    """{source file: names of its cases} as GoogleTest lists them."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "cases.json"
        subprocess.run([program, "--gtest_list_tests", f"--gtest_output=json:{report}"], check=True,
                       stdout=subprocess.DEVNULL)
        suites = json.loads(report.read_text(encoding="utf-8"))["testsuites"]
    found = {}
    for suite in suites:
        for case in suite["testsuite"]:
            found.setdefault(case["file"], []).append(f"{suite['name']}.{case['name']}")
    return found


def test(name, program, cases, labels, timeout, cost):
    """The lines by which CTest takes a test of one or several cases. One case alone may be skipped."""
    skipped = 'SKIP_REGULAR_EXPRESSION "\\\\[  SKIPPED \\\\]"' if len(cases) == 1 else ""
    return (f'add_test([=[{name}]=] "{program}" "--gtest_filter={":".join(cases)}")\n'
            f'set_tests_properties([=[{name}]=] PROPERTIES TIMEOUT {timeout} COST {cost:g} '
            f'LABELS "{";".join(labels)}" WORKING_DIRECTORY "{pathlib.Path(program).parent}" '
            f'ENVIRONMENT "GTEST_COLOR=no" {skipped})\n')


def main():
    program, kind, timeout, output = sys.argv[1:]
    slow, rooms_of = slow_tests(), rooms()
    alone, batches, single = "", "", ""
    for file, cases in cases_of(program).items():
        labels = rooms_of.get("/".join(pathlib.Path(file).parts[-2:]), [])
        quick = [case for case in cases if f"{kind}.{case}" not in slow]
        for case in cases:
            name = f"{kind}.{case}"
            if case in quick:
                single += test(name, program, [case], [kind, "quick", *labels], timeout, 0)
            else:
                alone += test(name, program, [case], [kind, "slow", *labels], timeout, slow[name])
        if quick:
            batches += test(f"{kind}.{pathlib.Path(file).stem}", program, quick, [kind, "quick", *labels], timeout, 1)
    pathlib.Path(output).write_text(
        f'{alone}if(CTEST_CONFIGURATION_TYPE STREQUAL "Batches")\n{batches}else()\n{single}endif()\n', encoding="utf-8")


if __name__ == "__main__":
    main()
