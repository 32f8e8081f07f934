"""Prints the errors measured by the verification tests: measured.py [BUILD_FOLDER] [GTEST_FILTER]."""
import json
import subprocess
import sys
import tempfile

STANDARD = {"name", "file", "line", "status", "result", "timestamp", "time", "classname", "value_param", "failures"}


def run_tests(build, chosen="*"):
    """Runs the chosen verification tests. Returns {test: {figure: text}} without prefixes of suites, and the status."""
    with tempfile.NamedTemporaryFile(suffix=".json") as report:
        run = subprocess.run([build + "/tests/verification_tests", "--gtest_brief=1", "--gtest_filter=" + chosen,
                              "--gtest_output=json:" + report.name], stdout=subprocess.DEVNULL)
        return figures_of(json.load(report)), run.returncode


def figures_of(report):
    """{test: {figure: text}} of a JSON report of GoogleTest."""
    found = {}
    for suite in report["testsuites"]:
        for test in suite["testsuite"]:
            figures = {name: str(value) for name, value in test.items() if name not in STANDARD}
            if figures:
                found[f"{suite['name'].split('/')[-1]}.{test['name']}"] = figures
    return found


def main():
    build = sys.argv[1] if len(sys.argv) > 1 else "build"
    found, status = run_tests(build, sys.argv[2] if len(sys.argv) > 2 else "*")
    for test, figures in found.items():
        print(f"{test:<60} {'; '.join(f'{name} {value}' for name, value in figures.items())}")
    return status


if __name__ == "__main__":
    sys.exit(main())
