// TAO runs on rank 0; its callbacks evaluate the residuals on all ranks.
#include "fit/minimise.hpp"

#include <petsctao.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/petsc.hpp"

namespace traverse::app {
namespace {

constexpr double gradient = 1e-4;     // at the end, over the least sensitivity: in standard errors
constexpr double insensitive = 1e-8;  // relative to the largest sensitivity
constexpr double relative_gradient = 1e-8;
constexpr double allowed_decrease = 1e-2;  // of the sum of squares by the linearised residuals, over their mean
constexpr double least_mean = 1e-2;        // smallest mean square that is distinguished from 0
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

PetscErrorCode find_residuals(Tao, Vec u, Vec r, void* problem) {
  return base::guard([&] { Entries(r).get() = static_cast<Problem*>(problem)->evaluate(copy_of(u)); });
}

PetscErrorCode find_jacobian(Tao, Vec u, Mat J, Mat, void* problem) {
  return base::guard([&] {
    const Eigen::MatrixXd found = static_cast<Problem*>(problem)->jacobian(copy_of(u));
    double* array = nullptr;
    base::check(MatDenseGetArray(J, &array));
    std::copy_n(found.data(), found.size(), array);
    base::check(MatDenseRestoreArray(J, &array));
    base::check(MatAssemblyBegin(J, MAT_FINAL_ASSEMBLY));
    base::check(MatAssemblyEnd(J, MAT_FINAL_ASSEMBLY));
  });
}

base::Handle<Vec> vector_of(Eigen::Index size, double value) {
  base::Handle<Vec> vector;
  base::check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(size), vector.out()));
  base::check(VecSet(vector, value));
  return vector;
}

/// The gradient of the misfit at which a minimisation ends.
double gradient_limit(const Eigen::MatrixXd& jacobian) {
  const Eigen::VectorXd sensitivity = jacobian.colwise().norm();
  double least = sensitivity.maxCoeff();
  for (const double one : sensitivity)
    if (one > insensitive * sensitivity.maxCoeff()) least = std::min(least, one);
  return gradient * least;
}

/// Whether the linearised residuals promise no noteworthy decrease of the misfit within the bounds.
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

}  // namespace

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
  const base::Handle<Vec> u = vector_of(size, 0.0), low = vector_of(size, 0.0), high = vector_of(size, 1.0),
                          r = vector_of(count, 0.0);
  Entries(u).get() = start;
  base::Handle<Mat> J;
  base::check(
      MatCreateSeqDense(PETSC_COMM_SELF, static_cast<PetscInt>(count), static_cast<PetscInt>(size), nullptr, J.out()));
  base::Handle<Tao> tao;
  base::check(TaoCreate(PETSC_COMM_SELF, tao.out()));
  base::check(TaoSetType(tao, TAOBRGN));
  base::check(TaoSetSolution(tao, u));
  base::check(TaoSetVariableBounds(tao, low, high));
  base::check(TaoSetResidualRoutine(tao, r, find_residuals, &problem));
  base::check(TaoSetJacobianResidualRoutine(tao, J, J, find_jacobian, &problem));
  base::check(TaoSetTolerances(tao, gradient_limit(problem.jacobian(start)), relative_gradient, 0.0));
  base::check(TaoSetMaximumIterations(tao, most_iterations));
  base::check(TaoSetFromOptions(tao));
  base::check(TaoSolve(tao));
  Minimum minimum;
  PetscInt iterations = 0;
  TaoConvergedReason reason = TAO_CONTINUE_ITERATING;
  base::check(TaoGetIterationNumber(tao, &iterations));
  base::check(TaoGetConvergedReason(tao, &reason));
  minimum.u = copy_of(u).cwiseMax(0.0).cwiseMin(1.0);
  minimum.residuals = problem.evaluate(minimum.u);
  minimum.jacobian = problem.jacobian(minimum.u);
  minimum.iterations = iterations;
  minimum.reason = TaoConvergedReasons[reason];
  minimum.converged = has_converged(minimum);
  return minimum;
}

}  // namespace traverse::app
