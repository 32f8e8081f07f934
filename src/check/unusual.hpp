// Finds input that is valid but probably not intended: values that are usual in another unit, trains that do not reach
// the bridge. The scene's reader finds further cases (scene/scene_sense.cpp).
#pragma once

#include <string>
#include <vector>

#include "look.hpp"
#include "rest.hpp"

namespace traverse::app {

/// One line for each finding.
std::vector<std::string> unusual_in(const FirstRun& run, const std::vector<Axle>& axles,
                                    const StaticResponse& response);

}  // namespace traverse::app
