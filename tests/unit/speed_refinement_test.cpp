// Speeds that are added near peaks, and the distance at which a train repeats itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/load_models.hpp"
#include "study/interval_search.hpp"
#include "study/sweep_findings.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::study {
namespace {

/// Of a slightly damped oscillator about its resonance at v = 61.3.
double resonance(double v) {
  const double r = 61.3 / v, zeta = 0.02;
  return 1.0 / std::hypot(1.0 - r * r, 2.0 * zeta * r);
}

struct Refined {
  std::vector<double> speed, value;
  double uncertainty = 0.0;
};

template <class ExtremumTracker>
Refined refined(std::vector<double> speed, double tolerance, const ExtremumTracker& curve) {
  for (int round = 0; round < 60; ++round) {
    std::vector<double> value;
    for (const double v : speed) value.push_back(curve(v));
    const Refinement next = refine(speed, {{"curve", value}}, tolerance);
    if (next.speeds.empty()) return {speed, value, next.uncertainty};
    speed.insert(speed.end(), next.speeds.begin(), next.speeds.end());
    std::sort(speed.begin(), speed.end());
  }
  ADD_FAILURE() << "it does not end";
  return {};
}

TEST(SpeedRefinement, FindsAPeakBetweenSpeeds) {
  const std::vector<double> coarse = {30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0};
  double exact = 0.0;
  for (int i = 0; i < 100000; ++i) exact = std::max(exact, resonance(60.0 + 3e-5 * i));
  double before = 0.0;
  for (const double v : coarse) before = std::max(before, resonance(v));
  EXPECT_LT(before, 0.8 * exact) << "the coarse speeds miss it";
  for (const double tolerance : {1e-2, 1e-3, 1e-5}) {
    const Refined found = refined(coarse, tolerance, resonance);
    const double peak = *std::max_element(found.value.begin(), found.value.end());
    EXPECT_LE(found.uncertainty, tolerance);
    EXPECT_LT(exact / peak - 1.0, tolerance);
    EXPECT_LT(found.speed.size(), 45u) << tolerance;
  }
}

// A resonance 0.04 v wide at half its power: where it may break the limit between two speeds others are added, until it
// is broken, or the neighbours of the highest lack a hundredth at most.
TEST(SpeedRefinement, LeavesNoLimitInDoubt) {
  std::vector<double> speed = {30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0};
  const double exact = 25.0;
  const auto highest_at = [&](double limit) {
    std::vector<double> at = speed;
    for (int round = 0; round < 60; ++round) {
      SpeedCurve curve{"curve", {}};
      for (const double v : at) curve.value.push_back(resonance(v));
      const double highest = *std::max_element(curve.value.begin(), curve.value.end());
      if (highest > limit) return highest;
      const Refinement next = refine_for_limits(at, {{curve, limit}}, 0.04);
      if (next.speeds.empty()) return highest;
      at.insert(at.end(), next.speeds.begin(), next.speeds.end());
      std::sort(at.begin(), at.end());
      EXPECT_LT(at.size(), 60U);
    }
    ADD_FAILURE() << "it does not end";
    return 0.0;
  };
  EXPECT_GT(highest_at(0.97 * exact), 0.97 * exact) << "broken between 60 and 70 m/s only";
  EXPECT_GT(highest_at(1.005 * exact), 0.98 * exact) << "kept, by speeds close to the peak";
  SpeedCurve low{"low", {1.0, 1.0, 1.0}};
  EXPECT_TRUE(refine_for_limits({50.0, 51.0, 52.0}, {{low, 2.0}}, 0.04).speeds.empty()) << "far from its limit";
}

// The higher of two peaks is the lower one of the coarse speeds.
TEST(SpeedRefinement, LooksAtEveryPeakThatMayBeTheHighest) {
  const auto curve = [](double v) {
    return std::exp(-0.5 * std::pow((v - 42.0) / 6.0, 2)) + 1.1 * std::exp(-0.5 * std::pow((v - 75.0) / 4.0, 2));
  };
  const std::vector<double> coarse = {30.0, 36.0, 42.0, 48.0, 54.0, 60.0, 66.0, 72.0, 78.0, 84.0};
  const Refined found = refined(coarse, 1e-3, curve);
  EXPECT_NEAR(*std::max_element(found.value.begin(), found.value.end()), 1.1, 1.1e-3);
}

TEST(SpeedRefinement, LeavesAloneWhatIsKnown) {
  EXPECT_TRUE(refine({1.0, 2.0, 3.0}, {{"straight", {1.0, 2.0, 3.0}}}, 1e-6).speeds.empty());
  EXPECT_TRUE(refine({1.0, 2.0, 3.0}, {{"at rest", {0.0, 0.0, 0.0}}}, 1e-6).speeds.empty());
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refine({1.0, 2.0, 3.0}, {{"not known", {none, none, none}}}, 1e-6).speeds.empty());
  EXPECT_EQ(refine({1.0, 2.0, 3.0}, {{"bent", {1.0, 2.0, 1.0}}}, 1e-2).speeds, (std::vector<double>{1.5, 2.5}));
}

TEST(RegularDistance, IsTheCoachOfEveryTrainOfHslmA) {
  const std::vector<double> coach = {18.0, 19.0, 20.0, 21.0, 22.0,
                                     23.0, 24.0, 25.0, 26.0, 27.0};  // EN 1991-2, 6.4.6.1.1
  for (int train = 1; train <= 10; ++train) {
    const scene::AxleList axles = scene::hslm_a(train);
    EXPECT_NEAR(regular_distance(axles.offsets, axles.forces), coach[static_cast<std::size_t>(train - 1)], 1e-9);
  }
  EXPECT_NEAR(regular_distance(scene::hslm_b(10, 3.5).offsets, scene::hslm_b(10, 3.5).forces), 3.5, 1e-9);
}

TEST(RegularDistance, OfWhatDoesNotRepeatItselfIsNone) {
  EXPECT_EQ(regular_distance(std::vector{0.0}, std::vector{1e5}), 0.0);
  EXPECT_EQ(regular_distance(std::vector{0.0, -2.5}, std::vector{1e5, 1e5}), 0.0) << "half of its weight";
  EXPECT_EQ(regular_distance(std::vector{0.0, -3.0, -7.5, -14.0}, std::vector(4, 1e5)), 0.0);
}

TEST(Cancellations, AreThoseOfUniformSimpleSpansAlone) {
  beam::BeamModel beam;
  beam.spans = {20.0};
  beam.EI = 1e10;
  beam.mass = 1e4;
  beam.supports = {beam::Support::pinned, beam::Support::roller};
  const std::vector<double> frequencies = {5.0, 20.0};
  const auto found = cancellations_of(beam, frequencies, 30.0, 100.0);
  std::vector<double> speeds;
  for (const results::Cancellation& c : found) speeds.push_back(c.speed);
  // 200/3, 200/5; 800/8, 800/10 and so on, but not 800/2.
  EXPECT_EQ(speeds, (std::vector<double>{200.0 / 3.0, 40.0, 100.0, 80.0, 800.0 / 12, 800.0 / 14, 50.0, 800.0 / 18, 40.0,
                                         800.0 / 22, 800.0 / 24, 800.0 / 26}));
  beam.supports[0] = beam::Support::clamped;
  EXPECT_TRUE(cancellations_of(beam, frequencies, 30.0, 100.0).empty());
  beam.supports[0] = beam::Support::pinned;
  beam.foundation.vertical.push_back({10.0, 1e6, 0.0});
  EXPECT_TRUE(cancellations_of(beam, frequencies, 30.0, 100.0).empty());
}

}  // namespace
}  // namespace traverse::study
