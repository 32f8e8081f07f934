// A few modes at a time by SLEPc's Krylov-Schur method with shifts from counted brackets, so that no repeated frequency
// is missed; all modes of small segments by LAPACK.
#include "eigen.hpp"

#include <fmt/format.h>
#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "vectors.hpp"

namespace traverse::modes {
namespace {

using base::check;

constexpr double tolerance = 1e-12;  // of SLEPc, relative to the inverted eigenvalue
constexpr double resolution = 1e-9;  // brackets of eigenvalues are not made narrower, relatively

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

/// From where to look when there are rigid motions, or nearly so: from below zero. The eigenvalues of a beam spread
/// with the fourth power of the number of its elements, those of a bar with the second.
double shift_below_zero(const Segment& s) {
  const double elements = std::max(1.0, static_cast<double>(s.nodes.back() - s.nodes.front()));
  return -highest_quotient(s.K, s.M) / std::pow(elements, s.axial ? 2.0 : 4.0);
}

/// The eigenvalues of a beam spread with the fourth power of the number of its elements. The lowest one must not be
/// below the rounding of the highest, but where next to nothing holds the beam.
void check_rounding(const Segment& s, const Bracket& lowest) {
  const double rounding = std::numeric_limits<double>::epsilon() * highest_quotient(s.K, s.M);
  const double elements = s.nodes.back() - s.nodes.front();
  const bool too_many = !s.axial && std::pow(elements, 4.0) * std::numeric_limits<double>::epsilon() > 1.0;
  if (too_many && lowest.high < rounding)
    throw InputError(fmt::format(
        "beam_elements_per_span: in {:g} elements from joint to joint rounding hides the lowest frequencies; fewer "
        "elements are as exact",
        elements));
}

/// Next to the lowest eigenvalue of a bracket, from below, at a distance like that of the others in it.
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
  for (auto i = static_cast<PetscInt>(s.rigid.size()); i < s.size(); ++i) {  // the rigid ones come first
    modes.push_back(pair_of(
        eps, M, i, [](double mu, double below) { return below + 1.0 / mu; }, shift));
  }
  std::stable_sort(modes.begin(), modes.end(), [](const auto& a, const auto& b) { return a.omega < b.omega; });
  return modes;
}

/// Krylov-Schur, for a few of many.
class Solver {
 public:
  explicit Solver(const Segment& segment) : segment_(segment), K_(matrix(segment.K)), M_(matrix(segment.M)) {
    for (const auto& motion : segment_.rigid) known_.push_back(vector(motion));
  }

  /// The `count` modes nearest to the shift, or a few more, other than the rigid ones and those found before.
  void find(double shift, int count) {
    const int left = segment_.size() - static_cast<int>(known_.size());
    count = std::min(count, left - 1);
    if (count <= 0) return;
    base::Handle<EPS> eps;
    set_up(eps, shift, count, std::min(left, std::max(2 * count, count + 15)));
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
    check(PCFactorSetMatOrderingType(pc, MATORDERINGNATURAL));            // a band: no fill beyond it
    check(PCFactorSetZeroPivot(pc, std::numeric_limits<double>::min()));  // pivots carry units: 1e-14 may be all right
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

/// The lowest modes of a long chain: a few at a time, each time with the shift next to the lowest one that is still
/// unknown. Counting tells where that is. So frequencies that crowd cost little, and copies of a repeated one, which
/// an iteration that starts from one vector may not see, are not missed.
class Hunt {
 public:
  explicit Hunt(const Segment& s) : s_(s), solver_(s), highest_(highest_quotient(s.K, s.M)) {}

  /// At least `count` elastic modes.
  std::vector<Eigenpair> lowest(int count) {
    start(count);
    while (const double high = unknown_below(count)) {
      const Bracket b = narrow({floor_, high}, at_once, resolution, [this](double sigma) { return unknown(sigma); });
      const double edge = b.high * (1.0 + tolerance_at(b.high));
      const int before = solver_.found_below(edge);
      solver_.find(shift_below(b), std::min(sought(b, count), 4 * at_once));
      // Nothing there after all: the count was off by rounding.
      if (solver_.found_below(edge) == before) floor_ = edge;
    }
    if (static_cast<int>(solver_.found().size()) < count) {
      throw SolverError(
          "modes: the natural frequencies cannot be told apart; use fewer elements or ask for fewer modes");
    }
    return solver_.found();
  }

 private:
  static constexpr int at_once = 16;
  static constexpr double crowded = 1.01;  // high over low of a bracket, beside which all others are far away

  void start(int count) {
    Bracket b;
    if (s_.rigid.empty()) {
      b = bracket_lowest(s_.K, s_.M);
      check_rounding(s_, b);
    }
    if (b.low > 0.0) {
      // Two at least: a free beam on a bed has one frequency twice, and no bracket is narrow enough to part them.
      b = narrow(b, std::clamp(count, 2, at_once), resolution, [this](double sigma) { return unknown(sigma); });
      floor_ = b.low;
      solver_.find(shift_below(b), std::min(sought(b, count), at_once));
    } else {
      const double shift = shift_below_zero(s_);
      floor_ = -shift * 1e-10;
      solver_.find(shift, std::min(count, at_once));
    }
  }

  /// How many to look for next to a bracket: what is in it, and of the `count` what will be wanted after that.
  int sought(const Bracket& b, int count) const {
    const int inside = std::max(unknown(b.high), 1), missing = count - static_cast<int>(solver_.found().size());
    return b.high < crowded * b.low ? inside : std::max(inside, std::min(missing, at_once));
  }

  /// Relative width within which a count and a computed eigenvalue may disagree by rounding.
  double tolerance_at(double sigma) const { return std::clamp(1e-14 * highest_ / sigma, resolution, 1e-4); }

  /// How many eigenvalues below sigma have not been found.
  int unknown(double sigma) const {
    return count_below(s_.K, s_.M, sigma) - static_cast<int>(s_.rigid.size()) -
           solver_.found_below(sigma * (1.0 + tolerance_at(sigma)));
  }

  /// Zero when the `count` lowest are known, else a bound with something unknown below it and above the floor.
  double unknown_below(int count) const {
    const auto& found = solver_.found();
    if (static_cast<int>(found.size()) >= count) {
      const double last = std::pow(found[static_cast<std::size_t>(count - 1)].omega, 2);
      const double limit = last * (1.0 - 2.0 * tolerance_at(last));
      return limit > floor_ && unknown(limit) > 0 ? limit : 0.0;
    }
    double high = std::max(2.0 * floor_, found.empty() ? 0.0 : std::pow(found.back().omega, 2));
    while (unknown(high) <= 0) {
      high *= 1.1;
      if (high > 10.0 * highest_) return 0.0;
    }
    return high;
  }

  const Segment& s_;
  Solver solver_;
  double highest_ = 0.0;
  double floor_ = 0.0;  // nothing unknown lies below
};

std::vector<Eigenpair> all(const Segment& s) {
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
    const bool few = segment.size() <= 32 || count > segment.size() / 2;
    const auto found = few ? all(segment) : Hunt(segment).lowest(elastic);
    modes.insert(modes.end(), found.begin(), found.end());
  }
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(count)));
  return modes;
}

}  // namespace traverse::modes
