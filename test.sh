#!/usr/bin/env bash
# Builds Traverse where needed, then runs every test, with --quick all but the slow ones (tests/slow.txt). Other arguments
# go to ctest: ./test.sh -R contact, ./test.sh -L solve. The slowest are listed; the last line counts: N passed, N failed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/scripts/setup.sh"
locked set_up_tests
# At its first use Matplotlib lists the fonts of the machine, and says so if that takes long: no test shall see it.
/usr/bin/python3 -c 'import matplotlib.font_manager' >>"$setup_log" 2>&1

chosen=()
if [ "${1:-}" = --quick ]; then
  shift
  chosen=(-L '^quick$')
fi
[ $# -gt 0 ] || chosen+=(-C Batches)  # the quick cases of a file share a process and its start

log=build/Testing/Temporary/LastTest.log
rm -f "$log"
status=0
ctest --test-dir build -j "$(nproc)" --output-on-failure --no-tests=error "${chosen[@]}" "$@" || status=$?
python3 -B scripts/test_summary.py "$log"
exit "$status"
