// Natural frequencies of uniform spans against closed-form values, with repeated, crowded and rigid-body modes, and
// Rayleigh coefficients against equation 20 of the paper.
#include "modes/modes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace traverse {
namespace {

using beam::Beam;
using beam::BeamModel;
using beam::Support;
using std::numbers::pi;

BeamModel model_of(std::vector<double> spans, int elements, bool isolated, bool axial = false) {
  BeamModel m;
  m.elements.assign(spans.size(), elements);
  m.supports.assign(spans.size() + 1, isolated ? Support::pinned : Support::roller);
  m.supports[0] = Support::pinned;
  m.spans = std::move(spans);
  m.EI = 2e9;
  m.EA = 1e10;
  m.mass = 2000.0;
  if (isolated) m.joints = {beam::Joint::separate};
  m.axial = axial;
  return m;
}

/// The first two distinct frequencies.
std::pair<double, double> distinct_pair(const Beam& beam) { return modes::first_two(modes::distinct_modes(beam, 2)); }

double simple_span(double L, int n = 1) { return std::pow(n * pi / L, 2) * std::sqrt(2e9 / 2000.0); }

TEST(Modes, EqualIsolatedSpansRepeatEveryFrequency) {
  const Beam b(PETSC_COMM_WORLD, model_of({20, 20, 20}, 8, true));
  const auto found = modes::natural_modes(b, 7, true);
  ASSERT_EQ(found.omega.size(), 7u);
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(found.omega[i] / simple_span(20, 1 + i / 3), 1.0, 2e-3);
  EXPECT_EQ(found.omega[0], found.omega[2]);
  for (int copy = 0; copy < 3; ++copy) {  // one span moves, the others rest
    for (int node = 0; node < 27; ++node) {
      const double x = node % 9 / 8.0;
      const double v = node / 9 == copy ? std::sin(pi * x) : 0.0;
      EXPECT_NEAR(std::abs(found.shape[copy][node]), v, 1e-4);
    }
  }
}

TEST(Modes, DistinctPairOfManyEqualSpans) {
  const Beam b(PETSC_COMM_WORLD, model_of(std::vector<double>(1000, 32.0), 6, true, true));
  const auto [first, second] = distinct_pair(b);
  EXPECT_NEAR(first / simple_span(32), 1.0, 1e-4);
  EXPECT_NEAR(second / simple_span(32, 2), 1.0, 1e-3);
}

TEST(Modes, DistinctPairSkipsRigidModesAndCopies) {
  auto free = model_of({20.0}, 12, false);
  free.supports = {Support::free, Support::free};
  const auto [first, second] = distinct_pair(Beam(PETSC_COMM_WORLD, free));
  EXPECT_NEAR(first / simple_span(20) / std::pow(4.730040744862704 / pi, 2), 1.0, 1e-4);
  EXPECT_NEAR(second / simple_span(20) / std::pow(7.853204624095838 / pi, 2), 1.0, 1e-3);

  // Two kinds of span, two of each.
  const auto pair = distinct_pair(Beam(PETSC_COMM_WORLD, model_of({20, 25, 20, 25}, 8, true)));
  EXPECT_NEAR(pair.first / simple_span(25), 1.0, 1e-3);
  EXPECT_NEAR(pair.second / simple_span(20), 1.0, 1e-3);
}

// Spans of one drawing are one kind of span, however they are measured: their frequencies are no pair of eq. 20.
TEST(Modes, DistinctPairTakesSpansAlikeUpToTheirToleranceForOne) {
  const auto alike = distinct_pair(Beam(PETSC_COMM_WORLD, model_of({20, 20.002}, 8, true)));
  EXPECT_NEAR(alike.first / simple_span(20.002), 1.0, 1e-4);
  EXPECT_NEAR(alike.second / simple_span(20.002, 2), 1.0, 1e-3);
  const auto others = distinct_pair(Beam(PETSC_COMM_WORLD, model_of({20, 20.4}, 8, true)));
  EXPECT_NEAR(others.second / simple_span(20), 1.0, 1e-4);
  // The neighbouring modes of one continuous beam are two, however close.
  const auto chain = distinct_pair(Beam(PETSC_COMM_WORLD, model_of(std::vector<double>(100, 32.0), 4, false)));
  EXPECT_LT(chain.second, 1.001 * chain.first);
}

TEST(Modes, DistinctPairDoesNotDependOnAxialUnknowns) {
  const auto with = distinct_pair(Beam(PETSC_COMM_WORLD, model_of({200, 200, 200}, 10, false, true)));
  const auto without = distinct_pair(Beam(PETSC_COMM_WORLD, model_of({200, 200, 200}, 10, false, false)));
  EXPECT_NEAR(with.first / without.first, 1.0, 1e-12);
  EXPECT_NEAR(with.second / without.second, 1.0, 1e-12);
}

TEST(Modes, DistinctPairNeedsTwoFrequencies) {
  auto m = model_of({20.0}, 1, false);
  m.supports = {Support::clamped, Support::roller};  // one free unknown
  EXPECT_THROW(distinct_pair(Beam(PETSC_COMM_WORLD, m)), InputError);
  m.supports = {Support::clamped, Support::clamped};
  EXPECT_THROW(distinct_pair(Beam(PETSC_COMM_WORLD, m)), InputError);
  EXPECT_TRUE(modes::natural_modes(Beam(PETSC_COMM_WORLD, m), 3, true).omega.empty());
}

TEST(Modes, LongContinuousBridge) {
  // Frequencies of N equal continuous spans crowd above the simple span's, 3e-6 apart for 1,000 spans.
  const Beam b(PETSC_COMM_WORLD, model_of(std::vector<double>(1000, 32.0), 6, false));
  const auto found = modes::natural_modes(b, 4, false);
  EXPECT_NEAR(found.omega[0] / simple_span(32), 1.0, 1e-4);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(found.omega[i + 1], found.omega[i]);
    EXPECT_NEAR(found.omega[i + 1] / found.omega[i], 1.0, 5e-5);
  }
}

