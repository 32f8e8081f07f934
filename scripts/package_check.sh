#!/usr/bin/env bash
# Builds the Debian packages on a bare Debian, installs them on another one, which has no sources, uses them there as an
# ordinary user (tests/packages/as_user.py), removes them, and installs them over the packages of the version before, which are
# built from its last commit. One line for each check; the first failure ends it.
#   scripts/package_check.sh [RELEASE [FOLDER]]      as root; RELEASE: bookworm, trixie (default: that of this machine)
# FOLDER (default: /var/tmp/traverse-RELEASE) keeps the bare system, the build and the packages; the next call is faster.
set -euo pipefail
# shellcheck source=/dev/null
release=${1:-$(. /etc/os-release && echo "$VERSION_CODENAME")}
folder=$(realpath -m "${2:-/var/tmp/traverse-$release}")
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=tests/packages/bare_system.sh
source tests/packages/bare_system.sh
builder=$folder/builder machine=$folder/machine log=$folder/log
trap 'rm -rf --one-file-system "$machine"' EXIT

fail() { echo "FAILED: $* (The whole log is $log.)"; exit 1; }
passed() { printf '%-9s %4d s  %s\n' "$release" "$((SECONDS - began))" "$*"; began=$SECONDS; }
quietly() { "$@" >"$log" 2>&1 || { tail -n 40 "$log" >&2; fail "$*"; }; }
install() { quietly inside "$machine" apt-get install -y "$@"; }
as_user() { inside "$machine" runuser -u someone -- env -C /home/someone HOME=/home/someone USER=someone "$@"; }
# install_packages PATTERN: those that the machine has in its root.
install_packages() {
  local files
  files=$(cd "$machine" && compgen -G "./$1") || fail "There is no $1."
  # shellcheck disable=SC2086  # the list is meant to split
  install $files
}

# The tracked files as they are now, beside the build of the last time: what has changed is newer than that.
copy_sources() {
  local before=$builder/root/traverse now=$builder/root/traverse.now file
  [ -e "$builder" ] || cp -a "$folder/bare" "$builder"
  rm -rf "$now"
  mkdir -p "$now"
  git ls-files -z | tar -c --null -T - | tar -x -C "$now"
  while IFS= read -r -d '' file; do
    if cmp -s "$before/$file" "$now/$file"; then touch -r "$before/$file" "$now/$file"; else touch "$now/$file"; fi
  done < <(git ls-files -z)
  rm -rf "$before"
  mv "$now" "$before"
}

# build_packages SOURCES NAME: the packages of these sources of the builder, in the folder NAME.
build_packages() {
  quietly inside "$builder" env CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" \
    "/root/$1/scripts/package.sh" "/root/$2"
  rm -rf "${folder:?}/$2"
  mkdir "$folder/$2"
  mv "$builder/root/$2"/*.deb "$folder/$2"
}

build_version_before() {
  local commit
  [ ! -e "$folder/before" ] || return 0
  commit=$(git log -1 --format=%H -G'^project\(traverse VERSION' -- CMakeLists.txt)
  git archive --prefix=traverse-before/ "$commit^" | tar -x -C "$builder/root"
  build_packages traverse-before before
}

check_by_lintian() {
  quietly inside "$builder" apt-get install -y lintian
  cp -r "$folder/package" "$builder/root/checked"
  quietly inside "$builder" bash -c 'lintian --allow-root --fail-on error --display-level ">=warning" /root/checked/*.deb'
  rm -r "$builder/root/checked"
  cp "$log" "$folder/lintian"
}

# A bare system with the packages, and a user without rights.
make_machine() {
  rm -rf --one-file-system "$machine"
  cp -a "$folder/bare" "$machine"
  cp -r "$folder/package" "$folder/before" tests/packages/as_user.py "$machine/"
  quietly inside "$machine" useradd --create-home someone
}

first_report() {
  quietly as_user traverse check --span "28 m" --EI "260 GN.m2" --mass "19 t/m" --type prestressed --line-speed "250 km/h"
  ls "$machine"/home/someone/results/check/*.pdf >"$log" || fail "There is no report."
  rm -r "$machine/home/someone/results"
}

use_as_user() { as_user /usr/bin/python3 -B /as_user.py || fail "as an ordinary user"; }

# Removes all packages of Traverse, after which no file of theirs may be left; lists what else there is.
purge() {
  local names
  names=$(inside "$machine" dpkg-query -W -f '${Package}\n' '*traverse*')
  # shellcheck disable=SC2086  # the list is meant to split
  quietly inside "$machine" apt-get purge -y $names
  ! inside "$machine" dpkg-query -W '*traverse*' >"$log" 2>/dev/null || fail "A package is left."
  (cd "$machine" && find . -xdev \( -path ./proc -o -path ./home -o -path ./package -o -path ./before -o -path ./tmp \
    -o -path ./var/cache -o -path ./var/log \) -prune -o -print | sort) >"$1"
  # Boost and SymPy have files of this name, too, in folders of their own.
  ! grep -E '^\./(etc|var/lib|usr/(s?bin|include|share|share/doc|lib|lib/python3/dist-packages|lib/[^/]*))/(python3-|lib)?traverse' \
    "$1" >"$log" || { cat "$log"; fail "Files are left."; }
}

began=0
mkdir -p "$folder"
quietly make_bare "$release" "$folder/bare"
passed "a bare system"
copy_sources
build_packages traverse package
mv "$builder"/root/package/traverse-*.tar.xz "$folder"
passed "packages built: $(cd "$folder/package" && ls -- *.deb | tr '\n' ' ')"
check_by_lintian
passed "no error by lintian, $(grep -c '^W:' "$folder/lintian" || true) warnings"
build_version_before
passed "packages of the version before built: $(cd "$folder/before" && ls -- *.deb | tr '\n' ' ')"
make_machine

start=$SECONDS
began=$SECONDS
install_packages 'package/*.deb'
passed "all packages installed by apt"
first_report
passed "first report; $((SECONDS - start)) s from apt install to it"
install man-db bash-completion desktop-file-utils cmake g++ make
use_as_user
passed "used as an ordinary user"
purge "$folder/left"
passed "purged: nothing is left"

install_packages 'package/traverse_*.deb'
first_report
passed "the program installed alone, without downloads, and its first report"
purge "$folder/left_again"
diff "$folder/left" "$folder/left_again" || fail "Files differ after a purge."
passed "purged again: all files are as after the first purge"

install_packages 'before/*.deb'
first_report
passed "the version before installed, and its first report"
install_packages 'package/*.deb'
use_as_user
passed "installed over the version before, and used as an ordinary user"
purge "$folder/left_again"
diff "$folder/left" "$folder/left_again" || fail "Files differ after a purge."
passed "purged: all files are as after the first purge"
