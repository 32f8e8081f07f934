#include "layered_track.hpp"

#include <cmath>

#include "assembly.hpp"
#include "beam/shape.hpp"

namespace traverse::beam {
namespace {

/// A station moved by up to 1e-10 of its element, so that sleepers that stand alike are alike to the last bit: matrices
/// and factors that repeat are kept once.
Station on_grid(Station station) {
  constexpr double grid = 4294967296.0;
  station.xi = std::round(station.xi * grid) / grid;
  return station;
}

/// k (a - b)^2/2 between two unknowns: [k, -k; -k, k].
std::array<double, 4> between(double k) { return {k, -k, -k, k}; }

/// The track's own term of one kind of layer: into the stiffness by k, into the damping by c.
template <class Add>
void add_layer(const Layer& layer, Rows& stiffness, Rows& damping, Add add) {
  add(layer.k, stiffness);
  add(layer.c, damping);
}

void add_on_bridge(const Sleeper& s, const Line& bridge, const Layout& layout, const LayeredTrack& track, Rows& mass,
                   Rows& stiffness, Rows& damping) {
  const auto [v1, theta1, v2, theta2] = bridge.transverse(s.at.element);
  const Element& element = bridge.mesh.element(s.at.element);
  const auto psi = hermite(s.at.xi, element.length, element.shear).value;
  const Ride ride = ride_of(s, track, layout);
  mass.add(bridge.transverse(s.at.element), outer(ride.mass, psi));
  const std::array<double, 5> direction{1.0, -psi[0], -psi[1], -psi[2], -psi[3]};
  const std::array<int, 5> unknowns{ride.unknown, v1, theta1, v2, theta2};
  add_layer(ride.spring, stiffness, damping, [&](double k, Rows& rows) { rows.add(unknowns, outer(k, direction)); });
  if (ride.along < 0) return;
  // The beam's surface at height e above its axis moves by u - e theta along x.
  const auto [u1, u2] = bridge.axial(s.at.element);
  const auto phi = linear(s.at.xi);
  const auto turn = rotation(s.at.xi, element.length, element.shear);
  const double e = bridge.model.surface_height;
  const std::array<double, 7> along{1.0, -phi[0], -phi[1], e * turn[0], e * turn[1], e * turn[2], e * turn[3]};
  const std::array<int, 7> moved{ride.along, u1, u2, v1, theta1, v2, theta2};
  add_layer(track.longitudinal, stiffness, damping, [&](double k, Rows& rows) { rows.add(moved, outer(k, along)); });
}

void add_on_ground(const Sleeper& s, const Layout& layout, const LayeredTrack& track, Rows& stiffness, Rows& damping) {
  const int column = s.rail_node * layout.block;
  visit_ground_springs(s, track, layout, [&](int unknown, const Layer& layer, bool) {
    add_layer(layer, stiffness, damping, [&](double k, Rows& rows) { rows.add(std::array{unknown}, std::array{k}); });
  });
  if (!track.ballast || !track.subballast) return;
  const int ballast = column + layout.place[v];
  add_layer(*track.ballast, stiffness, damping, [&](double k, Rows& rows) {
    rows.add(std::array{column + layout.place[sleeper], ballast}, between(k));
  });
}

}  // namespace

std::vector<Sleeper> sleepers_of(const Line& bridge, int first, int past) {
  const LayeredTrack& track = *bridge.model.track;
  const RailMesh rail = rail_mesh(bridge.model);
  const double rounding = 1e-9 * rail.element;
  std::vector<Sleeper> sleepers;
  const int each = track.elements_per_bay;
  for (int node = (std::max(first, 0) + each - 1) / each * each; node < std::min(past, rail.elements + 1);
       node += each) {
    Sleeper s{rail.x(node), node, false, {}};
    s.on_bridge = s.x >= bridge.mesh.start() - rounding && s.x <= bridge.mesh.end() + rounding;
    // The right-hand one of two separate spans, as the numbering has it, whatever the rounding of x.
    if (s.on_bridge) s.at = on_grid(bridge.mesh.locate(s.x + rounding));
    sleepers.push_back(s);
  }
  return sleepers;
}

Ride ride_of(const Sleeper& s, const LayeredTrack& track, const Layout& layout) {
  const int column = s.rail_node * layout.block;
  const int along = layout.place[rail_u] < 0 ? -1 : column + layout.place[rail_u];
  if (track.ballast) return {column + layout.place[sleeper], *track.ballast, track.ballast_mass, along};
  return {column + layout.place[rail_v], track.pad, track.sleeper_mass, along};
}

std::vector<std::pair<int, double>> masses_of(const Sleeper& s, const LayeredTrack& track, const Layout& layout) {
  std::vector<std::pair<int, double>> masses;
  const int column = s.rail_node * layout.block;
  if (track.ballast || (track.subballast && !s.on_bridge))
    masses.emplace_back(column + layout.place[sleeper], track.sleeper_mass);
  if (track.ballast && track.subballast && !s.on_bridge)
    masses.emplace_back(column + layout.place[v], track.ballast_mass);
  return masses;
}

void release_sleeper(const Sleeper& s, const LayeredTrack& track, const Layout& layout, Slice& slice) {
  for (const auto& [unknown, mass] : masses_of(s, track, layout)) slice.release(unknown);
}

void add_track(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping) {
  const LayeredTrack& track = *bridge.model.track;
  for (const Sleeper& s : sleepers_of(bridge, slice.first - 1, slice.first + slice.local + 1)) {
    if (s.on_bridge) {
      add_on_bridge(s, bridge, layout, track, mass, stiffness, damping);
    } else {
      add_on_ground(s, layout, track, stiffness, damping);
    }
    const auto masses = masses_of(s, track, layout);
    for (const auto& [unknown, its_mass] : masses) mass.add(std::array{unknown}, std::array{its_mass});
    if (masses.empty()) continue;  // no sleeper of its own: the pad stands on the next layer
    const int column = s.rail_node * layout.block;
    add_layer(track.pad, stiffness, damping, [&](double k, Rows& rows) {
      rows.add(std::array{column + layout.place[rail_v], column + layout.place[sleeper]}, between(k));
    });
  }
}

}  // namespace traverse::beam
