// The summary of a run as attributes of the results file.
#pragma once

#include <vector>

#include "results/recorder.hpp"

namespace traverse::results {

/// Omits quantities that are unknown or do not exist in the scene.
std::vector<Attribute> attributes_of(const Summary& summary);

}  // namespace traverse::results
