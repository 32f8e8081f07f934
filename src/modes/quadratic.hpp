// The damped modes of one segment: (lambda^2 M + lambda C + K) x = 0, C = a M + b K + D with the matrix D of the
// foundation's dampers, which are added to Rayleigh damping.
#pragma once

#include <Eigen/Dense>
#include <complex>
#include <vector>

#include "segment.hpp"

namespace traverse::modes {

struct DampedPair {
  std::complex<double> lambda;              // 1/s, Im >= 0
  std::vector<std::complex<double>> shape;  // for each unknown of the segment
};

/// The inverse of the linearised problem. With z = lambda x, lambda (x, z) = A (x, z) where
///
///   A (x, z) = (z, -M^-1 (C z + K x)),   A^-1 (x, z) = (-K^-1 (C x + M z), x),
///
/// so that the lowest lambda are the largest eigenvalues 1/lambda of A^-1 and are not affected by the highest
/// frequencies of the mesh. K is singular if there are rigid motions Phi, lambda = 0. The other modes satisfy
///
///   Phi^T (C x + M z) = 0, and Phi0^T M x = 0 for the undamped rigid motions Phi0 (C Phi0 = 0),
///
/// which follows from their equation times Phi^T. In the subspace of these conditions A has an inverse, which is this
/// class.
class Inverse {
 public:
  /// Throws SolverError if K without its rigid motions is singular to rounding.
  Inverse(const Segment& segment, beam::Rayleigh ab);

  int size() const { return 2 * unknowns(); }
  /// Number of eigenvalues of A without the zeros of the rigid motions.
  int nonrigid() const { return size() - rigid() - undamped_; }
  /// state and result are sqrt(M_ii) x and sqrt(M_ii) z/scale, which have the same unit and similar magnitudes.
  void apply(const double* state, double* result) const;
  /// x of a state.
  template <class Number>
  std::vector<Number> shape(std::vector<Number> state) const {
    state.resize(static_cast<std::size_t>(unknowns()));
    for (int i = 0; i < unknowns(); ++i) state[static_cast<std::size_t>(i)] /= root_mass_[i];
    return state;
  }

 private:
  int unknowns() const { return s_.size(); }
  int rigid() const { return static_cast<int>(motions_.cols()); }
  void prepare_motions();
  /// K without as many unknowns as there are rigid motions; holding these unknowns prevents the rigid motions.
  Band restrained_stiffness();
  /// Adds rigid motions to x' so that it satisfies the conditions of the other modes; x = lambda x'.
  void add_motions(const Eigen::VectorXd& x, Eigen::VectorXd& x_new) const;

  const Segment& s_;
  beam::Rayleigh ab_;
  double scale_ = 1.0;              // 1/s, magnitude of the lowest lambda
  Eigen::VectorXd root_mass_;       // sqrt(M_ii)
  Eigen::MatrixXd motions_;         // Phi, one per column, the undamped ones Phi0 first; Phi^T M Phi = 1
  Eigen::MatrixXd mass_motions_;    // M Phi
  Eigen::MatrixXd damped_motions_;  // C Phi
  Eigen::VectorXd rates_;           // the diagonal matrix Phi^T C Phi, 1/s
  int undamped_ = 0;                // number of motions in Phi0
  std::vector<int> held_;           // unknowns
  Factor stiffness_{Band()};
};

/// The modes of the segment with the `count` lowest |lambda|, including the rigid ones, ascending. If b is not 0, only
/// modes with |lambda| < 1/|b|. There is no communication; the result is identical on all ranks. Throws SolverError.
std::vector<DampedPair> lowest_damped(const Segment& segment, beam::Rayleigh ab, int count);

}  // namespace traverse::modes
