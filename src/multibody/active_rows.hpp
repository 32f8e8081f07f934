// Gaussian elimination on sparse rows, one pivot at a time: for choosing pivots, not for speed of numbers.
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

  /// The non-zero entries of A.
  void assign(const Eigen::MatrixXd& A);

  int rows() const { return static_cast<int>(rows_.size()); }
  int columns() const { return static_cast<int>(count_.size()); }
  bool active(int row) const { return active_[row] != 0; }
  /// Entries of an active row, ascending in column.
  const std::vector<Entry>& row(int i) const { return rows_[i]; }
  /// Active rows with an entry in this column.
  int count(int column) const { return count_[column]; }

  /// Takes the pivot out: its row becomes inactive, its column vanishes from the others.
  void eliminate(int row, int column);

 private:
  std::vector<std::vector<Entry>> rows_;
  std::vector<char> active_;
  std::vector<int> count_;
  std::vector<Entry> merged_;
};

}  // namespace traverse::multibody
