#!/usr/bin/env bash
# Builds Traverse where needed, runs it in this folder and draws what it has written to results/.
#   ./run.sh                                                     the example: a train over three spans
#   ./run.sh -options_file options/scenes/x.yml -train_speed 40  any arguments of the program
#   RANKS=2 ./run.sh ...                                         on two ranks
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/scripts/setup.sh"
locked set_up_program

program=(build/traverse)
if [ "${RANKS:-1}" != 1 ]; then
  program=(mpirun -n "$RANKS" "${program[@]}")
fi
[ $# -gt 0 ] || set -- -options_file options/scenes/three_span_train.yml

mkdir -p results
touch build/run.start
status=0
"${program[@]}" "$@" || status=$?
find results -name '*.h5' -newer build/run.start | while read -r results; do
  /usr/bin/python3 scripts/picture.py "$results" "${results%.h5}.png"
done
exit "$status"
