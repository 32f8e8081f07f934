#!/usr/bin/env bash
# Writes pages of the public headers, include/traverse, to build/api/html/index.html. Doxygen is installed where it is
# missing; what it warns of is an error.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
locked install_packages doxygen
rm -rf build/api
doxygen doc/Doxyfile
echo "The pages of the public headers are in build/api/html/index.html."
