#!/usr/bin/env bash
# Builds Traverse where needed, runs it in this folder, and makes a picture and a page for any browser of each results
# file in results/.
#   ./run.sh                                                     the example: a train over three spans
#   ./run.sh -options_file options/scenes/x.yml -train_speed 40  any arguments of the program
#   RANKS=2 ./run.sh ...                                         on two ranks
#   REPORT=1 ./run.sh ...                                        with a report to hand in, PDF and XLSX, which sweeps
#                                                                and studies with limits have unasked; REPORT=0: none
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/scripts/setup.sh"
locked set_up_program

program=(build/traverse)
if [ "${RANKS:-1}" != 1 ]; then
  program=(mpirun -n "$RANKS" "${program[@]}")
fi
[ $# -gt 0 ] || set -- -options_file options/scenes/three_span_train.yml

# Where files that the scene names are looked for: beside the last options file.
folder=.
for ((i = 1; i < $#; ++i)); do
  [ "${!i}" != -options_file ] || { next=$((i + 1)) && folder=$(dirname "${!next}"); }
done

mkdir -p results
touch build/run.start
status=0
"${program[@]}" "$@" || status=$?
find results -name '*.h5' -newer build/run.start | while read -r results; do
  /usr/bin/python3 scripts/picture.py "$results" "${results%.h5}.png"
  /usr/bin/python3 scripts/page.py "$results" "${results%.h5}.html"
  case ${REPORT:-} in
    0) ;;
    '') scripts/traverse-report --if-limits --folder "$folder" --program build/traverse "$results" ;;
    *) scripts/traverse-report --folder "$folder" --program build/traverse "$results" ;;
  esac
done
exit "$status"
