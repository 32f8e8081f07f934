// Forces, energy and dissipation of each nonlinear foundation point from its displacement and rate, the history of
// points that slide with friction, and the sum of forces over all ranks.
#include "structure/nonlinear_foundation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace traverse::structure {
namespace {

using beam::Direction;

constexpr double same_station = 1e-6;  // m

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
  for (const beam::NonlinearPoint& source : beam::nonlinear_points(beam.bridge(), first, past))
    add_point(beam, source, load);
  for (const beam::NonlinearPoint& source : beam::hanging_sleepers(beam.bridge(), beam.layout(), 0, beam.columns())) {
    add_point(beam, source, load);
    ++sleepers_;
  }
  for (const beam::NonlinearPoint& source : beam::sliding_sleepers(beam.bridge(), beam.layout(), 0, beam.columns()))
    add_point(beam, source, load);
  record_terms(beam);
  tangent_k_.resize(points_.size());
  tangent_c_.resize(points_.size());
  for (AddedSprings& springs : stored_) {
    springs.terms = &terms_;
    springs.k.assign(points_.size(), -1.0);  // differs from all required tangents
    springs.c.assign(points_.size(), -1.0);
  }
}

void NonlinearFoundation::add_point(const beam::Beam& beam, const beam::NonlinearPoint& source, double load) {
  const beam::NonlinearShape shape = beam::shape_of(beam.bridge(), source);
  Point p;
  p.source = source;
  p.terms = static_cast<std::size_t>(shape.count);
  p.shape = shape.shape;
  p.place.fill(-1);
  bool on_this_rank = source.kind < beam::foundation_kind_count;
  for (std::size_t i = 0; i < p.terms; ++i) {
    const int from_first = shape.unknown[i] - beam.first_column() * block_;
    p.place[i] = shape.unknown[i] < 0 ? -1 : from_first < 0 ? n_ + block_ + from_first : from_first;
    // The left neighbour's column follows this rank's unknowns, then the right neighbour's.
    if (shape.unknown[i] >= 0 && from_first >= n_) p.place[i] = from_first + block_;
    on_this_rank = on_this_rank || beam.local(shape.unknown[i]) >= 0;
  }
  if (!on_this_rank) return;
  p.counted = beam.local(shape.unknown[0]) >= 0;
  p.reference = source.k + std::cbrt(source.law.cubic * load * load);
  points_.push_back(p);
}

