// The values of -ts_type, which are the program's own methods (base::methods) and the types of PETSc that integrate
// this system correctly, and the integrator that the options select.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/one_step_methods.hpp"

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

/// The integrator's type: the given type, or the type that other given options need, otherwise by_accuracy unless it is
/// empty. Throws InputError for types that this system does not support (some of them fail without a message), and for
/// options that do not fit the type.
std::string chosen_type(const std::string& by_accuracy = {});

/// Whether an option determines the type, so that it must not be chosen automatically.
bool type_is_given();

/// The method of the chosen type, for steps of 1 s; none for a type of PETSc.
std::optional<base::Method> own_method(const std::string& by_accuracy = {});

}  // namespace traverse::integrate
