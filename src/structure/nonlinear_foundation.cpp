#include "structure/nonlinear_foundation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace traverse::structure {
namespace {

using beam::Direction;

constexpr double tolerance = 1e-12;        // of the greatest force: what tangents may leave
constexpr int most_stage_iterations = 40;  // of a stage; else the step is cut
constexpr int most_static_iterations = 100;
constexpr double near_tangent = 0.1;   // of a stiffness: tangents that are kept
constexpr int patience = 4;            // iterations with them, then only with the true ones
constexpr double loose = 1e-6;         // of the reference stiffness: what holds in statics where nothing touches
constexpr double overshoot = 0.5;      // of the slope at the start of a step, at its end
constexpr int most_trials = 50;        // for the length of a step
constexpr double same_station = 1e-6;  // m
constexpr double unit_rounding = 16.0 * std::numeric_limits<double>::epsilon();

bool near(double kept, double wanted, double share) {
  return std::abs(kept - wanted) <= share * std::max(std::abs(kept), std::abs(wanted));
}

}  // namespace

NonlinearFoundation::NonlinearFoundation(const beam::Beam& beam, const BeamOperator& op, double load, double point_load)
    : comm_(beam.comm()),
      operator_(op),
      foundation_(beam.model().foundation),
      spans_(beam.mesh().spans()),
      n_(op.unknowns()),
      block_(op.block()),
      point_load_(point_load),
      borders_(2 * static_cast<std::size_t>(op.block()), 0.0) {
  const auto [first, past] = beam.bridge().elements_at(beam.first_column(), beam.local_columns());
  for (const beam::NonlinearPoint& its : beam::nonlinear_points(beam.bridge(), first, past)) add_point(beam, its, load);
  for (const beam::NonlinearPoint& its : beam::hanging_sleepers(beam.bridge(), beam.layout(), 0, beam.columns())) {
    add_point(beam, its, load);
    ++sleepers_;
  }
  for (const beam::NonlinearPoint& its : beam::sliding_sleepers(beam.bridge(), beam.layout(), 0, beam.columns()))
    add_point(beam, its, load);
  note_terms(beam);
  wanted_k_.resize(points_.size());
  wanted_c_.resize(points_.size());
  for (AddedSprings& springs : kept_) {
    springs.terms = &terms_;
    springs.k.assign(points_.size(), -1.0);  // like nothing that is wanted
    springs.c.assign(points_.size(), -1.0);
  }
}

void NonlinearFoundation::add_point(const beam::Beam& beam, const beam::NonlinearPoint& its, double load) {
  const beam::NonlinearShape shape = beam::shape_of(beam.bridge(), its);
  Point p;
  p.its = its;
  p.terms = static_cast<std::size_t>(shape.count);
  p.shape = shape.shape;
  p.place.fill(-1);
  bool here = its.kind < beam::foundation_kind_count;
  for (std::size_t i = 0; i < p.terms; ++i) {
    const int from_first = shape.unknown[i] - beam.first_column() * block_;
    p.place[i] = shape.unknown[i] < 0 ? -1 : from_first < 0 ? n_ + block_ + from_first : from_first;
    // The left neighbour's column follows this rank's unknowns, then the right neighbour's.
    if (shape.unknown[i] >= 0 && from_first >= n_) p.place[i] = from_first + block_;
    here = here || beam.local(shape.unknown[i]) >= 0;
  }
  if (!here) return;
  p.counted = beam.local(shape.unknown[0]) >= 0;
  p.reference = its.k + std::cbrt(its.law.cubic * load * load);
  points_.push_back(p);
}

