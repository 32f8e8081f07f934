// A plain beam to test with: pinned at its left end, on rollers elsewhere.
#pragma once

#include <utility>
#include <vector>

#include "traverse/beam/model.hpp"

namespace traverse::test {

inline beam::BeamModel model_of(std::vector<double> spans, int elements, bool axial = true) {
  beam::BeamModel m;
  m.elements.assign(spans.size(), elements);
  m.supports.assign(spans.size() + 1, beam::Support::roller);
  m.supports[0] = beam::Support::pinned;
  m.spans = std::move(spans);
  m.EI = 2e9;
  m.EA = 1e10;
  m.mass = 2000.0;
  m.axial = axial;
  return m;
}

}  // namespace traverse::test
