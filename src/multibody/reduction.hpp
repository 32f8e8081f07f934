// The two small factorisations of generalized coordinate partitioning, for mechanisms whose equations contain few
// coordinates each. `plan` determines the order of elimination and the possible non-zeros once. The numerical
// operations then need no search, no operations with zeros and no allocation. Measured on a coach (21 coordinates, 11
// constraints): a whole evaluation takes 1.4 us, dense factorisations and B^T N B alone 2.4 us
// (benchmarks/multibody_benchmark.cpp).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "multibody/sparse_ldl.hpp"

namespace traverse::multibody {

/// The independent coordinates, and the kept rows of Phi (redundant rows are dropped).
struct Partition {
  std::vector<int> independent;  // f indices into q, ascending
  std::vector<int> dependent;    // one for each kept row, ascending
  std::vector<int> rows;         // kept rows of Phi, ascending
  void keep(base::Bytes& bytes) { bytes(independent, dependent, rows); }
};

/// Factors that make the entries of Phi_q comparable: an angle is scaled by a typical arm.
struct Scaling {
  Eigen::VectorXd row;     // scale of a row of Phi, m
  Eigen::VectorXd column;  // scale of a column of Phi_q: 1 for x and y, 1/length for an angle
};

/// The sensitivity of dependent to independent coordinates: value[j] of coordinate[i] for every j in list i.
struct Sensitivity {
  std::vector<int> coordinate;  // coordinate of list i, as index into q
  IndexLists independent;       // 0..f-1, ascending
  std::vector<double> value;

  void keep(base::Bytes& bytes) { bytes(coordinate, independent, value); }
  /// Adds a change of the independent coordinates, whose indices in q are `places`, and its effect on the others to q.
  void add(const Eigen::VectorXd& change, const std::vector<int>& places, Eigen::VectorXd& q) const;
};

/// Number of floating-point operations (+, -, *, / and square roots) of a call, for the planned non-zeros.
struct BlockOperations {
  long factor = 0, sensitivity = 0;  // compute_sensitivity
  long solve = 0;                    // operations of solve or solve_transposed
  long expand = 0;                   // operations of expand or project
};
struct MassOperations {
  long factor = 0, solve = 0;
};

/// LU of Phi_u, the kept rows and dependent columns of Phi_q, and the sensitivity -Phi_u^-1 Phi_p of the dependent to
/// the independent coordinates. Vectors have the numbering of Phi's rows and of q.
class DependentBlock {
 public:
  /// Chooses the order of elimination for the current values. `pattern` (rows x coordinates) is true where Phi_q may be
  /// non-zero.
  void plan(const Eigen::MatrixXd& Phi_q, const std::vector<char>& pattern, const Partition& partition,
            const Scaling& scaling);
  /// Whether the sensitivity has so many non-zeros, as along a chain, that `expand` and `project` cost less by a
  /// solution with the factors than by the matrix. The matrix is then computed only where it is asked for.
  bool many_sensitivities() const { return many_sensitivities_; }
  /// Factorises. Returns false if a pivot is so much smaller than in the plan that a new plan is needed, or if a pivot
  /// is small: at least in this order the block is then nearly singular.
  bool factor(const Eigen::MatrixXd& Phi_q);
  /// Computes the sensitivity; factor must be called before. `expand` and `project` use it until the next
  /// factorisation.
  void compute_sensitivity();
  /// Whether the sensitivity of the last factorisation is computed.
  bool has_sensitivity() const { return has_sensitivity_; }

