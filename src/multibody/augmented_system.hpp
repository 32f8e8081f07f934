// The equations of motion of a mechanism with their multipliers as one sparse matrix,
//
//   [ K      Phi_q^T ] [ x  ]   [ r ]
//   [ Phi_q  0       ] [ mu ] = [ 0 ]
//
// where K (n x n) couples bodies that a force element or a joint connects. Its solution is x = B (B^T K B)^-1 B^T r:
// that of the equations projected by generalized coordinate partitioning (equation 42 of the paper), without B. Along a
// chain of bodies B is full, but this matrix is not: the cost grows linearly with the number of links.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "multibody/force_element.hpp"
#include "multibody/sparse_ldl.hpp"

namespace traverse::multibody {

/// The bodies, couplings and constraints that determine where the matrix has entries.
struct AugmentedPattern {
  int bodies = 0;
  std::vector<std::array<int, 2>> pairs;  // coupled bodies; a pair may occur several times
  std::vector<std::vector<int>> rows;     // coordinates (0..n-1) with an entry in each kept row of Phi_q
};

/// LU factorisation without pivoting: bodies are eliminated before the constraints that hold them.
class AugmentedSystem {
 public:
  void plan(const AugmentedPattern& pattern);
  bool planned() const { return !order_.empty(); }
  void set_zero();
  /// K += factor * diag(mass).
  void add_mass(const Eigen::VectorXd& mass, double factor);
  /// K += factor * first * second^T in the coordinates of a body.
  void add_to_body(int body, double factor, const std::array<double, 3>& first, const std::array<double, 3>& second);
  /// K += `matrix` of pair number `pair` of the pattern; parts of the ground are ignored.
  void add_pair(int pair, const PairMatrix& matrix);
  /// Sets Phi_q, of which the kept rows are `rows`.
  void set_constraints(const Eigen::MatrixXd& Phi_q, const std::vector<int>& rows);
  /// False unless K is positive definite in all motions that the constraints allow and in those of each body.
  bool factor();
  /// Replaces r (n) by x.
  void solve(Eigen::VectorXd& r);
  void keep(base::Bytes& bytes) {
    bytes(bodies_, order_, place_, lower_, upper_, diagonal_, pair_entry_, constraint_entry_, updated_, entries_,
          inverse_, work_);
  }

 private:
  std::vector<std::vector<int>> find_order(const AugmentedPattern& pattern);
  void find_updates(const AugmentedPattern& pattern);
  int entry(int i, int j) const;

  struct ConstraintEntry {
    int row, column;   // of the kept rows, of the coordinates
    int below, above;  // entries of Phi_q and of its transpose
  };
  int bodies_ = 0;
  std::vector<int> order_, place_;  // unknown of each pivot, and the inverse: coordinates first, then kept rows
  IndexLists lower_, upper_;        // pivots with an entry to the left and to the right of each pivot
  std::vector<int> diagonal_;       // entry of each pivot; its row begins with lower_, and upper_ follows
  std::vector<std::array<int, 36>> pair_entry_;  // -1: ground
  std::vector<ConstraintEntry> constraint_entry_;
  std::vector<int> updated_;  // entries changed by the elimination, in its order
  std::vector<double> entries_, inverse_, work_;
};

}  // namespace traverse::multibody
