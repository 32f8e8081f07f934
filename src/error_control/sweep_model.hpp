// What all runs of a sweep are computed with: mesh, step and modes, as far as the scene leaves them open.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "error_control/model_choice.hpp"
#include "results/run_model.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// The scene of one run of a sweep, of its first train.
Scene at_speed(const Scene& sweep, double speed);

/// What all runs of a sweep are computed with, the same on every rank, in one of two ways: by trial runs of trains side
/// by side (batch_model.hpp), nothing where these cannot; else the finest mesh and step that the slowest, a middle and
/// the fastest run need, or modes of moving forces. What was chosen, and the errors to expect, go into `notes`.
/// InputError as the runs themselves would throw it.
std::optional<Choice> choose_side_by_side(const Scene& given, std::vector<std::string>& notes);
Choice choose_one_by_one(const Scene& given, std::vector<std::string>& notes);

/// As it is stored: of a complete scene.
results::RunModel stored_model(const Scene& scene, const Accuracy& accuracy);

}  // namespace traverse::app
