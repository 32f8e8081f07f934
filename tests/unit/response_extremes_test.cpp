// Extremes of sampled curves.
#include "run/response_extremes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::run {
namespace {

constexpr std::size_t only[] = {0};  // place

/// Passages of the only probe, at ascending times.
struct Passages {
  std::vector<double> times;
  std::vector<recovery::StationPassage> now{};
  std::size_t next = 0;
  /// Those since the last call.
  const std::vector<recovery::StationPassage>& until(double t) {
    now.clear();
    for (; next < times.size() && times[next] <= t; ++next) now.push_back({0, times[next]});
    return now;
  }
};

/// The extremes of one probe's curve f, all quantities the same, sampled every dt until 1 s and at `extra`.
template <class ExtremumTracker>
ResponseExtremes peaks_of_curve(ExtremumTracker f, double dt, const std::vector<double>& passages = {}) {
  ResponseExtremes peaks(1, 1);
  std::vector<double> times = passages;
  for (int i = 0; i * dt <= 1.0; ++i) times.push_back(i * dt);
  std::sort(times.begin(), times.end());
  Passages passed{passages};
  for (const double t : times) {
    recovery::Response response;
    response.relative_deflection = response.acceleration = response.moment = f(t);
    const double force = f(t);
    peaks.add(t, {{&response, 1}, only}, {{&force, 1}, only}, passed.until(t));
  }
  peaks.finish();
  return peaks;
}

// Two events of a crossing may be 1e-12 s apart. Between such instants the slope is that of rounding.
TEST(ResponseExtremes, InstantsThatNearMakeNoParabola) {
  ResponseExtremes peaks(0, 1);
  const double crest = 1.03, step = 0.1;
  const auto force = [&](double t) { return 1e5 * (2.0 - (t - crest) * (t - crest)); };
  for (double t = 0.0; t < 2.0; t += step) {
    const double now[] = {force(t)}, rounded[] = {force(t) * (1.0 - 1e-10)};
    peaks.add(t, {}, {now, only});
    peaks.add(t + 1e-12, {}, {rounded, only});
  }
  peaks.finish();
  EXPECT_NEAR(peaks.largest(wheel_force).value, force(crest), 1e-8 * force(crest));
  EXPECT_NEAR(peaks.largest(wheel_force).time, crest, 1e-6);
}

// A force that jumps within a short step makes no parabola through the three samples beside it.
TEST(ResponseExtremes, AJumpMakesNoParabola) {
  ResponseExtremes peaks(0, 1);
  const double jump = 0.505, before = 100.0, after = 110.0;
  for (const double t : {0.3, 0.4, 0.5, jump, 0.6, 0.7, 0.8}) {
    const double now[] = {t < jump ? before : after - 10.0 * (t - jump)};
    peaks.add(t, {}, {now, only});
  }
  peaks.finish();
  EXPECT_NEAR(peaks.largest(wheel_force).value, after, 0.3 * (after - before));
}

// The error falls with the sixth power of the interval, wherever the samples lie.
TEST(ResponseExtremes, LieBetweenSamples) {
  double before = 0.0;
  for (const double dt : {0.16, 0.08, 0.04}) {
    double worst = 0.0;
    for (double phase = 0.0; phase < 1.0; phase += 0.05) {
      const auto wave = [&](double t) { return -std::sin(7.0 * t - phase); };
      const ResponseExtremes peaks = peaks_of_curve(wave, dt);
      worst = std::max(worst, std::abs(std::abs(peaks.largest(deflection).value) - 1.0));
    }
    EXPECT_LT(worst, std::pow(7.0 * dt, 6) / 200.0) << dt;
    if (before > 0.0) {
      EXPECT_LT(worst, before / 40.0) << dt;
    }
    before = worst;
  }
}

// Filtered rows have extremes between their instants too; where a curve still rises at the last row none is known.
TEST(ResponseExtremes, OfFilteredRows) {
  ResponseExtremes peaks(2, 0);
  const double h = 0.01;
  std::vector<double> rows;
  for (int k = 0; k * h <= 1.0; ++k) {
    rows.push_back(std::sin(7.0 * k * h));
    rows.push_back(-3.0 * k * h);
  }
  peaks.add_low_passed(rows, h);
  ASSERT_EQ(peaks.largest_of_each(low_passed).size(), 2U);
  EXPECT_NEAR(std::abs(peaks.largest_of_each(low_passed)[0].value), 1.0, 1e-5);
  EXPECT_DOUBLE_EQ(peaks.largest_of_each(low_passed)[1].value, 0.0);
  EXPECT_EQ(peaks.largest(low_passed).place, 0);
  EXPECT_TRUE(peaks.of(acceleration).empty());
}

// At a kink that has a sample no parabola rounds it off or overshoots.
TEST(ResponseExtremes, AtAKinkThatHasASample) {
  const double kink = 0.4321;
  const auto roof = [&](double t) { return 1.0 - std::abs(t - kink); };
  const ResponseExtremes peaks = peaks_of_curve(roof, 0.03, {kink});
  EXPECT_DOUBLE_EQ(peaks.largest(moment).value, 1.0);
  EXPECT_DOUBLE_EQ(peaks.largest(moment).time, kink);
}

// M + b dM/dt is a roof: its peak is (1 - b ln 2) high, b ln 2 behind the kink, whether steps are long or short for b.
TEST(ResponseExtremes, BehindAKinkThatRelaxes) {
  const double kink = 0.4321;
  for (const double b : {1e-4, 3e-3, 0.05}) {
    for (const double dt : {0.03, 0.003}) {
      ResponseExtremes peaks(1, 0, b);
      std::vector<double> times = {kink};
      for (int i = 0; i * dt <= 1.0; ++i) times.push_back(i * dt);
      std::sort(times.begin(), times.end());
      for (const double t : times) {
        const double s = t - kink, roof = 1.0 - std::abs(s);
        recovery::Response response;
        response.moment = s < 0.0 ? roof - b : roof + b - 2.0 * b * std::exp(-s / b);
        response.moment_rate = (roof - response.moment) / b;
        peaks.add(t, {{&response, 1}, only}, {});
      }
      peaks.finish();
      EXPECT_NEAR(peaks.largest(moment).value, 1.0 - b * std::log(2.0), 1e-12) << b << " " << dt;
      EXPECT_NEAR(peaks.largest(moment).time, kink + b * std::log(2.0), 1e-9) << b << " " << dt;
    }
  }
}

/// A shear that falls by 1 a second, jumps by 3 at 0.4321 s and, with b, relaxes behind that.
recovery::Response jumping(double t, double jump, double b) {
  recovery::Response r;
  const double s = t - jump;
  r.moment_rate = b > 0.0 ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  if (b > 0.0 && s >= 0.0) r.unrelaxed_shear = -3.0 * std::exp(-s / b);
  r.shear = -1.0 - t + (s >= 0.0 ? 3.0 : 0.0) + r.unrelaxed_shear;
  if (t == jump) r.shear_beside = {-3.0, 0.0};
  return r;
}

// Both sides of a jump count, whether an instant is there or between two, and what relaxes is greatest where it falls
// as fast as it rises.
TEST(ResponseExtremes, BesideAJump) {
  const double jump = 0.4321;
  for (const double b : {0.0, 1e-4, 2e-3})
    for (const bool ends_there : {true, false}) {
      ResponseExtremes peaks(1, 0, b);
      std::vector<double> times;
      for (int i = 0; i <= 30; ++i) times.push_back(i / 30.0);
      if (ends_there) times.push_back(jump);
      std::sort(times.begin(), times.end());
      Passages passed{std::vector<double>(1, jump)};
      for (const double t : times) {
        const recovery::Response response = jumping(t, jump, b);
        peaks.add(t, {{&response, 1}, only}, {}, passed.until(t));
      }
      peaks.finish();
      const double way = b > 0.0 ? b * std::log(3.0 / b) : 0.0;
      EXPECT_NEAR(peaks.range(shear_force, 0).greatest.value, 2.0 - jump - way - b, 1e-12) << b << ends_there;
      EXPECT_NEAR(peaks.range(shear_force, 0).greatest.time, jump + way, 1e-12) << b << ends_there;
      EXPECT_NEAR(peaks.range(shear_force, 0).least.value, -1.0 - jump, 1e-12) << b << ends_there;
      EXPECT_NEAR(peaks.largest(shear_force).value, 2.0 - jump - way - b, 1e-12) << b << ends_there;
    }
}

// The least and the greatest of a probe are those between samples, as peaks are, on either side of zero.
TEST(ResponseExtremes, RangesLieBetweenSamplesToo) {
  const ResponseExtremes peaks = peaks_of_curve([](double t) { return 5.0 + std::sin(7.0 * t + 0.3); }, 0.04);
  for (const Quantity q : {deflection, acceleration, moment}) {
    EXPECT_NEAR(peaks.range(q, 0).greatest.value, 6.0, 3e-6);
    EXPECT_NEAR(peaks.range(q, 0).least.value, 4.0, 3e-6);
    EXPECT_EQ(peaks.largest(q).value, peaks.range(q, 0).greatest.value);
  }
}

TEST(ResponseExtremes, TheFirstAndTheLastValueCount) {
  EXPECT_DOUBLE_EQ(peaks_of_curve([](double t) { return 2.0 - t; }, 0.1).largest(acceleration).value, 2.0);
  EXPECT_NEAR(peaks_of_curve([](double t) { return -1.0 - t; }, 0.1).largest(wheel_force).value, -2.0, 1e-12);
}

// Where the largest extremes agree by chance, their neighbours tell that the curves differ.
TEST(ResponseExtremes, DifferenceSeesNeighbours) {
  const auto curve = [](double second) {
    return [=](double t) { return std::sin(M_PI * 8.0 * t) * (t > 0.25 && t < 0.5 ? second : 1.0); };
  };
  const ResponseExtremes a = peaks_of_curve(curve(0.97), 1e-3), b = peaks_of_curve(curve(0.95), 1e-3);
  EXPECT_NEAR(peak_difference(a, b, deflection), 0.0, 1e-9);
  EXPECT_GT(difference(a, b, deflection, 0.01), 0.01);
  EXPECT_LT(difference(a, b, deflection, 0.01), 0.03);
  EXPECT_EQ(difference(a, a, deflection, 0.01), 0.0);
}

// A ripple that longer steps have not seen, 0.02 s before the extreme that both have, is no difference of that.
TEST(ResponseExtremes, DifferenceComparesExtremesThatAreEachOthersNearest) {
  const auto curve = [](double ripple) {
    return [=](double t) {
      return std::exp(-std::pow((t - 0.5) / 0.01, 2)) + ripple * std::exp(-std::pow((t - 0.48) / 0.005, 2));
    };
  };
  const ResponseExtremes rough = peaks_of_curve(curve(0.0), 1e-3), fine = peaks_of_curve(curve(0.8), 1e-3);
  EXPECT_LT(difference(rough, fine, deflection, 0.03), 1e-5);
}

}  // namespace
}  // namespace traverse::run
