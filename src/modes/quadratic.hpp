// The damped modes of one segment: lambda^2 M + lambda C + K, C = a M + b K + D.
#pragma once

#include <Eigen/Dense>
#include <complex>
#include <vector>

#include "segment.hpp"

namespace traverse::modes {

struct DampedPair {
  std::complex<double> lambda;              // 1/s, Im >= 0
  std::vector<std::complex<double>> shape;  // of each unknown of the segment
};

/// The inverse of the linearised problem. With z = lambda x, lambda (x, z) = A (x, z) where
///
///   A (x, z) = (z, -M^-1 (C z + K x)),   A^-1 (x, z) = (-K^-1 (C x + M z), x),
///
/// so the lowest lambda are the largest eigenvalues 1/lambda of A^-1, and the highest frequencies of the mesh do not
/// spoil them. K is singular where there are rigid motions Phi, lambda = 0. The other modes obey
///
///   Phi^T (C x + M z) = 0, and Phi0^T M x = 0 for those motions Phi0 that nothing damps (C Phi0 = 0),
///
/// which follows from their equation times Phi^T. On what obeys that, A has an inverse, and this is it.
class Inverse {
 public:
  /// Throws SolverError when K, without its rigid motions, is singular to rounding.
  Inverse(const Segment& segment, beam::Rayleigh ab);

  int size() const { return 2 * unknowns(); }
  /// How many eigenvalues of A are not the zeros of the rigid motions.
  int moving() const { return size() - rigid() - still_; }
  /// state and result: sqrt(M_ii) x and sqrt(M_ii) z/scale, all of one unit and of like size.
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
  /// K with the unknowns that hold the rigid motions taken out, as many as there are motions.
  Band held_stiffness();
  /// What the rigid motions add to x', so that it obeys what the other modes obey; x = lambda x'.
  void add_motions(const Eigen::VectorXd& x, Eigen::VectorXd& x_new) const;

  const Segment& s_;
  beam::Rayleigh ab_;
  double scale_ = 1.0;              // 1/s, of the lowest lambda
  Eigen::VectorXd root_mass_;       // sqrt(M_ii)
  Eigen::MatrixXd motions_;         // Phi, one a column, the still ones Phi0 first; Phi^T M Phi = 1
  Eigen::MatrixXd mass_motions_;    // M Phi
  Eigen::MatrixXd damped_motions_;  // C Phi
  Eigen::VectorXd rates_;           // the diagonal matrix Phi^T C Phi, 1/s
  int still_ = 0;                   // motions in Phi0
  std::vector<int> held_;           // unknowns
  Factor stiffness_{Band()};
};

/// The modes of the segment with the `count` lowest |lambda|, the rigid ones included, ascending. With b, none from
/// |lambda| = 1/|b| on. Needs nothing from other ranks, and gives the same bits on each. Throws SolverError.
std::vector<DampedPair> lowest_damped(const Segment& segment, beam::Rayleigh ab, int count);

}  // namespace traverse::modes
