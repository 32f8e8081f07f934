#include "traverse/coupling/beam_operator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace traverse::coupling {
namespace {

constexpr std::size_t kept_factors = 12;
constexpr int most_unknowns = beam::kinds;  // of a column

// r += sign*A x for the nodes of one rank; the neighbours' border nodes come in `left` and `right` (null: none).
// B > 0 fixes the block size at compile time.
template <int B>
void block_product(const solve::BlockTridiagonal& A, double sign, const double* x, const double* left,
                   const double* right, const double* left_upper, double* r) {
  const int b = B > 0 ? B : A.block;
  const int bb = b * b;
  for (int i = 0; i < A.nodes; ++i) {
    const double* D = A.diagonal.data() + static_cast<std::ptrdiff_t>(i) * bb;
    const double* xi = x + static_cast<std::ptrdiff_t>(i) * b;
    const double* U = A.upper.data() + static_cast<std::ptrdiff_t>(i) * bb;
    const double* next = i + 1 < A.nodes ? xi + b : right;
    const double* L = i > 0 ? U - bb : left_upper;
    const double* previous = i > 0 ? xi - b : left;
    double* ri = r + static_cast<std::ptrdiff_t>(i) * b;
    std::array<double, (B > 0 ? B : most_unknowns)> sum{};
    for (int col = 0; col < b; ++col)  // down the columns, as they are stored
      for (int row = 0; row < b; ++row) sum[row] += D[row + col * b] * xi[col];
    if (next != nullptr)
      for (int col = 0; col < b; ++col)
        for (int row = 0; row < b; ++row) sum[row] += U[row + col * b] * next[col];
    if (previous != nullptr && L != nullptr)
      for (int row = 0; row < b; ++row)
        for (int col = 0; col < b; ++col) sum[row] += L[col + row * b] * previous[col];
    for (int row = 0; row < b; ++row) ri[row] += sign * sum[row];
  }
}

}  // namespace

BeamOperator::BeamOperator(const beam::Beam& beam)
    : comm_(beam.comm()),
      left_rank_(MPI_PROC_NULL),
      right_rank_(MPI_PROC_NULL),
      fixed_(beam.fixed()),
      mass_(solve::BlockTridiagonal::from(beam.mass(), beam.block())),
      damping_(solve::BlockTridiagonal::from(beam.damping(), beam.block())),
      stiffness_(solve::BlockTridiagonal::from(beam.stiffness(), beam.block())),
      work_(beam.block(), beam.local_columns()),
      halo_(4 * static_cast<std::size_t>(beam.block()) + static_cast<std::size_t>(beam.block()) * beam.block() * 3),
      mass_factor_(beam.comm(), beam.block(), beam.local_columns()) {
  if (beam.local_columns() > 0) {
    if (beam.first_column() > 0) left_rank_ = beam.owner(beam.first_column() - 1);
    if (beam.first_column() + beam.local_columns() < beam.columns())
      right_rank_ = beam.owner(beam.first_column() + beam.local_columns());
  }
  damped_ = std::any_of(damping_.diagonal.begin(), damping_.diagonal.end(), [](double d) { return d != 0.0; });
  int damped = damped_ ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &damped, 1, MPI_INT, MPI_MAX, comm_);
  damped_ = damped != 0;

  // The coupling block to the left neighbour's last node is that rank's; fetch it once for M, C, K.
  const int b = mass_.block;
  const int bb = b * b;
  std::vector<double> send(3 * static_cast<std::size_t>(bb), 0.0);
  double* received = halo_.data() + 4 * b;
  if (mass_.nodes > 0) {
    const std::size_t last = static_cast<std::size_t>(mass_.nodes - 1) * bb;
    std::copy_n(mass_.upper.data() + last, bb, send.data());
    std::copy_n(damping_.upper.data() + last, bb, send.data() + bb);
    std::copy_n(stiffness_.upper.data() + last, bb, send.data() + 2 * bb);
  }
  MPI_Sendrecv(send.data(), 3 * bb, MPI_DOUBLE, right_rank_, 0, received, 3 * bb, MPI_DOUBLE, left_rank_, 0, comm_,
               MPI_STATUS_IGNORE);
  mass_factor_.factor(mass_, fixed_);
}

