// Hinges, continuous and separate spans mixed, overhangs: frequencies and statics against exact ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "modes/modes.hpp"
#include "support/beam_model.hpp"
#include "support/scene_run.hpp"
#include "traverse/base/error.hpp"

namespace traverse::test {
namespace {

using beam::Joint;
using beam::Support;

std::vector<double> frequencies(const beam::BeamModel& model, int count) {
  return modes::natural_modes(beam::Beam(PETSC_COMM_WORLD, model), count, false).omega;
}

/// Two cantilevers that meet at a hinge: what is symmetric about it moves as a cantilever with a free end, what is not
/// as one with a pinned end (roots of the frequency equations after Blevins 1979).
TEST(Joints, HingeBetweenTwoCantilevers) {
  constexpr double exact[] = {1.875104068711961, 3.926602312047919, 4.694091132974174, 7.068582745628732};
  for (const bool at_span_end : {false, true}) {
    auto m = at_span_end ? model_of({15.0, 15.0}, 32, false) : model_of({30.0}, 64, false);
    if (at_span_end) m.joints = {Joint::hinge};
    if (!at_span_end) m.hinges = {15.0};
    m.supports.assign(m.spans.size() + 1, Support::free);
    m.supports.front() = m.supports.back() = Support::clamped;
    const auto found = frequencies(m, 4);
    for (std::size_t i = 0; i < 4; ++i) {
      const double omega = std::pow(exact[i] / 15.0, 2) * std::sqrt(2e9 / 2000.0);
      const double h = 30.0 / 64;
      EXPECT_NEAR(found[i] / omega, 1.0, 1.1 * std::pow(exact[i] * h / 15.0, 4) / 1440 + 1e-9) << i;
    }
  }
}

/// A Gerber beam: a span of 20 m, an arm of 5 m beyond its second support to a hinge, a hung span of 10 m on a last
/// one.
TEST(Joints, GerberBeamUnderAForce) {
  const std::string scene = R"(
beam: {spans: [20.0, 15.0], elements_per_span: 6, EI: 2.0e9, mass: 1.0e3, hinges: 25.0}
support: {types: [pinned, roller, roller]}
load: {forces: 1.0e5, positions: 29.0, speed: 0.0}
scene: {analysis: static}
output: {probes: [25.0, 20.0, 10.0, 29.0]}
)";
  Results run = run_yaml(scene);
  // By statics: the hung span carries 1e5 N as a simple span, its left reaction stands on the arm's tip.
  const double tip = 1e5 * 6.0 / 10.0;
  const std::vector<double> moment = run("/probes/moment");
  EXPECT_NEAR(moment[0], 0.0, 1e-3);
  EXPECT_NEAR(moment[1], -tip * 5.0, 1e-3);
  EXPECT_NEAR(moment[2], -tip * 2.5, 1e-3);
  EXPECT_NEAR(moment[3], 1e5 * 4.0 * 6.0 / 10.0, 1e-3);
  EXPECT_NEAR(run.column("/supports/reaction", 3 * 2 + 1)[0], 1e5 * 4.0 / 10.0, 1e-5);
  EXPECT_NEAR(run.column("/supports/reaction", 1)[0], -tip * 5.0 / 20.0, 1e-5);
  // The arm's tip under `tip`: F a^2 (L + a)/(3 EI).
  EXPECT_NEAR(run("/probes/deflection")[0], -tip * 25.0 * 25.0 / (3 * 2e9), 1e-10);
}

TEST(Joints, WithoutItsHungSpanSupportedItIsAMechanism) {
  const std::string scene = R"(
beam: {spans: [20.0, 15.0], elements_per_span: 6, EI: 2.0e9, mass: 1.0e3, hinges: 25.0}
support: {types: [pinned, roller, free]}
load: {forces: 1.0e5, positions: 29.0, speed: 0.0}
scene: {analysis: static}
)";
  try {
    run_yaml(scene);
    FAIL() << "a mechanism was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("mechanism"), std::string::npos) << error.what();
  }
  auto m = model_of({20.0, 15.0}, 6, false);
  m.hinges = {25.0};
  m.supports[2] = Support::free;
  const auto found = frequencies(m, 2);
  EXPECT_EQ(found[0], 0.0);
  EXPECT_GT(found[1], 1.0);
}

/// Two continuous spans and a separate one: each part's frequencies, as if alone.
TEST(Joints, ContinuousAndSeparateSpansMixed) {
  auto mixed = model_of({20.0, 25.0, 18.0}, 10, false);
  mixed.joints = {Joint::continuous, Joint::separate};
  std::vector<double> alone = frequencies(model_of({20.0, 25.0}, 10, false), 4);
  for (const double omega : frequencies(model_of({18.0}, 10, false), 2)) alone.push_back(omega);
  std::sort(alone.begin(), alone.end());
  const auto found = frequencies(mixed, 5);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(found[i] / alone[i], 1.0, 1e-9) << i;
}

/// A train on a bridge with a hinge inside a span and an overhang: forces and energy balance, steps end at the hinge.
TEST(Joints, TrainOverHingeAndOverhang) {
  Results run = run_scene("three_span_half_car", {{"beam_hinges", "30.0"},
                                                  {"support_types", "free,roller,pinned,roller"},
                                                  {"foundation_vertical_x", "0"},
                                                  {"foundation_vertical_k", "1e9"},
                                                  {"foundation_vertical_c", "1e5"},
                                                  {"ts_dt", "5e-4"}});
  EXPECT_LT(std::abs(peak(run("/balance/residual")).first), 1e-9 * 9.81 * 80 * 2303.0);
  EXPECT_LT(std::abs(peak(run("/energy/residual")).first), 2e-5 * std::abs(peak(run("/energy/dissipated")).first));
}

/// Bearings of their own under either end of two separate spans.
TEST(Joints, BearingsOfSeparateSpans) {
  Results run = run_yaml(R"(
beam: {spans: [10.0, 10.0], elements_per_span: 4, EI: 2.0e9, mass: 1.0e3, continuity: simply_supported}
support: {types: [pinned, free, pinned]}
foundation: {vertical: {x: [10.0, 10.0], k: [2.0e7, 4.0e7], side: [left, right]}}
load: {forces: [1.0e5, 2.0e5], positions: [5.0, 15.0], speed: 0.0}
scene: {analysis: static}
output: {probes: [5.0, 15.0]}
)");
  EXPECT_NEAR(run.column("/foundation/vertical/force", 0)[0], 5e4, 1e-5);
  EXPECT_NEAR(run.column("/foundation/vertical/force", 1)[0], 1e5, 1e-5);
  const double bent = 1e5 * 1000.0 / (48 * 2e9);
  EXPECT_NEAR(run("/probes/deflection")[0], -bent - 0.5 * 5e4 / 2e7, 1e-12);
  EXPECT_NEAR(run("/probes/deflection")[1], -2 * bent - 0.5 * 1e5 / 4e7, 1e-12);
}

}  // namespace
}  // namespace traverse::test
