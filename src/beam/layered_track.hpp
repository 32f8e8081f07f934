// Sleepers with their pads, ballast and sub-ballast, which connect the rail to the bridge and to the ground, and shear
// springs and dampers between neighbouring ballast masses (Zhai, Wang and Lin 2004).
//
// Ballast masses are a bay apart, which is several columns if the rail has several elements per bay, and only
// neighbouring columns may be coupled. Each column between two masses therefore has a link: an unknown on the straight
// line between the masses. If the masses are n columns apart, neighbouring links are connected by springs and dampers
// with n times the coefficients of the shear; in equilibrium they act as the spring and damper of the shear. A link has
// a millionth of the ballast's mass, so that the mass matrix is regular.
#pragma once

#include "slice.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {

/// A station of the grid of sleepers, with the properties of its layers.
struct Sleeper {
  double x = 0.0;
  int rail_node = 0;
  bool on_bridge = false;
  int side = 0;  // -1 on the ground before the bridge, 0 on it, 1 on the ground behind it
  Station at;    // on the bridge
  TrackValues values;
  bool missing = false;        // there are no sleeper and no pads
  bool sleeper_moves = false;  // it has a separate unknown
  bool ballast_moves = false;  // the ballast's mass has a separate unknown

  /// Whether the sleeper hangs on the rail until a gap below it closes.
  bool hangs() const { return values.gap > 0.0; }
  /// The ballast's spring in the matrices: none over a gap.
  Spring linear_ballast() const { return hangs() ? Spring{} : values.ballast; }
  /// Whether the sleeper slides along x when its force reaches a limit.
  bool slides() const { return values.slides_at > 0.0; }
  /// The longitudinal spring in the matrices: only the damper of a sleeper that slides.
  Spring linear_longitudinal() const { return slides() ? Spring{0.0, values.longitudinal.c} : values.longitudinal; }
  /// The unknowns of the sleeper and of the ballast's mass. On the ground the ballast's mass uses the place of the
  /// bridge's deflection, unless the ballast has a separate unknown on the bridge too.
  int unknown(const Layout& layout) const { return rail_node * layout.block + layout.place[sleeper]; }
  int ballast_unknown(const Layout& layout) const { return rail_node * layout.block + layout.ballast_place(); }
};

/// The sleepers whose rail node is among the columns [first, past), from left to right.
std::vector<Sleeper> sleepers_of(const Line& bridge, int first, int past);

/// Releases the existing unknowns of the sleeper and of the ballast's mass in the sleeper's column.
void release_sleeper(const Sleeper& sleeper, const Layout& layout, Slice& slice);

/// Adds the masses of sleepers and ballast and the springs and dampers of all layers.
void add_track(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping);

/// Calls visit(unknown, spring, along_x) for each spring and damper between the track and the ground.
template <class Visit>
void visit_ground_springs(const Sleeper& s, const LayeredTrack& track, const Layout& layout, Visit visit) {
  if (s.on_bridge) return;
  const int column = s.rail_node * layout.block;
  if (layout.place[rail_u] >= 0) visit(column + layout.place[rail_u], s.linear_longitudinal(), true);
  if (s.ballast_moves) {
    visit(s.ballast_unknown(layout), s.values.subballast, false);
  } else if (s.sleeper_moves) {
    visit(s.unknown(layout), track.subballast ? s.values.subballast : s.linear_ballast(), false);
  } else if (!s.missing) {
    visit(column + layout.place[rail_v], s.values.pad, false);
  }
}

/// The unknowns and masses of a sleeper and its ballast.
std::vector<std::pair<int, double>> masses_of(const Sleeper& s, const Layout& layout);

/// The connection of a sleeper to the beam of the bridge: a spring and a damper from `unknown`, and a mass that moves
/// with the beam; along x, at the running surface, a spring and a damper from `along` (-1: no axial unknowns).
struct SleeperConnection {
  int unknown = 0;
  Spring spring;
  double mass = 0.0;
  int along = -1;
  Spring spring_along;
};
SleeperConnection connection_of(const Sleeper& s, const LayeredTrack& track, const Layout& layout);

/// Calls visit(unknown, mass) for the links between two neighbouring sleepers whose ballast masses are in shear.
template <class Visit>
void visit_links(const Sleeper& left, const Sleeper& right, const Layout& layout, Visit visit) {
  constexpr double mass_ratio = 1e-6;
  const double mass = mass_ratio * 0.5 * (left.values.ballast_mass + right.values.ballast_mass);
  for (int column = left.rail_node + 1; column < right.rail_node; ++column)
    visit(column * layout.block + layout.ballast_place(), mass);
}

/// Whether shear acts between two neighbours: both have a separate ballast mass, and the deflection of a bridge does
/// not use the unknowns of the links between them.
bool shear_between(const Sleeper& left, const Sleeper& right, const Layout& layout);

/// The pairs of neighbours in shear with a column or a link among the columns [first, past).
std::vector<std::pair<Sleeper, Sleeper>> pairs_in_shear(const Line& bridge, const Layout& layout, int first, int past);

void release_links(const Line& bridge, const Layout& layout, Slice& slice);
/// Adds the masses of the links and the springs and dampers of the shear.
void add_shear(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping);

/// Throws InputError if it cannot; the message names the option or the sleeper, the value and the allowed values.
void check_track(const BeamModel& model);

}  // namespace traverse::beam
