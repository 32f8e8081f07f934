// A PCSHELL that factorises the matrix by SubstructuredCholesky in its set-up and solves with it when applied.
#include "solve/beam_preconditioner.hpp"

#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>

#include "base/petsc.hpp"
#include "solve/block_tridiagonal.hpp"

namespace traverse::solve {
namespace {

using base::check;
using base::guard;

/// Reads this rank's rows; if this fails on one rank, all ranks throw.
BlockTridiagonal read_everywhere(MPI_Comm comm, Mat matrix, int block) {
  BlockTridiagonal blocks;
  std::exception_ptr failure;
  try {
    blocks = BlockTridiagonal::from(matrix, block);
  } catch (const std::logic_error&) {
    failure = std::current_exception();
  }
  int failed = failure ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, comm);
  if (failure) std::rethrow_exception(failure);
  if (failed != 0) throw std::logic_error("another rank's rows are not block tridiagonal");
  return blocks;
}

class BeamPreconditioner {
 public:
  void set_up(PC pc) {
    Mat matrix = nullptr;
    check(PCGetOperators(pc, nullptr, &matrix));
    PetscInt block = 1;
    check(MatGetBlockSize(matrix, &block));
    const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(matrix));
    const BlockTridiagonal blocks = read_everywhere(comm, matrix, static_cast<int>(block));
    cholesky_.emplace(comm, blocks.block, blocks.nodes);
    cholesky_->factor(blocks, {});
  }

  void apply(Vec right_hand_side, Vec solution) const {
    check(VecCopy(right_hand_side, solution));
    double* x = nullptr;
    check(VecGetArray(solution, &x));
    cholesky_->solve(x);
    check(VecRestoreArray(solution, &x));
  }

 private:
  std::optional<SubstructuredCholesky> cholesky_;
};

BeamPreconditioner& of(PC pc) {
  void* context = nullptr;
  check(PCShellGetContext(pc, &context));
  return *static_cast<BeamPreconditioner*>(context);
}

PetscErrorCode set_up(PC pc) {
  return guard([&] { of(pc).set_up(pc); });
}

PetscErrorCode apply(PC pc, Vec right_hand_side, Vec solution) {
  return guard([&] { of(pc).apply(right_hand_side, solution); });
}

PetscErrorCode destroy(PC pc) {
  return guard([&] { delete &of(pc); });
}

}  // namespace

void use_beam_factorisation(PC pc) {
  check(PCSetType(pc, PCSHELL));
  check(PCShellSetName(pc, "block tridiagonal Cholesky"));
  check(PCShellSetSetUp(pc, set_up));
  check(PCShellSetApply(pc, apply));
  check(PCShellSetDestroy(pc, destroy));
  check(PCShellSetContext(pc, std::make_unique<BeamPreconditioner>().release()));
}

}  // namespace traverse::solve
