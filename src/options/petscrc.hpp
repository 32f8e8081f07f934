// Options from the places that PETSc reads: the files .petscrc and petscrc, the variables PETSC_OPTIONS and
// PETSC_OPTIONS_YAML. Traverse reads them instead of PETSc, checks them as all others, and reports the effect of each.
// Of options that PETSc has renamed (base/petsc_versions.hpp) users may write either name with every version of PETSc.
#pragma once

#include <string>
#include <vector>

#include "traverse/options/entry.hpp"

namespace traverse::options {

/// The options of ~/.petscrc, .petscrc, petscrc, PETSC_OPTIONS, PETSC_OPTIONS_YAML in this order, in which later ones
/// override earlier ones. Removes the two variables from the environment, so that PETSc does not read them. InputError
/// if they are not well formed. files: whether the files are read.
std::vector<Entry> read_petscrc(bool files);

/// Adds the options of Traverse among them to the options in force, unless these have an entry of the same name.
/// Returns a line for each: that it is in force, which entry overrides it, or that it is ignored.
std::vector<std::string> add_weakest(std::vector<Entry> given, Entries& in_force);

/// Renames entries with a newer name of PETSc, or a former name of Traverse, to the present name in Traverse. Returns a
/// line for each former name. InputError if both names are given.
std::vector<std::string> use_own_names(Entries& entries);

/// The name of an option in the linked version of PETSc.
std::string name_in_petsc(const std::string& name);
/// The present name of an option in Traverse, from any of its names.
std::string own_name(const std::string& name);

}  // namespace traverse::options
