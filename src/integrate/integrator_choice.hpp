// Which of the integrators that work here the options ask for.
#pragma once

#include <optional>
#include <string>

#include "base/one_step_methods.hpp"

namespace traverse::integrate {

/// The type: as given, or the one that the options given belong to, or else by_accuracy where that is not empty. Others
/// than those named in its message fail on this system, some of them without a word. InputError for these, and for
/// options that do not go with the type.
std::string chosen_type(const std::string& by_accuracy = {});

/// Whether an option says how steps are taken, so that nothing else may choose the type.
bool type_is_given();

/// The method of that type, for steps of 1 s; none where the type is PETSc's own.
std::optional<structure::Method> own_method(const std::string& by_accuracy = {});

}  // namespace traverse::integrate
