#!/usr/bin/env bash
# Compiles, without making a program, all that calls PETSc or SLEPc against the headers of other versions of them:
#   scripts/petsc_versions.sh 3.18 3.25         two versions, each with its newest tag
#   scripts/petsc_versions.sh                   all that Traverse is written for
# The headers come from the public repositories, or from those that PETSC_SOURCE and SLEPC_SOURCE name, addresses or
# folders, and are kept in build/petsc_versions. What PETSc's configuration writes, petscconf.h and the like, is that of
# the installed version, and codes of errors are a type of their own, as strict builds have them since 3.19.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
locked set_up_checks

versions=("$@")
[ $# -gt 0 ] || versions=(3.18 3.19 3.20 3.21 3.22 3.23 3.24 3.25)
kept=build/petsc_versions
mkdir -p "$kept"

# headers NAME MODULE SOURCE VERSION: the folder include of the newest tag of a version, with the installed configuration.
headers() {
  local folder=$kept/$1-$4 tag file
  [ ! -d "$folder" ] || return 0
  tag=$(git ls-remote --tags --refs "$3" "v$4.*" | sed 's|.*refs/tags/||' | sort -V | tail -n 1)
  [ -n "$tag" ] || { echo "$3 has no tag v$4.*" >&2; return 1; }
  rm -rf "$folder.part"
  if [ -d "$3" ]; then
    mkdir "$folder.part"
    git -C "$3" archive "$tag" include | tar x -C "$folder.part"
  else
    git -c advice.detachedHead=false clone --quiet --depth 1 --filter=blob:none --sparse --branch "$tag" "$3" "$folder.part"
    git -C "$folder.part" sparse-checkout set include
  fi
  for file in "$(pkg-config --variable=includedir "$2")/$1"{conf,conf_poison,fix,pkg_version}.h; do
    [ ! -f "$file" ] || cp "$file" "$folder.part/include"
  done
  mv "$folder.part" "$folder"
}

# What petscconf.h of this version says otherwise than that of the installed one: the attributes of what is deprecated,
# which have other names since 3.20, and the MPI, which 3.22 and later compare with mpi.h.
adapt() {
  local include=$kept/petsc-$1/include suffix='' kind
  grep -q DEPRECATED_FUNCTION_BASE "$include/petscmacros.h" && suffix=_BASE
  {
    sed '/define PETSC_DEPRECATED_/d; /define PETSC_HAVE_OPENMPI /d' "$include/petscconf.h"
    for kind in ENUM FUNCTION OBJECT TYPEDEF; do
      echo "#define PETSC_DEPRECATED_$kind$suffix(why) __attribute__((deprecated(why)))"
    done
    echo "#define PETSC_DEPRECATED_MACRO$suffix(why) _Pragma(why)"
  } >"$include/adapted.h"
  mv "$include/adapted.h" "$include/petscconf.h"
}

# flags VERSION: of the compiler, for all sources.
flags() {
  printf '%s\n' -std=c++20 -fsyntax-only -Wall -Wextra -Werror -DOMPI_SKIP_MPICXX "-DTRAVERSE_VERSION='\"\"'" \
    -DPETSC_USE_STRICT_PETSCERRORCODE=1 -DPETSC_HAVE_OPENMPI=1 '-DPETSC_PKG_OPENMPI_VERSION_GT(...)=0' \
    '-DPETSC_PKG_OPENMPI_VERSION_LT(...)=0' -Iinclude -Isrc -Itests -Ibenchmarks -Ibuild-checks/tests \
    -include build-checks/tests/support/folders.hpp \
    -isystem "$kept/slepc-$1/include" -isystem "$kept/petsc-$1/include"
  pkg-config --cflags-only-I eigen3 "$(pkg-config --exists hdf5-openmpi && echo hdf5-openmpi || echo hdf5)" yaml-cpp \
    fmt ompi-cxx | sed 's/-I/-isystem /g'
}

# release NAME VERSION: with its third number, as the header says.
release() {
  awk -v name="$1" '$2 ~ toupper(name) "_VERSION_(MAJOR|MINOR|SUBMINOR)$" { text = text dot $3; dot = "." }
    END { print text }' "$kept/$1-$2/include/$1version.h"
}

# Sources that call PETSc or SLEPc, or include their headers.
mapfile -t sources < <(grep -rlE '\b(Petsc|Slepc|Mat|Vec|TS|SNES|KSP|PC|EPS|ST|IS)[A-Z]\w+\(|include <(petsc|slepc)' \
  src tests benchmarks examples --include='*.cpp' | sort)
for version in "${versions[@]}"; do
  headers petsc PETSc "${PETSC_SOURCE:-https://gitlab.com/petsc/petsc.git}" "$version"
  headers slepc SLEPc "${SLEPC_SOURCE:-https://gitlab.com/slepc/slepc.git}" "$version"
  adapt "$version"
  flags "$version" >"$kept/flags-$version"
  printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 1 g++ "@$kept/flags-$version"
  echo "PETSc $(release petsc "$version") and SLEPc $(release slepc "$version"): ${#sources[@]} files compile."
done
