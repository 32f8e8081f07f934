// The summary of a run as attributes of the results file.
#pragma once

#include <vector>

#include "results/recorder.hpp"

namespace traverse::results {

/// What is not known, or what the scene has not, is left out.
std::vector<Attribute> attributes_of(const Summary& summary);

}  // namespace traverse::results
