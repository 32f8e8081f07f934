// Solves the quadratic eigenvalue problem by SLEPc on its inverse operator and refines each eigenvalue by Newton's
// method on x^T (lambda^2 M + lambda C + K) x = 0.
#include "quadratic.hpp"

#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "eigen.hpp"

namespace traverse::modes {
namespace {

using base::check;
using Complex = std::complex<double>;

constexpr double eigen_tolerance = 1e-11;  // tolerance of SLEPc, relative to the inverted eigenvalue
constexpr int restarts = 2000;
constexpr int few_unknowns = 64;         // up to here by LAPACK, all modes at once
constexpr double max_change = 1e-4;      // relative to lambda: largest change by refinement
constexpr double inverse_error = 1e-10;  // error of 1/lambda, relative to the largest one, in ill-conditioned cases
constexpr double dense_from = 0.95;      // fraction of 1/b: from this |lambda| on the meaningless modes are dense

PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
  return base::guard([&] {
    const Inverse* inverse = nullptr;
    const PetscScalar* from = nullptr;
    PetscScalar* to = nullptr;
    check(MatShellGetContext(matrix, &inverse));
    check(VecGetArrayRead(x, &from));
    check(VecGetArrayWrite(y, &to));
    inverse->apply(from, to);
    check(VecRestoreArrayWrite(y, &to));
    check(VecRestoreArrayRead(x, &from));
  });
}

base::Handle<Mat> matrix_of(Inverse& inverse) {
  base::Handle<Mat> shell;
  const PetscInt n = inverse.size();
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, &inverse, shell.out()));
  check(MatShellSetOperation(shell, MATOP_MULT, reinterpret_cast<base::ShellOperation>(multiply)));
  return shell;
}

class Spectrum {
 public:
  Spectrum(Inverse& inverse, int eigenvalues, bool all) : inverse_(inverse), matrix_(matrix_of(inverse)) {
    check(EPSCreate(PETSC_COMM_SELF, eps_.out()));
    check(EPSSetOperators(eps_, matrix_, nullptr));
    check(EPSSetProblemType(eps_, EPS_NHEP));
    check(EPSSetWhichEigenpairs(eps_, EPS_LARGEST_MAGNITUDE));
    check(EPSSetType(eps_, all ? EPSLAPACK : EPSKRYLOVSCHUR));
    if (!all) {
      const int subspace = std::min(inverse.size(), std::max(2 * eigenvalues, eigenvalues + 30));
      check(EPSSetTolerances(eps_, eigen_tolerance, restarts));
      check(EPSSetDimensions(eps_, eigenvalues, subspace, PETSC_DETERMINE));
      const base::Handle<Vec> start = vector(start_vector(inverse.size(), 0));
      Vec raw = start;
      check(EPSSetInitialSpace(eps_, 1, &raw));
    }
    check(EPSSolve(eps_));
  }

  /// Number of converged eigenvalues, which are always the lowest ones.
  int converged() const {
    PetscInt count = 0;
    check(EPSGetConverged(eps_, &count));
    return std::min(static_cast<int>(count), inverse_.nonrigid());
  }

  std::vector<DampedPair> modes() const {
    base::Handle<Vec> real, imaginary;
    check(MatCreateVecs(matrix_, real.out(), imaginary.out()));
    std::vector<DampedPair> found;
    for (int i = 0; i < converged(); ++i) {
      PetscScalar re = 0.0, im = 0.0;
      check(EPSGetEigenpair(eps_, i, &re, &im, real, imaginary));
      if (im > 0.0) continue;  // 1/lambda of the conjugate
      const Complex lambda = im == 0.0 ? Complex(1.0 / re, 0.0) : 1.0 / Complex(re, im);
      found.push_back({lambda, shape(real, imaginary)});
    }
    return found;
  }

 private:
  std::vector<Complex> shape(Vec real, Vec imaginary) const {
    const PetscScalar *re = nullptr, *im = nullptr;
    check(VecGetArrayRead(real, &re));
    check(VecGetArrayRead(imaginary, &im));
    std::vector<Complex> state;
    for (int i = 0; i < inverse_.size(); ++i) state.emplace_back(re[i], im[i]);
    check(VecRestoreArrayRead(imaginary, &im));
    check(VecRestoreArrayRead(real, &re));
    return inverse_.shape(std::move(state));
  }

