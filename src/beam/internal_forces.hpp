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

/// The forces at the ends of an element that twists, from the difference d of the twists and the rates r1, r2:
///   torque on the left node  T d + A r1 + B r2   (on the right one the opposite),
///   moments of the rates     -A d + C r1 + D r2  and  -B d + D r1 + E r2.
struct TwistForces {
  double T = 0.0, A = 0.0, B = 0.0, C = 0.0, D = 0.0, E = 0.0;

  TwistForces() = default;
  /// From the stiffness of (twist1, rate1, twist2, rate2).
  explicit TwistForces(const Transverse& k) : T(k[2]), A(k[1]), B(k[3]), C(k[5]), D(k[7]), E(k[15]) {}
  /// {torque on the left node, moment of the left rate, moment of the right one}.
  template <class Real>
  std::array<double, 3> of(Real d, Real r1, Real r2) const {
    return {static_cast<double>(Real(T) * d + Real(A) * r1 + Real(B) * r2),
            static_cast<double>(-Real(A) * d + Real(C) * r1 + Real(D) * r2),
            static_cast<double>(-Real(B) * d + Real(D) * r1 + Real(E) * r2)};
  }
  bool operator==(const TwistForces&) const = default;
};

/// Places in a column of the twist, of its rate at an element's left end, and of that at its right end; -1: none.
struct TwistPlaces {
  explicit TwistPlaces(const Line& line)
      : twist(line.place[5]), left_rate(line.place[line.place[7] >= 0 ? 7 : 6]), right_rate(line.place[6]) {}
  int twist, left_rate, right_rate;
};

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
    TwistPlaces twist;
    std::vector<Stiffness> elements = {};
    std::vector<TwistForces> twisting = {};  // of each element, only with torsion
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
  // The coefficients h, A, B, C, D and S of InternalForces for each element, and those of its twist. Element j is
  // between the local nodes j - 1 and j; its coefficients are zero if there is no element.
  static constexpr int numbers = 6;
  struct Run {
    int u, v, theta;  // places in a column
    TwistPlaces twist;
    std::array<std::vector<double>, numbers> coefficients;
    std::vector<TwistForces> twisting;  // only with torsion
    solve::StoredSequence stored;
  };
  static Run run_of(const Beam& beam, const Line& line);
  template <bool axial>
  static void add_run(const Run& run, int first, int past, const Planes& x, const Planes& r);
  static void add_twist(const Run& run, int first, int past, const Planes& x, const Planes& r);

  std::vector<Run> runs_;
};

}  // namespace traverse::beam
