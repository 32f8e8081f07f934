// Relations between options: what an option needs, excludes, or has no effect without. They are checked before a scene
// is read.
#pragma once

#include <string>
#include <vector>

#include "traverse/options/options.hpp"

namespace traverse::options {

/// The options that the relations are of; those of all but the first two have names that begin with a block's.
enum class Related { scene, study, course, load, part, springs, bed, damper, measurement };

/// Throws InputError for a relation that is not kept. block: the begin of the names, such as "train_" or
/// "vehicle_car_wheel_". Returns a note on each option without effect.
std::vector<std::string> check_relations(const Options& options, Related related, const std::string& block = "");

}  // namespace traverse::options
