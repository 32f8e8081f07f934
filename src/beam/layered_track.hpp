// Sleepers with their pads, ballast and sub-ballast: what joins the rail to the bridge and to the ground.
#pragma once

#include "slice.hpp"

namespace traverse::beam {

/// Where a sleeper stands, or would stand, and what its layers are there.
struct Sleeper {
  double x = 0.0;
  int rail_node = 0;
  bool on_bridge = false;
  int side = 0;  // -1 on the ground before the bridge, 0 on it, 1 on the ground behind it
  Station at;    // on the bridge
  TrackValues values;
  bool missing = false;        // neither sleeper nor pads
  bool sleeper_moves = false;  // by an unknown of its own
  bool ballast_moves = false;  // the same of the ballast's mass

  /// Whether it hangs on the rail until a gap below it closes.
  bool hangs() const { return values.gap > 0.0; }
  /// The ballast's spring as the matrices know it: none over a gap.
  Spring linear_ballast() const { return hangs() ? Spring{} : values.ballast; }
  /// Whether it slides along x where the force on it reaches a limit.
  bool slides() const { return values.slides_at > 0.0; }
  /// The longitudinal spring as the matrices know it: of one that slides its damper alone.
  Spring linear_longitudinal() const { return slides() ? Spring{0.0, values.longitudinal.c} : values.longitudinal; }
  /// The unknown of the sleeper, and that of the ballast's mass: in the place of the bridge's deflection on the ground,
  /// or in one of its own where ballast moves by itself on the bridge too.
  int unknown(const Layout& layout) const { return rail_node * layout.block + layout.place[sleeper]; }
  int ballast_unknown(const Layout& layout) const { return rail_node * layout.block + layout.ballast_place(); }
};

/// The sleepers whose rail node is among the columns [first, past), from left to right.
std::vector<Sleeper> sleepers_of(const Line& bridge, int first, int past);

/// Which of the unknowns of a sleeper's column exist: the sleeper itself, the ballast's mass.
void release_sleeper(const Sleeper& sleeper, const Layout& layout, Slice& slice);

/// Masses of sleepers and ballast; springs and dampers of all layers.
void add_track(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping);

/// The part of the layers that stands on the ground: stiffness and damping of the springs between it and the track.
/// Calls visit(unknown, spring, along_x) for each of them.
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

/// The masses of a sleeper's own unknowns: itself, its ballast.
std::vector<std::pair<int, double>> masses_of(const Sleeper& s, const Layout& layout);

/// What a sleeper on the bridge does to the beam: a spring and a damper from `unknown` above, and a mass that rides;
/// along x, at the running surface, a spring and a damper from `along` (-1: not modelled).
struct Ride {
  int unknown = 0;
  Spring spring;
  double mass = 0.0;
  int along = -1;
  Spring spring_along;
};
Ride ride_of(const Sleeper& s, const LayeredTrack& track, const Layout& layout);

}  // namespace traverse::beam
