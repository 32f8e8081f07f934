// Decides which scenes can run in batches (engine/batch.hpp): linear vehicles over a bridge by its elements.
#pragma once

#include <string>

#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// The reason why a scene's runs cannot be batched, in words; empty: the scene itself does not prevent it.
std::string batch_obstacle(const Scene& scene, const SharedBeam& shared);

}  // namespace traverse::app
