// The nonlinear law of a spring and its damper: tables, a gap, one-sided action.
//
// With the elongation e relative to the free length (for a torsion spring: the twist) and the gap G:
//   |e| <= G:  no force;     |e| > G:  x = e - G sign(e), tension T(x) + D(de/dt).
// A one-sided spring acts only for e < -G (compression) or e > G (tension). The tension of a spring with a gap or with
// one-sided action never changes its sign: if T + D and x differ in sign, the ends separate faster than the spring
// follows, and the tension is zero. The damper force increases linearly over the first nanometre of x; otherwise a
// stage of an implicit method that ends in this range could have no solution. The work of the tension minus
// the work of T is dissipated; it is never negative.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace traverse::base {

/// A piecewise linear function through points. Its first and last segments continue outside the points.
class Polyline {
 public:
  /// x must increase strictly and have at least two values; otherwise InputError is thrown.
  Polyline(std::vector<double> x, std::vector<double> y);
  /// The function y = slope*x.
  static Polyline line(double slope) { return {{0.0, 1.0}, {0.0, slope}}; }

  /// The function -value(-x).
  Polyline reversed() const;

  double value(double x) const;     // linear between the points, with the end slopes outside
  double slope(double x) const;     // at a corner the slope on the right
  double integral(double x) const;  // integral of the value from 0 to x
  /// The argument at which the value is y; empty unless the function increases everywhere.
  std::optional<double> inverse(double y) const;
  /// The reason, in words, why x y < 0 somewhere; empty if x y >= 0 everywhere.
  std::string opposing() const;

 private:
  std::size_t segment(double x) const;
  double from_start(double x) const;

  std::vector<double> x_, y_;
  std::vector<double> slope_;  // slope of each segment
  std::vector<double> area_;   // integral from the first point to each point
  double origin_ = 0.0;        // integral from the first point to 0
};

enum class Side { both, compression, tension };

/// For a torsion spring the units are rad instead of m and N m instead of N.
struct ForceLaw {
  Polyline elastic = Polyline::line(0.0);  // T: N over m
  Polyline damper = Polyline::line(0.0);   // D: N over m/s
  double gap = 0.0;                        // m, in both directions, >= 0
  Side side = Side::both;

  /// Whether the spring has no force in a range of elongations.
  bool can_disengage() const { return gap > 0.0 || side != Side::both; }
  /// The elongation at which the spring alone has this tension; empty if there is none or more than one.
  std::optional<double> elongation_at(double tension) const;
};

/// The tension with its derivatives and dissipation at an elongation e (m) and its rate (m/s).
struct Tension {
  double tension = 0.0;        // N, damper included
  double by_elongation = 0.0;  // N/m
  double by_rate = 0.0;        // N s/m
  double dissipation = 0.0;    // W, >= 0
};
Tension tension(const ForceLaw& law, double elongation, double rate);
/// A force, N, with its slope over its argument.
struct ForceWithSlope {
  double force = 0.0;
  double slope = 0.0;
};
/// The tension of a spring that can disengage, `engaged` (m, not 0) beyond the end of its loose range: the damper does
/// not reverse the force of the spring.
Tension one_sided_tension(double engaged, double rate, ForceWithSlope spring, ForceWithSlope damper);
/// Stored energy, J: the integral of the tension without the damper from 0 to the elongation.
double stored_energy(const ForceLaw& law, double elongation);

}  // namespace traverse::base