void NonlinearFoundation::note_terms(const beam::Beam& beam) {
  const int b = block_;
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const beam::NonlinearShape s = beam::shape_of(beam.bridge(), points_[n].its);
    const std::size_t terms = points_[n].terms;
    for (std::size_t i = 0; i < terms; ++i) {
      const int row = s.unknown[i] < 0 ? -1 : beam.local(s.unknown[i]);
      if (row < 0) continue;
      for (std::size_t j = 0; j < terms; ++j) {
        if (s.unknown[j] < 0 || s.shape[i] * s.shape[j] == 0.0) continue;
        const int ahead = s.unknown[j] / b - s.unknown[i] / b;
        const int place = ahead < 0 ? -1 : (row / b * b + s.unknown[j] % b) * b + row % b;
        terms_.push_back({n, row, points_[n].place[j], ahead > 0, place, s.shape[i] * s.shape[j]});
      }
    }
  }
}

// --- at a state ----------------------------------------------------------------------------------------------------

void NonlinearFoundation::gather(const double* x, double Point::*into) {
  operator_.borders(x, borders_.data(), borders_.data() + block_);
  for (Point& p : points_) {
    double sum = 0.0;
    for (std::size_t i = 0; i < p.terms; ++i)
      if (p.place[i] >= 0) sum += p.shape[i] * (p.place[i] < n_ ? x[p.place[i]] : borders_[p.place[i] - n_]);
    p.*into = sum;
  }
}

void NonlinearFoundation::evaluate(const double* v, const double* w) {
  gather(v, &Point::still);
  gather(w, &Point::still_rate);
  for (Point& p : points_) {
    p.state = force_of(p, p.still, p.still_rate);
  }
}

void NonlinearFoundation::add_forces(double* nodal) const {
  for (const Point& p : points_)
    for (std::size_t i = 0; i < p.terms; ++i)
      if (p.place[i] >= 0 && p.place[i] < n_) nodal[p.place[i]] += p.shape[i] * p.state.force;
}

double NonlinearFoundation::energy() const {
  double sum = 0.0;
  for (const Point& p : points_) sum += p.counted ? p.state.energy : 0.0;
  return sum;
}

double NonlinearFoundation::dissipation() const {
  double sum = 0.0;
  for (const Point& p : points_) sum += p.counted ? p.state.dissipation : 0.0;
  return sum;
}

