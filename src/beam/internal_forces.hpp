// Forces inside the beam elements, K_aa v (eqs. 9 and 12), from the relative displacement of each element's ends: the
// nodal values minus the rigid motion of the element. The rounding error is then relative to these forces, not to the
// far larger terms that cancel in a product with the assembled matrix, and the forces on an element's ends balance
// exactly. Time steps compute them for many elements at a time.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "beam/beam.hpp"
#include "beam/line.hpp"
#include "solve/repeats.hpp"

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
  /// Along x: S (u2 - u1). Of the twist: T (twist2 - twist1), N m. All zero between separate spans.
  struct Stiffness {
    double h, A, B, C, D, S, T;
    std::ptrdiff_t theta1, u1;  // indices in the left column, which differ at a hinge or an expansion device
  };
  struct Run {
    int first = 0;  // local column of its first element's left node; -1: a column of the neighbour rank
    int u = -1, v = 0, theta = 0, twist = -1;
    std::vector<Stiffness> elements;
  };
  Run run_of(const Beam& beam, const Line& line) const;
  template <class Real, bool axial>
  void add_run(const Run& run, double sign, const double* x, const double* left, const double* right, double* r) const;
  template <class Real>
  void add_twist(const Run& run, double sign, const double* x, const double* left, const double* right,
                 double* r) const;

  int block_, local_;
  std::vector<Run> runs_;
};

/// The same forces for many elements at a time. A time step computes them for a few nodes in the cache. The
/// coefficients of elements that repeat along the beam are stored once.
class ElementRows {
 public:
  /// Whether the beam has no hinges and no expansion devices, whose nodes have an additional unknown.
  static bool fit(const Beam& beam) {
    const auto& place = beam.layout().place;
    return place[theta_right] < 0 && place[rail_theta_right] < 0 && place[rail_u_right] < 0;
  }
  explicit ElementRows(const Beam& beam);

  /// r += K_aa x for this rank's nodes [first, past), at most `tile`. x begins at node first - 1 and ends at node past;
  /// its values outside the beam have no effect but must be finite. `r` begins at node first.
  void add(int first, int past, const Planes& x, const Planes& r) const;

 private:
  // The coefficients h, A, B, C, D, S and T of InternalForces for each element. Element j is between the local nodes
  // j - 1 and j; its coefficients are zero if there is no element.
  static constexpr int numbers = 7;
  struct Run {
    int u, v, theta, twist;  // places in a column
    std::array<std::vector<double>, numbers> coefficients;
    solve::StoredSequence stored;
  };
  static Run run_of(const Beam& beam, const Line& line);
  template <bool axial>
  static void add_run(const Run& run, int first, int past, const Planes& x, const Planes& r);
  static void add_twist(const Run& run, int first, int past, const Planes& x, const Planes& r);

  std::vector<Run> runs_;
};

}  // namespace traverse::beam
