# Set-up, sourced by run.sh and test.sh: goes to the project's root, installs what is missing from Debian's own
# packages, builds build/ in release mode and sets what Open MPI needs. Says nothing when there is nothing to do.

cd -P "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
mkdir -p build
setup_log=build/setup.log

fail() {
  tail -n 40 "$setup_log" >&2
  echo "$* The whole log is $setup_log." >&2
  exit 1
}

# Those of the named Debian packages that are not installed.
missing_packages() {
  local installed name
  installed=$(dpkg-query -W -f '|${Package}:${db:Status-Status}|' "$@" 2>/dev/null) || true
  for name in "$@"; do
    [[ $installed == *"|$name:installed|"* ]] || printf '%s ' "$name"
  done
}

# Installs what is missing of the named packages. On other systems than Debian the user provides them.
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
  { $as_root apt-get update || true
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends -o Dpkg::Use-Pty=0 $missing
  } >"$setup_log" 2>&1 </dev/null || fail "Packages could not be installed."
}

# Configures when that has not been done for this very folder, and builds what is out of date.
build() {
  if [ ! -f build/build.ninja ] || ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" build/CMakeCache.txt; then
    cmake --fresh --preset release >"$setup_log" 2>&1 || fail "CMake could not configure."
  fi
  cmake --build build 2>&1 | awk -v log_file="$setup_log" '
    /^\[[1-9]/ && !said++ { print "Building Traverse, log in " log_file > "/dev/stderr" }
    { print > log_file }' || fail "Traverse could not be built."
}

{
  flock 9  # two calls at once build one after the other
  install_packages g++ cmake ninja-build pkg-config libpetsc-real-dev libslepc-real-dev libopenmpi-dev openmpi-bin \
    libhdf5-openmpi-dev libeigen3-dev libyaml-cpp-dev libfmt-dev libgtest-dev libbenchmark-dev python3-h5py \
    python3-matplotlib
  build
} 9>build/setup.lock

if [ "$(id -u)" = 0 ]; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
# One machine: no search for networks, displays or accelerators; no process reads another's memory, which containers
# forbid. What speeds up a single rank further the programs set themselves.
export OMPI_MCA_pml="${OMPI_MCA_pml:-ob1}" OMPI_MCA_btl="${OMPI_MCA_btl:-self,vader}"
export OMPI_MCA_btl_vader_single_copy_mechanism="${OMPI_MCA_btl_vader_single_copy_mechanism:-none}"
export HWLOC_COMPONENTS="${HWLOC_COMPONENTS:--gl,-opencl}" HWLOC_HIDE_ERRORS="${HWLOC_HIDE_ERRORS:-2}"
