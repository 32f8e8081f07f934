# Set-up, sourced by run.sh and test.sh: goes to the project's root and sets what Open MPI needs. Its functions install
# what is missing from the distribution's own packages and build build/ in release mode. Says nothing when there is
# nothing to do.

cd -P "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
mkdir -p build
setup_log=build/setup.log

# No name carries a version, so that Debian 12 and 13 and Ubuntu take what they have.
program_packages=(g++ cmake ninja-build pkg-config libpetsc-real-dev libslepc-real-dev libopenmpi-dev openmpi-bin
  libhdf5-openmpi-dev libeigen3-dev libyaml-cpp-dev libfmt-dev libboost-dev libjs-chart.js python3-h5py python3-matplotlib
  python3-openpyxl python3-scipy python3-xarray python3-yaml)
test_packages=(ccache chromium libgtest-dev python3-h5netcdf python3-netcdf4)
document_packages=(libjs-katex python3-myst-parser python3-sphinx)
packaging_packages=(build-essential debhelper dh-python patchelf)
cluster_packages=(environment-modules openmpi-bin slurm-client slurmctld slurmd)
benchmark_packages=(libbenchmark-dev)
other_programs=(calculix-ccx python3-dolfinx)  # that benchmarks compare with; not every distribution has all of them
check_packages=(clang-format clang-tidy)

# One line that says what stopped, with what the log says of the first error: CMake says it on the lines that follow.
fail() {
  local cause
  cause=$(awk '/^CMake Error/ { cmake = 1; next }
               cmake && /^ / { line = line $0; next }
               cmake && line != "" || /^E: |error: |^ninja: / { print line != "" ? line : $0; exit }' "$setup_log" |
    tr -s ' ')
  echo "$* ${cause:-$(tail -n 1 "$setup_log")} (The whole log is $setup_log.)" >&2
  exit 1
}

# Those of the named packages that are not installed.
missing_packages() {
  local installed name
  installed=$(dpkg-query -W -f '|${Package}:${db:Status-Status}|' "$@" 2>/dev/null) || true
  for name in "$@"; do
    [[ $installed == *"|$name:installed|"* ]] || printf '%s ' "$name"
  done
}

# Fetches the lists of packages, through the given command where it is not root that asks. It waits up to ten minutes for
# another apt to end, as DPkg::Lock::Timeout does for installing; a source that is out of reach is not an error yet.
update_lists() {
  local tries
  for tries in {1..120}; do
    "$@" apt-get update 2>&1 | tee build/update.log
    grep -q '^E: Could not get lock' build/update.log || return 0
    sleep 5
  done
}

# Installs what is missing of the named packages. On systems without apt the user provides them.
install_packages() {
  local missing as_root=
  command -v apt-get >/dev/null || return 0
  missing=$(missing_packages "$@")
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" != 0 ]; then
    as_root=$(command -v sudo) || { echo "As root, please run: apt-get install $missing" >&2; exit 1; }
  fi
  echo "Installing $missing" >&2
  # shellcheck disable=SC2086  # the list is meant to split
  { update_lists $as_root
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends -o Dpkg::Use-Pty=0 \
      -o DPkg::Lock::Timeout=600 $missing
  } >"$setup_log" 2>&1 </dev/null || fail "Packages could not be installed."
}