void NonlinearFoundation::report(NonlinearForces& forces, std::vector<beam::ElementLoad>& loads) const {
  for (std::size_t i = 0; i < beam::foundation_kind_count; ++i) {
    const beam::FoundationKind& kind = beam::foundation_kinds[i];
    const bool bed = kind.bed != nullptr && foundation_.*kind.bed && (foundation_.*kind.bed)->law.nonlinear();
    const std::size_t count = kind.points != nullptr ? (foundation_.*kind.points).size()
                              : bed                  ? static_cast<std::size_t>(spans_)
                                                     : 0;
    forces.of_kind[i].assign(count, 0.0);
  }
  std::vector<beam::ElementLoad> mine;
  forces.below_sleepers.assign(sleepers_, 0.0);
  forces.open_gaps.assign(sleepers_, 0.0);
  forces.of_ground = forces.along_ground = 0.0;
  for (const Point& p : points_) {
    if (!p.counted) continue;
    if (p.its.kind == beam::below_a_sleeper) {
      forces.below_sleepers[static_cast<std::size_t>(p.its.index)] = p.state.force;
      forces.open_gaps[static_cast<std::size_t>(p.its.index)] = p.still + p.its.law.gap;
      if (!p.its.on_bridge && p.its.below < 0) forces.of_ground += p.state.force;
      if (p.its.on_bridge && p.state.force != 0.0) mine.push_back({p.its.at.element, p.its.at.xi, 0.0, -p.state.force});
      continue;
    }
    if (p.state.force == 0.0) continue;
    if (p.slides()) {
      const double height = p.its.height, on_beam = -p.state.force;
      if (p.its.on_bridge) mine.push_back({p.its.at.element, p.its.at.xi, on_beam, 0.0, -height * on_beam});
      if (!p.its.on_bridge) forces.along_ground += p.state.force;
      continue;
    }
    forces.of_kind[p.its.kind][static_cast<std::size_t>(p.its.index)] += p.state.force;
    beam::ElementLoad load{p.its.at.element, p.its.at.xi};
    (p.its.direction == Direction::vertical       ? load.fy
     : p.its.direction == Direction::longitudinal ? load.fx
                                                  : load.moment) = p.state.force;
    if (p.its.depth != 0.0) load.moment = p.its.depth * p.state.force;
    mine.push_back(load);
  }
  const auto sum = [&](std::vector<double>& list) {
    if (!list.empty())
      MPI_Allreduce(MPI_IN_PLACE, list.data(), static_cast<int>(list.size()), MPI_DOUBLE, MPI_SUM, comm_);
  };
  for (std::vector<double>& list : forces.of_kind) sum(list);
  sum(forces.below_sleepers);
  sum(forces.open_gaps);
  for (double* ground : {&forces.of_ground, &forces.along_ground})
    MPI_Allreduce(MPI_IN_PLACE, ground, 1, MPI_DOUBLE, MPI_SUM, comm_);

  int ranks = 1;
  MPI_Comm_size(comm_, &ranks);
  std::vector<int> counts(static_cast<std::size_t>(ranks)), starts(counts.size(), 0);
  const int bytes = static_cast<int>(mine.size() * sizeof(beam::ElementLoad));
  MPI_Allgather(&bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
  for (std::size_t i = 1; i < starts.size(); ++i) starts[i] = starts[i - 1] + counts[i - 1];
  const std::size_t before = loads.size();
  loads.resize(before + static_cast<std::size_t>(starts.back() + counts.back()) / sizeof(beam::ElementLoad));
  MPI_Allgatherv(mine.data(), bytes, MPI_BYTE, loads.data() + before, counts.data(), starts.data(), MPI_BYTE, comm_);
}

// --- sleepers that slide -------------------------------------------------------------------------------------------

void NonlinearFoundation::stand(double from, double to) {
  for (Point& p : points_) p.loaded = p.slides() && p.its.x >= from - same_station && p.its.x <= to + same_station;
}

void NonlinearFoundation::settle(const double* v) {
  gather(v, &Point::still);
  for (Point& p : points_) {
    if (!p.slides()) continue;
    const double k = p.its.sliding.k_of(p.loaded), limit = p.its.sliding.limit_of(p.loaded);
    p.state = force_of(p, p.still, 0.0);
    const double start = std::clamp(p.settled_force, -limit, limit), force = p.state.force;
    const double slide = std::abs(p.still - p.settled) - std::abs(force - start) / k;
    const double work = 0.5 * (force * force - start * start) / k + std::abs(force) * slide;
    if (p.counted) slid_ += p.settled_energy + work - p.state.energy;
    p.settled_force = force;
    p.settled = p.still;
    p.settled_energy = p.state.energy;
  }
}

NonlinearFoundation::History NonlinearFoundation::history() const {
  History history;
  for (const Point& p : points_) {
    if (!p.slides()) continue;
    history.force.push_back(p.settled_force);
    history.displacement.push_back(p.settled);
  }
  return history;
}

void NonlinearFoundation::set_history(const History& history) {
  std::size_t i = 0;
  for (Point& p : points_) {
    if (!p.slides()) continue;
    p.settled_force = history.force.empty() ? 0.0 : history.force[i];
    p.settled = history.force.empty() ? 0.0 : history.displacement[i++];
  }
}

// --- within a stage ------------------------------------------------------------------------------------------------

beam::FoundationForce NonlinearFoundation::force_of(const Point& p, double displacement, double rate) {
  if (!p.slides()) return beam::foundation_force(p.its.law, p.its.k, p.its.c, displacement, rate);
  const beam::Sliding& law = p.its.sliding;
  return beam::sliding_force(law.k_of(p.loaded), law.limit_of(p.loaded), p.settled_force, displacement - p.settled);
}

beam::FoundationForce NonlinearFoundation::force_at(const Point& p, double zeta) const {
  return force_of(p, p.still + zeta, p.still_rate + shift_ * zeta);
}

void NonlinearFoundation::begin(double shift, const double* v_still, const double* w_still, const double* w_guess) {
  shift_ = shift;
  iteration_ = 0;
  if (shift == 0.0) {
    for (Point& p : points_) p.still = p.still_rate = 0.0;
    if (v_still != nullptr) gather(v_still, &Point::still);
    return;
  }
  gather(v_still, &Point::still);
  gather(w_still, &Point::still_rate);
  gather(w_guess, &Point::zeta0);
  for (Point& p : points_) p.zeta0 = (p.zeta0 - p.still_rate) / shift;
}

// Statics begins as if whatever can carry weight did, from where it first touches, and as if nothing slid.
void NonlinearFoundation::start_statics(Point& p) const {
  if (p.slides()) {
    p.zeta0 = p.settled - p.still;
    p.state = force_of(p, p.settled, 0.0);
    p.state.by_displacement = p.its.sliding.k_of(p.loaded);
    return;
  }
  const bool carries = p.its.direction == Direction::vertical;
  p.zeta0 = (carries ? -p.its.law.gap : 0.0) - p.still;
  p.state = {};
  p.state.by_displacement = carries || p.its.law.gap == 0.0 ? p.reference : 0.0;
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
    wanted_k_[i] = shift_ > 0.0 ? p.state.by_displacement : std::max(p.state.by_displacement, loose * p.reference);
    wanted_c_[i] = p.state.by_rate;
  }
  choose_tangents();
  return kept_[current_];
}

