// Where a circle can touch a profile. With its centre at x and Y it is closest to the profile, or farthest from it, at
// stations s where g(s) = (x - s) + (Y - h) h' vanishes: local minima of the distance where g falls, maxima where it
// grows. One minimum where every valley is wider than the circle, else there may be several. Y is the greatest value of
//
//   e(s) = h(s) + sqrt(R^2 - (s - x)^2),
//
// the height at which the circle just touches at the deepest of them: as x goes on this is the roll-over curve
// (envelope) on which the centre of a hard wheel moves.
//
// A wheel that is not hard overlaps the profile. Every minimum of the distance carries by the contact's law, alpha its
// depth, and what two neighbours share is taken off again where the maximum between them still overlaps: with U the
// law's potential, U(alpha_1) + U(alpha_2) - U(alpha_between). So a minimum and a maximum that meet and vanish (as a
// wheel leaves a valley) do so without a jump of force or energy, a valley as wide as the wheel is one contact, and two
// points apart are two.
//
// Where the surface steps, as at the end of a beam that nothing rigid holds, each side has its own minima: a wheel
// touches the floor below the step and its edge. On the wall between the two sides the distance is greatest at one of
// its ends, the one farther from the centre: that is what they share.
#pragma once

#include <array>
#include <span>

#include "traverse/track/profile.hpp"

namespace traverse::track {

inline constexpr int most_points = 3;

struct TouchingPoint {
  double station = 0.0;          // m, to within the scan's interpolation
  double depth = 0.0;            // radius less distance when the deepest one just touches, m: at most 0
  double low = 0.0, high = 0.0;  // stations of the maxima of distance on either side, or of the wheel's reach
  int number = 0;                // among all from the left
};

struct TouchingPoints {
  int count = 0;
  std::array<TouchingPoint, most_points> points;  // the deepest ones, from left to right
  double left_out = 0.0;                          // depth of the deepest one not among them; minus infinity: none
  double height = 0.0;                            // Y, m
};

/// Half the length of track that a wheel can touch: all that lies below it where there may be steps; else where the
/// profile is nowhere steeper than its greatest slope.
double reach(const Profile& profile, double radius);
double reach_of_steps(double radius);

/// Whether a wheel of this radius can touch at more than one point.
inline bool is_sharp(const Profile& profile, double radius) { return radius * profile.greatest_valley() >= 1.0; }

/// Whether a wheel would often touch roughness at more than `most_points`: where that many of its shortest waves lie
/// within the wheel's reach.
bool too_rough(const Profile& profile, double radius);

/// The local minima of the distance for a centre at x, where at these stations, ascending and within reach_of_steps of
/// x, the surface may step by an unknown height.
TouchingPoints touching_points(const Profile& profile, double radius, double x, std::span<const double> steps = {});

}  // namespace traverse::track
