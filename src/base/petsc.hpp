// PETSc handles with one owner, PETSc codes as exceptions, the guard for code that PETSc calls, and the names and types
// of PETSc and SLEPc that Traverse uses and that differ between 3.18 and 3.25 (scripts/petsc_versions.sh compiles
// against each version).
#pragma once

#include <petscmat.h>
#include <petscts.h>

#include <array>
#include <exception>
#include <string>
#include <type_traits>
#include <utility>

#include "traverse/base/error.hpp"

namespace traverse::base {

/// The success code of callbacks: PETSC_SUCCESS from 3.19 on, where codes may have a separate type.
inline constexpr auto success = static_cast<PetscErrorCode>(0);

/// The argument type of setfromoptions: PetscOptionItems is a pointer from 3.23 on.
using OptionItems = std::conditional_t<std::is_pointer_v<PetscOptionItems>, PetscOptionItems, PetscOptionItems*>;

/// The last argument of MatShellSetOperation: a function without a result, from 3.24 on with a PetscErrorCode.
template <class Operation>
Operation operation_of(PetscErrorCode (*)(Mat, MatOperation, Operation));
using ShellOperation = decltype(operation_of(MatShellSetOperation));

/// PETSc's specific text on the present error; empty if there is none. `message` is PetscErrorMessage, whose last
/// argument points to constant text from 3.25 on.
template <class Text>
std::string details_of(PetscErrorCode code, PetscErrorCode (*message)(PetscErrorCode, const char**, Text**)) {
  Text* details = nullptr;
  (void)message(code, nullptr, &details);
  return details != nullptr ? details : "";
}

/// An option with a different name from 3.25 on. Traverse accepts both names and uses the first one with any PETSc;
/// `known` is the name that the present PETSc reads.
struct RenamedOption {
  const char *name, *newer;
  constexpr const char* known() const { return PETSC_VERSION_LT(3, 25, 0) ? name : newer; }
  constexpr const char* unknown() const { return PETSC_VERSION_LT(3, 25, 0) ? newer : name; }
};
inline constexpr std::array renamed_options = {RenamedOption{"ts_dt", "ts_time_step"},
                                               RenamedOption{"ts_max_reject", "ts_max_step_rejections"}};

/// Turns a PETSc error code into a SolverError. Only this function turns codes into exceptions.
void check(PetscErrorCode code);

/// Stores the current exception for the next `check` and returns a PETSc error code. Only `guard` calls it.
PetscErrorCode keep_exception() noexcept;

/// Runs `body` inside a PETSc callback. An exception becomes a PETSc error code, and the `check` around the PETSc call
/// rethrows it unchanged. No exception passes through PETSc's frames.
template <class Body>
PetscErrorCode guard(Body&& body) noexcept {
  try {
    body();
    return success;
  } catch (...) {
    return keep_exception();
  }
}

/// Move-only owner of one PETSc object (Mat, Vec, TS, EPS, ...). Borrowed objects remain raw.
template <class Object>
class Handle {
 public:
  Handle() = default;
  explicit Handle(Object object) : object_(object) {}
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Handle() {
    if (object_ == nullptr) return;
    PetscObject raw = reinterpret_cast<PetscObject>(object_);
    (void)PetscObjectDestroy(&raw);
  }

  /// For PETSc's creating calls: `check(MatCreate(comm, m.out()))`.
  Object* out() {
    *this = Handle();
    return &object_;
  }
  operator Object() const { return object_; }  // NOLINT: a handle is used in place of its object

 private:
  Object object_ = nullptr;
};

}  // namespace traverse::base
