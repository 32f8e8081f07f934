// A rank's rows of the matrices of a line of elements, of its foundation and of a layered track.
#pragma once

#include "slice.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {

/// Mass and stiffness of a beam itself, eqs. 8-12.
void add_beam(const Line& line, const Slice& slice, Rows& mass, Rows& stiffness);

/// The springs of cracks, each between the rotations of its node: into K*, no part of what is damped by b K.
void add_cracks(const Line& line, const Slice& slice, Rows& stiffness);

/// An element of a line, and where in it: for a point of the foundation.
Station station_of(const Mesh& mesh, const PointFoundation& point);

enum class Term { stiffness, damping };

/// Eqs. 22-24, 31-33 and 40 as matrices: the sum of {s} k {s}^T over the points, s the shape vector at the station. Of
/// a rotational kind s holds the slopes of the shape functions: at a node it is that node's rotation alone.
Rows points_of(const FoundationKind& kind, const Line& line, const Slice& slice, Term term);
/// Eqs. 27, 29 and 36, 38; there is a bed.
Rows bed_of(const FoundationKind& kind, const Line& line, const Slice& slice, Term term);

}  // namespace traverse::beam
