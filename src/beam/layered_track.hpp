// Sleepers with their pads, ballast and sub-ballast, which connect the rail to the bridge and to the ground.
#pragma once

#include "slice.hpp"

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

}  // namespace traverse::beam
