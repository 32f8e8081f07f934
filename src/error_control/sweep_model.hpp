// Chooses the model of all runs of a sweep: mesh, step and modes, as far as the scene leaves them open.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "error_control/model_choice.hpp"
#include "results/study_table.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// The scene of one run of a sweep, with its first train.
scene::Scene at_speed(const scene::Scene& sweep, double speed);

/// Choose the model of all runs of a sweep; the result is the same on every rank. choose_batched uses batched trial
/// runs of trains (batch_model.hpp); it returns nothing if these are not possible. choose_unbatched combines the finest
/// mesh and step of the slowest, a middle and the fastest run, or chooses modes for moving forces. The choice and the
/// estimated errors are appended to `notes`. InputError as from the runs themselves.
std::optional<Choice> choose_batched(const scene::Scene& given, std::vector<std::string>& notes);
Choice choose_unbatched(const scene::Scene& given, std::vector<std::string>& notes);

/// The model for the results file, of a complete scene.
results::RunModel stored_model(const scene::Scene& scene, const Accuracy& accuracy);

}  // namespace traverse::error_control
