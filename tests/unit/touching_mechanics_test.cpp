// Where a circle can touch a profile: against a fine search.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "track/touching.hpp"

namespace traverse::track {
namespace {

constexpr double R = 0.46;  // m

struct Found {
  double station, depth;
};
double height_of_centre(const Profile& p, double x) {
  double height = 0.0;
  for (double s = x - 0.9 * R; s < x + 0.9 * R; s += 1e-5)
    height = std::max(height, p.at(s).value + std::sqrt(R * R - (s - x) * (s - x)));
  return height;
}
// Local minima of the distance among stations in a wheel's reach.
std::vector<Found> by_search(const Profile& p, double x) {
  std::vector<Found> minima;
  const double step = 1e-5, half = reach(p, R), y = height_of_centre(p, x);
  const auto depth = [&](double s) { return R - std::hypot(s - x, y - p.at(s).value); };
  double before = -1.0, here = depth(x - half);
  for (int i = 0; i <= 2.0 * half / step; ++i) {
    const double after = i + 1 <= 2.0 * half / step ? depth(x - half + (i + 1) * step) : -1.0;
    if (here >= before && here > after) minima.push_back({x - half + i * step, here});
    before = here;
    here = after;
  }
  return minima;
}

void expect_points(const Profile& p, double x) {
  const TouchingPoints points = touching_points(p, R, x);
  const std::vector<Found> minima = by_search(p, x);
  ASSERT_EQ(points.count, static_cast<int>(minima.size())) << "x = " << x;
  EXPECT_NEAR(points.height, height_of_centre(p, x), 3e-5);
  for (std::size_t i = 0; i < minima.size(); ++i) {
    const TouchingPoint& point = points.points[i];
    EXPECT_NEAR(point.station, minima[i].station, 3e-3) << "x = " << x;
    EXPECT_NEAR(point.depth, minima[i].depth, 3e-5) << "x = " << x;
    EXPECT_LE(point.low, minima[i].station + 1e-5);
    EXPECT_GE(point.high, minima[i].station - 1e-5);
    EXPECT_EQ(point.number, static_cast<int>(i));
    if (i > 0) {
      EXPECT_EQ(point.low, points.points[i - 1].high);
    }
  }
}

TEST(Touching, OnePointOnLevelAndGentleTrack) {
  const Profile gentle = Profile::bump(0.0, 3.0, 0.004);
  EXPECT_FALSE(is_sharp(gentle, R));
  EXPECT_FALSE(is_sharp(Profile(), R));
  for (double x : {-1.0, 0.2, 1.5, 4.0}) expect_points(gentle, x);
}

TEST(Touching, SharpBump) {
  const Profile bump = Profile::bump(2.0, 0.1, 0.01);
  EXPECT_TRUE(is_sharp(bump, R));
  int most = 0;
  for (double x = 1.8013; x < 2.3; x += 0.0031) {
    expect_points(bump, x);
    most = std::max(most, touching_points(bump, R, x).count);
  }
  EXPECT_EQ(most, 2);  // the ground straight below, and the bump
}

// A crest may be as sharp as it likes; at its feet, corners, a wheel touches ground and slope.
TEST(Touching, CrestsTouchOnce) {
  const Profile crest = Profile::spline({0.0, 0.05, 0.1}, {0.0, 0.01, 0.0}, "t.csv");
  EXPECT_GT(-crest.at(0.05).curvature * R, 5.0);
  for (double x = 0.02; x < 0.081; x += 0.01) EXPECT_EQ(touching_points(crest, R, x).count, 1) << "x = " << x;
  bool twice = false;
  for (double x = -0.2; x < 0.3; x += 0.0031) {
    expect_points(crest, x);
    twice = twice || touching_points(crest, R, x).points[1].depth > -1e-4;
  }
  EXPECT_TRUE(twice);
  EXPECT_TRUE(is_sharp(crest, R));
  const Profile valley = Profile::spline({0.0, 0.5, 1.0}, {0.0, -0.2, 0.0}, "t.csv");
  EXPECT_TRUE(is_sharp(valley, R));
}

TEST(Touching, MorePointsThanAreKept) {
  std::vector<double> x, h;
  for (int i = 0; i <= 200; ++i) {
    x.push_back(0.005 * i);
    h.push_back(0.002 * std::cos(2.0 * 3.14159265358979 * x.back() / 0.05));
  }
  const Profile waves = Profile::spline(x, h, "t.csv");
  const TouchingPoints points = touching_points(waves, R, 0.5);
  const std::vector<Found> minima = by_search(waves, 0.5);
  ASSERT_GT(minima.size(), 3u);
  ASSERT_EQ(points.count, 3);
  std::vector<double> depths;
  for (const Found& f : minima) depths.push_back(f.depth);
  std::sort(depths.rbegin(), depths.rend());
  EXPECT_NEAR(points.deepest_omitted, depths[3], 3e-5);
  for (const TouchingPoint& point : points.points) EXPECT_GT(point.depth, depths[2] - 3e-5);
  EXPECT_LT(points.points[0].station, points.points[1].station);
  EXPECT_LT(points.points[1].station, points.points[2].station);
}

TEST(Touching, RoughnessThatIsTooRough) {
  EXPECT_FALSE(too_rough(Profile::rough(iso8608('A'), 0.0, 1), R));
  EXPECT_FALSE(too_rough(Profile::rough(iso8608('C'), 0.0, 1), R));
  EXPECT_TRUE(too_rough(Profile::rough(iso8608('E'), 0.0, 1), R));
  EXPECT_FALSE(too_rough(Profile::rough(iso8608('E'), 1.0, 100.0, 0.0, 1), R));
  EXPECT_FALSE(is_sharp(Profile::rough(german(true), 0.0, 1), R));
  EXPECT_FALSE(is_sharp(Profile::rough(fra(1), 0.0, 1), R));
}

// Each side of a step has its own minimum: under the centre, and at the step.
TEST(Touching, BothSidesOfASurfaceThatMayStep) {
  const double steps[] = {0.05, 0.3};
  const TouchingPoints points = touching_points(Profile(), R, 0.0, steps);
  ASSERT_EQ(points.count, 3);
  const double low[] = {-reach_of_steps(R), 0.05, 0.3}, high[] = {0.05, 0.3, reach_of_steps(R)},
               at[] = {0.0, 0.05, 0.3};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(points.points[i].station, at[i], 1e-12);
    EXPECT_EQ(points.points[i].low, low[i]);
    EXPECT_EQ(points.points[i].high, high[i]);
    EXPECT_EQ(points.points[i].number, static_cast<int>(i));
  }
}

}  // namespace
}  // namespace traverse::track
