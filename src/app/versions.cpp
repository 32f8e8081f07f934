// The libraries are asked themselves: they may be newer than those that the program was compiled with.
#include "versions.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <slepcsys.h>

#include <array>
#include <string_view>

#include "traverse/base/version.hpp"

namespace traverse::app {
namespace {

using Version = std::array<PetscInt, 4>;

/// A line with the version that a function of PETSc or SLEPc tells.
std::string line_of(const char* name, PetscErrorCode (*tell)(PetscInt*, PetscInt*, PetscInt*, PetscInt*)) {
  Version v = {};
  (void)tell(&v[0], &v[1], &v[2], &v[3]);
  return fmt::format("{} {}.{}.{}\n", name, v[0], v[1], v[2]);
}

std::string line_of_hdf5() {
  std::array<unsigned, 3> v = {};
  (void)H5get_libversion(&v[0], &v[1], &v[2]);
  return fmt::format("HDF5 {}.{}.{}\n", v[0], v[1], v[2]);
}

/// The name and version at the beginning of what MPI says of itself.
std::string line_of_mpi() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text = {};
  int length = 0;
  (void)MPI_Get_library_version(text.data(), &length);
  const std::string_view said(text.data());
  return fmt::format("{}\n", said.substr(0, said.find_first_of(",\n")));
}

#ifdef __clang__
constexpr const char* compiler = "clang " __clang_version__;
#else
constexpr const char* compiler = "g++ " __VERSION__;
#endif

}  // namespace

std::string versions() {
  return fmt::format("traverse {}\n", version()) + line_of("PETSc", PetscGetVersionNumber) +
         line_of("SLEPc", SlepcGetVersionNumber) + line_of_hdf5() + line_of_mpi() +
         fmt::format("compiled by {}\n", compiler);
}

}  // namespace traverse::app
