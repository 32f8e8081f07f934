// Modes instead of elements, where a sweep of moving forces cannot tell the difference.
#pragma once

#include <string>
#include <vector>

#include "traverse/app/accuracy.hpp"

namespace traverse::app {

/// The least number of modes that gives every peak as the scene's elements do, to a share of the accuracy, in some of
/// the sweep's runs, slow and fast ones; 0 where there is none, where that is not worth trying or the user has chosen.
/// What was found is said in `notes`.
int modes_that_do(const Scene& scene, const Accuracy& accuracy, std::vector<std::string>& notes);

}  // namespace traverse::app