  /// x_u = Phi_u^-1 rhs; only the dependent entries of x are written.
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x);
  /// y = Phi_u^-T r_u; only the kept entries of y are written.
  void solve_transposed(const Eigen::VectorXd& r, Eigen::VectorXd& y);
  /// x_p = p and x_u = x_u + sensitivity * p.
  void expand(const double* p, Eigen::VectorXd& x);
  /// The projection B^T r.
  void project(const Eigen::Ref<const Eigen::VectorXd>& r, Eigen::Ref<Eigen::VectorXd> reduced);
  /// Writes the sensitivity into the dependent rows of B (n x f); the other rows of B remain unchanged.
  void scatter(Eigen::MatrixXd& B) const;
  /// The largest scaled sensitivity.
  double largest_sensitivity(const Scaling& scaling) const;
  /// Whether a scaled pivot of the last factorisation is so small that rounding errors affect accelerations.
  bool nearly_singular() const { return least_pivot_ < small_pivot; }
  void copy_sensitivity(Sensitivity& copy) const;
  BlockOperations operations() const;

  int size() const { return static_cast<int>(row_of_.size()); }
  int freedom() const { return static_cast<int>(independent_.size()); }
  int coordinate(int pivot) const { return column_of_[pivot]; }
  int independent(int k) const { return independent_[k]; }
  /// The independent coordinates (0..f-1, ascending) that affect the coordinate of a pivot, and the sensitivities to
  /// them.
  const int* sensitivity_begin(int pivot) const { return sensitive_.begin(pivot); }
  const int* sensitivity_end(int pivot) const { return sensitive_.end(pivot); }
  const double* sensitivities(int pivot) const { return sensitivity_.data() + pivot * freedom(); }
  double sensitivity(int pivot, int k) const { return sensitivities(pivot)[k]; }
  /// Sets the sensitivity from B (n x f).
  void set_sensitivity(const Eigen::Ref<const Eigen::MatrixXd>& B);
  void keep(base::Bytes& bytes) {
    bytes(row_of_, column_of_, independent_, lower_, upper_, sensitive_, block_sources_, sensitivity_sources_, block_,
          by_independent_, sensitivity_, inverse_pivot_, planned_pivot_, pivot_scale_, work_, least_pivot_,
          many_sensitivities_, has_sensitivity_);
  }

 private:
  static constexpr double small_pivot = 3e-3;
  struct Source {
    int from;  // index in Phi_q's storage
    int to;    // index in block_ or sensitivity_
  };
  bool by_factors() const { return many_sensitivities_ && !has_sensitivity_; }
  void solve_work();
  void solve_work_transposed();
  void choose_order(const Eigen::MatrixXd& Phi_q, const Partition& partition, const Scaling& scaling);
  void find_fill(const std::vector<char>& pattern, int rows);
  void find_sensitive(const std::vector<char>& pattern, int rows);
  double& block(int i, int j) { return block_[i * size() + j]; }

  std::vector<int> row_of_, column_of_, independent_;  // row, column and independent coordinate of pivot k
  IndexLists lower_, upper_, sensitive_;               // non-zero columns of every pivot's row
  std::vector<Source> block_sources_, sensitivity_sources_;
  std::vector<double> block_, sensitivity_;  // size x size, size x freedom, by rows
  std::vector<double> by_independent_;       // Phi_p: an entry for each of sensitivity_sources_
  std::vector<double> inverse_pivot_, planned_pivot_, pivot_scale_, work_;
  double least_pivot_ = 1.0;
  bool many_sensitivities_ = false, has_sensitivity_ = false;
  std::vector<char> filled_;  // workspace of plan
};

/// L D L^T of the projected mass matrix B^T N B, with the elimination order of least fill.
class ReducedMass {
 public:
  void plan(const DependentBlock& block);
  /// compute_sensitivity must be called before.
  void factor(const DependentBlock& block, const Eigen::VectorXd& mass);
  void solve(Eigen::VectorXd& x);  // in place
  MassOperations operations(const DependentBlock& block) const;
  void keep(base::Bytes& bytes) { bytes(ldl_, diagonal_, target_); }

 private:
  SparseLdl ldl_;
  std::vector<int> diagonal_, target_;  // indices of the results of factor, in the order of its operations
  std::vector<char> filled_;            // workspace of plan
};

}  // namespace traverse::multibody
