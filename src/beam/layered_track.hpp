// Sleepers with their pads, ballast and sub-ballast: what joins the rail to the bridge and to the ground.
#pragma once

#include "slice.hpp"

namespace traverse::beam {

/// Where a sleeper stands.
struct Sleeper {
  double x = 0.0;
  int rail_node = 0;
  bool on_bridge = false;
  Station at;  // on the bridge
};

/// The sleepers whose rail node is among the columns [first, past), from left to right.
std::vector<Sleeper> sleepers_of(const Line& bridge, int first, int past);

/// Which of the unknowns of a sleeper's column exist: the sleeper itself, the ballast's mass on the ground.
void release_sleeper(const Sleeper& sleeper, const LayeredTrack& track, const Layout& layout, Slice& slice);

/// Masses of sleepers and ballast; springs and dampers of all layers.
void add_track(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping);

/// The part of the layers that stands on the ground: stiffness and damping of the springs between it and the track.
/// Calls visit(unknown, layer, along_x) for each of them.
template <class Visit>
void visit_ground_springs(const Sleeper& s, const LayeredTrack& track, const Layout& layout, Visit visit) {
  if (s.on_bridge) return;
  const int column = s.rail_node * layout.block;
  if (layout.place[rail_u] >= 0) visit(column + layout.place[rail_u], track.longitudinal, true);
  const bool sleeper_moves = track.ballast || track.subballast;
  const bool ballast_moves = track.ballast && track.subballast;
  const int lowest = layout.place[ballast_moves ? v : sleeper_moves ? sleeper : rail_v];
  visit(column + lowest, track.subballast ? *track.subballast : sleeper_moves ? *track.ballast : track.pad, false);
}

/// The masses of a sleeper's own unknowns: itself, the ballast on the ground.
std::vector<std::pair<int, double>> masses_of(const Sleeper& s, const LayeredTrack& track, const Layout& layout);

/// What a sleeper on the bridge does to the beam: a spring and a damper from `unknown` above, and a mass that rides;
/// along x, at the running surface, a spring and a damper from `along` (-1: not modelled).
struct Ride {
  int unknown = 0;
  Layer spring;
  double mass = 0.0;
  int along = -1;
};
Ride ride_of(const Sleeper& s, const LayeredTrack& track, const Layout& layout);

}  // namespace traverse::beam
