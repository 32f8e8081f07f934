// The low-pass of deck accelerations: SciPy's numbers, and the exact response to sines.
#include "run/low_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace traverse::run {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

// SciPy 1.10: sosfiltfilt(butter(4, 30, fs=1000, output='sos'), x, padtype='odd', padlen=100) of the series below.
TEST(LowPass, AgreesWithSciPy) {
  const double h = 0.001;
  std::vector<double> series;
  for (int k = 0; k < 400; ++k) {
    const double t = k * h;
    series.push_back(2.0 * std::exp(-3.0 * t) * std::sin(two_pi * 7.3 * t) + 0.8 * std::cos(two_pi * 41.0 * t + 0.3) +
                     0.5 * std::sin(two_pi * 180.0 * t) + 0.1);
  }
  LowPass(30.0, h).apply(series);
  const std::vector<std::pair<std::size_t, double>> scipy = {
      {0, 0.86423754224065},   {1, 0.81989444460914},   {37, 1.8477820738688},
      {100, -1.3339662139376}, {199, 0.43839233629284}, {250, -0.7593726172148},
      {333, 0.38713368677985}, {398, -1.1790452336563}, {399, -1.3338259589062}};
  for (const auto& [k, value] : scipy) EXPECT_NEAR(series[k], value, 1e-11) << "instant " << k;
}

// Far from the ends a sine keeps its phase and 1/(1 + r^8) of its amplitude; a line stays a line, ends and all.
TEST(LowPass, KeepsPhasesAndTheAmplitudesThatItNames) {
  const double h = 1e-3, cut = 30.0;
  for (const double f : {3.0, 15.0, 30.0, 45.0, 90.0}) {
    std::vector<double> series;
    for (int k = 0; k < 6000; ++k) series.push_back(std::sin(two_pi * f * k * h + 0.7));
    LowPass(cut, h).apply(series);
    const double gain = 1.0 / (1.0 + std::pow(std::tan(0.5 * two_pi * f * h) / std::tan(0.5 * two_pi * cut * h), 8));
    for (int k = 2500; k < 3500; ++k)
      ASSERT_NEAR(series[static_cast<std::size_t>(k)], gain * std::sin(two_pi * f * k * h + 0.7), 1e-10) << f << " Hz";
  }
}

TEST(LowPass, LeavesALineAsItIs) {
  std::vector<double> series;
  for (int k = 0; k < 700; ++k) series.push_back(5.0 - 0.01 * k);
  std::vector<double> filtered = series;
  LowPass(30.0, 1e-3).apply(filtered);
  EXPECT_NEAR(filtered.front(), series.front(), 2e-3);  // a slope that begins 0.1 s before has all but arrived
  EXPECT_NEAR(filtered.back(), series.back(), 2e-3);
  for (std::size_t k = 300; k < 400; ++k) ASSERT_NEAR(filtered[k], series[k], 1e-9);
}

// A constant from the first instant on: no trace of a start from zero.
TEST(LowPass, HasNoStartUp) {
  for (const std::size_t n : {1, 2, 10, 1000}) {
    std::vector<double> series(n, 3.0);
    LowPass(30.0, 1.0 / 600.0).apply(series);
    for (const double value : series) ASSERT_NEAR(value, 3.0, 1e-12);
  }
}

}  // namespace
}  // namespace traverse::run
