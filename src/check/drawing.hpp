// A drawing of a scene to scale in characters: the bridge with its train from the side, or a mechanism.
#pragma once

#include <string>
#include <vector>

#include "canvas.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::check {

/// Lines of at most style.width columns; the last two are the legend and the scale.
std::vector<std::string> drawing_of(const scene::Scene& scene, const OutputStyle& style);

}  // namespace traverse::check
