// The law of a spring and its damper that is not linear: tables, play, one side only.
//
// With the elongation e beyond the free length (of a torsion spring: the twist) and the gap G:
//   |e| <= G:  no force;     |e| > G:  x = e - G sign(e), tension T(x) + D(de/dt).
// One-sided: only for e < -G (compression) or e > G (tension). A spring that lets go, by its side or its gap, never
// changes the sign of its tension: where T + D has not that of x the ends run apart faster than the spring follows
// and the tension is zero. Its damper comes on over the first nanometre of x, without which a stage of an implicit
// method that ends just there would have no solution. What the tension does beyond T is lost, never gained.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace traverse::multibody {

/// Straight lines through points, the first and the last one continued.
class Polyline {
 public:
  /// x strictly increasing, at least two points; throws InputError otherwise.
  Polyline(std::vector<double> x, std::vector<double> y);
  /// y = slope*x.
  static Polyline line(double slope) { return {{0.0, 1.0}, {0.0, slope}}; }

  /// -value(-x).
  Polyline reversed() const;

  double value(double x) const;     // straight lines between the points, the end slopes outside
  double slope(double x) const;     // at a corner the one on its right
  double integral(double x) const;  // of the value, from 0
  /// Where the value is y; nothing unless the lines rise all along.
  std::optional<double> inverse(double y) const;
  /// Why x y < 0 somewhere, in words; empty when it is nowhere.
  std::string opposing() const;

 private:
  std::size_t segment(double x) const;
  double from_start(double x) const;

  std::vector<double> x_, y_;
  std::vector<double> slope_;  // of every segment
  std::vector<double> area_;   // integral from the first point to every other
  double origin_ = 0.0;        // integral from the first point to 0
};

enum class Side { both, compression, tension };

/// For a torsion spring read m as rad and N as N m.
struct ForceLaw {
  Polyline elastic = Polyline::line(0.0);  // T: N over m
  Polyline damper = Polyline::line(0.0);   // D: N over m/s
  double gap = 0.0;                        // m, either way, >= 0
  Side side = Side::both;

  /// The spring is loose in some positions.
  bool lets_go() const { return gap > 0.0 || side != Side::both; }
  /// The elongation at which the spring alone gives a tension; nothing when there is none or more than one.
  std::optional<double> elongation_at(double tension) const;
};

/// At one elongation e (m) and its rate (m/s).
struct Tension {
  double tension = 0.0;        // N, damper included
  double by_elongation = 0.0;  // N/m
  double by_rate = 0.0;        // N s/m
  double dissipation = 0.0;    // W, >= 0
};
Tension tension(const ForceLaw& law, double elongation, double rate);
/// Energy stored: the integral of the tension without damper from 0 on, J.
double stored_energy(const ForceLaw& law, double elongation);

}  // namespace traverse::multibody