TEST(Modes, CrowdedFrequenciesAreAllFound) {
  // 30 equal spans and an overhang: one lonely frequency, then 30 within a few per cent, and so on. All of them at once
  // (dense) against the first 75 (hunted a few at a time).
  auto m = model_of(std::vector<double>(31, 32.0), 4, false);
  m.supports.back() = Support::free;
  const Beam b(PETSC_COMM_WORLD, m);
  const auto all = modes::natural_modes(b, 1000, false), some = modes::natural_modes(b, 75, false);
  ASSERT_EQ(some.omega.size(), 75u);
  for (std::size_t i = 0; i < 75; ++i) EXPECT_NEAR(some.omega[i] / all.omega[i], 1.0, 1e-9) << i;
}

TEST(Modes, ClampedInnerSupportSeparatesEqualSpans) {
  auto m = model_of({20, 20, 20}, 8, false);
  m.supports = {Support::clamped, Support::clamped, Support::clamped, Support::clamped};
  const auto found = modes::natural_modes(Beam(PETSC_COMM_WORLD, m), 6, false);
  EXPECT_EQ(found.omega[0], found.omega[2]);
  EXPECT_EQ(found.omega[3], found.omega[5]);
  EXPECT_NEAR(found.omega[0] / simple_span(20) / std::pow(4.730040744862704 / pi, 2), 1.0, 1e-3);
}

TEST(Modes, AllModesOfASmallAndOfALargerMesh) {
  for (int elements : {1, 2, 5, 40}) {
    const Beam b(PETSC_COMM_WORLD, model_of({20.0, 25.0}, elements, false, true));
    const auto found = modes::natural_modes(b, 1000, true);
    EXPECT_EQ(found.omega.size(), static_cast<std::size_t>(3 * (2 * elements + 1) - 4));
    EXPECT_TRUE(std::is_sorted(found.omega.begin(), found.omega.end()));
    EXPECT_GT(found.omega[0], 0.0);
    // The few lowest alone are the same.
    const auto few = modes::natural_modes(b, 3, false);
    for (std::size_t i = 0; i < few.omega.size(); ++i) EXPECT_NEAR(few.omega[i] / found.omega[i], 1.0, 1e-8);
  }
}

