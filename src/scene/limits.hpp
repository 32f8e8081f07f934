// The memory that a scene needs, estimated from counts before anything of it is allocated.
#pragma once

#include "traverse/options/options.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::scene {

inline constexpr double most_elements = 2e7;  // 32 bits can number the entries of their matrices

/// The memory of a run of the scene on this rank in addition to the program itself, in bytes.
double memory_of(const Scene& scene);

/// InputError if the scene needs more memory than this machine has, or more items than can be numbered, with the option
/// that contributes most.
void check_size(const options::Options& options, const Scene& scene);

}  // namespace traverse::scene
