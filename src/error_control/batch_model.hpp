// How the runs of a sweep of trains go side by side: mesh, method and step, chosen from the accuracy.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "error_control/model_choice.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Where the scene leaves them open: tries meshes, steps and methods on the beginning of the passages at slow and at
/// fast speeds, each until a finer one changes the peaks by a part of the accuracy, and checks the choice on whole
/// passages. `notes` says what was chosen, or why not. The same on every rank.
std::optional<Choice> choose_batch_model(const Scene& given, std::vector<std::string>& notes);

}  // namespace traverse::app
