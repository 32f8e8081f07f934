// Options that PETSc has renamed (base/petsc_versions.hpp). Users may write either name with every version of PETSc.
#pragma once

#include <string>

#include "traverse/options/entry.hpp"

namespace traverse::options {

/// Renames entries with a newer name of PETSc to the name in Traverse. InputError if both names are given.
void use_own_names(Entries& entries);

/// The name of an option in the linked version of PETSc.
std::string name_in_petsc(const std::string& name);
/// The name of an option in Traverse, from either name.
std::string own_name(const std::string& name);

}  // namespace traverse::options
