// Finds input that is valid but probably not intended: values that are usual in another unit, trains that do not reach
// the bridge. The scene's reader finds further cases (scene/scene_plausibility.cpp).
#pragma once

#include <string>
#include <vector>

#include "scene_at_rest.hpp"
#include "static_response.hpp"

namespace traverse::check {

/// One line for each finding for the first run of a scene.
std::vector<std::string> unusual_in(const scene::Scene& given, const SceneAtRest& rest, const std::vector<Axle>& axles,
                                    const StaticResponse& response);

/// Not collective; the same on every rank. No findings if the first run has no state of rest, of which the run itself
/// gives the reason.
std::vector<std::string> unusual_in(const scene::Scene& given);

}  // namespace traverse::check
