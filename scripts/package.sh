#!/usr/bin/env bash
# Builds the Debian packages of this system: for any processor, with all that they depend on named in them.
#   scripts/package.sh [FOLDER]          into FOLDER (default: build-package), which holds the build too
# Then, as root, on a machine of the same Debian: apt install ./traverse_VERSION_ARCHITECTURE.deb
set -euo pipefail
folder=$(realpath -m "${1:-build-package}")  # before the set-up goes to the project's root
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
locked install_packages "${program_packages[@]}" dpkg-dev file

cmake --preset release -B "$folder" -DTRAVERSE_NATIVE=OFF -DTRAVERSE_TESTS=OFF -DTRAVERSE_BENCHMARKS=OFF \
  >"$setup_log" 2>&1 || fail "CMake could not configure."
cmake --build "$folder" >"$setup_log" 2>&1 || fail "Traverse could not be built."
rm -f "$folder"/*.deb
(cd "$folder" && cpack -G DEB) >"$setup_log" 2>&1 || fail "The packages could not be made."
ls "$folder"/*.deb
