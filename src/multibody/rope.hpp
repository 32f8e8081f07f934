// A rope that runs through points on bodies and over a drum, with its derivatives and energy. One tension T acts along
// the whole path. With e(q, t) = L(q) - L0(q, t), the length of the path minus the unstretched length,
//
//   T = k e + c e' >= 0,   k given or EA/L0,   g = -T de/dq
//
// where g is a part of the generalized forces in equation 42 of the paper.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "multibody/force_element.hpp"

namespace traverse::multibody {

/// Vectors and matrices of a rope contain x, y, phi of each of its bodies, in the order of RopeGeometry::bodies.
using RopeVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * most_bodies_of_a_rope, 1>;
using RopeMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * most_bodies_of_a_rope, 3 * most_bodies_of_a_rope>;

/// The state of a rope at an instant.
struct RopeState {
  RopeVector by_q;                // de/dq, m/m and m/rad
  RopeVector unstretched_by_q;    // dL0/dq
  double length = 0.0;            // m, L
  double unstretched = 0.0;       // m, L0
  double unstretched_rate = 0.0;  // m/s
  double winding_rate = 0.0;      // m/s, the part of the winch
  double elastic = 0.0;           // N, k e, or 0 of a slack rope
  base::Tension tension;          // with the derivatives by e and e'
};

class RopeGeometry {
 public:
  /// `frames`: the ground, then the bodies, at t = 0.
  RopeGeometry(const Rope& rope, const std::vector<Frame>& frames);

  /// The bodies that the rope moves, each once.
  const std::vector<int>& bodies() const { return bodies_; }
  bool select_side(double t) { return winding_ != nullptr && winding_->select_side(t); }

  /// The state at time t (s) with the frames of the ground and of the bodies. Throws SolverError if the rope is wound
  /// up entirely.
  RopeState state(const std::vector<Frame>& frames, double t) const;
  /// by_q dg/dq + by_qd dg/dq'.
  RopeMatrix tangent(const std::vector<Frame>& frames, const RopeState& at, double by_q, double by_qd) const;
  /// Calls use(first, second, K) for pairs of its bodies, the second of a single one the ground: with K of x1 y1 phi1
  /// x2 y2 phi2 the sum is `all`.
  template <class Use>
  void each_pair(const RopeMatrix& all, Use use) const;
  /// A matrix of zeros of the rope's size.
  RopeMatrix no_tangent() const {
    const Eigen::Index size = 3 * static_cast<Eigen::Index>(bodies_.size());
    return RopeMatrix::Zero(size, size);
  }
  /// Stored energy of the rope that is not wound up, J.
  double strain_energy(const RopeState& at) const;
  /// Power of the winch, W, minus the power by which stretched rope takes its energy onto winch and drum.
  double work(const RopeState& at) const;

 private:
  std::vector<int> bodies_;
  std::vector<SpringGeometry> falls_;            // between neighbouring points, each with a tension of 1 N
  double stiffness_;                             // N/m, without EA
  double axial_rigidity_;                        // N, EA, or 0
  double damping_;                               // N s/m
  double free_length_;                           // m, at t = 0
  std::shared_ptr<base::TimeFunction> winding_;  // null: none
  int drum_, carrier_;                           // bodies
  double drum_radius_;                           // m
  double drum_angle_;                            // rad, of the drum relative to its carrier at t = 0
  int slot(int body) const;                      // of the body in a RopeVector
};

template <class Use>
void RopeGeometry::each_pair(const RopeMatrix& all, Use use) const {
  const auto count = static_cast<Eigen::Index>(bodies_.size());
  PairMatrix K = PairMatrix::Zero();
  if (count == 1) {
    K.topLeftCorner<3, 3>() = all;
    use(bodies_[0], ground, K);
  }
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = i + 1; j < count; ++j) {
      K.setZero();
      if (j == i + 1) K.topLeftCorner<3, 3>() = all.block<3, 3>(3 * i, 3 * i);
      if (j == i + 1 && j + 1 == count) K.bottomRightCorner<3, 3>() = all.block<3, 3>(3 * j, 3 * j);
      K.topRightCorner<3, 3>() = all.block<3, 3>(3 * i, 3 * j);
      K.bottomLeftCorner<3, 3>() = all.block<3, 3>(3 * j, 3 * i);
      use(bodies_[static_cast<std::size_t>(i)], bodies_[static_cast<std::size_t>(j)], K);
    }
}

}  // namespace traverse::multibody
