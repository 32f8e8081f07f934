// Options that PETSc has renamed (base/petsc_versions.hpp): users may write either name, whatever the version of PETSc.
#pragma once

#include <string>

#include "traverse/options/entry.hpp"

namespace traverse::options {

/// Gives entries under a newer name the name that Traverse has for it. InputError where both are given.
void take_other_names(Entries& entries);

/// The name by which the PETSc at hand knows an option of Traverse's or its own.
std::string name_in_petsc(const std::string& name);
/// The name that Traverse has for an option, by whichever it is called.
std::string own_name(const std::string& name);

}  // namespace traverse::options
