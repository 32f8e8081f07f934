#!/usr/bin/env bash
# Builds Traverse where needed, then runs it in this folder.
#   ./run.sh                                                    the example: a train over three spans, with a picture
#   ./run.sh -options_file options/scenes/x.yml -train_speed 40  any arguments of the program
#   RANKS=2 ./run.sh ...                                         on two ranks
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/scripts/setup.sh"

program=(build/traverse)
if [ "${RANKS:-1}" != 1 ]; then
  program=(mpirun --oversubscribe -n "$RANKS" "${program[@]}")
fi
mkdir -p results
if [ $# -gt 0 ]; then
  exec "${program[@]}" "$@"
fi

"${program[@]}" -options_file options/scenes/three_span_train.yml | tee build/run.log
# The program's line "results  FILE.h5" names what there is to draw.
results=$(sed -n 's/^[[:space:]]*results[[:space:]:]\{1,\}\(.*\.h5\).*$/\1/p' build/run.log | tail -n 1)
if [ -n "$results" ]; then
  /usr/bin/python3 scripts/picture.py "$results" "${results%.h5}.png"
fi
