// Newton's method within a stage for the nonlinear part of the foundation: tangents, and the test of their agreement
// with the forces.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "structure/nonlinear_foundation.hpp"

namespace traverse::structure {
namespace {

using beam::Direction;

constexpr double tolerance = 1e-12;        // remaining error of tangents, relative to the greatest force
constexpr int most_stage_iterations = 40;  // limit of iterations in a stage; if exceeded, the step is shortened
constexpr int most_static_iterations = 100;
constexpr double near_tangent = 0.1;      // relative difference of stiffnesses: stored tangents are used
constexpr int reuse_iterations = 4;       // iterations with them, then with the exact tangents only
constexpr double loose_stiffness = 1e-6;  // stiffness in statics without contact, relative to the reference stiffness
constexpr double overshoot = 0.5;         // slope at the end of a step over that at its start, at most
constexpr int most_trials = 50;           // limit of bisections for the length of a Newton step
constexpr double unit_rounding = 16.0 * std::numeric_limits<double>::epsilon();

bool nearly_equal(double stored, double required, double share) {
  return std::abs(stored - required) <= share * std::max(std::abs(stored), std::abs(required));
}

}  // namespace

beam::FoundationForce NonlinearFoundation::force_at(const Point& p, double zeta) const {
  return force_of(p, p.predicted + zeta, p.predicted_rate + shift_ * zeta);
}

void NonlinearFoundation::begin(double shift, const double* v_predicted, const double* w_predicted,
                                const double* w_guess) {
  shift_ = shift;
  iteration_ = 0;
  if (shift == 0.0) {
    for (Point& p : points_) p.predicted = p.predicted_rate = 0.0;
    if (v_predicted != nullptr) gather(v_predicted, &Point::predicted);
    return;
  }
  gather(v_predicted, &Point::predicted);
  gather(w_predicted, &Point::predicted_rate);
  gather(w_guess, &Point::zeta0);
  for (Point& p : points_) p.zeta0 = (p.zeta0 - p.predicted_rate) / shift;
}

// Statics begins with all vertical supports in contact, from the displacement of first contact, and without slip.
void NonlinearFoundation::start_statics(Point& p) const {
  if (p.slides()) {
    p.zeta0 = p.slip_displacement - p.predicted;
    p.state = force_of(p, p.slip_displacement, 0.0);
    p.state.by_displacement = p.source.sliding.k_of(p.loaded);
    return;
  }
  const bool carries = p.source.direction == Direction::vertical;
  p.zeta0 = (carries ? -p.source.law.gap : 0.0) - p.predicted;
  p.state = {};
  p.state.by_displacement = carries || p.source.law.gap == 0.0 ? p.reference : 0.0;
}

const AddedSprings& NonlinearFoundation::linearise() {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Point& p = points_[i];
    if (shift_ == 0.0 && iteration_ == 0) {
      start_statics(p);
    } else {
      p.state = force_at(p, p.zeta0);
    }
    p.force0 = p.state.force;
    tangent_k_[i] =
        shift_ > 0.0 ? p.state.by_displacement : std::max(p.state.by_displacement, loose_stiffness * p.reference);
    tangent_c_[i] = p.state.by_rate;
  }
  choose_tangents();
  return stored_[current_];
}

// Selects stored tangents if they are accurate enough at all points, otherwise stores the exact ones.
void NonlinearFoundation::choose_tangents() {
  const double share = iteration_ < reuse_iterations ? near_tangent : 0.0;
  unsigned fitting = 0;
  for (std::size_t i = 0; i < stored_.size(); ++i) {
    const AddedSprings& stored = stored_[i];
    bool fits = stored.version > 0;
    for (std::size_t j = 0; fits && j < points_.size(); ++j)
      fits = nearly_equal(stored.k[j] + shift_ * stored.c[j], tangent_k_[j] + shift_ * tangent_c_[j], share);
    fitting |= fits ? 1U << i : 0U;
  }
  MPI_Allreduce(MPI_IN_PLACE, &fitting, 1, MPI_UNSIGNED, MPI_BAND, comm_);
  if ((fitting >> current_ & 1U) != 0) return;
  for (std::size_t i = 0; i < stored_.size(); ++i) {
    if ((fitting >> i & 1U) == 0) continue;
    current_ = i;
    return;
  }
  current_ = (current_ + 1) % stored_.size();
  stored_[current_].version = ++versions_;
  stored_[current_].k = tangent_k_;
  stored_[current_].c = tangent_c_;
}

void NonlinearFoundation::add_linearised(double* nodal) const {
  const AddedSprings& tangent = stored_[current_];
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const Point& p = points_[n];
    const double force = p.force0 + (tangent.k[n] + shift_ * tangent.c[n]) * p.zeta0;
    for (std::size_t i = 0; i < p.terms; ++i)
      if (p.place[i] >= 0 && p.place[i] < n_) nodal[p.place[i]] += p.shape[i] * force;
  }
}

