#!/usr/bin/env bash
# Makes the Debian packages of what is built: packaging/debian/pack.sh BUILD FOLDER
# That of the documents only if scripts/site.sh has made BUILD/site.
set -euo pipefail
BUILD=$(realpath "$1") folder=$(realpath -m "$2")
cd -P "$(dirname "${BASH_SOURCE[0]}")/../.."
export BUILD SOURCE=$PWD

# What packaging/debian does not know itself: version, who releases, and the licence.
write_debian_folder() {
  local version system maintainer
  version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$BUILD/CMakeCache.txt")
  # shellcheck source=/dev/null
  system=$(. /etc/os-release && echo "$ID$VERSION_ID")
  maintainer="${DEBFULLNAME:-Traverse developers} <${DEBEMAIL:-traverse@example.org}>"
  rm -rf "$1"
  mkdir -p "$1"
  cp -r packaging/debian/. "$1"
  mv "$1/libtraverse.install" "$1/libtraverse${version%%.*}.install"
  sed -i "s/@soversion@/${version%%.*}/; s/@maintainer@/$maintainer/" "$1/control"
  sed -i -e '/@license@/{r /dev/stdin' -e 'd}' "$1/copyright" < <(sed -e '1,/^Copyright/d' -e 's/^$/./; s/^/ /' LICENSE)
  printf 'traverse (%s-1+%s) unstable; urgency=medium\n\n  * changelog.gz lists what a user notices.\n\n -- %s  %s\n' \
    "$version" "$system" "$maintainer" "$(date -R -r CHANGELOG.md)" >"$1/changelog"
}

write_debian_folder "$folder/package/debian"
[ -e "$BUILD/site/html/index.html" ] || export DH_OPTIONS=--no-package=traverse-doc
export DEB_BUILD_OPTIONS="noautodbgsym ${DEB_BUILD_OPTIONS:-}"
cd "$folder/package"
dpkg-buildpackage --no-pre-clean --build=binary --no-sign
