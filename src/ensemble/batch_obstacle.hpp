// Which scenes run side by side (engine/batch.hpp): linear vehicles over a bridge by its elements.
#pragma once

#include <string>

#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Why a scene's runs cannot go side by side, in words; empty: as far as the scene itself tells, they can.
std::string batch_obstacle(const Scene& scene, const SharedBeam& shared);

}  // namespace traverse::app
