// The span of 20 m that several frequency tests use.
#pragma once

#include <cmath>

#include "traverse/beam/model.hpp"

namespace traverse::test::one_span {

constexpr double EI = 1.96e9, EA = 1.0e10, m = 1000.0, L = 20.0;
const double unit = std::sqrt(EI / m) / (L * L);  // rad/s for beta L = 1

inline beam::BeamModel span(beam::Support left, beam::Support right, int elements, bool axial = false) {
  beam::BeamModel model;
  model.spans = {L};
  model.elements = {elements};
  model.supports = {left, right};
  model.EI = EI;
  model.EA = EA;
  model.mass = m;
  model.axial = axial;
  return model;
}

}  // namespace traverse::test::one_span
