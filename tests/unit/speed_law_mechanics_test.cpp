// Speeds over time and over place, the ways gone, and tables that are run through from the other side.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "traverse/base/error.hpp"
#include "traverse/base/force_law.hpp"
#include "traverse/base/speed_law.hpp"
#include "traverse/track/profile.hpp"

namespace traverse {
namespace {

using base::SpeedLaw;

/// The integral of the speed by midpoints.
double way_by_midpoints(const SpeedLaw& law, double end) {
  constexpr int parts = 200000;
  double sum = 0.0;
  for (int i = 0; i < parts; ++i) sum += law.speed(end * (i + 0.5) / parts);
  return sum * end / parts;
}

TEST(SpeedLaw, GoesTheIntegralOfItsSpeed) {
  const SpeedLaw law = SpeedLaw::over_time({-1.0, 0.5, 2.0, 3.0, 5.0}, {10.0, 10.0, 25.0, 25.0, 0.0});
  for (const double end : {0.3, 1.0, 2.5, 4.0, 7.0})
    EXPECT_NEAR(law.distance(end), way_by_midpoints(law, end), 1e-7) << end;
  EXPECT_DOUBLE_EQ(law.speed(1.25), 17.5);
  EXPECT_DOUBLE_EQ(law.standstill(), 5.0);
  EXPECT_DOUBLE_EQ(law.fastest(), 25.0);
  EXPECT_EQ(law.distance(9.0), law.distance(5.0)) << "it stands";
}

TEST(SpeedLaw, FindsWhenAWayIsGone) {
  for (const double sign : {1.0, -1.0}) {
    const SpeedLaw law = SpeedLaw::over_time({0.0, 2.0, 3.0, 7.0}, {0.0, sign * 20.0, sign * 20.0, 0.0});
    for (const double t : {0.1, 1.0, 2.0, 2.7, 3.5, 6.9}) EXPECT_NEAR(law.time_of(law.distance(t)), t, 1e-12) << t;
    EXPECT_EQ(law.direction(), sign);
    EXPECT_TRUE(std::isinf(law.time_of(sign * 80.001))) << "it stands at 80 m";
    EXPECT_LT(law.time_of(-sign), 0.0) << "behind it";
  }
  EXPECT_EQ(SpeedLaw(-4.0).time_of(-10.0), 2.5);
}

TEST(SpeedLaw, KeepsItsAccelerationBetweenPlaces) {
  // Of v^2 = 100 + 15 x until x = 20, and down to rest at 60: from x = 5 on.
  const SpeedLaw law = SpeedLaw::over_place({0.0, 20.0, 60.0}, {10.0, 20.0, 0.0}, 5.0);
  EXPECT_DOUBLE_EQ(law.speed(0.0), std::sqrt(175.0));
  for (double t = 0.0; t < law.standstill(); t += 0.1) {
    const double x = 5.0 + law.distance(t), v = law.speed(t);
    EXPECT_NEAR(v * v, x < 20.0 ? 100.0 + 15.0 * x : 10.0 * (60.0 - x), 1e-10) << t;
  }
  EXPECT_NEAR(5.0 + law.distance(100.0), 60.0, 1e-12);
  EXPECT_NEAR(law.standstill(), 2.0 * 15.0 / (20.0 + std::sqrt(175.0)) + 4.0, 1e-12);
}

TEST(SpeedLaw, MirrorsPlaces) {
  const SpeedLaw right = SpeedLaw::over_place({0.0, 20.0, 60.0}, {0.0, 20.0, 5.0}, 0.0);
  const SpeedLaw left = SpeedLaw::over_place({-60.0, -20.0, 0.0}, {-5.0, -20.0, 0.0}, 0.0);
  for (const double t : {0.0, 1.0, 2.0, 4.0, 9.0}) EXPECT_DOUBLE_EQ(left.distance(t), -right.distance(t));
  EXPECT_GT(right.distance(1.0), 0.0) << "it starts from rest";
}

TEST(SpeedLaw, PassesEveryRowOfATableOfPositions) {
  for (const double sign : {1.0, -1.0}) {
    const std::vector<double> times = {-0.5, 0.0, 0.4, 1.5, 2.0, 3.5, 4.0, 6.0};
    std::vector<double> even, stops = {0.0, 0.1, 0.5, 4.0, 4.0, 4.0, 7.0, 7.5};
    for (const double t : times) even.push_back(sign * (3.0 * (t + 1.0) + 2.0 * t * t / 2.0));
    for (double& x : stops) x *= sign;
    const SpeedLaw uniform = SpeedLaw::through(times, even), halting = SpeedLaw::through(times, stops);
    EXPECT_EQ(halting.direction(), sign);
    for (std::size_t i = 0; i < times.size(); ++i) {
      EXPECT_NEAR(uniform.distance(times[i]), even[i] - even[1], 1e-12) << i;
      EXPECT_NEAR(halting.distance(times[i]), stops[i] - stops[1], 1e-12) << i;
    }
    for (double t = -0.5; t < 6.0; t += 0.01) {
      EXPECT_GE(sign * halting.speed(t), 0.0) << t;
      if (t > 0.0) {
        EXPECT_NEAR(uniform.acceleration(t), sign * 2.0, 1e-11) << "a constant acceleration, at " << t;
      }
    }
    EXPECT_EQ(halting.speed(2.8), 0.0) << "it stands between two equal rows";
    EXPECT_DOUBLE_EQ(uniform.speed(9.0), uniform.speed(6.0));
  }
  EXPECT_THROW(SpeedLaw::through({0.0, 1.0, 2.0}, {0.0, 1.0, 0.5}), InputError);
  EXPECT_THROW(SpeedLaw::through({0.0, 1.0}, {2.0, 2.0}), InputError);
  EXPECT_THROW(SpeedLaw::through({0.0, 0.0}, {2.0, 3.0}), InputError);
}

TEST(SpeedLaw, RefusesWhatCannotRun) {
  EXPECT_THROW(SpeedLaw::over_time({0.0, 1.0}, {-1.0, 1.0}), InputError);
  EXPECT_THROW(SpeedLaw::over_time({0.0, 1.0}, {0.0, 0.0}), InputError);
  EXPECT_THROW(SpeedLaw::over_time({0.0, 0.0}, {1.0, 2.0}), InputError);
  EXPECT_THROW(SpeedLaw::over_time({-2.0, -1.0}, {1.0, 0.0}), InputError) << "at rest before it begins";
  EXPECT_THROW(SpeedLaw::over_place({0.0, 10.0, 20.0, 30.0}, {10.0, 0.0, 0.0, 10.0}, 0.0), InputError);
  EXPECT_THROW(SpeedLaw::over_place({0.0, 10.0}, {0.0, 10.0}, -5.0), InputError) << "never comes to 0";
  EXPECT_THROW(SpeedLaw::over_place({0.0, 10.0}, {10.0, 0.0}, 10.0), InputError) << "stands at its end";
}

TEST(SpeedLaw, HoldsAPieceAtItsEnd) {
  base::TimeFunction way = SpeedLaw::over_time({0.0, 2.0, 4.0}, {20.0, 10.0, 10.0}).from(3.0);
  EXPECT_EQ(way.kinks(), (std::vector<double>{0.0, 2.0, 4.0}));
  way.select_side(1.0);
  EXPECT_DOUBLE_EQ(way.acceleration(2.0), -5.0) << "of the step that ends there";
  EXPECT_DOUBLE_EQ(way.value(2.0), 33.0);
  EXPECT_TRUE(way.select_side(3.0));
  EXPECT_FALSE(way.select_side(3.5));
  EXPECT_DOUBLE_EQ(way.acceleration(2.0), 0.0) << "of the step that begins there";
  EXPECT_DOUBLE_EQ(way.value(2.0), 33.0);
}

TEST(Reversed, ProfilesAndTablesAreSeenFromTheOtherSide) {
  const track::Profile bump = track::Profile::bump(3.0, 2.0, 0.01), back = bump.reversed();
  const track::Profile rough = track::Profile::rough(track::german(false), -10.0, 1), from = rough.reversed();
  for (const double x : {-30.0, -4.7, -3.2, 0.0, 3.4, 8.0}) {
    for (const auto& [one, other] : {std::pair(bump, back), std::pair(rough, from)}) {
      EXPECT_EQ(other.at(x).value, one.at(-x).value);
      EXPECT_EQ(other.at(x).slope, -one.at(-x).slope);
      EXPECT_EQ(other.at(x).curvature, one.at(-x).curvature);
    }
    EXPECT_EQ(from.along(x, 0.5, 3)[2].value, from.at(x + 1.0).value);
  }
  EXPECT_EQ(back.kinks(), (std::vector<double>{-5.0, -3.0}));
  const base::Polyline table({-1.0, 0.0, 2.0}, {-3.0, 0.0, 1.0}), turned = table.reversed();
  for (const double x : {-4.0, -2.0, -0.3, 0.0, 0.7, 5.0}) EXPECT_DOUBLE_EQ(turned.value(x), -table.value(-x));
}

}  // namespace
}  // namespace traverse
