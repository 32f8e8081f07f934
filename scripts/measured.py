"""Prints the errors that the verification tests measure: measured.py [BUILD_FOLDER] [GTEST_FILTER]."""
import json
import subprocess
import sys
import tempfile

build = sys.argv[1] if len(sys.argv) > 1 else "build"
chosen = sys.argv[2] if len(sys.argv) > 2 else "*"
standard = {"name", "file", "line", "status", "result", "timestamp", "time", "classname", "value_param", "failures"}

with tempfile.NamedTemporaryFile(suffix=".json") as report:
    run = subprocess.run([build + "/tests/verification_tests", "--gtest_brief=1", "--gtest_filter=" + chosen,
                          "--gtest_output=json:" + report.name], stdout=subprocess.DEVNULL)
    for suite in json.load(report)["testsuites"]:
        for test in suite["testsuite"]:
            figures = [f"{name} {value}" for name, value in test.items() if name not in standard]
            if figures:
                print(f"{suite['name'].split('/')[-1]}.{test['name']:<40} {'; '.join(figures)}")
sys.exit(run.returncode)
