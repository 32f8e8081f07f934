// Compares frequencies on three meshes with exact frequencies, and computes the order of convergence.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "modes/modes.hpp"
#include "support/exact_model.hpp"

namespace traverse::test {

inline std::vector<double> frequencies(const beam::BeamModel& model, int count) {
  return modes::natural_modes(beam::Beam(PETSC_COMM_SELF, model), count, false).omega;
}

/// The frequencies of motion along x only.
inline std::vector<double> axial_frequencies(const beam::BeamModel& model, int count) {
  const auto found = modes::natural_modes(beam::Beam(PETSC_COMM_SELF, model), 1 << 20, false);
  std::vector<double> omega;
  for (std::size_t i = 0; i < found.omega.size() && static_cast<int>(omega.size()) < count; ++i) {
    if (found.motion[i] == modes::Motion::along) omega.push_back(found.omega[i]);
  }
  return omega;
}

/// Bounds of the order of convergence from the first to the second mesh, of the error of the limit (both meshes
/// extrapolated to h = 0), and of the error on the third mesh (`error`).
struct Bounds {
  double order = 4.0, scatter = 0.1, error = 1e-6, limit = 5e-7;
};

/// Compares the elastic frequencies on n, 2 n and 4 n elements per span with the exact frequencies. The frequencies of
/// rigid modes must be exactly zero. Rounding errors, 0.02 eps n^4 and 16 times as much if beta L is pi/2 instead of
/// pi, hide the order on many elements, so that it is computed from the two coarser meshes.
template <class Model>
void expect_convergence(const std::vector<double>& exact, const Model& model, int n, int rigid,
                        const Bounds& bounds = {}, exact::Motion motion = exact::Motion::bending) {
  const int count = static_cast<int>(exact.size());
  const auto on = [&](int elements) {
    return motion == exact::Motion::bending ? frequencies(model(elements), count)
                                            : axial_frequencies(model(elements), count);
  };
  const auto coarse = on(n), fine = on(2 * n), finest = on(4 * n);
  ASSERT_EQ(fine.size(), exact.size());
  for (int i = 0; i < rigid; ++i) {
    EXPECT_EQ(finest[i], 0.0) << "rigid mode " << i + 1;
    EXPECT_LT(exact[i], 1e-6 * exact[rigid]) << "rigid mode " << i + 1;
  }
  double worst = 0.0, lowest_order = 99.0;
  const double power = std::pow(2.0, bounds.order);
  for (int i = rigid; i < count; ++i) {
    const double e1 = coarse[i] / exact[i] - 1.0, e2 = fine[i] / exact[i] - 1.0, e3 = finest[i] / exact[i] - 1.0;
    const std::string mode =
        "elastic mode " + std::to_string(i - rigid + 1) + ", " + std::to_string(exact[i]) + " rad/s";
    EXPECT_NEAR(std::log2(e1 / e2), bounds.order, bounds.scatter) << mode;
    EXPECT_GT(e2, 0.0) << "a conforming mesh is too stiff, " << mode;
    EXPECT_LT(std::abs(e3), bounds.error) << mode;
    EXPECT_LT(std::abs(power * e2 - e1) / (power - 1.0), bounds.limit) << mode;
    worst = std::max(worst, std::abs(e3));
    lowest_order = std::min(lowest_order, std::log2(e1 / e2));
  }
  testing::Test::RecordProperty("error", std::to_string(worst * 1e6) + "e-6");
  testing::Test::RecordProperty("order", std::to_string(lowest_order));
}

/// Like the check above, with the reference from the exact dynamic stiffness.
template <class Model>
void expect_exact(const Model& model, int rigid, int elastic, const Bounds& bounds = {},
                  exact::Motion motion = exact::Motion::bending, int n = 16) {
  const auto reference = exact::frequencies(exact::chain_of(model(1), motion).chain, rigid + elastic);
  expect_convergence(reference, model, n, rigid, bounds, motion);
}

}  // namespace traverse::test