TEST(Modes, FreeBeamOfManyElementsAllModes) {
  auto m = model_of({20.0}, 30, false);
  m.supports = {Support::free, Support::free};
  const auto found = modes::natural_modes(Beam(PETSC_COMM_WORLD, m), 62, true);
  ASSERT_EQ(found.omega.size(), 62u);
  EXPECT_EQ(found.omega[1], 0.0);
  EXPECT_NEAR(found.omega[2] / simple_span(20) / std::pow(4.730040744862704 / pi, 2), 1.0, 1e-5);
  EXPECT_EQ(found.shape[0].front(), 1.0);
  EXPECT_NEAR(std::abs(found.shape[1].front()), 1.0, 1e-12);
  EXPECT_NEAR(found.shape[1].front() + found.shape[1].back(), 0.0, 1e-12);
}

TEST(Modes, FreeRailOnABed) {
  // The lowest frequencies lie within 1e-9 of each other, the pair has to be distinct.
  auto m = model_of({300.0}, 1000, false);
  m.supports = {Support::free, Support::free};
  m.EI = 1.32476e7;
  m.mass = 121.28;
  m.foundation.vertical_bed = beam::Bed{6.5e7 / 0.6, 0.0};
  const auto [first, second] = distinct_pair(Beam(PETSC_COMM_WORLD, m));
  EXPECT_NEAR(first / std::sqrt(6.5e7 / 0.6 / 121.28), 1.0, 1e-8);
  EXPECT_GT(second, first * (1 + 1e-6));
  EXPECT_LT(second, first * (1 + 2e-5));
}

TEST(Modes, SameBitsEveryTime) {
  const Beam b(PETSC_COMM_WORLD, model_of({20, 25, 30}, 20, false, true));
  const auto one = modes::natural_modes(b, 10, true), two = modes::natural_modes(b, 10, true);
  EXPECT_EQ(one.omega, two.omega);
  EXPECT_EQ(one.shape, two.shape);
}

TEST(Rayleigh, GivesTheRatiosBack) {
  const double w1 = 20.0, w2 = 71.0;
  const auto [a, b] = modes::rayleigh({w1}, {w2}, 0.02, 0.05);
  EXPECT_NEAR(a / (2 * w1) + b * w1 / 2, 0.02, 1e-15);
  EXPECT_NEAR(a / (2 * w2) + b * w2 / 2, 0.05, 1e-15);
  // As the paper prints it.
  EXPECT_NEAR(a, 2 * w1 * w2 * (0.02 * w2 - 0.05 * w1) / (w2 * w2 - w1 * w1), 1e-14);
  EXPECT_NEAR(b, 2 * (0.05 * w2 - 0.02 * w1) / (w2 * w2 - w1 * w1), 1e-16);
}

// a and b are not negative where zeta2/zeta1 is between omega1/omega2 and omega2/omega1, and zero at these.
TEST(Rayleigh, NeverFeedsEnergy) {
  const double w1 = 20.0, w2 = 80.0;
  EXPECT_EQ(modes::rayleigh({w1}, {w2}, 0.05, 0.0125).b, 0.0);
  EXPECT_DOUBLE_EQ(modes::rayleigh({w1}, {w2}, 0.05, 0.0125).a, 2 * 0.05 * w1);
  EXPECT_EQ(modes::rayleigh({w1}, {w2}, 0.01, 0.04).a, 0.0);
  EXPECT_DOUBLE_EQ(modes::rayleigh({w2}, {w1}, 0.04, 0.01).b, 2 * 0.01 / w1);
  for (const auto& [zeta1, zeta2] : {std::pair(0.05, 0.012), {0.05, 0.21}, {0.05, 0.0}, {0.0, 0.05}}) {
    EXPECT_THROW(modes::rayleigh({w1}, {w2}, zeta1, zeta2), InputError) << zeta1 << " " << zeta2;
    EXPECT_THROW(modes::rayleigh({w2}, {w1}, zeta2, zeta1), InputError) << zeta1 << " " << zeta2;
  }
  EXPECT_EQ(modes::rayleigh({w1}, {w2}, 0.0, 0.0).b, 0.0);
}

