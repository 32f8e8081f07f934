// A few modes at a time by SLEPc's Krylov-Schur method with shifts from counted brackets, so that no repeated frequency
// is missed, from a reproducible pseudo-random start vector; all modes of small segments by LAPACK.
#include "eigen.hpp"

#include <fmt/format.h>
#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace traverse::modes {
namespace {

using base::check;

constexpr double tolerance = 1e-12;  // tolerance of SLEPc, relative to the inverted eigenvalue
constexpr double resolution = 1e-9;  // smallest relative width of brackets of eigenvalues

base::Handle<Mat> matrix(const Band& band) {
  const PetscInt n = band.size();
  std::vector<PetscInt> starts{0}, columns;
  std::vector<double> values;
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt j = std::max(0, i - band.width()); j <= std::min(n - 1, i + band.width()); ++j) {
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

/// A shift below zero for a segment with rigid or nearly rigid motions. The ratio of the largest to the lowest
/// eigenvalue grows with the fourth power of the number of elements for a beam, with the second power for a bar.
double shift_below_zero(const Segment& s) {
  const double elements = std::max(1.0, static_cast<double>(s.nodes.back() - s.nodes.front()));
  return -highest_quotient(s.K, s.M) / std::pow(elements, s.order());
}

/// Checks that the lowest eigenvalue is not below the rounding error of the highest one. The ratio of both grows with
/// the fourth power of the number of a beam's elements. With few elements such a low eigenvalue is due to a very soft
/// support.
void check_rounding(const Segment& s, const Bracket& lowest) {
  const double rounding = std::numeric_limits<double>::epsilon() * highest_quotient(s.K, s.M);
  const double elements = s.nodes.back() - s.nodes.front();
  const bool too_many = s.order() == 4.0 && std::pow(elements, 4.0) * std::numeric_limits<double>::epsilon() > 1.0;
  if (too_many && lowest.high < rounding)
    throw InputError(fmt::format(
        "beam_elements_per_span: in {:g} elements from joint to joint rounding hides the lowest frequencies; fewer "
        "elements are as exact",
        elements));
}

/// A shift below the lowest eigenvalue of a bracket; its distance is similar to the distances between the eigenvalues.
double shift_below(const Bracket& b) { return b.low - 0.2 * (b.high - b.low); }

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

/// Solves the eigenvalue problem. A failure of the factorisation is due to the matrices, which come from the input.
void solve(EPS eps) {
  try {
    check(EPSSolve(eps));
  } catch (const SolverError&) {
    throw SolverError(
        "modes: the natural frequencies cannot be computed, because stiffnesses or masses differ so much that rounding "
        "hides the smaller ones; compare beam_EI, beam_mass, beam_GA, beam_rotary_inertia, beam_cracks_k, support_ and "
        "foundation_ values, also their units");
  }
}

/// All elastic modes, by LAPACK. By the inverted problem M x = mu (K - shift M) x the lowest frequencies are the most
/// accurate, not the highest.
std::vector<Eigenpair> all_elastic(const Segment& s, double shift) {
  const base::Handle<Mat> shifted = matrix(s.K), M = matrix(s.M);
  check(MatAXPY(shifted, -shift, M, SAME_NONZERO_PATTERN));
  base::Handle<EPS> eps;
  check(EPSCreate(PETSC_COMM_SELF, eps.out()));
  check(EPSSetOperators(eps, M, shifted));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSSetType(eps, EPSLAPACK));
  check(EPSSetWhichEigenpairs(eps, EPS_LARGEST_REAL));
  solve(eps);
  std::vector<Eigenpair> modes;
  for (auto i = static_cast<PetscInt>(s.rigid.size()); i < s.size(); ++i) {  // rigid modes are the first ones
    modes.push_back(pair_of(
        eps, M, i, [](double mu, double below) { return below + 1.0 / mu; }, shift));
  }
  std::stable_sort(modes.begin(), modes.end(), [](const auto& a, const auto& b) { return a.omega < b.omega; });
  return modes;
}

/// Krylov-Schur solver for a few of many modes.
class Solver {
 public:
  explicit Solver(const Segment& segment) : segment_(segment), K_(matrix(segment.K)), M_(matrix(segment.M)) {
    for (const auto& motion : segment_.rigid) known_.push_back(vector(motion));
  }