// One of those used lately if it is near enough everywhere, else the true ones.
void NonlinearFoundation::choose_tangents() {
  const double share = iteration_ < patience ? near_tangent : 0.0;
  unsigned fitting = 0;
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const AddedSprings& kept = kept_[i];
    bool fits = kept.version > 0;
    for (std::size_t j = 0; fits && j < points_.size(); ++j)
      fits = near(kept.k[j] + shift_ * kept.c[j], wanted_k_[j] + shift_ * wanted_c_[j], share);
    fitting |= fits ? 1U << i : 0U;
  }
  MPI_Allreduce(MPI_IN_PLACE, &fitting, 1, MPI_UNSIGNED, MPI_BAND, comm_);
  if ((fitting >> current_ & 1U) != 0) return;
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    if ((fitting >> i & 1U) == 0) continue;
    current_ = i;
    return;
  }
  current_ = (current_ + 1) % kept_.size();
  kept_[current_].version = ++versions_;
  kept_[current_].k = wanted_k_;
  kept_[current_].c = wanted_c_;
}

void NonlinearFoundation::add_linearised(double* nodal) const {
  const AddedSprings& tangent = kept_[current_];
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const Point& p = points_[n];
    const double force = p.force0 + (tangent.k[n] + shift_ * tangent.c[n]) * p.zeta0;
    for (std::size_t i = 0; i < p.terms; ++i)
      if (p.place[i] >= 0 && p.place[i] < n_) nodal[p.place[i]] += p.shape[i] * force;
  }
}

