// Gaussian elimination on sparse rows, one pivot at a time, for the choice of pivots.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace traverse::multibody {

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
