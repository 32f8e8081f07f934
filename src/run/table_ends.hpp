// Tables over time that end before the run, or begin after its start.
#pragma once

#include <string>
#include <vector>

#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Appends a note for each table that ends before a run until `end` (s) while its values still change. InputError, with
/// the option, for a displacement of supports or drivers that would start or stop at once, which needs an infinite
/// force.
void check_table_ends(const scene::Scene& scene, double end, std::vector<std::string>& notes);

}  // namespace traverse::run
