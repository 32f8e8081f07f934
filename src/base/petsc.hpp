// PETSc handles with one owner, PETSc codes as exceptions, and the guard for code that PETSc calls.
#pragma once

#include <petscts.h>

#include <exception>
#include <utility>

#include "base/petsc_versions.hpp"
#include "traverse/base/error.hpp"

namespace traverse::base {

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
