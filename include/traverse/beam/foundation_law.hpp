// The law of a foundation that is one-sided or has a gap or a cubic term. A bed obeys the law per length.
//
// With the displacement d of the beam at the station (upward, to the right, counter-clockwise) and the gap g:
//   |d| <= g:  no force;     |d| > g:  s = |d| - g,  force k s + cubic s^3 + c ds/dt, towards d = 0.
// A one-sided foundation acts only if the beam is pressed down, d < -g. A foundation that is one-sided or has a gap
// never pulls: if k s + cubic s^3 + c ds/dt is negative, the beam moves away faster than the foundation follows, and
// the force is zero. The damper force increases linearly over the first nanometre of s; otherwise a stage of an
// implicit method that ends in this range could have no solution. The work of the force minus the work
// of the spring is dissipated.
#pragma once

namespace traverse::beam {

/// The properties that make a foundation nonlinear; with the default values it is linear.
struct FoundationLaw {
  bool one_sided = false;
  double gap = 0.0;    // in both directions, m or rad, >= 0
  double cubic = 0.0;  // N/m3, N m/rad3; for a bed N/m4; >= 0
  /// The force at which a longitudinal point slides, as a bearing does by friction, N; 0: it never slides. A sliding
  /// point has none of the other properties.
  double slides_at = 0.0;

  /// Whether the force is not proportional to displacement and rate.
  bool nonlinear() const { return one_sided || gap > 0.0 || cubic > 0.0 || slides_at > 0.0; }
};

/// The force with its derivatives, energy and dissipation at a displacement d and its rate w.
struct FoundationForce {
  double force = 0.0;            // on the beam, N or N m
  double by_displacement = 0.0;  // -d force/dd, N/m
  double by_rate = 0.0;          // -d force/dw, N s/m, >= 0
  double energy = 0.0;           // strain energy of the spring, J
  double dissipation = 0.0;      // W, >= 0
};
FoundationForce foundation_force(const FoundationLaw& law, double k, double c, double d, double w);

/// A spring that slides if its force reaches a limit: the longitudinal resistance of a sleeper (UIC 774-3) or the
/// friction of a bearing. A sleeper under a train has a larger stiffness and limit.
struct Sliding {
  double k = 0.0, limit = 0.0;                // N/m, N; limit 0: it never slides
  double loaded_k = 0.0, loaded_limit = 0.0;  // stiffness and limit under a train, N/m, N

  /// Stiffness (N/m) and limit (N), under a train or outside it.
  double k_of(bool loaded) const { return loaded ? loaded_k : k; }
  double limit_of(bool loaded) const { return loaded ? loaded_limit : limit; }
};
/// The force after a displacement d (m) from the position with the force `previous` (N), which is first limited to
/// `limit`.
FoundationForce sliding_force(double k, double limit, double previous, double d);

}  // namespace traverse::beam
