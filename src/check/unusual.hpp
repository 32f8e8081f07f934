// Finds input that is valid but probably not intended: values that are usual in another unit, trains that do not reach
// the bridge. The scene's reader finds further cases (scene/scene_plausibility.cpp).
#pragma once

#include <string>
#include <vector>

#include "first_run.hpp"
#include "static_response.hpp"

namespace traverse::app {

/// One line for each finding.
std::vector<std::string> unusual_in(const FirstRun& run, const std::vector<Axle>& axles,
                                    const StaticResponse& response);

}  // namespace traverse::app
