// Contact points of a circle with a profile. A circle with its centre at x and Y is closest to the profile, or farthest
// from it, at stations s where g(s) = (x - s) + (Y - h) h' is zero: local minima of the distance where g decreases,
// maxima where it increases. There is one minimum if every valley is wider than the circle, otherwise there may be
// several. Y is the largest value of
//
//   e(s) = h(s) + sqrt(R^2 - (s - x)^2),
//
// the height at which the circle just touches at the deepest minimum. Over x this is the roll-over curve (envelope), on
// which the centre of a rigid wheel moves.
//
// A deformable wheel overlaps the profile. Every minimum of the distance transmits a force by the contact law, with its
// depth as alpha. The common part of two neighbours is subtracted if the maximum between them overlaps too: with the
// law's potential U it is U(alpha_1) + U(alpha_2) - U(alpha_between). A minimum and a maximum that merge and vanish (as
// a wheel leaves a valley) therefore cause no jump of force or energy, a valley as wide as the wheel is one contact,
// and two separate points are two contacts.
//
// If the surface has a jump in height, as at the end of a beam without a rigid support, each side has its own minima: a
// wheel touches the lower surface beside the jump and the edge of the higher surface. On the wall between the two sides
// the distance is largest at the end of the wall that is farther from the centre; this end is the common part of both
// sides.
#pragma once

#include <array>
#include <span>

#include "traverse/track/profile.hpp"

namespace traverse::track {

inline constexpr int most_points = 3;

struct TouchingPoint {
  double station = 0.0;          // m, with the error of the scan's interpolation
  double depth = 0.0;            // radius minus distance if the deepest point just touches, m: at most 0
  double low = 0.0, high = 0.0;  // stations of the maxima of the distance on either side, or ends of the wheel's reach
  int number = 0;                // index among all points, from the left
};

struct TouchingPoints {
  int count = 0;
  std::array<TouchingPoint, most_points> points;  // the points with the largest depths, from left to right
  double deepest_omitted = 0.0;                   // depth of the deepest point that is not stored; minus infinity: none
  double height = 0.0;                            // Y, m
};

/// Half the length of track that a wheel can touch: the track below the wheel if the surface may jump in height,
/// otherwise a length that follows from the profile's largest slope.
double reach(const Profile& profile, double radius);
double reach_of_steps(double radius);

/// Whether a wheel of this radius can touch at more than one point.
inline bool is_sharp(const Profile& profile, double radius) { return radius * profile.greatest_valley() >= 1.0; }

/// Whether a wheel would often touch roughness at more than `most_points`: if its reach contains more than that number
/// of shortest waves.
bool too_rough(const Profile& profile, double radius);

/// The local minima of the distance for a centre at x. At the stations `steps`, ascending and within reach_of_steps of
/// x, the surface may have a jump of unknown height.
TouchingPoints touching_points(const Profile& profile, double radius, double x, std::span<const double> steps = {});

}  // namespace traverse::track
