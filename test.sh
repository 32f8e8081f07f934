#!/usr/bin/env bash
# Builds Traverse where needed, then runs every test. Arguments go to ctest: ./test.sh -R contact
# The last line counts: N passed, N failed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/scripts/setup.sh"

status=0
ctest --test-dir build -j "$(nproc)" --output-on-failure --no-tests=error "$@" | tee build/test.log || status=$?
awk '/tests passed, / { failed = $4; total = $NF }
     /\((Skipped|Disabled)\)$/ { left_out++ }
     END { if (left_out) print left_out " left out"
           printf "%d passed, %d failed\n", total - failed - left_out, failed }' build/test.log
exit "$status"
