// What a scene needs of the machine, by counting, before anything of it is made.
#pragma once

#include "traverse/options/options.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

inline constexpr double most_elements = 2e7;  // whose matrices' entries 32 bits can number

/// What a run of the scene takes of memory on this rank, besides the program itself, bytes.
double memory_of(const Scene& scene);

/// InputError where the scene needs more memory than this machine has, or counts go beyond what can be numbered: names
/// the option that asks for most.
void check_size(const options::Options& options, const Scene& scene);

}  // namespace traverse::app
