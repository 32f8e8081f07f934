// L D L^T of a small symmetric positive definite matrix with few non-zeros, with the elimination order of least fill.
// The order and the possible non-zeros are determined once. The numerical operations then process no zeros and allocate
// no memory.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "base/bytes.hpp"

namespace traverse::multibody {

/// Several lists of indices in one array; list i is [begin(i), end(i)).
struct IndexLists {
  std::vector<int> start = {0};
  std::vector<int> index;
  const int* begin(int i) const { return index.data() + start[i]; }
  const int* end(int i) const { return index.data() + start[i + 1]; }
  void clear() {
    start.resize(1);
    index.clear();
  }
  void close() { start.push_back(static_cast<int>(index.size())); }
  void keep(base::Bytes& bytes) { bytes(start, index); }
};

class SparseLdl {
 public:
  /// `filled` (size x size, symmetric) is true where the matrix may be non-zero; it is overwritten.
  void plan(int size, std::vector<char>& filled);
  void set_zero();
  /// Entry (i, j) of the matrix, for additions. Use only one of (i, j) and (j, i), no matter which.
  double& entry(int i, int j) { return entries_[entry_index(i, j)]; }
  /// Access to an entry in two calls: its index, which is constant, and the entries by index.
  int entry_index(int i, int j) const {
    const int a = place_[i], b = place_[j];
    return a < b ? a * size() + b : b * size() + a;
  }
  double* entries() { return entries_.data(); }
  void factor();
  void solve(double* x);  // in place

  long factor_operations() const;
  long solve_operations() const;

  int size() const { return static_cast<int>(order_.size()); }
  void keep(base::Bytes& bytes) { bytes(order_, place_, below_, entries_, inverse_); }

 private:
  std::vector<int> order_, place_;  // index of the k-th elimination, and the inverse
  IndexLists below_;                // non-zero rows below the diagonal, by columns
  std::vector<double> entries_;     // size x size, by columns
  std::vector<double> inverse_;     // 1/D
  std::vector<double> work_;
};

/// Gaussian elimination on sparse rows, one pivot at a time, for the choice of pivots.
class ActiveRows {
 public:
  struct Entry {
    int column;
    double value;
  };

  /// Stores the non-zero entries of A.
  void assign(const Eigen::MatrixXd& A);

  int rows() const { return static_cast<int>(rows_.size()); }
  int columns() const { return static_cast<int>(count_.size()); }
  bool active(int row) const { return active_[row] != 0; }
  /// Entries of an active row, in ascending order of columns.
  const std::vector<Entry>& row(int i) const { return rows_[i]; }
  /// Number of active rows with an entry in this column.
  int count(int column) const { return count_[column]; }

  /// Eliminates a pivot: its row becomes inactive, and the other rows have no entry in its column.
  void eliminate(int row, int column);

 private:
  std::vector<std::vector<Entry>> rows_;
  std::vector<char> active_;
  std::vector<int> count_;
  std::vector<Entry> merged_;
};

}  // namespace traverse::multibody
