#!/usr/bin/env bash
# Builds Traverse where needed, then runs every test. Arguments go to ctest: ./test.sh -R contact
# The last line counts: N passed, N failed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/scripts/setup.sh"
locked set_up_tests

status=0
ctest --test-dir build -j "$(nproc)" --output-on-failure --no-tests=error "$@" | tee build/test.log || status=$?
awk '/tests passed, / { failed = $4; total = $NF }
     /\(Skipped\)$/ { skipped++ }
     END { if (skipped) print skipped " skipped"
           printf "%d passed, %d failed\n", total - failed - skipped, failed }' build/test.log
exit "$status"
