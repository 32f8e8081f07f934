#!/usr/bin/env bash
# Makes a site of the documents, which any browser reads from the disk, in FOLDER/html; only what has changed is made anew.
#   scripts/site.sh [FOLDER]             (default: build/site)
# It has the pages of the public headers too if scripts/api_pages.sh has made them. What Sphinx warns of is an error, as a
# link that leads nowhere.
set -euo pipefail
folder=${1:+$(realpath -m "$1")}  # before the set-up goes to the project's root
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
locked install_packages "${document_packages[@]}"

folder=${folder:-$PWD/build/site}
read_before=$folder/doctrees/environment.pickle  # without it all documents are read again
[ -z "$(find scripts/site -name '*.py' -newer "$read_before" 2>/dev/null)" ] || rm -f "$read_before"
if ! /usr/bin/python3 -B -m sphinx -q -W --keep-going -c scripts/site -d "$folder/doctrees" . "$folder/html"; then
  rm -f "$read_before"  # so that the next try repeats the warnings
  exit 1
fi
echo "The documents are in $folder/html/index.html."
