// Parts of a vehicle that are repeated along a line, such as the steps of an escalator or the links of a chain. Part
// PART of the list vehicle_NAME_repeat_parts stands for PART0, PART1, ..., each displaced by repeat_pitch from the one
// before. In its references to bodies, a repeated BODY is the body with its own number, BODY+1 the next one and BODY-1
// the one before; a part that would refer to a body beyond the ends is left out.
#pragma once

#include <string>
#include <vector>

#include "traverse/options/options.hpp"

namespace traverse::scene {

/// Adds the options of all repetitions as defaults, so that options given for one of them are kept, and makes the
/// options of the repeated parts known. `prefix` is "vehicle_NAME_". Throws InputError with the name of the option.
void add_repeated_parts(options::Options& options, const std::string& prefix);

/// The names of all parts of this kind, in the order of their list.
std::vector<std::string> part_names(const options::Options& options, const std::string& prefix, options::Part part);

}  // namespace traverse::scene