  Inverse& inverse_;
  base::Handle<Mat> matrix_;
  base::Handle<EPS> eps_;
};

struct Form {
  Complex value;      // x^T A x, without conjugation
  double size = 0.0;  // magnitude of its terms; times the machine epsilon the rounding error
};

Form form(const Band& A, const std::vector<Complex>& x) {
  Form sum;
  for (int i = 0; i < A.size(); ++i) {
    for (int j = std::max(0, i - A.width()); j <= i; ++j) {
      const Complex term =
          (i == j ? 1.0 : 2.0) * A.at(i, j) * x[static_cast<std::size_t>(i)] * x[static_cast<std::size_t>(j)];
      sum.value += term;
      sum.size += std::abs(term);
    }
  }
  return sum;
}

/// Refines lambda as a root of x^T (lambda^2 M + lambda C + K) x = 0 by Newton's method. The matrices are symmetric, so
/// that the error of the root is the square of that of x, plus the rounding error of x^T K x. The root is used if the
/// latter is smaller than the error of lambda: errors of A^-1 are relative to its largest eigenvalue, so that one slow
/// mode reduces the accuracy of all others. It is not used if two modes almost coincide and the root is far away.
Complex refined(const Segment& s, const beam::Rayleigh& ab, const DampedPair& mode, double lowest) {
  const Form stiffness = form(s.K, mode.shape);
  const Complex mass = form(s.M, mode.shape).value;
  const Complex damping = ab.a * mass + ab.b * stiffness.value + form(s.D, mode.shape).value;
  Complex lambda = mode.lambda;
  for (int i = 0; i < 3; ++i) {
    lambda -= ((mass * lambda + damping) * lambda + stiffness.value) / (2.0 * mass * lambda + damping);
  }
  const double size = std::abs(mode.lambda), error = inverse_error * size / lowest;
  const double rounding =
      std::numeric_limits<double>::epsilon() * stiffness.size / (size * std::abs(2.0 * mass * mode.lambda + damping));
  return rounding < error && std::abs(lambda - mode.lambda) < max_change * size ? lambda : mode.lambda;
}

/// The elastic modes and the decay modes of rigid motions.
std::vector<DampedPair> nonrigid_modes(const Segment& s, const beam::Rayleigh& ab, int count) {
  Inverse inverse(s, ab);
  if (inverse.nonrigid() == 0) return {};
  const double end = ab.b != 0.0 ? 1.0 / std::abs(ab.b) : std::numeric_limits<double>::infinity();
  const bool all = s.size() <= few_unknowns || count > s.size() / 2;
  if (!all && ab.b != 0.0) count = std::min(count, std::max(1, count_below(s.K, s.M, std::pow(dense_from * end, 2))));
  const int eigenvalues = std::min(2 * count, inverse.nonrigid());
  const Spectrum spectrum(inverse, eigenvalues, all);
  auto found = spectrum.modes();
  const bool dense = !found.empty() && std::abs(found.back().lambda) > 0.5 * end;
  if (spectrum.converged() < eigenvalues && !dense) {
    throw SolverError("modes: SLEPc found " + std::to_string(spectrum.converged()) + " of " +
                      std::to_string(eigenvalues) + " damped eigenvalues; use fewer elements or ask for fewer modes");
  }
  const double lowest = found.empty() ? 1.0 : std::abs(found.front().lambda);
  for (DampedPair& mode : found) mode.lambda = refined(s, ab, mode, lowest);
  std::erase_if(found, [&](const DampedPair& mode) { return std::abs(mode.lambda) >= end; });
  return found;
}

}  // namespace

std::vector<DampedPair> lowest_damped(const Segment& segment, beam::Rayleigh ab, int count) {
  std::vector<DampedPair> modes;
  for (const auto& motion : segment.rigid) modes.push_back({0.0, {motion.begin(), motion.end()}});
  const int others = count - static_cast<int>(modes.size());
  if (others > 0) {
    for (DampedPair& mode : nonrigid_modes(segment, ab, others)) modes.push_back(std::move(mode));
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.lambda) < std::abs(b.lambda); });
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(std::max(count, 0))));
  return modes;
}

}  // namespace traverse::modes
