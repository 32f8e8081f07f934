// Designs of experiments in the unit cube for sensitivity analyses. Each returns points [point][factor].
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace traverse::base {

/// The matrices A and B of Saltelli's design, from one Sobol' sequence of 2 * factors dimensions with a random shift,
/// and the matrices AB_i, which are A with column i of B: for each sample the rows A, AB_1, ..., AB_factors, B (A.
/// Saltelli et al., Computer Physics Communications 181 (2010) 259).
std::vector<double> saltelli_design(std::size_t samples, std::size_t factors, std::uint64_t seed);
inline std::size_t saltelli_block(std::size_t factors) { return factors + 2; }

/// Trajectories of factors + 1 points on the levels 0, 1/3, 2/3 and 1: each point differs from the one before in one
/// factor, by 2/3, and each factor changes once, in random order (M. D. Morris, Technometrics 33 (1991) 161).
std::vector<double> morris_design(std::size_t trajectories, std::size_t factors, std::uint64_t seed);
inline constexpr double morris_step = 2.0 / 3.0;
inline std::size_t morris_block(std::size_t factors) { return factors + 1; }

/// Steps relative to the nominal value of central differences: the nominal point, then for each factor + and - the
/// step. Runs of one batch have the same steps in distance, which permits a smaller step.
inline constexpr double local_step = 5e-3, batch_step = 3e-5;
inline constexpr std::size_t local_points_per_factor = 2;

}  // namespace traverse::base
