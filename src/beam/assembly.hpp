// A rank's rows of the beam's and the foundation's matrices.
#pragma once

#include "slice.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {

/// Mass and stiffness of the beam itself, eqs. 8-12.
struct BeamRows {
  Rows mass, stiffness;
};
BeamRows beam_rows(const BeamModel& model, const Mesh& mesh, const Slice& slice);

enum class Term { stiffness, damping };

/// Eqs. 22-24 and 31-33 as matrices: the sum of {s} k {s}^T over the points, s the shape vector at the station.
Rows vertical_points(const BeamModel& model, const Mesh& mesh, const Slice& slice, Term term);
Rows longitudinal_points(const BeamModel& model, const Mesh& mesh, const Slice& slice, Term term);
/// Eq. 40, at any station: s holds the slopes of the shape functions. At a node it is that node's rotation alone.
Rows rotational_points(const BeamModel& model, const Mesh& mesh, const Slice& slice, Term term);
/// Eqs. 27, 29 and 36, 38.
Rows vertical_bed(const BeamModel& model, const Mesh& mesh, const Slice& slice, Term term);
Rows longitudinal_bed(const BeamModel& model, const Mesh& mesh, const Slice& slice, Term term);

}  // namespace traverse::beam
