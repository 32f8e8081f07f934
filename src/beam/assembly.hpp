// A rank's rows of the matrices of a line of elements, of its foundation and of a layered track.
#pragma once

#include "slice.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {

/// Mass and stiffness of a beam itself, eqs. 8-12.
void add_beam(const Line& line, const Slice& slice, Rows& mass, Rows& stiffness);

/// An element of a line, and where in it: for a point of the foundation.
Station station_of(const Mesh& mesh, const PointFoundation& point);

enum class Term { stiffness, damping };

/// Eqs. 22-24 and 31-33 as matrices: the sum of {s} k {s}^T over the points, s the shape vector at the station.
Rows vertical_points(const Line& line, const Slice& slice, Term term);
Rows longitudinal_points(const Line& line, const Slice& slice, Term term);
/// Eq. 40, at any station: s holds the slopes of the shape functions. At a node it is that node's rotation alone.
Rows rotational_points(const Line& line, const Slice& slice, Term term);
/// Eqs. 27, 29 and 36, 38.
Rows vertical_bed(const Line& line, const Slice& slice, Term term);
Rows longitudinal_bed(const Line& line, const Slice& slice, Term term);

}  // namespace traverse::beam
