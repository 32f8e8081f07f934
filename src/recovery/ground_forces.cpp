// Sums of foundation, ground and inertia forces as products of precomputed coefficients with nodal displacements,
// velocities and accelerations, pad and ballast forces as linear combinations of those above and below each spring, and
// openings as the difference of the rail's two longitudinal displacements at a node; all summed over ranks.
#include "recovery/ground_forces.hpp"

#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"
#include "beam/assembly.hpp"
#include "beam/shape.hpp"

namespace traverse::recovery {

GroundForces::GroundForces(const beam::Beam& beam) : beam_(beam) {
  const beam::Foundation& f = beam.model().foundation;
  const std::size_t spans = beam.model().spans.size();
  for (std::size_t i = 0; i < beam::foundation_kind_count; ++i) {
    const beam::FoundationKind& kind = beam::foundation_kinds[i];
    first_[i + 1] = first_[i] + (kind.bed != nullptr ? spans : (f.*kind.points).size());
  }
  track_ = first_.back();
  inertia_ = track_ + 2;
  drag_ = inertia_ + 2;
  sums_.assign(drag_ + 2, 0.0);
  for (std::size_t i = 0; i < beam::foundation_kind_count; ++i) {
    if (beam::foundation_kinds[i].bed != nullptr) {
      add_bed(i, beam.bridge());
    } else {
      add_points(i, beam.bridge());
    }
  }
  for (auto& along : bridge_masses_) along.assign(beam::index(beam.local_unknowns()), 0.0);
  add_masses(beam.bridge(), bridge_masses_);
  masses_ = bridge_masses_;
  for (const beam::DamperPlace& place : beam::places_of_dampers(beam.bridge(), beam.layout()))
    add_mass(masses_[1], place.unknown, place.damper->mass);
  if (beam.rail() != nullptr) {
    add_masses(*beam.rail(), masses_);
    add_track();
  }
  mass_ = 0.0;
  // In a rigid vertical motion all deflections are equal.
  for (int i = 0; i < beam.local_unknowns(); ++i) {
    if (beam::Layout::is_vertical(beam.layout().kind[beam::index(i % beam.block())]))
      mass_ += masses_[1][beam::index(i)];
  }
  MPI_Allreduce(MPI_IN_PLACE, &mass_, 1, MPI_DOUBLE, MPI_SUM, beam.comm());
}

void GroundForces::add(std::size_t sum, int unknown, double c, double k) {
  const int local = unknown < 0 ? -1 : beam_.local(unknown);
  if (local >= 0 && (c != 0.0 || k != 0.0)) terms_.push_back({sum, beam::index(local), c, k});
}

void GroundForces::add_mass(std::vector<double>& masses, int unknown, double mass) const {
  const int local = unknown < 0 ? -1 : beam_.local(unknown);
  if (local >= 0) masses[beam::index(local)] += mass;
}

void GroundForces::add_points(std::size_t kind, const beam::Line& line) {
  std::size_t sum = first_[kind];
  for (const beam::PointFoundation& p : line.model.foundation.*beam::foundation_kinds[kind].points) {
    if (!p.law.nonlinear()) {
      const beam::PointShape s = beam::shape_at(line, beam::foundation_kinds[kind].direction,
                                                beam::station_of(line.mesh, p), p.depth, p.eccentricity);
      for (std::size_t i = 0; i < s.unknown.size(); ++i) add(sum, s.unknown[i], p.c * s.shape[i], p.k * s.shape[i]);
    }
    ++sum;
  }
}

void GroundForces::add_bed(std::size_t kind, const beam::Line& line) {
  const std::optional<beam::Bed>& bed = line.model.foundation.*beam::foundation_kinds[kind].bed;
  if (!bed || bed->law.nonlinear()) return;
  const beam::Direction direction = beam::foundation_kinds[kind].direction;
  for (int e = 0; e < line.mesh.elements(); ++e) {
    const beam::Element& element = line.mesh.element(e);
    const auto c = beam::bed_form(direction, bed->c, element), k = beam::bed_form(direction, bed->k, element);
    const auto places = beam::unknowns_of(line, direction, e);
    for (std::size_t i = 0; i < 4; ++i) add(first_[kind] + beam::index(element.span), places[i], c[i], k[i]);
  }
}

void GroundForces::add_masses(const beam::Line& line, Masses& masses) const {
  for (int e = 0; e < line.mesh.elements(); ++e) {
    const auto along = beam::axial_load(line.model.mass, line.mesh.element(e));
    const auto up = beam::transverse_load(line.model.mass, line.mesh.element(e));
    for (std::size_t i = 0; i < 2; ++i) add_mass(masses[0], line.axial(e)[i], along[i]);
    for (std::size_t i = 0; i < 4; ++i) add_mass(masses[1], line.transverse(e)[i], up[i]);
  }
  const auto add_at = [&](double x, double mass) {
    for (const beam::Direction direction : {beam::Direction::longitudinal, beam::Direction::vertical}) {
      const beam::PointShape s = beam::shape_at(line, direction, line.mesh.locate(x));
      std::vector<double>& sums = masses[direction == beam::Direction::longitudinal ? 0 : 1];
      for (std::size_t i = 0; i < s.unknown.size(); ++i) add_mass(sums, s.unknown[i], mass * s.shape[i]);
    }
  };
  for (const beam::PointMass& point : line.model.point_masses) add_at(point.x, point.mass);
}

void GroundForces::add_track() {
  const beam::LayeredTrack& track = *beam_.model().track;
  const beam::Layout& layout = beam_.layout();
  for (const beam::Sleeper& s : beam::sleepers_of(beam_.bridge(), 0, beam_.columns())) {
    beam::visit_ground_springs(s, track, layout, [&](int unknown, const beam::Spring& spring, bool along_x) {
      add(track_ + (along_x ? 0 : 1), unknown, spring.c, spring.k);
    });
    for (const auto& [unknown, mass] : beam::masses_of(s, layout)) add_mass(masses_[1], unknown, mass);
    if (!s.on_bridge) continue;
    const double mass = beam::connection_of(s, track, layout).mass;
    const beam::PointShape on =
        beam::shape_at(beam_.bridge(), beam::Direction::vertical, s.at, 0.0, beam_.bridge().eccentricity(0));
    for (std::size_t i = 0; i < on.unknown.size(); ++i) add_mass(masses_[1], on.unknown[i], mass * on.shape[i]);
  }
  for (const auto& [left, right] : beam::pairs_in_shear(beam_.bridge(), layout, 0, beam_.columns()))
    beam::visit_links(left, right, layout, [&](int unknown, double mass) { add_mass(masses_[1], unknown, mass); });
}

void GroundForces::evaluate(const double* v, const double* w, const double* a) {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (const Term& t : terms_) sums_[t.sum] -= t.c * w[t.unknown] + t.k * v[t.unknown];
  for (const std::size_t direction : {0U, 1U}) {
    if (direction == 0 && beam_.layout().place[beam::u] < 0) continue;
    sums_[inertia_ + direction] = -base::dot(masses_[direction], a);
    if (beam_.rayleigh().a != 0.0) sums_[drag_ + direction] = -base::dot(bridge_masses_[direction], w);
  }
  MPI_Allreduce(MPI_IN_PLACE, sums_.data(), static_cast<int>(sums_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
}

std::array<double, 2> GroundForces::foundation() const {
  std::array<double, 2> sum = track_bed();
  // Points, then beds: a constant order of summation.
  for (const bool of_bed : {false, true}) {
    for (std::size_t kind = 0; kind < beam::foundation_kind_count; ++kind) {
      const beam::Direction direction = beam::foundation_kinds[kind].direction;
      if ((beam::foundation_kinds[kind].bed != nullptr) != of_bed || direction == beam::Direction::rotational) continue;
      double& total = sum[direction == beam::Direction::longitudinal ? 0 : 1];
      for (std::size_t i = first_[kind]; i < first_[kind + 1]; ++i) total += sums_[i];
    }
  }
  return sum;
}

std::array<double, 2> GroundForces::drag() const {
  const double a = beam_.rayleigh().a;
  return {a * sums_[drag_], a * sums_[drag_ + 1]};
}

SleeperForces::SleeperForces(const beam::Beam& beam, const std::vector<double>& stations)
    : beam_(beam), sums_(2 * stations.size(), 0.0) {
  const std::vector<beam::Sleeper> all = beam::sleepers_of(beam.bridge(), 0, beam.columns());
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto nearest = std::min_element(all.begin(), all.end(), [&](const beam::Sleeper& a, const beam::Sleeper& b) {
      return std::abs(a.x - stations[i]) < std::abs(b.x - stations[i]);
    });
    x_.push_back(nearest->x);
    add_sleeper(i, *nearest);
  }
}

void SleeperForces::add_sleeper(std::size_t i, const beam::Sleeper& s) {
  const beam::Layout& layout = beam_.layout();
  const std::size_t pad = 2 * i, ballast = pad + 1;
  add(pad, s.rail_node * layout.block + layout.place[beam::rail_v], s.values.pad, -1.0);
  if (!s.sleeper_moves) {  // the pad acts on the bridge or on the ground
    if (s.on_bridge) add_bridge(pad, s, s.values.pad);
    return;
  }
  add(pad, s.unknown(layout), s.values.pad, 1.0);
  add(ballast, s.unknown(layout), s.linear_ballast(), -1.0);
  if (s.ballast_moves)
    add(ballast, s.ballast_unknown(layout), s.linear_ballast(), 1.0);
  else if (s.on_bridge)
    add_bridge(ballast, s, s.linear_ballast());
}

void SleeperForces::add_bridge(std::size_t sum, const beam::Sleeper& s, const beam::Spring& spring) {
  const beam::PointShape on =
      beam::shape_at(beam_.bridge(), beam::Direction::vertical, s.at, 0.0, beam_.bridge().eccentricity(0));
  for (std::size_t i = 0; i < on.unknown.size(); ++i) add(sum, on.unknown[i], spring, on.shape[i]);
}

void SleeperForces::add(std::size_t sum, int unknown, const beam::Spring& spring, double factor) {
  const int local = unknown < 0 ? -1 : beam_.local(unknown);
  if (local >= 0) terms_.push_back({sum, beam::index(local), factor * spring.c, factor * spring.k});
}

void SleeperForces::evaluate(const double* v, const double* w) {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (const Term& t : terms_) sums_[t.sum] += t.c * w[t.unknown] + t.k * v[t.unknown];
  MPI_Allreduce(MPI_IN_PLACE, sums_.data(), static_cast<int>(sums_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
}

RailDevices::RailDevices(const beam::Beam& beam) : beam_(beam) {
  if (beam.rail() == nullptr || !beam.model().axial) return;
  const beam::Line& rail = *beam.rail();
  for (const double x : rail.model.expansion_devices) {
    const int right = rail.mesh.locate(x).element, left = rail.mesh.locate(x, true).element;
    x_.push_back(x);
    left_.push_back(rail.axial(left)[1]);
    right_.push_back(rail.axial(right)[0]);
  }
  openings_.resize(x_.size());
}

void RailDevices::evaluate(const double* v) {
  const auto value = [&](int unknown) { return beam_.local(unknown) < 0 ? 0.0 : v[beam_.local(unknown)]; };
  for (std::size_t i = 0; i < x_.size(); ++i) openings_[i] = value(right_[i]) - value(left_[i]);
  MPI_Allreduce(MPI_IN_PLACE, openings_.data(), static_cast<int>(x_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
}

}  // namespace traverse::recovery
