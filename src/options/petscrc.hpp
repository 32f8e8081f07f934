// Options from where users of PETSc leave them: the files .petscrc and petscrc, the variables PETSC_OPTIONS and
// PETSC_OPTIONS_YAML. Traverse reads them itself, checks them as all others, and says what each does; PETSc does not.
#pragma once

#include <string>
#include <vector>

#include "traverse/options/entry.hpp"

namespace traverse::options {

/// Their options in the order in which later ones win: ~/.petscrc, .petscrc, petscrc, PETSC_OPTIONS,
/// PETSC_OPTIONS_YAML. Takes the two variables out of the environment, where PETSc would read them again. InputError
/// where they are not well formed. files: whether the files are read.
std::vector<Entry> read_petscrc(bool files);

/// Adds those that are options of Traverse's to the options in force where these do not give them. Returns a line on
/// each: that it is in force, what overrides it, or that it is left out.
std::vector<std::string> add_weakest(std::vector<Entry> given, Entries& in_force);

}  // namespace traverse::options
