// Spans that do not touch, by all the modes of their elements (lanes/span_crossing.hpp).
#pragma once

#include <vector>

#include "lanes/span_crossing.hpp"
#include "response/beam_operator.hpp"

namespace traverse::app {

/// The spans of a beam that one rank has whole, each of its own, in bending alone and with Rayleigh's damping: their
/// kinds and places. The method and what is stepped are left open.
lanes::SpanPlan spans_of(const beam::Beam& beam, const structure::BeamOperator& op);

/// The modes' coordinates of nodal deflections v: [span][SpanCrossing::stride_of()].
std::vector<double> modal_coordinates(const beam::Beam& beam, const structure::BeamOperator& op,
                                      const lanes::SpanPlan& plan, const double* v);

}  // namespace traverse::app