  /// Computes the `count` modes nearest to the shift, or a few more, without the rigid ones and those found before.
  void find(double shift, int count) {
    const int remaining = segment_.size() - static_cast<int>(known_.size());
    count = std::min(count, remaining - 1);
    if (count <= 0) return;
    base::Handle<EPS> eps;
    set_up(eps, shift, count, std::min(remaining, std::max(2 * count, count + 15)));
    solve(eps);
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
  /// Number of found modes with omega^2 below `limit`.
  int found_below(double limit) const {
    return static_cast<int>(
        std::count_if(found_.begin(), found_.end(), [&](const auto& m) { return m.omega * m.omega < limit; }));
  }

 private:
  void set_up(base::Handle<EPS>& eps, double shift, int count, int subspace) {
    check(EPSCreate(PETSC_COMM_SELF, eps.out()));
    check(EPSSetOperators(eps, K_, M_));
    check(EPSSetProblemType(eps, EPS_GHEP));
    check(EPSSetType(eps, EPSKRYLOVSCHUR));
    check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
    check(EPSSetTarget(eps, shift));
    check(EPSSetTolerances(eps, tolerance, 1000));
    check(EPSSetDimensions(eps, count, subspace, PETSC_DETERMINE));
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
    check(PCFactorSetMatOrderingType(pc, MATORDERINGNATURAL));            // no fill outside the band
    check(PCFactorSetZeroPivot(pc, std::numeric_limits<double>::min()));  // pivots have units: 1e-14 may be valid
    if (!known_.empty()) {
      std::vector<Vec> raw(known_.begin(), known_.end());
      check(EPSSetDeflationSpace(eps, static_cast<PetscInt>(raw.size()), raw.data()));
    }
    const base::Handle<Vec> start = vector(start_vector(segment_.size(), static_cast<unsigned>(known_.size())));
    Vec raw = start;
    check(EPSSetInitialSpace(eps, 1, &raw));
  }

  const Segment& segment_;
  base::Handle<Mat> K_, M_;
  std::vector<base::Handle<Vec>> known_;
  std::vector<Eigenpair> found_;
};

/// Computes the lowest modes of a long chain, a few at a time, each time with the shift next to the lowest missing
/// mode, which is located by counting. Clusters of frequencies therefore cost little, and copies of a repeated
/// frequency, which an iteration from one start vector may miss, are found.
class ModeSearch {
 public:
  explicit ModeSearch(const Segment& s) : s_(s), solver_(s), highest_(highest_quotient(s.K, s.M)) {}

  /// At least `count` elastic modes.
  std::vector<Eigenpair> lowest(int count) {
    start(count);
    while (const double high = bound_of_missing(count)) {
      const Bracket b = narrow({lower_limit_, high}, modes_per_solve, resolution,
                               [this](double sigma) { return missing_below(sigma); });
      const double edge = b.high * (1.0 + tolerance_at(b.high));
      const int before = solver_.found_below(edge);
      solver_.find(shift_below(b), std::min(modes_to_solve(b, count), 4 * modes_per_solve));
      // No mode was found: the count was wrong because of rounding.
      if (solver_.found_below(edge) == before) lower_limit_ = edge;
    }
    if (static_cast<int>(solver_.found().size()) < count) {
      throw SolverError(
          "modes: the natural frequencies cannot be told apart; use fewer elements or ask for fewer modes");
    }
    return solver_.found();
  }

 private:
  static constexpr int modes_per_solve = 16;
  static constexpr double narrow_bracket =
      1.01;  // high over low of a narrow bracket, from which all other eigenvalues are far away

