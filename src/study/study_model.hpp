// Chooses the model of all runs of a study: mesh, step and modes, as far as the scene leaves them open.
#pragma once

#include <string>
#include <vector>

#include "error_control/sweep_model.hpp"
#include "study/study_scenes.hpp"

namespace traverse::study {

/// The finest model that the study's extreme scenes need, each computed as a sweep over all speeds of the study. The
/// result is the same on every rank.
error_control::Choice choose_for_study(const StudyScenes& scenes, std::vector<std::string>& notes);

}  // namespace traverse::study
