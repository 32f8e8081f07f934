// Forces inside the beam elements, K_aa v (eqs. 9 and 12), from the relative displacement of each element's ends: the
// nodal values minus the rigid motion of the element. The rounding error is then relative to these forces, not to the
// far larger terms that cancel in a product with the assembled matrix, and the forces on an element's ends balance
// exactly.
#pragma once

#include <cstddef>
#include <vector>

#include "beam/beam.hpp"

namespace traverse::beam {

class InternalForces {
 public:
  explicit InternalForces(const Beam& beam);

  /// r += sign*K x for this rank's unknowns, including held ones, whose rows are not meaningful. `left` and `right` are
  /// the values of the columns next to this rank's, null at the ends of the beam. Real is the type of the computation,
  /// double or long double.
  template <class Real = double>
  void add(double sign, const double* x, const double* left, const double* right, double* r) const;

 private:
  /// Forces and moment at the left end from t = (v2 - v1 - h theta1, theta2 - theta1): {A, B; C, D} t; N and N m.
  /// Along x: S (u2 - u1). All zero between separate spans.
  struct Stiffness {
    double h, A, B, C, D, S;
    std::ptrdiff_t theta1, u1;  // indices in the left column, which differ at a hinge or an expansion device
  };
  struct Run {
    int first = 0;  // local column of its first element's left node; -1: a column of the neighbour rank
    int u = -1, v = 0, theta = 0;
    std::vector<Stiffness> elements;
  };
  Run run_of(const Beam& beam, const Line& line) const;
  template <class Real, bool axial>
  void add_run(const Run& run, double sign, const double* x, const double* left, const double* right, double* r) const;

  int block_, local_;
  std::vector<Run> runs_;
};

}  // namespace traverse::beam
