// What a scene may hold without an error and is hardly meant: figures that look like those of another unit, trains that
// never meet the bridge. The scene's reader finds more of these (scene/scene_sense.cpp).
#pragma once

#include <string>
#include <vector>

#include "look.hpp"
#include "rest.hpp"

namespace traverse::app {

/// One line each.
std::vector<std::string> unusual_in(const Look& look, const std::vector<Axle>& axles, const Rest& rest);

}  // namespace traverse::app
