// What all runs of a sweep are computed with: mesh, step and modes, as far as the scene leaves them open.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/choice.hpp"
#include "results/sweep.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// The scene of one run of a sweep, of its first train.
Scene at_speed(const Scene& sweep, double speed);

/// What all runs of a sweep are computed with; the same on every rank. What was chosen, and the errors to expect, go
/// into `notes`. InputError as the runs themselves would throw it.
Choice choose_for_sweep(const Scene& given, std::vector<std::string>& notes);
/// The two ways that it tries: by trial runs of trains side by side (lanes_choice.hpp), nothing where these cannot;
/// else the finest mesh and step that the slowest, a middle and the fastest run need, or modes of moving forces.
std::optional<Choice> choose_side_by_side(const Scene& given, std::vector<std::string>& notes);
Choice choose_one_by_one(const Scene& given, std::vector<std::string>& notes);

/// As it is stored: of a complete scene.
results::Sweep::Model stored_model(const Scene& scene, const Accuracy& accuracy);

}  // namespace traverse::app
