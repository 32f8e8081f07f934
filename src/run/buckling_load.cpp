// The buckling load is N = 1/mu times the given compression, with the largest mu of G x = mu K x: G is the stiffness
// that the compression removes and K the stiffness without it. Power iteration with Rayleigh's quotient, whose error is
// the square of that of the shape.
#include "run/buckling_load.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/petsc.hpp"
#include "structure/beam_operator.hpp"
#include "traverse/base/error.hpp"

namespace traverse::run {
namespace {

constexpr int most_iterations = 5000;
constexpr double converged = 1e-12;  // relative change of the quotient

double sum_over_ranks(MPI_Comm comm, const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, comm);
  return sum;
}

}  // namespace

double buckling_load(const beam::Beam& compressed) {
  beam::BeamModel model = compressed.model();
  const double largest = -model.foundation.rotational_bed->k.minimum();
  model.foundation.rotational_bed.reset();
  beam::Beam straight(compressed.comm(), std::move(model));
  straight.set_rayleigh({});
  structure::BeamOperator stiffness(straight);
  const Mat removed = compressed.foundation().of("rotational_bed")[0];

  const auto size = static_cast<std::size_t>(straight.local_unknowns());
  base::Handle<Vec> in, out;
  base::check(MatCreateVecs(removed, in.out(), out.out()));
  const auto multiply = [&](const std::vector<double>& x, std::vector<double>& y) {
    double* to = nullptr;
    base::check(VecGetArray(in, &to));
    std::copy(x.begin(), x.end(), to);
    base::check(VecRestoreArray(in, &to));
    base::check(MatMult(removed, in, out));
    const double* from = nullptr;
    base::check(VecGetArrayRead(out, &from));
    for (std::size_t i = 0; i < size; ++i) y[i] = -from[i];
    base::check(VecRestoreArrayRead(out, &from));
  };

  std::vector<double> x(size), Gx(size), y(size), Gy(size);
  for (std::size_t i = 0; i < size; ++i)
    x[i] = straight.fixed()[i] != 0 ? 0.0 : 1.0 + std::sin(1.0 + static_cast<double>(i) + straight.first_column());
  multiply(x, Gx);
  double mu = 0.0;
  for (int i = 0; i < most_iterations; ++i) {
    y = Gx;
    stiffness.solve_static(y.data());  // K y = G x
    multiply(y, Gy);
    const double before =
        std::exchange(mu, sum_over_ranks(straight.comm(), y, Gy) / sum_over_ranks(straight.comm(), y, Gx));
    if (std::abs(mu - before) <= converged * mu) return largest / mu;
    const double length = std::sqrt(sum_over_ranks(straight.comm(), y, Gy));
    for (std::size_t k = 0; k < size; ++k) Gx[k] = Gy[k] / length;
  }
  throw SolverError("beam_tension: the buckling load does not converge");
}

}  // namespace traverse::run
