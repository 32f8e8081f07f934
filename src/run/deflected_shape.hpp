// The deflected shape of the bridge at the instant of its largest deflection, stored under /shape.
#pragma once

#include <vector>

#include "recovery/recovery.hpp"
#include "results/recorder.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// The data of the deflected shape: this rank's nodal values and the loads on the bridge.
struct LargestDeflection {
  double time = 0.0;  // s
  std::vector<double> v, w, a;
  std::vector<recovery::ElementLoad> loads;
  std::vector<double> ground;  // m: displacements of moving supports, at every span end; empty: none
};

/// Collective. The deflection relative to the line through the supports, at the nodes, at the probes and at points in
/// between, with the contribution of loads inside elements, as at probes.
results::Shape shape_of(const beam::Beam& beam, const scene::Scene& scene, const LargestDeflection& worst);

}  // namespace traverse::run
