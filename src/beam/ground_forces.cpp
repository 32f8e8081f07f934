#include "traverse/beam/ground_forces.hpp"

#include <algorithm>

#include "assembly.hpp"
#include "layered_track.hpp"
#include "traverse/beam/shape.hpp"

namespace traverse::beam {
namespace {

/// Integral of density(x) phi: nodal forces along x.
std::array<double, 2> axial_load(const Distribution& density, const Element& e) {
  const auto transverse = transverse_load(density, e);  // the same resultant and first moment about the left end
  const double force = transverse[0] + transverse[2];
  const double moment = transverse[2] * e.length + transverse[1] + transverse[3];
  return {force - moment / e.length, moment / e.length};
}

}  // namespace

GroundForces::GroundForces(const Beam& beam) : beam_(beam) {
  const Foundation& f = beam.model().foundation;
  const std::size_t spans = beam.model().spans.size();
  longitudinal_ = vertical_ + f.vertical.size();
  rotational_ = longitudinal_ + f.longitudinal.size();
  vertical_bed_ = rotational_ + f.rotational.size();
  longitudinal_bed_ = vertical_bed_ + spans;
  track_ = longitudinal_bed_ + spans;
  inertia_ = track_ + 2;
  drag_ = inertia_ + 2;
  sums_.assign(drag_ + 2, 0.0);
  add_points(beam.bridge());
  add_beds(beam.bridge());
  for (auto& along : bridge_masses_) along.assign(index(beam.local_unknowns()), 0.0);
  add_masses(beam.bridge(), bridge_masses_);
  masses_ = bridge_masses_;
  if (beam.rail() != nullptr) {
    add_masses(*beam.rail(), masses_);
    add_track();
  }
  mass_ = 0.0;
  // A rigid fall moves every deflection alike.
  for (int i = 0; i < beam.local_unknowns(); ++i) {
    const Kind kind = beam.layout().kind[index(i % beam.block())];
    if (kind == rail_v || kind == sleeper || kind == v) mass_ += masses_[1][index(i)];
  }
  MPI_Allreduce(MPI_IN_PLACE, &mass_, 1, MPI_DOUBLE, MPI_SUM, beam.comm());
}

void GroundForces::add(std::size_t sum, int unknown, double c, double k) {
  const int local = unknown < 0 ? -1 : beam_.local(unknown);
  if (local >= 0 && (c != 0.0 || k != 0.0)) terms_.push_back({sum, index(local), c, k});
}

void GroundForces::add_mass(std::vector<double>& masses, int unknown, double mass) const {
  const int local = unknown < 0 ? -1 : beam_.local(unknown);
  if (local >= 0) masses[index(local)] += mass;
}

void GroundForces::add_points(const Line& line) {
  const Foundation& f = line.model.foundation;
  const auto add_kind = [&](const std::vector<PointFoundation>& points, std::size_t sum, auto unknowns, auto shape) {
    for (const PointFoundation& p : points) {
      if (p.law.nonlinear()) {
        ++sum;
        continue;
      }
      const Station at = station_of(line.mesh, p);
      const auto s = shape(at.xi, line.mesh.element(at.element).length);
      const auto places = unknowns(at.element);
      for (std::size_t i = 0; i < s.size(); ++i) add(sum, places[i], p.c * s[i], p.k * s[i]);
      ++sum;
    }
  };
  const auto transverse = [&](int e) { return line.transverse(e); };
  const auto axial = [&](int e) { return line.axial(e); };
  add_kind(f.vertical, vertical_, transverse, [](double xi, double h) { return hermite(xi, h).value; });
  add_kind(f.longitudinal, longitudinal_, axial, [](double xi, double) { return linear(xi); });
  add_kind(f.rotational, rotational_, transverse, [](double xi, double h) { return hermite(xi, h).slope; });
}

void GroundForces::add_beds(const Line& line) {
  const Foundation& f = line.model.foundation;
  for (int e = 0; e < line.mesh.elements(); ++e) {
    const Element& element = line.mesh.element(e);
    const auto add_bed = [&](const Bed& bed, std::size_t sum, auto load, const auto& places) {
      const auto c = load(bed.c, element), k = load(bed.k, element);
      for (std::size_t i = 0; i < c.size(); ++i) add(sum + index(element.span), places[i], c[i], k[i]);
    };
    if (f.vertical_bed && !f.vertical_bed->law.nonlinear()) add_bed(*f.vertical_bed, vertical_bed_, transverse_load, line.transverse(e));
    if (f.longitudinal_bed && !f.longitudinal_bed->law.nonlinear()) add_bed(*f.longitudinal_bed, longitudinal_bed_, axial_load, line.axial(e));
  }
}

void GroundForces::add_masses(const Line& line, Masses& masses) const {
  for (int e = 0; e < line.mesh.elements(); ++e) {
    const auto along = axial_load(line.model.mass, line.mesh.element(e));
    const auto up = transverse_load(line.model.mass, line.mesh.element(e));
    for (std::size_t i = 0; i < 2; ++i) add_mass(masses[0], line.axial(e)[i], along[i]);
    for (std::size_t i = 0; i < 4; ++i) add_mass(masses[1], line.transverse(e)[i], up[i]);
  }
}

void GroundForces::add_track() {
  const LayeredTrack& track = *beam_.model().track;
  const Layout& layout = beam_.layout();
  for (const Sleeper& s : sleepers_of(beam_.bridge(), 0, beam_.columns())) {
    visit_ground_springs(s, track, layout, [&](int unknown, const Layer& layer, bool along_x) {
      add(track_ + (along_x ? 0 : 1), unknown, layer.c, layer.k);
    });
    for (const auto& [unknown, mass] : masses_of(s, track, layout)) add_mass(masses_[1], unknown, mass);
    if (!s.on_bridge) continue;
    const double mass = ride_of(s, track, layout).mass;
    const auto psi = hermite(s.at.xi, beam_.mesh().element(s.at.element).length).value;
    const auto places = beam_.bridge().transverse(s.at.element);
    for (std::size_t i = 0; i < 4; ++i) add_mass(masses_[1], places[i], mass * psi[i]);
  }
}

void GroundForces::evaluate(const double* v, const double* w, const double* a) {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (const Term& t : terms_) sums_[t.sum] -= t.c * w[t.unknown] + t.k * v[t.unknown];
  for (std::size_t i = 0; i < masses_[0].size(); ++i) {
    sums_[inertia_] -= masses_[0][i] * a[i];
    sums_[inertia_ + 1] -= masses_[1][i] * a[i];
    sums_[drag_] -= bridge_masses_[0][i] * w[i];
    sums_[drag_ + 1] -= bridge_masses_[1][i] * w[i];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums_.data(), static_cast<int>(sums_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
}

std::array<double, 2> GroundForces::foundation() const {
  std::array<double, 2> sum = track_bed();
  const auto add_range = [&](std::size_t from, std::size_t to, double& total) {
    for (std::size_t i = from; i < to; ++i) total += sums_[i];
  };
  add_range(vertical_, longitudinal_, sum[1]);
  add_range(longitudinal_, rotational_, sum[0]);
  add_range(vertical_bed_, longitudinal_bed_, sum[1]);
  add_range(longitudinal_bed_, track_, sum[0]);
  return sum;
}

std::array<double, 2> GroundForces::drag() const {
  const double a = beam_.rayleigh().a;
  return {a * sums_[drag_], a * sums_[drag_ + 1]};
}

}  // namespace traverse::beam
