// Wheels out of round: the deviation of the radius from its nominal value R over the angle rolled since the start.
//
// The angle a increases as the wheel rolls to the right (a = x/R without sliding); the point of the tread in contact at
// the start is at a = 0. A wheel has a polygonal shape, a flat, or both:
//
//   polygon: dr = A cos(n a + phase), n waves around the wheel (see J. C. O. Nielsen and A. Johansson, Out-of-round
//            railway wheels - a literature survey, Proc. Instn Mech. Engrs F 214 (2000) 79-91);
//   flat:    dr = -d/2 (1 + cos(2 pi R (a - flat_angle)/L)) within L/2 of its middle, depth d = L^2/(16 R): the
//            rounded (worn) flat of W. M. Zhai and others, Dynamic effects of vehicles on tracks in the case of raising
//            train speeds, Proc. Instn Mech. Engrs F 215 (2001) 125-135. A fresh flat, a chord, is twice as deep.
//
// The shape changes the radius at the point where the wheel's normal crosses the tread. Contact at a flat's edges
// beside that normal is neglected, as in the cited models.
#pragma once

#include <vector>

namespace traverse::track {

struct WheelShape {
  double flat_length = 0.0;        // L, m; 0: none
  double flat_angle = 0.0;         // angle of its middle, rad
  int polygon_order = 0;           // n; 0: none
  double polygon_amplitude = 0.0;  // A, m
  double polygon_phase = 0.0;      // rad

  /// Whether the wheel has no flat and no polygon.
  bool round() const { return flat_length == 0.0 && polygon_amplitude == 0.0; }
};

struct RadiusGain {
  double value = 0.0;      // dr, m
  double slope = 0.0;      // derivative by a, m/rad
  double curvature = 0.0;  // second derivative by a, m/rad2
};

/// dr at the rolled angle a (rad) of a wheel of the given radius (m).
RadiusGain radius_gain(const WheelShape& shape, double radius, double angle);

/// Depth of a rounded flat, m.
double flat_depth(double length, double radius);

/// The angles in (0, last), ascending, at which an end of the flat touches the rail; there the curvature jumps.
std::vector<double> flat_ends(const WheelShape& shape, double radius, double last);

}  // namespace traverse::track
