#include "eigen.hpp"

#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace traverse::modes {
namespace {

using base::check;

constexpr double tolerance = 1e-12;  // of SLEPc, relative to the inverted eigenvalue
constexpr double resolution = 1e-9;  // eigenvalues closer than this, relatively, count as one when copies are counted

base::Handle<Mat> matrix(const Band& band) {
  const PetscInt n = band.size();
  std::vector<PetscInt> starts{0}, columns;
  std::vector<double> values;
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt j = std::max(0, i - Band::width); j <= std::min(n - 1, i + Band::width); ++j) {
      columns.push_back(j);
      values.push_back(i >= j ? band.at(i, j) : band.at(j, i));
    }
    starts.push_back(static_cast<PetscInt>(columns.size()));
  }
  base::Handle<Mat> m;
  check(MatCreate(PETSC_COMM_SELF, m.out()));
  check(MatSetSizes(m, n, n, n, n));
  check(MatSetType(m, MATSEQAIJ));
  check(MatSeqAIJSetPreallocationCSR(m, starts.data(), columns.data(), values.data()));
  check(MatSetOption(m, MAT_SYMMETRIC, PETSC_TRUE));
  return m;
}

base::Handle<Vec> vector(const std::vector<double>& values) {
  base::Handle<Vec> v;
  check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(values.size()), v.out()));
  PetscScalar* raw = nullptr;
  check(VecGetArray(v, &raw));
  std::copy(values.begin(), values.end(), raw);
  check(VecRestoreArray(v, &raw));
  return v;
}

/// A start that hardly any mode is orthogonal to, always the same. (-1, 1), by a linear congruential generator.
std::vector<double> start_vector(int size, unsigned seed) {
  std::vector<double> values(static_cast<std::size_t>(size));
  std::uint64_t state = 0x9E3779B97F4A7C15ULL + seed;
  for (double& value : values) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    value = static_cast<double>(state >> 11) * 0x1p-52 - 1.0;
  }
  return values;
}

/// Where to look from: below all elastic frequencies, and close to the lowest where that is what tells neighbours
/// apart (a long continuous bridge has hundreds of frequencies within a per cent).
double shift_below(const Segment& s, int count) {
  if (s.rigid.empty()) {
    const Bracket lowest = bracket_lowest(s.K, s.M, std::max(count, 2));
    if (lowest.low > 0.0) return lowest.low - (lowest.high - lowest.low);
  }
  // Rigid motions, or nearly so: from below zero. A beam's eigenvalues spread with the fourth power of the number of
  // its elements, a bar's with the second.
  double most = 0.0;
  for (int i = 0; i < s.size(); ++i) most = std::max(most, s.K.at(i, i) / s.M.at(i, i));
  const double elements = std::max(1.0, static_cast<double>(s.nodes.back() - s.nodes.front()));
  return -most / std::pow(elements, s.axial ? 2.0 : 4.0);
}

Eigenpair pair_of(EPS eps, Mat K, PetscInt i, double (*eigenvalue)(double, double), double shift) {
  base::Handle<Vec> x;
  check(MatCreateVecs(K, x.out(), nullptr));
  PetscScalar value = 0.0;
  check(EPSGetEigenpair(eps, i, &value, nullptr, x, nullptr));
  PetscInt size = 0;
  const PetscScalar* raw = nullptr;
  check(VecGetSize(x, &size));
  check(VecGetArrayRead(x, &raw));
  Eigenpair pair{std::sqrt(std::max(eigenvalue(value, shift), 0.0)), {raw, raw + size}};
  check(VecRestoreArrayRead(x, &raw));
  return pair;
}

/// All elastic modes, by LAPACK. The pencil is turned round, M x = mu (K - shift M) x, so that the lowest
/// frequencies, not the highest, are the accurate ones.
std::vector<Eigenpair> all_elastic(const Segment& s, double shift) {
  const base::Handle<Mat> shifted = matrix(s.K), M = matrix(s.M);
  check(MatAXPY(shifted, -shift, M, SAME_NONZERO_PATTERN));
  base::Handle<EPS> eps;
  check(EPSCreate(PETSC_COMM_SELF, eps.out()));
  check(EPSSetOperators(eps, M, shifted));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSSetType(eps, EPSLAPACK));
  check(EPSSetWhichEigenpairs(eps, EPS_LARGEST_REAL));
  check(EPSSolve(eps));
  std::vector<Eigenpair> modes;
  for (PetscInt i = static_cast<PetscInt>(s.rigid.size()); i < s.size(); ++i) {  // the rigid ones come first
    modes.push_back(pair_of(
        eps, M, i, [](double mu, double below) { return below + 1.0 / mu; }, shift));
  }
  std::stable_sort(modes.begin(), modes.end(), [](const auto& a, const auto& b) { return a.omega < b.omega; });
  return modes;
}

