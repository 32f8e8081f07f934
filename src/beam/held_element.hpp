// The deflection inside an element that is clamped at both ends while a foundation acts on it: the response to loads
// inside the element that the cubic shape functions do not contain. With B the bending stiffness, k a bed and springs
// k_p,
//   B w'''' + k w + sum k_p w(s_p) delta(x - s_p) = load,   w = w' = 0 at both ends.
#pragma once

#include <vector>

namespace traverse::beam {

/// A spring inside an element of length h, at xi: N/m, or N m/rad if it resists the rotation.
struct InnerSpring {
  double xi = 0.0;
  double k = 0.0;
  bool rotational = false;
};

/// The deflection at one station of a clamped element over the position of a unit load (an influence line).
class HeldElement {
 public:
  /// EI in N m2; bed in N/m2, 0 without a bed; shear: 12 EI/(GA h^2). For an element with shear the effect of a bed,
  /// about k h^4/(500 EI) of the deflection, is neglected.
  HeldElement(double xi, double h, double EI, double bed, const std::vector<InnerSpring>& springs, double shear = 0.0);

  /// m/N: under an upward unit force at `load`.
  double by_force(double load) const { return sum(load, false); }
  /// m/(N m): under a unit moment, counter-clockwise.
  double by_moment(double load) const { return sum(load, true); }
  /// Positions from 0 to 1, ascending, between which the lines are smooth enough for Gauss' rule.
  std::vector<double> ends() const;

 private:
  /// The influence line of the deflection, or of the rotation, at xi for the element on its bed without springs.
  struct Line {
    double xi = 0.0;
    bool rotation = false;
    double factor = 1.0;
    double ends[4] = {};  // amplitudes of the waves that decay from the left end and from the right end
  };
  Line line(double xi, bool rotation) const;
  /// The value of the line for the load at `load`, or its derivative there, divided by h^3/EI with xi as the length.
  double value(const Line& line, double load, bool slope) const;
  double sum(double load, bool moment) const;

  double h_, EI_, shear_;
  double lambda_;  // h (k/(4 EI))^(1/4); 0: the effect of the bed is negligible
  std::vector<Line> lines_;
};

}  // namespace traverse::beam
