// The numbering of the structure's unknowns, column by column along x, with the same number in each column, and arrays
// of their values for products with many nodes at a time.
//
// A column contains a node of the bridge, (u, v, theta), with a second rotation if the beam has hinges. If the beam
// twists, it contains the twist and its rate along x; without stiffness against warping, one rate on each side of the
// node, because a torque makes it jump. With a layered track it also contains a node of the rail, with a second
// rotation if the rail has joints and a second displacement along x if it has expansion devices, and the sleeper at the
// node. On the ground the ballast's mass uses the place of the bridge's deflection, unless it has a separate place
// because the ballast on the bridge is a separate mass too. A mass damper has a place in a column of its element or, at
// a node, in one beside it. Only neighbouring columns are coupled, for every model.
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
  twist,
  twist_rate,
  twist_rate_right,
  damper,
  kinds
};

/// The unknowns of a column and their places.
struct Layout {
  explicit Layout(const BeamModel& model);

  int block = 0;                   // unknowns per column
  std::array<int, kinds> place{};  // within a column; -1: not modelled
  std::array<Kind, kinds> kind{};  // for each place < block

  /// The place of the ballast's mass in a column.
  int ballast_place() const { return place[Kind::ballast] >= 0 ? place[Kind::ballast] : place[Kind::v]; }

  static bool axial(Kind k) { return k == rail_u || k == rail_u_right || k == Kind::u; }
  static bool rotation(Kind k) {
    return k == rail_theta || k == rail_theta_right || k == Kind::theta || k == Kind::theta_right || of_twist(k);
  }
  static bool of_twist(Kind k) { return k == Kind::twist || k == twist_rate || k == twist_rate_right; }
  /// Whether the unknown is a vertical displacement: also that of a damper.
  static bool is_vertical(Kind k) { return !axial(k) && !rotation(k); }
  /// Whether the unknown belongs to the bridge; on the ground the ballast may use its place.
  static bool of_bridge(Kind k) {
    return k == Kind::u || k == Kind::v || k == Kind::theta || k == Kind::theta_right || of_twist(k);
  }
};

/// Beam elements among the columns: the elements of the bridge, or the elements of the rail.
struct Line {
  Line(BeamModel model, const Layout& layout, bool rail, int first_column);

  BeamModel model;
  Mesh mesh;
  int first_column = 0;  // column of its first node
  int block = 0;
  int per_node = 2;  // unknowns per node of an element: (v, theta), or (u, v, theta)
  /// Index of u, v, theta, theta_right, u_right, twist, twist_rate, twist_rate_right in a column; -1: it does not
  /// exist.
  std::array<int, 8> place{};

  /// The elements with a node among `count` columns from the first: [first, past).
  std::pair<int, int> elements_at(int first, int count) const;
  /// Global unknowns v1, theta1, v2, theta2 of an element; u1, u2 (only with axial unknowns).
  std::array<int, 4> transverse(int element) const;
  std::array<int, 2> axial(int element) const;
  std::array<int, 4> twists(int element) const;  // twist1, rate1, twist2, rate2, only with torsion
  int tracks() const { return model.torsion ? static_cast<int>(model.torsion->tracks.size()) : 1; }
  /// The lever of an element's track, m: its distance to the left of the shear centre (Mesh::element).
  double eccentricity(int element) const { return action_line(element).lever; }
  /// The line of action that an element belongs to (Mesh::element).
  const ActionLine& action_line(int element) const {
    static constexpr ActionLine axis;
    return model.torsion ? model.torsion->tracks[static_cast<std::size_t>(element / mesh.elements())] : axis;
  }
  /// Whether a track is beside the shear centre, or there are several.
  bool has_tracks_beside() const { return model.torsion && model.torsion->tracks != std::vector<ActionLine>{{}}; }
  /// Calls use(k, unknown, factor): nodal value k of an element's track, in the order of unknowns(), is the sum of
  /// these unknowns times their factors: deflection and rotation of the beam, and its twist with the rate along x,
  /// times the lever; only the latter on a line of forces to the left.
  template <class Use>
  void for_unknowns(int element, Use use) const;
  /// The unknowns node by node: (v1, theta1, v2, theta2) or (u1, v1, theta1, u2, v2, theta2), 2*per_node in number.
  std::array<int, 6> unknowns(int element) const;
  /// Global unknown of a node, by the order of `place`; -1: does not exist.
  int unknown(int node, int component) const {
    return place[component] < 0 ? -1 : (first_column + node) * block + place[component];
  }
};

template <class Use>
void Line::for_unknowns(int element, Use use) const {
  if (!action_line(element).sideways) {
    const auto own = unknowns(element);
    for (int k = 0; k < 2 * per_node; ++k) use(k, own[static_cast<std::size_t>(k)], 1.0);
  }
  const double e = eccentricity(element);
  if (e == 0.0) return;
  const auto twist = twists(element);
  for (std::size_t k = 0; k < 4; ++k)
    use(static_cast<int>(k / 2) * per_node + per_node - 2 + static_cast<int>(k % 2), twist[k], e);
}

/// The arrays, by the unknown's index in a column.
using Planes = std::array<double*, kinds>;

/// Largest number of nodes of one call with planes.
inline constexpr int tile = 128;

/// Number of nodes that a product processes at a time. A call may read as many values behind its own ones; they are
/// arbitrary.
inline constexpr int nodes_per_chunk = 32;

}  // namespace traverse::beam