/// Krylov-Schur, for the lowest few of many.
class Solver {
 public:
  Solver(const Segment& segment, double shift)
      : segment_(segment), shift_(shift), K_(matrix(segment.K)), M_(matrix(segment.M)) {
    for (const auto& motion : segment_.rigid) known_.push_back(vector(motion));
  }

  /// `count` more modes, other than the rigid ones and those found before.
  void find(int count) {
    const int left = segment_.size() - static_cast<int>(known_.size());
    count = std::min(count, left);
    if (count <= 0) return;
    base::Handle<EPS> eps;
    set_up(eps, count, std::min(left, std::max(2 * count, count + 15)));
    check(EPSSolve(eps));
    PetscInt converged = 0;
    check(EPSGetConverged(eps, &converged));
    if (converged < count) {
      throw SolverError("modes: SLEPc found " + std::to_string(converged) + " of " + std::to_string(count) +
                        " natural frequencies; use fewer elements or ask for fewer modes");
    }
    for (PetscInt i = 0; i < converged; ++i) {
      found_.push_back(pair_of(
          eps, K_, i, [](double value, double) { return value; }, 0.0));
      known_.push_back(vector(found_.back().shape));
    }
    std::stable_sort(found_.begin(), found_.end(), [](const auto& a, const auto& b) { return a.omega < b.omega; });
  }

  const std::vector<Eigenpair>& found() const { return found_; }
  /// How many of them have omega^2 below `limit`.
  int found_below(double limit) const {
    return static_cast<int>(
        std::count_if(found_.begin(), found_.end(), [&](const auto& m) { return m.omega * m.omega < limit; }));
  }

 private:
  void set_up(base::Handle<EPS>& eps, int count, int subspace) {
    check(EPSCreate(PETSC_COMM_SELF, eps.out()));
    check(EPSSetOperators(eps, K_, M_));
    check(EPSSetProblemType(eps, EPS_GHEP));
    check(EPSSetType(eps, EPSKRYLOVSCHUR));
    check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
    check(EPSSetTarget(eps, shift_));
    check(EPSSetTolerances(eps, tolerance, 1000));
    check(EPSSetDimensions(eps, count, subspace, PETSC_DEFAULT));
    ST st = nullptr;
    KSP ksp = nullptr;
    PC pc = nullptr;
    check(EPSGetST(eps, &st));
    check(STSetType(st, STSINVERT));
    check(STSetMatStructure(st, SAME_NONZERO_PATTERN));
    check(STGetKSP(st, &ksp));
    check(KSPSetType(ksp, KSPPREONLY));
    check(KSPGetPC(ksp, &pc));
    check(PCSetType(pc, PCLU));
    check(PCFactorSetMatOrderingType(pc, MATORDERINGNATURAL));  // a band: no fill beyond it
    if (!known_.empty()) {
      std::vector<Vec> raw(known_.begin(), known_.end());
      check(EPSSetDeflationSpace(eps, static_cast<PetscInt>(raw.size()), raw.data()));
    }
    const base::Handle<Vec> start = vector(start_vector(segment_.size(), static_cast<unsigned>(known_.size())));
    Vec raw = start;
    check(EPSSetInitialSpace(eps, 1, &raw));
  }

  const Segment& segment_;
  double shift_ = 0.0;
  base::Handle<Mat> K_, M_;
  std::vector<base::Handle<Vec>> known_;
  std::vector<Eigenpair> found_;
};

/// At least `count` elastic modes. An iteration that starts from one vector may not see the copies of a repeated
/// frequency: as long as there are more eigenvalues clearly below the last one wanted than were found there, it is
/// started again. The count itself may be off by rounding, so that nothing new there also ends the search.
std::vector<Eigenpair> some_elastic(const Segment& s, int count, double shift) {
  Solver solver(s, shift);
  solver.find(count);
  for (;;) {
    const double last = solver.found()[static_cast<std::size_t>(count - 1)].omega;
    const double limit = last * last * (1.0 - resolution);
    if (limit <= 0.0) break;
    const int missing = count_below(s.K, s.M, limit) - static_cast<int>(s.rigid.size()) - solver.found_below(limit);
    if (missing <= 0) break;
    const int before = solver.found_below(limit);
    solver.find(missing);
    if (solver.found_below(limit) == before) break;
  }
  return solver.found();
}

}  // namespace

std::vector<Eigenpair> lowest_modes(const Segment& segment, int count) {
  count = std::min(count, segment.size());
  std::vector<Eigenpair> modes;
  for (const auto& motion : segment.rigid) modes.push_back({0.0, motion});
  const int elastic = count - static_cast<int>(modes.size());
  if (elastic > 0) {
    const double shift = shift_below(segment, elastic);
    const bool few = segment.size() <= 32 || count > segment.size() / 2;
    const auto found = few ? all_elastic(segment, shift) : some_elastic(segment, elastic, shift);
    modes.insert(modes.end(), found.begin(), found.end());
  }
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(count)));
  return modes;
}

}  // namespace traverse::modes