NonlinearFoundation::Verdict NonlinearFoundation::judge(const double* z) {
  gather(z, &Point::zeta);
  const AddedSprings& tangent = kept_[current_];
  double greatest[2] = {0.0, 0.0};  // misfit beyond rounding, force
  for (std::size_t n = 0; n < points_.size(); ++n) {
    Point& p = points_[n];
    const double T = tangent.k[n] + shift_ * tangent.c[n];
    p.linear_force = p.force0 - T * (p.zeta - p.zeta0);
    p.state = force_at(p, p.zeta);
    const double size = std::abs(p.still) + std::abs(p.zeta) + std::abs(p.zeta0) + p.its.law.gap;
    const double rate = std::abs(p.still_rate) + shift_ * (std::abs(p.zeta) + std::abs(p.zeta0));
    const double floor = unit_rounding * ((std::abs(p.state.by_displacement) + std::abs(tangent.k[n])) * size +
                                          (p.state.by_rate + tangent.c[n]) * rate);
    p.misfit = std::abs(p.state.force - p.linear_force) - floor;
    if (!std::isfinite(p.zeta)) p.misfit = std::numeric_limits<double>::infinity();
    greatest[0] = std::max(greatest[0], p.misfit);
    greatest[1] = std::max(greatest[1], std::abs(p.state.force));
  }
  MPI_Allreduce(MPI_IN_PLACE, greatest, 2, MPI_DOUBLE, MPI_MAX, comm_);
  if (greatest[0] <= tolerance * std::max(greatest[1], point_load_)) return Verdict::settled;
  if (!std::isfinite(greatest[0]) || ++iteration_ >= (shift_ > 0.0 ? most_stage_iterations : most_static_iterations))
    return Verdict::failed;
  const double share = iteration_ == 1 ? 1.0 : best_share();  // of the first step the beginning is not in balance
  for (Point& p : points_) {
    p.balanced_force = share == 1.0 ? p.linear_force : p.balanced_force + share * (p.linear_force - p.balanced_force);
    p.zeta0 = share == 1.0 ? p.zeta : p.zeta0 + share * (p.zeta - p.zeta0);
  }
  return Verdict::again;
}

// Derivative along the step of the function that the solution makes least.
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

// The whole step, or where its slope ends if the whole goes far beyond.
double NonlinearFoundation::best_share() const {
  const double begin = slope(0.0);
  const double enough = -overshoot * begin;
  if (!(begin < 0.0) || slope(1.0) <= enough) return 1.0;
  double low = 0.0, high = 1.0, middle = 0.5;
  for (int i = 0; i < most_trials; ++i) {
    middle = 0.5 * (low + high);
    const double there = slope(middle);
    if (std::abs(there) <= 0.1 * enough) break;
    (there < 0.0 ? low : high) = middle;
  }
  return middle;
}

std::string NonlinearFoundation::worst_point() const {
  struct {
    double misfit;
    int rank;
  } worst{-1.0, 0};
  MPI_Comm_rank(comm_, &worst.rank);
  double which[2] = {0.0, 0.0};  // kind, x
  for (const Point& p : points_) {
    if (!(p.misfit > worst.misfit)) continue;
    worst.misfit = p.misfit;
    which[0] = static_cast<double>(p.its.kind);
    which[1] = p.its.x;
  }
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm_);
  MPI_Bcast(which, 2, MPI_DOUBLE, worst.rank, comm_);
  char text[96];
  const auto kind = static_cast<std::size_t>(which[0]);
  if (kind == beam::below_a_sleeper)
    std::snprintf(text, sizeof text, "the gap below the sleeper at x = %.6g m", which[1]);
  else if (kind == beam::along_a_sleeper)
    std::snprintf(text, sizeof text, "the longitudinal resistance of the sleeper at x = %.6g m", which[1]);
  else
    std::snprintf(text, sizeof text, "foundation_%s at x = %.6g m", beam::foundation_kinds[kind].name.data(), which[1]);
  return text;
}

const AddedSprings* NonlinearFoundation::tangents(long version) const {
  const auto* found =
      std::find_if(kept_.begin(), kept_.end(), [&](const AddedSprings& kept) { return kept.version == version; });
  return found == kept_.end() ? nullptr : &*found;
}

void NonlinearFoundation::keep(base::Bytes& bytes) {
  bytes(points_, current_, versions_, shift_, slid_, iteration_);
  for (AddedSprings& kept : kept_) bytes(kept.version, kept.k, kept.c);
}

}  // namespace traverse::structure
