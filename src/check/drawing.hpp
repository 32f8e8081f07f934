// A scene drawn to scale in characters: the bridge from the side with its train, or a mechanism by itself.
#pragma once

#include <string>
#include <vector>

#include "canvas.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Lines of at most looks.width columns; the last two are the legend and the scale.
std::vector<std::string> drawing_of(const Scene& scene, const Looks& sampling_interval);

}  // namespace traverse::app
