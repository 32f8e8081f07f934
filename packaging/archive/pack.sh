#!/usr/bin/env bash
# Makes an archive of what is built that runs in any folder, for clusters: packaging/archive/pack.sh BUILD FOLDER
# It has the libraries of the program too, except those of the C library and of Open MPI, which are the cluster's own.
set -euo pipefail
build=$(realpath "$1") folder=$(realpath "$2")
cd -P "$(dirname "${BASH_SOURCE[0]}")"
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
# shellcheck source=/dev/null
name=traverse-$version-$(. /etc/os-release && echo "$ID$VERSION_ID")-$(uname -m)
root=$folder/archive/$name
libraries=$root/lib/traverse
of_the_cluster='^(lib(c|m|dl|rt|pthread|resolv|mpi[a-z_0-9]*|open-(rte|pal))\.so|ld-linux)'

declare -A place  # of each library by its name

# take FILE: the libraries that it needs, and those that they need.
take() {
  local needed
  for needed in $(objdump -p "$1" | awk '$1 == "NEEDED" { print $2 }'); do
    [[ ! $needed =~ $of_the_cluster ]] && [ ! -e "$libraries/$needed" ] || continue
    cp -L "${place[$needed]}" "$libraries/$needed"
    take "$libraries/$needed"
  done
}

# The libraries' licences, beside that of Traverse.
take_licences() {
  local file package
  for file in "$libraries"/*; do realpath "${place[${file##*/}]}"; done | sed 's,.*/,*/,' | xargs dpkg -S | cut -d: -f1 | sort -u |
    while read -r package; do
      cp -L "/usr/share/doc/$package/copyright" "$root/share/doc/traverse/libraries/$package"
    done
}

rm -rf "$folder/archive"
mkdir -p "$libraries" "$root/share/doc/traverse/libraries" "$root/share/modulefiles/traverse"
cmake --install "$build" --prefix "$root" --strip
rm -r "$root"/include "$root"/lib/*/{cmake,pkgconfig,*.a} "$root/share/applications"  # they need more than there is
while read -r needed _ path _; do place[$needed]=$path; done < <(ldd "$root/bin/traverse" | grep '=> /')
take "$root/bin/traverse"
take_licences
shared=$(find "$root/lib" -name 'libtraverse.so.*.*.*')
patchelf --force-rpath --set-rpath "\$ORIGIN/../lib/traverse" "$root/bin/traverse"  # for what libraries need too
patchelf --force-rpath --set-rpath "\$ORIGIN/$(realpath --relative-to "$(dirname "$shared")" "$libraries")" "$shared"
cp modulefile "$root/share/modulefiles/traverse/$version"
tar -C "$folder/archive" --sort=name --owner=0 --group=0 -cJf "$folder/$name.tar.xz" "$name"
rm -r "$folder/archive"
