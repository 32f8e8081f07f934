// Stores the model for pictures and reports: /model of the results file.
#pragma once

#include <string>
#include <vector>

#include "results/recorder.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Stores the notes of the run.
void record_notes(const std::vector<std::string>& notes, results::Recorder& recorder);

/// Stores spans, supports, hinges, foundations, stiffness and mass, vehicles and forces at t = 0, and the notes of the
/// run.
void record_model(const scene::Scene& scene, const std::vector<std::string>& notes, results::Recorder& recorder);

/// Stores the modes that represent the bridge, or its first distinct frequencies, with their damping ratios: /modes.
void record_modes(const SharedBeam& shared, results::Recorder& recorder);

}  // namespace traverse::run
