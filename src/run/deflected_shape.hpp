// The bridge's shape at the instant of its largest deflection, as it is stored under /shape.
#pragma once

#include <vector>

#include "recovery/recovery.hpp"
#include "results/recorder.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// All that the deflection at any place follows from: this rank's nodal values and the loads on the bridge.
struct LargestDeflection {
  double time = 0.0;  // s
  std::vector<double> v, w, a;
  std::vector<beam::ElementLoad> loads;
};

/// Collective. The deflection at the nodes, at the probes and at points between them, with what loads inside an element
/// add: as the probes have it.
results::Shape shape_of(const beam::Beam& beam, const Scene& scene, const LargestDeflection& worst);

}  // namespace traverse::app