  void start(int count) {
    Bracket b;
    if (s_.rigid.empty()) {
      b = bracket_lowest(s_.K, s_.M);
      check_rounding(s_, b);
    }
    if (b.low > 0.0) {
      // At least two: a free beam on a bed has a double frequency, which no bracket can separate.
      b = narrow(b, std::clamp(count, 2, modes_per_solve), resolution,
                 [this](double sigma) { return missing_below(sigma); });
      lower_limit_ = b.low;
      solver_.find(shift_below(b), std::min(modes_to_solve(b, count), modes_per_solve));
    } else {
      const double shift = shift_below_zero(s_);
      lower_limit_ = -shift * 1e-10;
      solver_.find(shift, std::min(count, modes_per_solve));
    }
  }

  /// Number of modes to compute next to a bracket: those in it, or those that are missing of `count`.
  int modes_to_solve(const Bracket& b, int count) const {
    const int inside = std::max(missing_below(b.high), 1), missing = count - static_cast<int>(solver_.found().size());
    return b.high < narrow_bracket * b.low ? inside : std::max(inside, std::min(missing, modes_per_solve));
  }

  /// Relative width within which a count and a computed eigenvalue may differ by rounding.
  double tolerance_at(double sigma) const { return std::clamp(1e-14 * highest_ / sigma, resolution, 1e-4); }

  /// Number of eigenvalues below sigma that have not been found.
  int missing_below(double sigma) const {
    return count_below(s_.K, s_.M, sigma) - static_cast<int>(s_.rigid.size()) -
           solver_.found_below(sigma * (1.0 + tolerance_at(sigma)));
  }

  /// Zero if the `count` lowest modes are known; otherwise a bound with a missing mode below it and above the lower
  /// limit.
  double bound_of_missing(int count) const {
    const auto& found = solver_.found();
    if (static_cast<int>(found.size()) >= count) {
      const double last = std::pow(found[static_cast<std::size_t>(count - 1)].omega, 2);
      const double limit = last * (1.0 - 2.0 * tolerance_at(last));
      return limit > lower_limit_ && missing_below(limit) > 0 ? limit : 0.0;
    }
    double high = std::max(2.0 * lower_limit_, found.empty() ? 0.0 : std::pow(found.back().omega, 2));
    while (missing_below(high) <= 0) {
      high *= 1.1;
      if (high > 10.0 * highest_) return 0.0;
    }
    return high;
  }

  const Segment& s_;
  Solver solver_;
  double highest_ = 0.0;
  double lower_limit_ = 0.0;  // all eigenvalues below are known
};

std::vector<Eigenpair> all_modes(const Segment& s) {
  Bracket b;
  if (s.rigid.empty()) b = bracket_lowest(s.K, s.M);
  return all_elastic(s, b.low > 0.0 ? b.low : shift_below_zero(s));
}

}  // namespace

std::vector<Eigenpair> lowest_modes(const Segment& segment, int count) {
  count = std::min(count, segment.size());
  std::vector<Eigenpair> modes;
  for (const auto& motion : segment.rigid) modes.push_back({0.0, motion});
  const int elastic = count - static_cast<int>(modes.size());
  if (elastic > 0) {
    const bool small = segment.size() <= 32 || count > segment.size() / 2;
    const auto found = small ? all_modes(segment) : ModeSearch(segment).lowest(elastic);
    modes.insert(modes.end(), found.begin(), found.end());
  }
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(count)));
  return modes;
}

using base::check;

base::Handle<Vec> vector(const std::vector<double>& values) {
  base::Handle<Vec> v;
  check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(values.size()), v.out()));
  PetscScalar* raw = nullptr;
  check(VecGetArray(v, &raw));
  std::copy(values.begin(), values.end(), raw);
  check(VecRestoreArray(v, &raw));
  return v;
}

std::vector<double> start_vector(int size, unsigned seed) {
  std::vector<double> values(static_cast<std::size_t>(size));
  std::uint64_t state = 0x9E3779B97F4A7C15ULL + seed;
  for (double& value : values) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    value = static_cast<double>(state >> 11) * 0x1p-52 - 1.0;
  }
  return values;
}

}  // namespace traverse::modes
