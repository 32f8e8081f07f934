#!/usr/bin/env bash
# Builds the Debian packages of this system, for any processor: the program, its shared library, headers, the Python module
# and the documents (packaging/debian/control); and an archive that runs in any folder, for clusters.
#   scripts/package.sh [FOLDER]          into FOLDER (default: build-package), which holds the build too
# Then, as root, on a machine of the same Debian: apt install FOLDER/*.deb
# DEBFULLNAME and DEBEMAIL name who releases them.
set -euo pipefail
folder=$(realpath -m "${1:-build-package}")  # before the set-up goes to the project's root
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
locked install_packages "${program_packages[@]}" "${packaging_packages[@]}"

cmake --preset release -B "$folder/build" -DCMAKE_INSTALL_PREFIX=/usr -DTRAVERSE_NATIVE=OFF >"$setup_log" 2>&1 ||
  fail "CMake could not configure."
cmake --build "$folder/build" >"$setup_log" 2>&1 || fail "Traverse could not be built."
scripts/site.sh "$folder/build/site"
rm -f "$folder"/*.deb "$folder"/traverse-*.tar.xz
packaging/debian/pack.sh "$folder/build" "$folder" >"$setup_log" 2>&1 || fail "The packages could not be made."
packaging/archive/pack.sh "$folder/build" "$folder" >"$setup_log" 2>&1 || fail "The archive could not be made."
ls "$folder"/*.deb "$folder"/traverse-*.tar.xz
