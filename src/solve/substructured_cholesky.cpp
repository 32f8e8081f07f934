// Selects the factorisation compiled for the block size, from 2 to 7 unknowns per node or the general one, and forwards
// all calls to it.
#include <stdexcept>
#include <string>
#include <utility>

#include "solve/block_tridiagonal.hpp"
#include "substructure.hpp"

namespace traverse::solve {
namespace {

std::unique_ptr<AnySubstructure> make_substructure(MPI_Comm comm, int block_size, int local_nodes) {
  if (block_size < 1 || block_size > largest_block || local_nodes < 0) {
    throw std::logic_error("blocks have 1 to " + std::to_string(largest_block) + " unknowns");
  }
  switch (block_size) {
    case 2:
      return std::make_unique<Substructure<2>>(comm, block_size, local_nodes);
    case 3:
      return std::make_unique<Substructure<3>>(comm, block_size, local_nodes);
    case 4:
      return std::make_unique<Substructure<4>>(comm, block_size, local_nodes);
    case 5:
      return std::make_unique<Substructure<5>>(comm, block_size, local_nodes);
    case 6:
      return std::make_unique<Substructure<6>>(comm, block_size, local_nodes);
    case 7:
      return std::make_unique<Substructure<7>>(comm, block_size, local_nodes);
    default:
      return std::make_unique<Substructure<any_block>>(comm, block_size, local_nodes);
  }
}

}  // namespace

struct SubstructuredCholesky::Impl {
  std::unique_ptr<AnySubstructure> substructure;
  int block = 0;
  std::ptrdiff_t nodes = 0;
};

SubstructuredCholesky::SubstructuredCholesky(MPI_Comm comm, int block_size, int local_nodes)
    : impl_(std::make_unique<Impl>(Impl{make_substructure(comm, block_size, local_nodes), block_size, local_nodes})) {}
SubstructuredCholesky::~SubstructuredCholesky() = default;
SubstructuredCholesky::SubstructuredCholesky(SubstructuredCholesky&&) noexcept = default;
SubstructuredCholesky& SubstructuredCholesky::operator=(SubstructuredCholesky&&) noexcept = default;

void SubstructuredCholesky::factor(const BlockTridiagonal& A, const std::vector<char>& fixed) {
  impl_->substructure->factor(A, fixed);
}

void SubstructuredCholesky::solve(double* x, int columns) const {
  const Range all = {0, impl_->nodes};
  impl_->substructure->solve({{x, 0, impl_->nodes * impl_->block}, columns, all, nullptr});
}

void SubstructuredCholesky::solve(double* x, RhsCallback& rhs_callback) const {
  const Range all = {0, impl_->nodes};
  impl_->substructure->solve({{x, 0, impl_->nodes * impl_->block}, 1, all, &rhs_callback});
}

void SubstructuredCholesky::solve_window(double* x, std::ptrdiff_t first, std::ptrdiff_t past,
                                         RhsCallback& rhs_callback) const {
  impl_->substructure->solve({{x, 0, impl_->nodes * impl_->block}, 1, {first, past}, &rhs_callback});
}

void SubstructuredCholesky::solve_local(double* x, int columns, std::ptrdiff_t first, std::ptrdiff_t past) const {
  impl_->substructure->solve({{x, first, (past - first) * impl_->block}, columns, {first, past}, nullptr});
}

double SubstructuredCholesky::pivot_ratio() const { return impl_->substructure->pivot_ratio(); }
std::size_t SubstructuredCholesky::stored_numbers() const { return impl_->substructure->stored_numbers(); }

}  // namespace traverse::solve
