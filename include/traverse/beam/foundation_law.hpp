// The law of a foundation that is one-sided, has a gap or a cubic term; a bed obeys it per length.
//
// With the displacement d of the beam at the station (upward, towards the right, counter-clockwise) and the gap g:
//   |d| <= g:  no force;     |d| > g:  s = |d| - g,  force k s + cubic s^3 + c ds/dt, towards zero.
// One-sided: only where the beam is pressed down, d < -g. A foundation that the beam can leave, one-sided or with a
// gap, never pulls: where k s + cubic s^3 + c ds/dt is negative the beam runs away from it and the force is zero. Its
// damper comes on over the first nanometre of s, without which a stage of an implicit method that ends just there
// would have no solution. What the force does beyond that of the spring is lost.
#pragma once

namespace traverse::beam {

/// What makes a foundation nonlinear; without any of these it is linear.
struct FoundationLaw {
  bool one_sided = false;
  double gap = 0.0;    // on either side, m or rad, >= 0
  double cubic = 0.0;  // N/m3, N m/rad3; of a bed N/m4; >= 0

  bool nonlinear() const { return one_sided || gap > 0.0 || cubic > 0.0; }
};

/// At one displacement d and its rate w.
struct FoundationForce {
  double force = 0.0;            // on the beam, N or N m
  double by_displacement = 0.0;  // -d force/dd, N/m
  double by_rate = 0.0;          // -d force/dw, N s/m, >= 0
  double energy = 0.0;           // in the spring, J
  double dissipation = 0.0;      // W, >= 0
};
FoundationForce foundation_force(const FoundationLaw& law, double k, double c, double d, double w);

}  // namespace traverse::beam
