# shellcheck shell=bash
# Bare Debian systems in folders, sourced by scripts/package_check.sh. They see no file of this machine; their packages come
# from the source of this machine's apt, by its settings.

# make_bare RELEASE FOLDER: what debootstrap puts there, and the settings of this machine's apt and network.
make_bare() {
  local mirror
  [ ! -e "$2/bare" ] || return 0
  mirror=$(apt-get indextargets --format '$(REPO_URI)' | grep -v security | grep debian | head -n 1 || true)
  [ -n "$mirror" ] || { echo "apt knows no package source; run apt-get update first" >&2; return 1; }
  command -v debootstrap >/dev/null || apt-get install -y debootstrap || return 1
  { [ -e "$2/etc/debian_version" ] && [ ! -e "$2/debootstrap" ]; } || debootstrap --variant=minbase "$1" "$2" "$mirror" &&
    cp /etc/resolv.conf "$2/etc/" &&
    { apt-config dump | grep '^Acquire::\(http\|https\|Check\)' >"$2/etc/apt/apt.conf.d/20acquire" || true; } &&
    inside "$2" apt-get update && touch "$2/bare"
}

# inside FOLDER COMMAND...: runs it as root of that system, with processes and shared memory of its own.
inside() {
  unshare --mount --pid --fork --kill-child bash -c '
    mount -t proc proc "$0/proc" && mkdir -p "$0/dev/shm" && mount -t tmpfs tmpfs "$0/dev/shm" &&
    exec chroot "$0" /usr/bin/env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
      LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"' "$@" </dev/null
}