TEST(Rayleigh, EqualRatiosAtNeighbouringFrequencies) {
  const double w1 = 20.0, w2 = 20.0 * (1 + 2e-6);
  const auto [a, b] = modes::rayleigh({w1}, {w2}, 0.02, 0.02);
  EXPECT_DOUBLE_EQ(a, 2 * 0.02 * w1 * w2 / (w1 + w2));
  EXPECT_DOUBLE_EQ(b, 2 * 0.02 / (w1 + w2));
}

// A bed adds k/m to the square of every frequency, which is no part of the beam's own stiffness.
TEST(Rayleigh, TermsOfModesOnABed) {
  auto m = model_of({20.0}, 16, false);
  m.foundation.vertical_bed = beam::Bed{4e5, 1e3};
  const auto found = modes::distinct_modes(Beam(PETSC_COMM_WORLD, m), 3);
  ASSERT_EQ(found.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].springs / 200.0, 1.0, 1e-9);
    EXPECT_NEAR(found[i].dampers / 0.5, 1.0, 1e-9);
    EXPECT_NEAR(found[i].own_stiffness() / std::pow(simple_span(20, static_cast<int>(i) + 1), 2), 1.0, 1e-3);
    EXPECT_EQ(found[i].own_mass(), 1.0);
  }
  const auto [a, b] = modes::rayleigh(found[0], found[1], 0.02, 0.03);
  EXPECT_NEAR(found[0].ratio({a, b}), 0.02, 1e-12);
  EXPECT_NEAR(found[1].ratio({a, b}), 0.03, 1e-12);
}

// A mode that the springs carry has less bending than the first one: eq. 20 has a negative b, and the next mode is
// used.
TEST(Rayleigh, PairWithoutNegativeDamping) {
  const std::vector<modes::BendingMode> found = {{10.0, 50.0}, {20.0, 395.0}, {60.0, 100.0}, {150.0, 10.0}};
  EXPECT_THROW(modes::rayleigh(found[0], found[1], 0.02, 0.02), InputError);
  const modes::RayleighPair pair = modes::rayleigh_pair(found, 0.02, 0.02);
  EXPECT_EQ(pair.second, 2u);
  EXPECT_GE(pair.ab.a, 0.0);
  EXPECT_GE(pair.ab.b, 0.0);
  EXPECT_NEAR(found[0].ratio(pair.ab), 0.02, 1e-14);
  EXPECT_NEAR(found[2].ratio(pair.ab), 0.02, 1e-14);
  EXPECT_THROW(modes::rayleigh_pair({{10.0, 50.0}, {20.0, 395.0}}, 0.02, 0.02), InputError);
  EXPECT_EQ(modes::rayleigh_pair(found, 0.0, 0.0).ab.b, 0.0);
}

// Between modes the springs' part is linear in the square of the frequency.
TEST(Rayleigh, BetweenModes) {
  const std::vector<modes::BendingMode> found = {{10.0, 50.0}, {20.0, 80.0}};
  EXPECT_NEAR(modes::between(found, std::sqrt(200.0)).springs, 60.0, 1e-12);
  EXPECT_EQ(modes::between(found, 20.0).springs, 80.0);
  EXPECT_EQ(modes::between(found, 100.0).springs, 80.0);
  EXPECT_EQ(modes::between({}, 7.0).own_stiffness(), 49.0);
}

}  // namespace
}  // namespace traverse
