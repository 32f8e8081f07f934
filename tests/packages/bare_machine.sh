#!/usr/bin/env bash
# Installs the packages of scripts/package.sh on a bare Debian, uses them there as an ordinary user (as_user.py), upgrades
# from an older version, and removes them: nothing may be left.
#   tests/packages/bare_machine.sh FOLDER [RELEASE [BARE]]
# As root. FOLDER has the packages. RELEASE: bookworm, trixie, ...; default: that of this machine. BARE: the folder of the
# bare system, which is made by debootstrap unless it exists; it is copied, and stays bare. Packages come from the source
# of this machine's apt, by its settings.
set -euo pipefail
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
packages=$(realpath "$1")
# shellcheck source=/dev/null
release=${2:-$(. /etc/os-release && echo "$VERSION_CODENAME")}
bare=$(realpath -m "${3:-/var/tmp/bare-$release}")
machine=$bare.machine
user=(runuser -u someone -- env -C /home/someone HOME=/home/someone USER=someone)
trap 'rm -rf "$machine"' EXIT

# What a system of its own sees, without any file of this one: inside COMMAND...
inside() {
  unshare --mount --pid --fork --kill-child bash -c '
    mount -t proc proc "$0/proc" && mkdir -p "$0/dev/shm" && mount -t tmpfs tmpfs "$0/dev/shm" &&
    exec chroot "$0" /usr/bin/env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
      LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"' "$machine" "$@" </dev/null
}
fail() { echo "bare_machine.sh: $*" >&2; exit 1; }
quietly() { "$@" >"$machine.log" 2>&1 || { tail -n 40 "$machine.log" >&2; fail "$* failed"; }; }
install() { quietly inside apt-get install -y "$@"; }
names() { (cd "$packages" && for file in *.deb; do echo "${file%%_*}"; done); }

make_bare() {
  local mirror
  mirror=$(apt-get indextargets --format '$(REPO_URI)' | grep -v security | grep debian | head -n 1 || true)
  [ -n "$mirror" ] || fail "apt knows no package source; run apt-get update first"
  debootstrap --variant=minbase "$release" "$bare" "$mirror" >/dev/null
  apt-config dump | grep '^Acquire::\(http\|https\|Check\)' >"$bare/etc/apt/apt.conf.d/10acquire" || true
}

# The same packages as an older version, each with a file that the new one does not have.
make_older() {
  local file version
  for file in "$packages"/*.deb; do
    dpkg-deb -R "$file" "$machine/older/package"
    version=$(dpkg-deb -f "$file" Version)
    sed -i "s/$version/0.0.9-1/g" "$machine/older/package/DEBIAN/control"
    mkdir -p "$machine/older/package/usr/share/traverse" "$machine/older/package/usr/lib/python3/dist-packages/traverse"
    touch "$machine/older/package/usr/share/traverse/older-$(dpkg-deb -f "$file" Package)"
    [[ $file != */python3* ]] || touch "$machine/older/package/usr/lib/python3/dist-packages/traverse/older.py"
    dpkg-deb --root-owner-group -b "$machine/older/package" "$machine/older" >/dev/null
    rm -r "$machine/older/package"
  done
}

files() { (cd "$machine" && find usr etc opt var -xdev ! -path 'var/lib/dpkg/*' ! -path 'var/lib/apt/*' ! -path 'var/cache/*' \
  ! -path 'var/log/*' | sort); }

# What removing the packages leaves: nothing of them.
purge() {
  # shellcheck disable=SC2046  # the list is meant to split
  quietly inside apt-get purge -y $(names)
  ! (cd "$machine" && find usr etc opt var \( -path '*/traverse*' -o -name 'libtraverse*' \) ! -path 'var/cache/*' | grep .) ||
    fail "files are left"
}

[ -e "$bare/etc/os-release" ] || make_bare
rm -rf "$machine"
cp -a "$bare" "$machine"
cp /etc/resolv.conf "$machine/etc/"
mkdir "$machine/new" "$machine/older"
cp "$packages"/*.deb "$machine/new"
cp "$here/as_user.py" "$machine/"
quietly inside apt-get update
quietly inside useradd --create-home someone

start=$SECONDS
install $(cd "$machine" && echo ./new/traverse_*.deb)
installed=$SECONDS
quietly inside "${user[@]}" traverse check --span "28 m" --EI "260 GN.m2" --mass "19 t/m" --type prestressed \
  --line-speed "250 km/h"
ls "$machine"/home/someone/results/check/*.pdf >/dev/null || fail "there is no report"
echo "$release: $((installed - start)) s to install, then $((SECONDS - installed)) s to the first report."
rm -r "$machine/home/someone/results"

install $(cd "$machine" && echo ./new/*.deb) man-db bash-completion desktop-file-utils cmake g++ make
inside "${user[@]}" /usr/bin/python3 -B /as_user.py

purge
files >"$machine/before"
make_older
install $(cd "$machine" && echo ./older/*.deb)
quietly inside "${user[@]}" traverse -version
quietly inside /usr/bin/python3 -c 'import traverse.older'  # as root, which may write its byte code
install $(cd "$machine" && echo ./new/*.deb)
! find "$machine/usr" -name '*older*' -path '*traverse*' | grep . || fail "files of the older version are left"
quietly inside "${user[@]}" /usr/bin/python3 -B /as_user.py Program
quietly inside /usr/bin/python3 -c 'import traverse'
purge
files | diff "$machine/before" - || fail "files have changed"
echo "$release: upgraded and removed; nothing is left."
