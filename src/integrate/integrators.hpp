// What -ts_type may name: the program's own methods (structure::methods) and those types of PETSc that integrate this
// system rightly.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace traverse::integrate {

/// A type of PETSc's that works here.
struct PetscType {
  const char* name;
  bool implicit;
  bool multistep;
  int order;  // as it is set here, unless options say otherwise
  const char* words;
};

std::span<const PetscType> petsc_types();
/// Null: it is none of these.
const PetscType* find_petsc_type(std::string_view name);

/// A line for each choice of -ts_type, for -help.
std::string integrators_help();

}  // namespace traverse::integrate
