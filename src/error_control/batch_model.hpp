// Chooses mesh, method and step for the batched runs of a sweep of trains from the accuracy. A passage is one run of a
// train over the bridge.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "error_control/model_choice.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// Refines mesh and step of passages at slow, middle and fast speeds until the errors are within the accuracy, and
/// tries methods with fewer solves. Appends the choice, or the reason against it, to `notes`. The result is the same on
/// every rank.
std::optional<Choice> choose_batch_model(const scene::Scene& given, std::vector<std::string>& notes);

}  // namespace traverse::error_control
