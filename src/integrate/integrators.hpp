// The values of -ts_type: the program's own methods (base::methods) and the types of PETSc that integrate this
// system correctly.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace traverse::integrate {

/// A type of PETSc that this program supports.
struct PetscType {
  const char* name;
  bool implicit;
  bool multistep;
  int order;  // order as set here, unless options change it
  const char* words;
};

std::span<const PetscType> petsc_types();
/// The PETSc type with this name; null for other types.
const PetscType* find_petsc_type(std::string_view name);

/// A line for each choice of -ts_type, for -help.
std::string integrators_help();

}  // namespace traverse::integrate