void BeamOperator::borders(const double* x, double* left, double* right) const {
  if (left_rank_ == MPI_PROC_NULL && right_rank_ == MPI_PROC_NULL) return;
  const int b = mass_.block;
  const double* last = x + static_cast<std::ptrdiff_t>(mass_.nodes - 1) * b;
  MPI_Sendrecv(x, b, MPI_DOUBLE, left_rank_, 1, right, b, MPI_DOUBLE, right_rank_, 1, comm_, MPI_STATUS_IGNORE);
  MPI_Sendrecv(last, b, MPI_DOUBLE, right_rank_, 2, left, b, MPI_DOUBLE, left_rank_, 2, comm_, MPI_STATUS_IGNORE);
}

void BeamOperator::product(const solve::BlockTridiagonal& A, double sign, const double* x, double* r) const {
  const int b = A.block;
  double* left = halo_.data();
  double* right = halo_.data() + b;
  borders(x, left, right);
  const int kind = &A == &mass_ ? 0 : &A == &damping_ ? 1 : 2;
  const double* left_upper = halo_.data() + 4 * b + kind * b * b;
  const double* l = left_rank_ != MPI_PROC_NULL ? left : nullptr;
  const double* rt = right_rank_ != MPI_PROC_NULL ? right : nullptr;
  if (b == 2)
    block_product<2>(A, sign, x, l, rt, left_upper, r);
  else if (b == 3)
    block_product<3>(A, sign, x, l, rt, left_upper, r);
  else if (b == 5)
    block_product<5>(A, sign, x, l, rt, left_upper, r);
  else if (b == 7)
    block_product<7>(A, sign, x, l, rt, left_upper, r);
  else
    block_product<0>(A, sign, x, l, rt, left_upper, r);
}

void BeamOperator::multiply(double sign, const double* m, const double* c, const double* k, double* r) const {
  std::fill_n(r, unknowns(), 0.0);
  if (m != nullptr) product(mass_, sign, m, r);
  if (c != nullptr && damped_) product(damping_, sign, c, r);
  if (k != nullptr) product(stiffness_, sign, k, r);
}

void BeamOperator::solve_mass(double* x) const {
  ++solves;
  mass_factor_.solve(x);
}

const solve::SubstructuredCholesky& BeamOperator::factored(double shift, const AddedSprings* added) {
  const long version = added != nullptr ? added->version : 0;
  auto same = [&](const Factor& f) {
    return f.added == version && std::abs(f.shift - shift) <= 1e-9 * std::abs(shift);
  };
  auto found = std::find_if(factors_.begin(), factors_.end(), same);
  if (found != factors_.end()) {
    factors_.splice(factors_.begin(), factors_, found);
  } else {
    if (factors_.size() < kept_factors)
      factors_.push_front({shift, version, 0, solve::SubstructuredCholesky(comm_, work_.block, work_.nodes)});
    else
      factors_.splice(factors_.begin(), factors_, std::prev(factors_.end()));
    Factor& f = factors_.front();
    f.shift = shift;
    f.added = version;
    f.stamp = ++factorisations_;
    work_.combine(shift * shift, mass_, shift, damping_, 1.0, stiffness_);
    if (added != nullptr) {
      for (const AddedSprings::Term& t : *added->terms)
        (t.upper ? work_.upper : work_.diagonal)[t.place] += t.shape * (added->k[t.point] + shift * added->c[t.point]);
    }
    try {
      f.cholesky.factor(work_, fixed_);
    } catch (...) {
      factors_.pop_front();
      throw;
    }
  }
  stamp_ = factors_.front().stamp;
  return factors_.front().cholesky;
}

}  // namespace traverse::coupling
