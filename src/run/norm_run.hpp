// EN 1991-2's static effects and verdict of a scene: its trains as forces that pass, and the peaks of their runs.
#pragma once

#include <string>
#include <vector>

#include "coupling/quasi_static_response.hpp"
#include "norm/dynamic_verdict.hpp"
#include "run/response_extremes.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// The wheels of a train as they weigh at rest, and the forces that move with it.
norm::LoadModel train_at_rest(std::string name, const std::vector<coupling::StaticLoad>& weights);
/// Those of a scene, one for each train of its sweep. shared: of all ranks that call.
std::vector<norm::LoadModel> trains_at_rest(const Scene& scene, const SharedBeam& shared);

/// The same on every rank, each by itself.
norm::NormCheck norm_check(const Scene& scene, std::vector<norm::LoadModel> trains);
/// The peaks of one run that has ended.
norm::Passed passed_once(const Scene& scene, const ResponseExtremes& peaks);
/// Whether dynamic effects can be compared with load models: with LM71, and not where the bridge's own weight is in
/// them.
bool compares_with_lm71(const Scene& scene);

}  // namespace traverse::app