NonlinearFoundation::Verdict NonlinearFoundation::check_stage(const double* z) {
  gather(z, &Point::zeta);
  const AddedSprings& tangent = stored_[current_];
  double greatest[2] = {0.0, 0.0};  // misfit, force
  for (std::size_t n = 0; n < points_.size(); ++n) {
    Point& p = points_[n];
    const double T = tangent.k[n] + shift_ * tangent.c[n];
    p.linear_force = p.force0 - T * (p.zeta - p.zeta0);
    p.state = force_at(p, p.zeta);
    const double size = std::abs(p.predicted) + std::abs(p.zeta) + std::abs(p.zeta0) + p.source.law.gap;
    const double rate = std::abs(p.predicted_rate) + shift_ * (std::abs(p.zeta) + std::abs(p.zeta0));
    const double floor = unit_rounding * ((std::abs(p.state.by_displacement) + std::abs(tangent.k[n])) * size +
                                          (p.state.by_rate + tangent.c[n]) * rate);
    p.mismatch = std::abs(p.state.force - p.linear_force) - floor;
    if (!std::isfinite(p.zeta)) p.mismatch = std::numeric_limits<double>::infinity();
    greatest[0] = std::max(greatest[0], p.mismatch);
    greatest[1] = std::max(greatest[1], std::abs(p.state.force));
  }
  MPI_Allreduce(MPI_IN_PLACE, greatest, 2, MPI_DOUBLE, MPI_MAX, comm_);
  if (greatest[0] <= tolerance * std::max(greatest[1], point_load_)) return Verdict::converged;
  if (!std::isfinite(greatest[0]) || ++iteration_ >= (shift_ > 0.0 ? most_stage_iterations : most_static_iterations))
    return Verdict::failed;
  const double share =
      iteration_ == 1 ? 1.0 : best_share();  // the initial state of the first step is not in equilibrium
  for (Point& p : points_) {
    p.balanced_force = share == 1.0 ? p.linear_force : p.balanced_force + share * (p.linear_force - p.balanced_force);
    p.zeta0 = share == 1.0 ? p.zeta : p.zeta0 + share * (p.zeta - p.zeta0);
  }
  return Verdict::again;
}

// Derivative along the step of the function whose minimum is the solution.
double NonlinearFoundation::slope(double share) const {
  double sum = 0.0;
  for (const Point& p : points_) {
    if (!p.counted) continue;
    const double step = p.zeta - p.zeta0;
    const double balanced = p.balanced_force + share * (p.linear_force - p.balanced_force);
    sum += step * (balanced - force_at(p, p.zeta0 + share * step).force);
  }
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, comm_);
  return sum;
}

// The whole step, or the part up to the minimum if the whole step goes far beyond it.
double NonlinearFoundation::best_share() const {
  const double begin = slope(0.0);
  const double allowed_slope = -overshoot * begin;
  if (!(begin < 0.0) || slope(1.0) <= allowed_slope) return 1.0;
  double low = 0.0, high = 1.0, middle = 0.5;
  for (int i = 0; i < most_trials; ++i) {
    middle = 0.5 * (low + high);
    const double value = slope(middle);
    if (std::abs(value) <= 0.1 * allowed_slope) break;
    (value < 0.0 ? low : high) = middle;
  }
  return middle;
}

std::string NonlinearFoundation::worst_point() const {
  struct {
    double mismatch;
    int rank;
  } worst{-1.0, 0};
  MPI_Comm_rank(comm_, &worst.rank);
  double worst_place[2] = {0.0, 0.0};  // kind, x
  for (const Point& p : points_) {
    if (!(p.mismatch > worst.mismatch)) continue;
    worst.mismatch = p.mismatch;
    worst_place[0] = static_cast<double>(p.source.kind);
    worst_place[1] = p.source.x;
  }
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm_);
  MPI_Bcast(worst_place, 2, MPI_DOUBLE, worst.rank, comm_);
  char text[96];
  const auto kind = static_cast<std::size_t>(worst_place[0]);
  if (kind == beam::hanging_sleeper_kind)
    std::snprintf(text, sizeof text, "the gap below the sleeper at x = %.6g m", worst_place[1]);
  else if (kind == beam::sliding_sleeper_kind)
    std::snprintf(text, sizeof text, "the longitudinal resistance of the sleeper at x = %.6g m", worst_place[1]);
  else
    std::snprintf(text, sizeof text, "foundation_%s at x = %.6g m", beam::foundation_kinds[kind].name.data(),
                  worst_place[1]);
  return text;
}

const AddedSprings* NonlinearFoundation::tangents(long version) const {
  const auto* found = std::find_if(stored_.begin(), stored_.end(),
                                   [&](const AddedSprings& stored) { return stored.version == version; });
  return found == stored_.end() ? nullptr : &*found;
}

}  // namespace traverse::structure
