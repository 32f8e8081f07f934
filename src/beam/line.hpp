// How the structure's unknowns are numbered: column by column along x, the same number in each.
//
// A column holds a node of the bridge, (u, v, theta) with a second rotation where the beam has hinges. Under a layered
// track it also holds a node of the rail, with a second rotation where the rail has joints and a second displacement
// along x where it has expansion devices, and the sleeper that stands there; on the ground the ballast's mass takes the
// place of the bridge's deflection, unless it has one of its own because ballast moves by itself on the bridge too.
// Neighbouring columns alone couple, whatever is modelled.
#pragma once

#include <array>
#include <utility>

#include "beam/mesh.hpp"

namespace traverse::beam {

enum Kind {
  rail_u,
  rail_u_right,
  rail_v,
  rail_theta,
  rail_theta_right,
  sleeper,
  ballast,
  u,
  v,
  theta,
  theta_right,
  kinds
};

/// Which unknowns a column has, and where.
struct Layout {
  explicit Layout(const BeamModel& model);

  int block = 0;                   // unknowns a column
  std::array<int, kinds> place{};  // within a column; -1: not modelled
  std::array<Kind, kinds> kind{};  // of each place < block

  /// Where the ballast's mass has its place in a column.
  int ballast_place() const { return place[Kind::ballast] >= 0 ? place[Kind::ballast] : place[Kind::v]; }

  static bool axial(Kind k) { return k == rail_u || k == rail_u_right || k == Kind::u; }
  static bool rotation(Kind k) {
    return k == rail_theta || k == rail_theta_right || k == Kind::theta || k == Kind::theta_right;
  }
  /// Whether it moves vertically.
  static bool falls(Kind k) { return !axial(k) && !rotation(k); }
  /// Whether it belongs to the bridge, or on the ground may stand in the place of what does.
  static bool of_bridge(Kind k) { return k == Kind::u || k == Kind::v || k == Kind::theta || k == Kind::theta_right; }
};

/// A run of beam elements among the columns: the bridge, or the rail on its sleepers.
struct Line {
  Line(BeamModel model, const Layout& layout, bool rail, int first_column);

  BeamModel model;
  Mesh mesh;
  int first_column = 0;  // of its first node
  int block = 0;
  int per_node = 2;            // unknowns of a node that an element sees: (v, theta), or (u, v, theta)
  std::array<int, 5> place{};  // of u, v, theta, theta_right, u_right in a column; -1: not there

  /// The elements that have a node among `count` columns from the first: [first, past).
  std::pair<int, int> elements_at(int first, int count) const;
  /// Global unknowns v1, theta1, v2, theta2 of an element; u1, u2 (only where axial).
  std::array<int, 4> transverse(int element) const;
  std::array<int, 2> axial(int element) const;
  /// Node by node: (v1, theta1, v2, theta2) or (u1, v1, theta1, u2, v2, theta2); 2*per_node of them.
  std::array<int, 6> unknowns(int element) const;
  /// Global unknown of a node: 0 u, 1 v, 2 theta, 3 theta_right, 4 u_right; -1: not there.
  int unknown(int node, int which) const {
    return place[which] < 0 ? -1 : (first_column + node) * block + place[which];
  }
};

}  // namespace traverse::beam
