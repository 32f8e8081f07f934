// Assembles the masses of sleepers and ballast, and the springs and dampers between rail, sleeper, ballast, the bridge
// element below the sleeper, and the ground.
#include "layered_track.hpp"

#include <cmath>

#include "assembly.hpp"
#include "beam/shape.hpp"

namespace traverse::beam {
namespace {

/// The station rounded to 2^-32 of its element, so that sleepers at equal positions are equal to the last bit; matrices
/// and factors that repeat are stored once.
Station on_grid(Station station) {
  constexpr double grid = 4294967296.0;
  station.xi = std::round(station.xi * grid) / grid;
  return station;
}

/// The matrix of k (a - b)^2/2 between two unknowns: [k, -k; -k, k].
std::array<double, 4> between(double k) { return {k, -k, -k, k}; }

/// Adds a spring and a damper: to the stiffness with k, to the damping with c.
template <class Add>
void add_layer(const Spring& spring, Rows& stiffness, Rows& damping, Add add) {
  add(spring.k, stiffness);
  add(spring.c, damping);
}

void add_on_bridge(const Sleeper& s, const Line& bridge, const Layout& layout, const LayeredTrack& track, Rows& mass,
                   Rows& stiffness, Rows& damping) {
  const auto [v1, theta1, v2, theta2] = bridge.transverse(s.at.element);
  const Element& element = bridge.mesh.element(s.at.element);
  const auto psi = hermite(s.at.xi, element.length, element.shear).value;
  const SleeperConnection connection = connection_of(s, track, layout);
  mass.add(bridge.transverse(s.at.element), outer(connection.mass, psi));
  const std::array<double, 5> direction{1.0, -psi[0], -psi[1], -psi[2], -psi[3]};
  const std::array<int, 5> unknowns{connection.unknown, v1, theta1, v2, theta2};
  add_layer(connection.spring, stiffness, damping,
            [&](double k, Rows& rows) { rows.add(unknowns, outer(k, direction)); });
  if (connection.along < 0) return;
  // The beam's surface at the height e above its axis moves by u - e theta along x.
  const auto [u1, u2] = bridge.axial(s.at.element);
  const auto phi = linear(s.at.xi);
  const auto turn = rotation(s.at.xi, element.length, element.shear);
  const double e = bridge.model.surface_height;
  const std::array<double, 7> along{1.0, -phi[0], -phi[1], e * turn[0], e * turn[1], e * turn[2], e * turn[3]};
  const std::array<int, 7> unknowns_along{connection.along, u1, u2, v1, theta1, v2, theta2};
  add_layer(connection.spring_along, stiffness, damping,
            [&](double k, Rows& rows) { rows.add(unknowns_along, outer(k, along)); });
}

}  // namespace

std::vector<Sleeper> sleepers_of(const Line& bridge, int first, int past) {
  const LayeredTrack& track = *bridge.model.track;
  const RailMesh rail = rail_mesh(bridge.model);
  const double rounding = 1e-9 * rail.element;
  std::vector<Sleeper> sleepers;
  const int per_bay = track.elements_per_bay;
  for (int node = (std::max(first, 0) + per_bay - 1) / per_bay * per_bay; node < std::min(past, rail.elements + 1);
       node += per_bay) {
    Sleeper s;
    s.x = rail.x(node);
    s.rail_node = node;
    s.on_bridge = s.x >= bridge.mesh.start() - rounding && s.x <= bridge.mesh.end() + rounding;
    s.side = s.on_bridge ? 0 : s.x < bridge.mesh.start() ? -1 : 1;
    // Between two separate spans the sleeper is on the right-hand span, as in the numbering, independent of the
    // rounding of x.
    if (s.on_bridge) s.at = on_grid(bridge.mesh.locate(s.x + rounding));
    s.values = track.at(s.x);
    s.missing = !track.has_sleeper(s.x);
    s.sleeper_moves = !s.missing && (track.ballast || (track.subballast && !s.on_bridge));
    s.ballast_moves = track.ballast && track.subballast && (!s.on_bridge || track.own_mass);
    sleepers.push_back(s);
  }
  return sleepers;
}

SleeperConnection connection_of(const Sleeper& s, const LayeredTrack& track, const Layout& layout) {
  const int column = s.rail_node * layout.block;
  const int along = layout.place[rail_u] < 0 ? -1 : column + layout.place[rail_u];
  const Spring longitudinal = s.linear_longitudinal();
  if (s.ballast_moves) return {s.ballast_unknown(layout), s.values.subballast, 0.0, along, longitudinal};
  if (track.ballast) return {s.unknown(layout), s.linear_ballast(), s.values.ballast_mass, along, longitudinal};
  return {column + layout.place[rail_v], s.values.pad, s.values.sleeper_mass, along, longitudinal};
}

std::vector<std::pair<int, double>> masses_of(const Sleeper& s, const Layout& layout) {
  std::vector<std::pair<int, double>> masses;
  if (s.sleeper_moves) masses.emplace_back(s.unknown(layout), s.values.sleeper_mass);
  if (s.ballast_moves) masses.emplace_back(s.ballast_unknown(layout), s.values.ballast_mass);
  return masses;
}

void release_sleeper(const Sleeper& s, const Layout& layout, Slice& slice) {
  for (const auto& [unknown, mass] : masses_of(s, layout)) slice.release(unknown);
}

void add_track(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping) {
  const LayeredTrack& track = *bridge.model.track;
  for (const Sleeper& s : sleepers_of(bridge, slice.first - 1, slice.first + slice.local + 1)) {
    if (s.on_bridge) {
      add_on_bridge(s, bridge, layout, track, mass, stiffness, damping);
    } else {
      visit_ground_springs(s, track, layout, [&](int unknown, const Spring& spring, bool) {
        add_layer(spring, stiffness, damping,
                  [&](double k, Rows& rows) { rows.add(std::array{unknown}, std::array{k}); });
      });
    }
    const auto connect = [&](const Spring& spring, int above, int below) {
      add_layer(spring, stiffness, damping, [&](double k, Rows& rows) {
        rows.add(std::array{above, below}, between(k));
      });
    };
    if (s.ballast_moves && s.sleeper_moves) connect(s.linear_ballast(), s.unknown(layout), s.ballast_unknown(layout));
    for (const auto& [unknown, node_mass] : masses_of(s, layout)) mass.add(std::array{unknown}, std::array{node_mass});
    // Without a separate sleeper mass the pad acts on the next layer.
    if (s.sleeper_moves) connect(s.values.pad, s.rail_node * layout.block + layout.place[rail_v], s.unknown(layout));
  }
}

}  // namespace traverse::beam