# Installs those of the packages that the distribution has. Nothing else needs them: what does is skipped without them.
install_offered() {
  local name offered=()
  command -v apt-cache >/dev/null || return 0
  for name in "$@"; do
    ! apt-cache show "$name" >/dev/null 2>&1 || offered+=("$name")
  done
  [ ${#offered[@]} = 0 ] || (install_packages "${offered[@]}") || echo "It goes on without them." >&2
}

# Whether build/ is configured for this very folder with all the given options of CMake, each as -DNAME=VALUE.
configured() {
  local option
  [ -f build/build.ninja ] && grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" build/CMakeCache.txt || return 1
  for option in "$@"; do
    option=${option#-D}
    grep -qxE "${option%%=*}:[A-Z]+=${option#*=}" build/CMakeCache.txt || return 1
  done
}

# build TARGET [-DOPTION=VALUE ...]: configures where that has to be done, and builds what is out of date.
build() {
  local target=$1 fresh=
  shift
  if ! configured "$@"; then
    configured || fresh=--fresh
    [ ! -t 2 ] || printf 'Building Traverse, log in %s' "$setup_log" >&2
    cmake $fresh --preset release "$@" >"$setup_log" 2>&1 || fail "CMake could not configure."
  fi
  cmake --build build --target "$target" 2>&1 | show_progress || fail "Traverse could not be built."
}

# Copies Ninja's lines to the log. Says one line if something is built; on a terminal this line shows how many steps are
# done, and the time left at their mean pace so far.
show_progress() {
  local said='' start=$SECONDS line ended total left terminal=
  [ ! -t 2 ] || terminal=1
  while IFS= read -r line; do
    printf '%s\n' "$line" >&3
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] && ((BASH_REMATCH[1] > 0)) || continue
    ended=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
    if [ -n "$terminal" ]; then
      left=$(((SECONDS - start) * (total - ended) / ended))
      printf '\rBuilding Traverse [%d/%d], %d min %02d s left, log in %s\033[K' "$ended" "$total" $((left / 60)) $((left % 60)) \
        "$setup_log" >&2
    elif [ -z "$said" ]; then
      echo "Building Traverse, log in $setup_log" >&2
    fi
    said=1
  done 3>"$setup_log"
  [ -z "$terminal" ] || [ -z "$said" ] || echo >&2
}

# The program alone; the program and its tests; the benchmarks too.
set_up_program() { install_packages "${program_packages[@]}" && build traverse; }
set_up_tests() {
  install_packages "${program_packages[@]}" "${document_packages[@]}" "${test_packages[@]}" && build all -DTRAVERSE_TESTS=ON
}
set_up_benchmarks() {
  install_packages "${program_packages[@]}" "${document_packages[@]}" "${test_packages[@]}" "${benchmark_packages[@]}" &&
    install_offered "${other_programs[@]}" && build all -DTRAVERSE_TESTS=ON -DTRAVERSE_BENCHMARKS=ON
}

# What scripts/tidy.py needs: how each file is compiled, one by one and without precompiled headers, which are g++'s own,
# as are some of the options for this machine.
set_up_checks() {
  install_packages "${program_packages[@]}" "${test_packages[@]}" "${benchmark_packages[@]}" "${check_packages[@]}" &&
    cmake -G Ninja -S . -B build-checks -DCMAKE_BUILD_TYPE=Release -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
      -DTRAVERSE_NATIVE=OFF -DTRAVERSE_TESTS=ON -DTRAVERSE_BENCHMARKS=ON >"$setup_log" 2>&1 ||
    fail "CMake could not configure the checks."
}

# The unit and robustness tests, and the program that the latter run, with sanitizers in build-sanitizers/.
set_up_sanitizers() {
  install_packages "${program_packages[@]}" "${test_packages[@]}" &&
    cmake --preset sanitizers >"$setup_log" 2>&1 || fail "CMake could not configure the sanitizers' build."
  echo "Building with sanitizers, log in $setup_log" >&2
  cmake --build build-sanitizers --target traverse unit_mechanics unit_tests robustness_tests >"$setup_log" 2>&1 ||
    fail "Traverse could not be built with sanitizers."
}

# locked FUNCTION: two calls at once build one after the other.
locked() { { flock 9; "$@"; } 9>build/setup.lock; }

if [ "$(id -u)" = 0 ]; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
# One machine: no search for networks, displays or accelerators; more ranks than processors are allowed, in Open MPI 4's
# words and in 5's. What speeds up a single rank further the programs set themselves.
export OMPI_MCA_pml="${OMPI_MCA_pml:-ob1}" OMPI_MCA_btl="${OMPI_MCA_btl:-self,vader}"
export OMPI_MCA_rmaps_base_oversubscribe="${OMPI_MCA_rmaps_base_oversubscribe:-1}"
export PRTE_MCA_rmaps_default_mapping_policy="${PRTE_MCA_rmaps_default_mapping_policy:-:oversubscribe}"
# No process reads another's memory, which containers forbid.
export OMPI_MCA_btl_vader_single_copy_mechanism="${OMPI_MCA_btl_vader_single_copy_mechanism:-none}"
export UCX_LOG_LEVEL="${UCX_LOG_LEVEL:-fatal}"  # of a transport that is not used
export HWLOC_COMPONENTS="${HWLOC_COMPONENTS:--gl,-opencl}" HWLOC_HIDE_ERRORS="${HWLOC_HIDE_ERRORS:-2}"
