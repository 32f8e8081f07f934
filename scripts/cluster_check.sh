#!/usr/bin/env bash
# Unpacks the archive for clusters in a folder, uses it by its environment module, moves it, and runs it under Slurm: ranks of
# srun, and the job packaging/slurm/traverse.sbatch, which is put back into the queue twice and continues to the same results
# as without. One line for each check; the first failure ends it.
#   scripts/cluster_check.sh [ARCHIVE]       ARCHIVE of scripts/package.sh on this Debian (default: it is built)
# Slurm's daemons run for the time of this call, as this user, with settings and state in a folder of their own.
set -euo pipefail
archive=${1:+$(realpath "$1")}
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
locked install_packages "${program_packages[@]}" "${cluster_packages[@]}"
if [ -z "$archive" ]; then
  scripts/package.sh build-package
  archive=$(realpath build-package/traverse-*.tar.xz)
fi
batch=$PWD/packaging/slurm/traverse.sbatch
scratch=$(mktemp -d) log=$scratch/log began=0
export SLURM_CONF=$scratch/slurm.conf

stop() {
  local daemon end=$((SECONDS + 20))
  if [ -s "$scratch/slurmctld.pid" ]; then
    scancel --user="$(id -un)" || true
    while [ -n "$(squeue --noheader)" ] && ((SECONDS < end)); do sleep 0.2; done
  fi
  for daemon in slurmctld slurmd; do [ ! -s "$scratch/$daemon.pid" ] || kill "$(<"$scratch/$daemon.pid")" || true; done
  sleep 1
  rm -rf "$scratch"
}
trap stop EXIT
passed() { printf '%4d s  %s\n' "$((SECONDS - began))" "$*"; began=$SECONDS; }
failed() { echo "FAILED: $*"; tail -n 20 "$log" "$scratch"/*.log "$scratch"/jobs/*.out 2>/dev/null; exit 1; }
quietly() { "$@" >"$log" 2>&1 || failed "$*"; }

# load FOLDER: the module of the archive that is unpacked there.
load() {
  # shellcheck source=/dev/null
  source /usr/share/modules/init/bash
  module use "$1"/traverse-*/share/modulefiles
  module load traverse
  [[ $(command -v traverse) == "$1"/* ]] || failed "The module does not lead to $1."
}

# Which libraries of the system the program still takes: those of C and of Open MPI, with what these need.
check_libraries() {
  local strange
  strange=$(ldd "$(command -v traverse)" | grep '=> /' | grep -v "$scratch" |
    grep -vE '^\s+lib(c|m|dl|rt|pthread|resolv|mpi[a-z_0-9]*|open-(rte|pal)|hwloc|event[a-z_]*-[0-9.]*|udev|cap)\.so' || true)
  [ -z "$strange" ] || failed "Libraries that are not in the archive: $strange"
}

# write_scene NAME SECONDS STEP
write_scene() {
  printf '%s\n' 'beam: {spans: 25, EI: 2.8e9, mass: 2303, elements_per_span: 4}' 'model: {axial: false}' \
    'load: {forces: 1e5, speed: 2}' "ts: {dt: $3, max_time: $2}" 'output: {interval: 0.01}' >"$1"
}

# use_archive FOLDER NAME: in a shell of its own, by the module.
use_archive() (
  load "$1"
  check_libraries
  quietly traverse -options_file "$scratch/small.yml" -output_file "$scratch/$2.h5"
  quietly mpirun -n 2 traverse -options_file "$scratch/small.yml" -output_file "$scratch/$2_mpirun.h5"
  quietly /usr/bin/python3 -B -c 'import sys, traverse; traverse.run(sys.argv[1])' "$scratch/small.yml"
)

start_slurm() {
  local ports
  ports=$(/usr/bin/python3 -c 'import socket
ends = [socket.create_server(("", 0)) for _ in range(2)]
print(*(end.getsockname()[1] for end in ends))')
  mkdir "$scratch/state" "$scratch/spool" "$scratch/jobs"
  cat >"$SLURM_CONF" <<END
ClusterName=scratch
SlurmctldHost=$(hostname -s)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/none
AuthInfo=cred_expire=10
CredType=cred/none
SlurmctldPort=${ports% *}
SlurmdPort=${ports#* }
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/spool
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd.pid
SlurmctldLogFile=$scratch/slurmctld.log
SlurmdLogFile=$scratch/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=pmix
ReturnToService=2
KillWait=120
SchedulerType=sched/builtin
NodeName=$(hostname -s) CPUs=$(nproc)
PartitionName=all Nodes=ALL Default=YES OverSubscribe=FORCE:4
END
  quietly /usr/sbin/slurmctld -f "$SLURM_CONF" -i
  quietly /usr/sbin/slurmd -f "$SLURM_CONF"
  wait_until "the node is idle" 60 "sinfo -h -o %T | grep -q idle"
}

# wait_until WHAT SECONDS CONDITION
wait_until() {
  local end=$((SECONDS + $2))
  until eval "$3"; do
    ((SECONDS < end)) || failed "It is not so after $2 s that $1."
    sleep 0.2
  done
}

# The same numbers in two results files, to the last bit, in all datasets but those that list the options given.
compare() {
  quietly /usr/bin/python3 -B - "$@" <<'END'
import sys
import h5py
import numpy

with h5py.File(sys.argv[1]) as one, h5py.File(sys.argv[2]) as other:
    names = []
    one.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
    compared = [name for name in names if one[name].dtype.kind in "fiu" and name not in ("option", "input_option")]
    differ = [name for name in compared if not numpy.array_equal(one[name][()], other[name][()])]
    sys.exit(f"{sys.argv[1:]} differ: {differ}" if differ or "probes/deflection" not in compared else 0)
END
}

state() { scontrol show job "$1" | sed -n "s/.* *$2=\([^ ]*\).*/\1/p"; }

# How many lines of progress the job has written.
progress() { grep -c '%  *t = ' "$scratch"/jobs/*.out 2>/dev/null || true; }

# interrupt TURN COMMAND...: once the job computes in that turn, puts it back into the queue by the command.
interrupt() {
  local turn=$1
  shift
  wait_until "turn $turn of the job runs" 300 "[ \"\$(state $job JobState) \$(state $job Restarts)\" = 'RUNNING $((turn - 1))' ]"
  wait_until "turn $turn computes" 300 "((\$(progress) > reported))"
  reported=$(progress)
  touch "$scratch/before"
  quietly "$@" "$job"
  wait_until "turn $turn has written a checkpoint" 120 "[ '$scratch/jobs/results/long.h5.checkpoint' -nt '$scratch/before' ]"
}

write_scene "$scratch/small.yml" 0.5 5e-3
mkdir "$scratch/one"
tar -xJf "$archive" -C "$scratch/one"
use_archive "$scratch/one" one
passed "$(basename "$archive"), $(($(stat -c %s "$archive") / 1000000)) MB: by its module the program, 2 ranks and Python"
mv "$scratch/one" "$scratch/two"
use_archive "$scratch/two" two
compare "$scratch/one.h5" "$scratch/two.h5"
load "$scratch/two"
quietly traverse check --span "28 m" --EI "260 GN.m2" --mass "19 t/m" --type prestressed --line-speed "250 km/h" \
  --folder "$scratch/check"
passed "moved to another folder: the same, and a report"

start_slurm
passed "Slurm $(sinfo --version | cut -d' ' -f2) on $(nproc) processors"
quietly srun -n 2 traverse -options_file "$scratch/small.yml" -output_file "$scratch/srun.h5"
grep -q 'ranks: .* of 2' "$log" || failed "The two processes do not know of each other."
compare "$scratch/one_mpirun.h5" "$scratch/srun.h5"
passed "2 ranks of srun have the results of 2 ranks of mpirun"
quietly srun -n 2 /usr/bin/python3 -B -W ignore -c 'import sys, traverse
problems = [traverse.Problem(sys.argv[1], load_speed=speed) for speed in (2.0, 3.0)]
print(traverse.simulate(problems)["peak_deflection"].values.tolist())' "$scratch/small.yml"
[[ $(wc -l <"$log") = 2 && $(sort -u "$log" | wc -l) = 1 ]] || failed "The two processes of Python do not have the same results."
passed "2 processes of Python, which srun has started, share runs and have the same results"

cd "$scratch/jobs"
write_scene long.yml 6 4e-6
quietly sbatch -n 2 --time=120 "$batch" long.yml
job=$(grep -o '[0-9]*$' "$log") reported=0
interrupt 1 scontrol requeue
passed "scontrol requeue: the job ends with a checkpoint"
interrupt 2 scancel --batch --signal=USR1
passed "it started again; with the signal before its time limit it ends with a checkpoint"
wait_until "the job has ended" 900 "[[ \$(state $job JobState) =~ COMPLETED|FAILED|CANCELLED|TIMEOUT ]]"
[[ $(state "$job" JobState) = COMPLETED && $(state "$job" Restarts) = 2 && ! -e results/long.h5.checkpoint ]] ||
  failed "The job did not reach its end."
passed "it started again and reached its end"
quietly srun -n 2 traverse -options_file long.yml -output_file uninterrupted.h5
compare results/long.h5 uninterrupted.h5
passed "its results are those of an uninterrupted run, to the last bit"