void NonlinearFoundation::record_terms(const beam::Beam& beam) {
  const int b = block_;
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const beam::NonlinearShape s = beam::shape_of(beam.bridge(), points_[n].source);
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

beam::FoundationForce NonlinearFoundation::force_of(const Point& p, double displacement, double rate) {
  if (!p.slides()) return beam::foundation_force(p.source.law, p.source.k, p.source.c, displacement, rate);
  const beam::Sliding& law = p.source.sliding;
  return beam::sliding_force(law.k_of(p.loaded), law.limit_of(p.loaded), p.slip_force,
                             displacement - p.slip_displacement);
}

void NonlinearFoundation::evaluate(const double* v, const double* w) {
  gather(v, &Point::predicted);
  gather(w, &Point::predicted_rate);
  for (Point& p : points_) {
    p.state = force_of(p, p.predicted, p.predicted_rate);
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

void NonlinearFoundation::report(NonlinearForces& forces, std::vector<recovery::ElementLoad>& loads) const {
  for (std::size_t i = 0; i < beam::foundation_kind_count; ++i) {
    const beam::FoundationKind& kind = beam::foundation_kinds[i];
    const bool bed = kind.bed != nullptr && foundation_.*kind.bed && (foundation_.*kind.bed)->law.nonlinear();
    const std::size_t count = kind.points != nullptr ? (foundation_.*kind.points).size()
                              : bed                  ? static_cast<std::size_t>(spans_)
                                                     : 0;
    forces.of_kind[i].assign(count, 0.0);
  }
  std::vector<recovery::ElementLoad> own_loads;
  forces.below_sleepers.assign(sleepers_, 0.0);
  forces.open_gaps.assign(sleepers_, 0.0);
  forces.of_ground = forces.along_ground = 0.0;
  for (const Point& p : points_) {
    if (!p.counted) continue;
    if (p.source.kind == beam::hanging_sleeper_kind) {
      forces.below_sleepers[static_cast<std::size_t>(p.source.index)] = p.state.force;
      forces.open_gaps[static_cast<std::size_t>(p.source.index)] = p.predicted + p.source.law.gap;
      if (!p.source.on_bridge && p.source.below < 0) forces.of_ground += p.state.force;
      if (p.source.on_bridge && p.state.force != 0.0)
        own_loads.push_back({.element = p.source.at.element,
                             .xi = p.source.at.xi,
                             .fy = -p.state.force,
                             .torque = -p.source.eccentricity * p.state.force});
      continue;
    }
    if (p.state.force == 0.0) continue;
    if (p.source.kind == beam::sliding_sleeper_kind) {
      const double height = p.source.height, on_beam = -p.state.force;
      if (p.source.on_bridge)
        own_loads.push_back({p.source.at.element, p.source.at.xi, on_beam, 0.0, -height * on_beam});
      if (!p.source.on_bridge) forces.along_ground += p.state.force;
      continue;
    }
    forces.of_kind[p.source.kind][static_cast<std::size_t>(p.source.index)] += p.state.force;
    recovery::ElementLoad load{p.source.at.element, p.source.at.xi};
    (p.source.direction == Direction::vertical       ? load.fy
     : p.source.direction == Direction::longitudinal ? load.fx
                                                     : load.moment) = p.state.force;
    if (p.source.depth != 0.0) load.moment = p.source.depth * p.state.force;
    load.torque = p.source.eccentricity * p.state.force;
    own_loads.push_back(load);
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
  const auto count = static_cast<std::size_t>(ranks);
  std::vector<int> counts(count), starts(count);
  const int bytes = static_cast<int>(own_loads.size() * sizeof(recovery::ElementLoad));
  MPI_Allgather(&bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
  std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
  const std::size_t before = loads.size();
  loads.resize(before + static_cast<std::size_t>(starts.back() + counts.back()) / sizeof(recovery::ElementLoad));
  MPI_Allgatherv(own_loads.data(), bytes, MPI_BYTE, loads.data() + before, counts.data(), starts.data(), MPI_BYTE,
                 comm_);
}

// --- sliding sleepers and bearings ---------------------------------------------------------------------------------

void NonlinearFoundation::set_loaded_range(double from, double to) {
  for (Point& p : points_)
    p.loaded = p.slides() && p.source.x >= from - same_station && p.source.x <= to + same_station;
}

void NonlinearFoundation::update_slip(const double* v) {
  gather(v, &Point::predicted);
  for (Point& p : points_) {
    if (!p.slides()) continue;
    const double k = p.source.sliding.k_of(p.loaded), limit = p.source.sliding.limit_of(p.loaded);
    p.state = force_of(p, p.predicted, 0.0);
    const double start = std::clamp(p.slip_force, -limit, limit), force = p.state.force;
    const double slide = std::abs(p.predicted - p.slip_displacement) - std::abs(force - start) / k;
    const double work = 0.5 * (force * force - start * start) / k + std::abs(force) * slide;
    if (p.counted) slip_loss_ += p.slip_energy + work - p.state.energy;
    p.slip_force = force;
    p.slip_displacement = p.predicted;
    p.slip_energy = p.state.energy;
  }
}

NonlinearFoundation::History NonlinearFoundation::history() const {
  History history;
  for (const Point& p : points_) {
    if (!p.slides()) continue;
    history.force.push_back(p.slip_force);
    history.displacement.push_back(p.slip_displacement);
  }
  return history;
}

void NonlinearFoundation::set_history(const History& history) {
  std::size_t i = 0;
  for (Point& p : points_) {
    if (!p.slides()) continue;
    p.slip_force = history.force.empty() ? 0.0 : history.force[i];
    p.slip_displacement = history.force.empty() ? 0.0 : history.displacement[i++];
  }
}

void NonlinearFoundation::keep(base::Bytes& bytes) {
  bytes(points_, current_, versions_, shift_, slip_loss_, iteration_);
  for (AddedSprings& stored : stored_) bytes(stored.version, stored.k, stored.c);
}

}  // namespace traverse::structure
