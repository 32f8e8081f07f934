// Forces inside the beam elements, K_aa v (eqs. 9 and 12), from the relative displacement of each element's ends: the
// nodal values less the rigid motion of the element. What rounding leaves is a part of these forces, not of the far
// larger terms that cancel in a product with the assembled matrix, and the forces on an element's ends balance exactly.
#pragma once

#include <cstddef>
#include <vector>

#include "beam/beam.hpp"

namespace traverse::beam {

class InternalForces {
 public:
  explicit InternalForces(const Beam& beam);

  /// r += sign*K x for this rank's unknowns, held ones included (their rows mean nothing). `left` and `right`: the
  /// values of the columns next to this rank's, null where there are none.
  /// Real: the type to calculate in, double or long double.
  template <class Real = double>
  void add(double sign, const double* x, const double* left, const double* right, double* r) const;

 private:
  /// Forces and moment at the left end from t = (v2 - v1 - h theta1, theta2 - theta1): {A, B; C, D} t; N and N m.
  /// Along x: S (u2 - u1). All zero between separate spans.
  struct Stiffness {
    double h, A, B, C, D, S;
    std::ptrdiff_t theta1, u1;  // their places in the left column: beside a hinge or an expansion device other ones
  };
  struct Run {
    int first = 0;  // local column of its first element's left node, -1: a neighbour rank's
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
