// Eliminates one column from the remaining sparse rows by merging their sorted entries, and counts the non-zeros of
// every column.
#include "active_rows.hpp"

#include <algorithm>

namespace traverse::multibody {

void ActiveRows::assign(const Eigen::MatrixXd& A) {
  rows_.resize(A.rows());
  active_.assign(A.rows(), 1);
  count_.assign(A.cols(), 0);
  for (std::vector<Entry>& row : rows_) row.clear();
  for (int j = 0; j < A.cols(); ++j)
    for (int i = 0; i < A.rows(); ++i) {
      if (A(i, j) == 0.0) continue;
      rows_[i].push_back({j, A(i, j)});
      ++count_[j];
    }
}

void ActiveRows::eliminate(int pivot_row, int column) {
  const std::vector<Entry>& pivot = rows_[pivot_row];
  const auto in_column = [column](const Entry& e) { return e.column == column; };
  const double size = std::find_if(pivot.begin(), pivot.end(), in_column)->value;
  active_[pivot_row] = 0;
  for (const Entry& e : pivot) --count_[e.column];
  for (int i = 0; i < rows(); ++i) {
    if (!active(i)) continue;
    const auto place = std::find_if(rows_[i].begin(), rows_[i].end(), in_column);
    if (place == rows_[i].end()) continue;
    const double factor = place->value / size;
    merged_.clear();
    auto a = rows_[i].begin();
    auto b = pivot.begin();
    while (a != rows_[i].end() || b != pivot.end()) {
      if (b == pivot.end() || (a != rows_[i].end() && a->column < b->column)) {
        merged_.push_back(*a++);
      } else if (a == rows_[i].end() || b->column < a->column) {
        merged_.push_back({b->column, -factor * b->value});
        ++count_[b++->column];
      } else {
        if (a->column != column) merged_.push_back({a->column, a->value - factor * b->value});
        ++a;
        ++b;
      }
    }
    --count_[column];
    rows_[i].swap(merged_);
  }
}

}  // namespace traverse::multibody
