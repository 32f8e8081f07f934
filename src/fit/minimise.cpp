// TAO runs on rank 0; its callbacks evaluate the residuals on all ranks.
#include "fit/minimise.hpp"

#include <petsctao.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <string>

#include "base/petsc.hpp"

namespace traverse::fit {
namespace {

constexpr double gradient = 1e-3;  // at the end, in standard errors
constexpr double relative_gradient = 1e-8;
constexpr double allowed_decrease = 1e-2;  // of the sum of squares by the linearised residuals, over their mean
constexpr double least_mean = 1.0;         // mean square of residuals as large as their standard deviations
constexpr long most_iterations = 50;

using Vector = Eigen::Map<Eigen::VectorXd>;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

/// The entries of a vector of PETSc, as long as the object exists.
class Entries {
 public:
  explicit Entries(Vec vector) : vector_(vector) {
    base::check(VecGetArray(vector, &array_));
    base::check(VecGetLocalSize(vector, &size_));
  }
  Entries(const Entries&) = delete;
  Entries& operator=(const Entries&) = delete;
  ~Entries() { (void)VecRestoreArray(vector_, &array_); }
  Vector get() { return {array_, size_}; }

 private:
  Vec vector_;
  double* array_ = nullptr;
  PetscInt size_ = 0;
};

Eigen::VectorXd copy_of(Vec vector) {
  PetscInt size = 0;
  const double* array = nullptr;
  base::check(VecGetLocalSize(vector, &size));
  base::check(VecGetArrayRead(vector, &array));
  Eigen::VectorXd copy = ConstVector(array, size);
  base::check(VecRestoreArrayRead(vector, &array));
  return copy;
}

/// The unknowns of TAO are the changes of the unknowns u from their start times their sensitivity there: numbers of
/// standard errors. So is the gradient. The regularisation of TAO's method begins at 0.
struct ScaledProblem {
  Problem& problem;
  Eigen::VectorXd start, scale;

  Eigen::VectorXd u(Vec x) const { return (start + copy_of(x).cwiseQuotient(scale)).cwiseMax(0.0).cwiseMin(1.0); }
};

PetscErrorCode find_residuals(Tao, Vec x, Vec r, void* context) {
  return base::guard([&] {
    const auto& scaled = *static_cast<const ScaledProblem*>(context);
    Entries(r).get() = scaled.problem.evaluate(scaled.u(x));
  });
}

PetscErrorCode find_jacobian(Tao, Vec x, Mat J, Mat, void* context) {
  return base::guard([&] {
    const auto& scaled = *static_cast<const ScaledProblem*>(context);
    const Eigen::MatrixXd found = scaled.problem.jacobian(scaled.u(x)) * scaled.scale.cwiseInverse().asDiagonal();
    double* array = nullptr;
    base::check(MatDenseGetArray(J, &array));
    std::copy_n(found.data(), found.size(), array);
    base::check(MatDenseRestoreArray(J, &array));
    base::check(MatAssemblyBegin(J, MAT_FINAL_ASSEMBLY));
    base::check(MatAssemblyEnd(J, MAT_FINAL_ASSEMBLY));
  });
}

base::Handle<Vec> vector_of(Eigen::Index size) {
  base::Handle<Vec> vector;
  base::check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(size), vector.out()));
  base::check(VecSet(vector, 0.0));
  return vector;
}

/// The scale of the unknowns for TAO's method; POUNDERS has no derivatives, and a first step that suits u.
Eigen::VectorXd scale_of(Tao tao, const Problem& problem, const Eigen::VectorXd& u) {
  TaoType type = nullptr;
  base::check(TaoGetType(tao, &type));
  if (std::string(type) == TAOPOUNDERS) return Eigen::VectorXd::Ones(u.size());
  return problem.jacobian(u).colwise().norm().transpose().cwiseMax(1.0);
}

}  // namespace

bool has_converged(const Minimum& minimum) {
  const std::vector<char> held = at_bounds(minimum);
  Eigen::MatrixXd free(minimum.jacobian.rows(), 0);
  for (std::size_t j = 0; j < held.size(); ++j) {
    if (held[j] != 0) continue;
    free.conservativeResize(Eigen::NoChange, free.cols() + 1);
    free.rightCols(1) = minimum.jacobian.col(static_cast<Eigen::Index>(j));
  }
  if (free.cols() == 0) return true;
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(free);
  const double decrease = (free * decomposition.solve(minimum.residuals)).squaredNorm();
  const double mean = minimum.residuals.squaredNorm() / static_cast<double>(minimum.residuals.size());
  return decrease <= allowed_decrease * std::max(mean, least_mean);
}

std::vector<char> at_bounds(const Minimum& minimum) {
  const Eigen::VectorXd slope = minimum.jacobian.transpose() * minimum.residuals;
  std::vector<char> held;
  for (Eigen::Index j = 0; j < slope.size(); ++j)
    held.push_back((minimum.u[j] <= 0.0 && slope[j] > 0.0) || (minimum.u[j] >= 1.0 && slope[j] < 0.0) ? 1 : 0);
  return held;
}

Minimum minimise(Problem& problem, const Eigen::VectorXd& start) {
  problem.set_steps(start);
  const Eigen::Index size = start.size(), count = static_cast<Eigen::Index>(problem.residuals().size());
  ScaledProblem scaled{problem, start, Eigen::VectorXd::Ones(size)};
  const base::Handle<Vec> x = vector_of(size), low = vector_of(size), high = vector_of(size), r = vector_of(count);
  base::Handle<Mat> J;
  base::check(
      MatCreateSeqDense(PETSC_COMM_SELF, static_cast<PetscInt>(count), static_cast<PetscInt>(size), nullptr, J.out()));
  base::Handle<Tao> tao;
  base::check(TaoCreate(PETSC_COMM_SELF, tao.out()));
  base::check(TaoSetType(tao, TAOBRGN));
  base::check(TaoSetSolution(tao, x));
  base::check(TaoSetVariableBounds(tao, low, high));
  base::check(TaoSetResidualRoutine(tao, r, find_residuals, &scaled));
  base::check(TaoSetJacobianResidualRoutine(tao, J, J, find_jacobian, &scaled));
  base::check(TaoSetTolerances(tao, gradient, relative_gradient, 0.0));
  base::check(TaoSetMaximumIterations(tao, most_iterations));
  base::check(TaoSetFromOptions(tao));
  scaled.scale = scale_of(tao, problem, start);
  Entries(low).get() = -start.cwiseProduct(scaled.scale);
  Entries(high).get() = scaled.scale - start.cwiseProduct(scaled.scale);
  base::check(TaoSolve(tao));
  Minimum minimum;
  PetscInt iterations = 0;
  TaoConvergedReason reason = TAO_CONTINUE_ITERATING;
  base::check(TaoGetIterationNumber(tao, &iterations));
  base::check(TaoGetConvergedReason(tao, &reason));
  minimum.u = scaled.u(x);
  minimum.residuals = problem.evaluate(minimum.u);
  minimum.jacobian = problem.jacobian(minimum.u);
  minimum.iterations = iterations;
  minimum.reason = TaoConvergedReasons[reason];
  return minimum;
}

}  // namespace traverse::fit
