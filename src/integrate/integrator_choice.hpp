// The integrator that the options select.
#pragma once

#include <optional>
#include <string>

#include "base/one_step_methods.hpp"

namespace traverse::integrate {

/// The integrator's type: the given type, or the type that other given options need, otherwise by_accuracy unless it is
/// empty. Throws InputError for types that this system does not support (some of them fail without a message), and for
/// options that do not fit the type.
std::string chosen_type(const std::string& by_accuracy = {});

/// Whether an option determines the type, so that it must not be chosen automatically.
bool type_is_given();

/// The method of the chosen type, for steps of 1 s; none for a type of PETSc.
std::optional<base::Method> own_method(const std::string& by_accuracy = {});

}  // namespace traverse::integrate
