// Converts PETSc's error codes to C++ exceptions; an exception thrown inside a callback is kept and rethrown once PETSc
// has returned.
#include "base/petsc.hpp"

#include <new>
#include <string>

namespace traverse::base {
namespace {
std::exception_ptr kept;  // the exception on its way through PETSc's frames
}

PetscErrorCode keep_exception() noexcept {
  if (!kept) kept = std::current_exception();
  return PETSC_ERR_LIB;
}

void check(PetscErrorCode code) {
  if (code == 0) return;
  if (kept) std::rethrow_exception(std::exchange(kept, nullptr));
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
