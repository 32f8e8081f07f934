// The two small factorisations behind generalized coordinate partitioning, made for mechanisms whose equations touch
// few coordinates each. The order of elimination and the places that can be non-zero are found once (`plan`), the
// numbers are then computed without a search, without touching a zero and without allocating. Measured on a coach
// (21 coordinates, 11 constraints): a whole evaluation takes 1.4 us, dense factorisations and B^T N B alone 2.4 us
// (benchmarks/multibody_benchmark.cpp).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "multibody/sparse_ldl.hpp"

namespace traverse::multibody {

/// Which coordinates are independent, and which rows of Phi are kept (redundant ones are dropped).
struct Partition {
  std::vector<int> independent;  // f indices into q, ascending
  std::vector<int> dependent;    // as many as kept rows, ascending
  std::vector<int> rows;         // kept rows of Phi, ascending
  void keep(base::Bytes& bytes) { bytes(independent, dependent, rows); }
};

/// Weights that make the entries of Phi_q comparable: an angle counts as the way it makes at a typical arm.
struct Scaling {
  Eigen::VectorXd row;     // times a row of Phi: m
  Eigen::VectorXd column;  // times q's unit: 1 for x and y, 1/length for an angle
};

/// How dependent coordinates follow the independent ones: coordinate[i] by value[j] for every j in its list.
struct Sensitivity {
  std::vector<int> coordinate;  // of list i, in the numbering of q
  IndexLists independent;       // 0..f-1, ascending
  std::vector<double> value;

  void keep(base::Bytes& bytes) { bytes(coordinate, independent, value); }
  /// Moves q by a change of the independent coordinates, which stand at `places`.
  void add(const Eigen::VectorXd& change, const std::vector<int>& places, Eigen::VectorXd& q) const;
};

/// How many floating-point operations (+, -, *, / and square roots count one each) a call takes, from the places that
/// are computed with.
struct BlockOperations {
  long factor = 0, sensitivity = 0;  // compute_sensitivity
  long solve = 0;                    // or solve_transposed
  long expand = 0;                   // or project
};
struct MassOperations {
  long factor = 0, solve = 0;
};

/// LU of Phi_u, the kept rows and dependent columns of Phi_q, and the sensitivity -Phi_u^-1 Phi_p of the dependent
/// to the independent coordinates. Vectors are given in the numbering of Phi's rows and of q.
class DependentBlock {
 public:
  /// Chooses the order of elimination at the current numbers. `pattern` (rows x coordinates) is true where Phi_q can
  /// ever be non-zero.
  void plan(const Eigen::MatrixXd& Phi_q, const std::vector<char>& pattern, const Partition& partition,
            const Scaling& scaling);
  /// Factors. False when a pivot has shrunk so much since the plan was made that a new one is due, or is small: in its
  /// order at least the block is nearly singular then.
  bool factor(const Eigen::MatrixXd& Phi_q);
  /// Computes the sensitivity; after factor.
  void compute_sensitivity();

  /// x_u = Phi_u^-1 rhs; only the dependent places of x are written.
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x);
  /// y = Phi_u^-T r_u; only the kept places of y are written.
  void solve_transposed(const Eigen::VectorXd& r, Eigen::VectorXd& y);
  /// x_p = p and x_u = x_u + sensitivity * p.
  void expand(const double* p, Eigen::VectorXd& x) const;
  /// The projection B^T r.
  void project(const Eigen::Ref<const Eigen::VectorXd>& r, Eigen::Ref<Eigen::VectorXd> reduced) const;
  /// Writes the sensitivity into the dependent rows of B (n x f); the rest of B is left alone.
  void scatter(Eigen::MatrixXd& B) const;
  /// The largest scaled sensitivity.
  double largest_sensitivity(const Scaling& scaling) const;
  /// Whether some scaled pivot of the last factorisation has become so small that rounding shows in accelerations.
  bool nearly_singular() const { return least_pivot_ < small_pivot; }
  void copy_sensitivity(Sensitivity& copy) const;
  BlockOperations operations() const;

  int size() const { return static_cast<int>(row_of_.size()); }
  int freedom() const { return static_cast<int>(independent_.size()); }
  int coordinate(int pivot) const { return column_of_[pivot]; }
  int independent(int k) const { return independent_[k]; }
  /// The independent coordinates (0..f-1, ascending) that pivot's coordinate depends on, and how much on each of them.
  const int* sensitivity_begin(int pivot) const { return sensitive_.begin(pivot); }
  const int* sensitivity_end(int pivot) const { return sensitive_.end(pivot); }
  const double* sensitivities(int pivot) const { return sensitivity_.data() + pivot * freedom(); }
  double sensitivity(int pivot, int k) const { return sensitivities(pivot)[k]; }
  /// Takes the sensitivity from B (n x f).
  void set_sensitivity(const Eigen::Ref<const Eigen::MatrixXd>& B);
  void keep(base::Bytes& bytes) {
    bytes(row_of_, column_of_, independent_, lower_, upper_, sensitive_, block_sources_, sensitivity_sources_, block_,
          sensitivity_, inverse_pivot_, planned_pivot_, pivot_scale_, work_, least_pivot_);
  }

 private:
  static constexpr double small_pivot = 3e-3;
  struct Source {
    int from;  // in Phi_q's storage
    int to;    // in block_ or sensitivity_
  };
  void choose_order(const Eigen::MatrixXd& Phi_q, const Partition& partition, const Scaling& scaling);
  void find_fill(const std::vector<char>& pattern, int rows);
  void find_sensitive(const std::vector<char>& pattern, int rows);
  double& block(int i, int j) { return block_[i * size() + j]; }

  std::vector<int> row_of_, column_of_, independent_;  // of pivot k
  IndexLists lower_, upper_, sensitive_;               // non-zero columns of every pivot's row
  std::vector<Source> block_sources_, sensitivity_sources_;
  std::vector<double> block_, sensitivity_;  // size x size, size x freedom, by rows
  std::vector<double> inverse_pivot_, planned_pivot_, pivot_scale_, work_;
  double least_pivot_ = 1.0;
  std::vector<char> filled_;  // scratch of plan
};

/// L D L^T of the projected mass matrix B^T N B, eliminated in the order of least fill.
class ReducedMass {
 public:
  void plan(const DependentBlock& block);
  /// After compute_sensitivity.
  void factor(const DependentBlock& block, const Eigen::VectorXd& mass);
  void solve(Eigen::VectorXd& x);  // in place
  MassOperations operations(const DependentBlock& block) const;
  void keep(base::Bytes& bytes) { bytes(ldl_, diagonal_, target_); }

 private:
  SparseLdl ldl_;
  std::vector<int> diagonal_, target_;  // where the products of factor go, in their order
  std::vector<char> filled_;            // scratch of plan
};

}  // namespace traverse::multibody
