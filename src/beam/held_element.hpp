// The deflection inside an element that is held at both ends (no deflection, no rotation there) while a foundation acts
// on it: what the cubic shape functions leave out of the answer to the loads inside. With B the bending stiffness, k a
// bed and springs k_p,
//   B w'''' + k w + sum k_p w(s_p) delta(x - s_p) = load,   w = w' = 0 at both ends.
#pragma once

#include <vector>

namespace traverse::beam {

/// A spring inside an element of length h, at xi: N/m, or N m/rad where it holds the rotation.
struct InnerSpring {
  double xi = 0.0;
  double k = 0.0;
  bool rotational = false;
};

/// The deflection at one station of a held element, as a line over the place of what acts on it.
class HeldElement {
 public:
  /// EI in N m2; bed in N/m2, 0 where there is none; shear: 12 EI/(GA h^2). What a bed does to the deflection of an
  /// element that shears is left out: about k h^4/(500 EI) of it.
  HeldElement(double xi, double h, double EI, double bed, const std::vector<InnerSpring>& springs, double shear = 0.0);

  /// m/N: under a unit force upward at `load`.
  double by_force(double load) const { return sum(load, false); }
  /// m/(N m): under a unit moment, counter-clockwise.
  double by_moment(double load) const { return sum(load, true); }
  /// Ascending from 0 to 1: between them the lines are smooth enough for Gauss' rule.
  std::vector<double> ends() const;

 private:
  /// Of the element on its bed alone: the deflection, or the rotation, at xi.
  struct Line {
    double xi = 0.0;
    bool rotation = false;
    double factor = 1.0;
    double ends[4] = {};  // what the held ends add: of the waves that fade from the left end, from the right one
  };
  Line line(double xi, bool rotation) const;
  /// Divided by h^3/EI, with xi as the length: of the load at `load`, or its derivative there.
  double value(const Line& line, double load, bool slope) const;
  double sum(double load, bool moment) const;

  double h_, EI_, shear_;
  double lambda_;  // h (k/(4 EI))^(1/4); 0: the bed is too soft to count
  std::vector<Line> lines_;
};

}  // namespace traverse::beam
