// A scene gives the same results on one rank and on all: each rank also runs it on its own and compares with the
// file of the common run.
#pragma once

#include <cstddef>
#include <string>

#include "support/scene_run.hpp"

namespace traverse::test {

/// Every dataset of two runs, of which there are `least` at least, to `bound` of its peak; what is left of the energy
/// balance is rounding. Accelerations below `at_rest` (m/s2) are rounding, too.
void expect_same(Results& one, Results& all, std::size_t least, double at_rest = 0.0, double bound = 1e-9);
/// The same of a scene of options/scenes on all ranks and on this one.
void expect_same_on_all_ranks(const std::string& scene, const Values& options, std::size_t least, double bound = 1e-9);

}  // namespace traverse::test
