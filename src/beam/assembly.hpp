// A rank's rows of the matrices of a line of elements, of its foundation and of a layered track.
#pragma once

#include "slice.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {

/// Adds mass and stiffness of a beam without foundation, eqs. 8-12.
void add_beam(const Line& line, const Slice& slice, Rows& mass, Rows& stiffness);

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
