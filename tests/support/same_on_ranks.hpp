// Checks that a scene has the same results on one rank and on all ranks: each rank also runs it alone and compares the
// results with the file of the common run.
#pragma once

#include <cstddef>
#include <string>

#include "support/scene_run.hpp"

namespace traverse::test {

/// Expects that every dataset of two runs is equal to `bound` of its peak, and that there are at least `least`
/// datasets. The residual of the energy balance is rounding. Accelerations below `at_rest` (m/s2) are rounding, too.
void expect_same(Results& one, Results& all, std::size_t least, double at_rest = 0.0, double bound = 1e-9);
/// expect_same() for a scene of options/scenes that is run on all ranks and on this rank alone.
void expect_same_on_all_ranks(const std::string& scene, const Values& options, std::size_t least, double bound = 1e-9);

}  // namespace traverse::test
