// Static effects and verdict of EN 1991-2 for a scene: its trains as moving forces, and the peaks of their runs.
#pragma once

#include <string>
#include <vector>

#include "coupling/quasi_static_response.hpp"
#include "norm/dynamic_verdict.hpp"
#include "run/response_extremes.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// The static wheel loads of a train and the forces that move with it.
norm::LoadModel static_train(std::string name, const std::vector<coupling::StaticLoad>& weights);
/// The trains of a scene, one for each train of its sweep. shared: the beam that all calling ranks share.
std::vector<norm::LoadModel> static_trains(const scene::Scene& scene, const SharedBeam& shared);

/// Not collective; the result is the same on every rank.
norm::NormCheck norm_check(const scene::Scene& scene, std::vector<norm::LoadModel> trains);
/// The peaks of one run after its end.
norm::ComputedPeaks peaks_of_run(const scene::Scene& scene, const ResponseExtremes& peaks);
/// Whether dynamic effects can be compared with load models: LM71 is selected, and the results do not contain the
/// bridge's own weight.
bool compares_with_lm71(const scene::Scene& scene);

}  // namespace traverse::run
