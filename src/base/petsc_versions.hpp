// All that PETSc and SLEPc 3.18 to 3.25 name or type differently and Traverse calls. scripts/petsc_versions.sh compiles
// against each of them.
#pragma once

#include <petscmat.h>

#include <array>
#include <string>
#include <type_traits>

namespace traverse::base {

/// What callbacks return: PETSC_SUCCESS from 3.19 on, where codes may be a type of their own.
inline constexpr auto success = static_cast<PetscErrorCode>(0);

/// What setfromoptions of a type takes: PetscOptionItems is a pointer itself from 3.23 on.
using OptionItems = std::conditional_t<std::is_pointer_v<PetscOptionItems>, PetscOptionItems, PetscOptionItems*>;

/// The last argument of MatShellSetOperation: a function that returns nothing, from 3.24 on a PetscErrorCode.
template <class Operation>
Operation operation_of(PetscErrorCode (*)(Mat, MatOperation, Operation));
using ShellOperation = decltype(operation_of(MatShellSetOperation));

/// What PETSc says of the error at hand besides its kind; empty where it says nothing. `message` is PetscErrorMessage,
/// whose last argument is of constant text from 3.25 on.
template <class Text>
std::string details_of(PetscErrorCode code, PetscErrorCode (*message)(PetscErrorCode, const char**, Text**)) {
  Text* details = nullptr;
  (void)message(code, nullptr, &details);
  return details != nullptr ? details : "";
}

/// An option that has another name from 3.25 on. Traverse takes both and calls it by the first one, with any PETSc;
/// `known` is the name that the PETSc at hand reads.
struct RenamedOption {
  const char *name, *newer;
  constexpr const char* known() const { return PETSC_VERSION_LT(3, 25, 0) ? name : newer; }
  constexpr const char* unknown() const { return PETSC_VERSION_LT(3, 25, 0) ? newer : name; }
};
inline constexpr std::array renamed_options = {RenamedOption{"ts_dt", "ts_time_step"},
                                               RenamedOption{"ts_max_reject", "ts_max_step_rejections"}};

}  // namespace traverse::base
