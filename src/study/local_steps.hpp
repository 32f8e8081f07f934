// The steps of the differences of a local sensitivity analysis.
#pragma once

#include "study/study_scenes.hpp"

namespace traverse::study {

/// Reduces the step of a local analysis for each factor whose runs are in one batch with the nominal point. Runs of a
/// batch have the same steps in distance, so that their results are smooth functions of the factor: differences over a
/// small step are derivatives to about six digits. Runs outside batches need the step of the design, because their own
/// steps, and so their errors, differ.
void reduce_local_steps(StudyScenes& scenes);

}  // namespace traverse::study
