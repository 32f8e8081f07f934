// Converts PETSc's error codes to C++ exceptions. An exception thrown inside a callback is stored and rethrown after
// PETSc has returned.
#include "base/petsc.hpp"

#include <new>
#include <string>

namespace traverse::base {
namespace {
std::exception_ptr pending;  // the exception that passes through PETSc's frames as an error code
}

PetscErrorCode keep_exception() noexcept {
  if (!pending) pending = std::current_exception();
  return PETSC_ERR_LIB;
}

void check(PetscErrorCode code) {
  if (code == 0) return;
  if (pending) std::rethrow_exception(std::exchange(pending, nullptr));
  if (code == PETSC_ERR_MEM) throw std::bad_alloc();
  const char* text = nullptr;
  (void)PetscErrorMessage(code, &text, nullptr);
  const std::string specific = details_of(code, PetscErrorMessage);
  std::string message = "PETSc error " + std::to_string(static_cast<int>(code));
  if (text != nullptr) message += std::string(": ") + text;
  if (!specific.empty()) message += ": " + specific;
  throw SolverError(message);
}

}  // namespace traverse::base
