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
  /// N: the force at which a point along x slides, as a bearing does by its friction, and has none of the others; 0: it
  /// holds.
  double slides_at = 0.0;

  /// Whether the force is not proportional to displacement and rate.
  bool nonlinear() const { return one_sided || gap > 0.0 || cubic > 0.0 || slides_at > 0.0; }
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

/// A spring that slides where its force reaches a limit: the resistance of a sleeper along the track, UIC 774-3, or the
/// friction of a bearing. Under a train a sleeper is stiffer, and holds more.
struct Sliding {
  double k = 0.0, limit = 0.0;                // N/m, N; a limit of 0: it does not slide
  double loaded_k = 0.0, loaded_limit = 0.0;  // the same where a train stands

  /// Stiffness (N/m) and limit (N), under a train or beside it.
  double k_of(bool loaded) const { return loaded ? loaded_k : k; }
  double limit_of(bool loaded) const { return loaded ? loaded_limit : limit; }
};
/// After it has been moved by d (m) from where its force was `then` (N): what is beyond the limit was lost before.
FoundationForce sliding_force(double k, double limit, double then, double d);

}  // namespace traverse::beam
