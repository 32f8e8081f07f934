// A rank's rows of the matrices of a line of elements, of its foundation and of a layered track, and the displacement
// that a foundation resists at a station. Only this file distinguishes the directions of foundations.
#pragma once

#include <array>

#include "beam/element.hpp"
#include "beam/line.hpp"
#include "slice.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {

/// The unknowns of an element for a direction: four, or two for the longitudinal direction (-1: none).
std::array<int, 4> unknowns_of(const Line& line, Direction direction, int element);
/// The displacement, or the rotation of the sections, at xi of an element as the sum of shape*unknown.
std::array<double, 4> shape_of(Direction direction, double xi, const Element& element);

/// Unknowns and shapes at a station.
struct PointShape {
  std::array<int, 8> unknown{-1, -1, -1, -1, -1, -1, -1, -1};  // global
  std::array<double, 8> shape{};
};
PointShape shape_at(const Line& line, Direction direction, const Station& at);
/// Unknowns and shapes at a point of the foundation. At a depth below the axis of a span end the displacement along x
/// is u + depth*theta; at an eccentricity the deflection is v + eccentricity*twist.
PointShape shape_at(const Line& line, Direction direction, const Station& at, double depth, double eccentricity);

/// Integral of density(x) s s^T over the element, s the shape of a direction: the matrix of a bed (eqs. 27, 29, 36,
/// 38).
Transverse bed_matrix(Direction direction, const Distribution& density, const Element& element);
/// Integral of density(x) s: the coefficients of the unknowns in the resultant of a bed.
std::array<double, 4> bed_form(Direction direction, const Distribution& density, const Element& element);

/// Adds mass and stiffness of a beam without foundation, eqs. 8-12, with its point masses.
void add_beam(const Line& line, const Slice& slice, Rows& mass, Rows& stiffness);

/// A mass damper among the unknowns: its own, and those of the beam with their shapes.
struct DamperPlace {
  const MassDamper* damper = nullptr;
  PointShape beam;
  int unknown = 0;  // global
};
/// The dampers of the line's model, in their order. InputError if too many are at one place.
std::vector<DamperPlace> places_of_dampers(const Line& line, const Layout& layout);

/// Adds the masses, springs and dashpots of the dampers.
void add_dampers(const std::vector<DamperPlace>& dampers, Rows& mass, Rows& stiffness, Rows& damping);

/// Adds the springs of cracks, each between the two rotations of its node, to K*; the damping b K does not include
/// them.
void add_cracks(const Line& line, const Slice& slice, Rows& stiffness);

/// The element of a foundation point and the position in the element.
Station station_of(const Mesh& mesh, const PointFoundation& point);

enum class Term { stiffness, damping };

/// Eqs. 22-24, 31-33 and 40 as matrices: the sum of {s} k {s}^T over the points, with the shape vector s at the
/// station. For a rotational kind s contains the slopes of the shape functions; at a node it is the node's rotation
/// alone.
Rows points_of(const FoundationKind& kind, const Line& line, const Slice& slice, Term term);
/// Eqs. 27, 29 and 36, 38; the kind must have a bed.
Rows bed_of(const FoundationKind& kind, const Line& line, const Slice& slice, Term term);

}  // namespace traverse::beam
