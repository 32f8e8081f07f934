// Minimum-degree ordering and symbolic factorisation, then numerical factorisation and solution on the planned
// non-zeros. For the choice of pivots, one column at a time is eliminated from the remaining sparse rows by merging
// their sorted entries, and the non-zeros of every column are counted. Decision 041 compares this with Eigen's.
#include "multibody/sparse_ldl.hpp"

#include <algorithm>

namespace traverse::multibody {
namespace {

/// The index without a place that is coupled with the fewest others without a place.
int least_coupled(const std::vector<char>& filled, const std::vector<int>& place) {
  const int n = static_cast<int>(place.size());
  int best = -1;
  int fewest = n + 1;
  for (int i = 0; i < n; ++i) {
    if (place[i] >= 0) continue;
    int count = 0;
    for (int j = 0; j < n; ++j)
      if (place[j] < 0 && filled[i * n + j]) ++count;
    if (count >= fewest) continue;
    fewest = count;
    best = i;
  }
  return best;
}

}  // namespace

void SparseLdl::plan(int n, std::vector<char>& filled) {
  entries_.assign(static_cast<std::size_t>(n) * n, 0.0);
  inverse_.assign(n, 0.0);
  work_.assign(n, 0.0);
  place_.assign(n, -1);
  order_.clear();
  below_.clear();
  for (int k = 0; k < n; ++k) {
    const int next = least_coupled(filled, place_);
    place_[next] = k;
    order_.push_back(next);
    for (int i = 0; i < n; ++i) {
      if (place_[i] >= 0 || !filled[next * n + i]) continue;
      below_.index.push_back(i);  // renumbered after all places are known
      for (int j = 0; j < n; ++j)
        if (filled[next * n + j]) filled[i * n + j] = 1;
    }
    below_.close();
  }
  for (int& i : below_.index) i = place_[i];
  for (int k = 0; k < n; ++k)
    std::sort(below_.index.data() + below_.start[k], below_.index.data() + below_.start[k + 1]);
}

void SparseLdl::set_zero() {
  for (int k = 0; k < size(); ++k) {
    double* column = entries_.data() + k * size();
    column[k] = 0.0;
    for (const int* i = below_.begin(k); i != below_.end(k); ++i) column[*i] = 0.0;
  }
}

void SparseLdl::factor() {
  const int n = size();
  for (int k = 0; k < n; ++k) {
    double* column = entries_.data() + k * n;
    inverse_[k] = 1.0 / column[k];
    for (const int* j = below_.begin(k); j != below_.end(k); ++j) {
      const double l = column[*j] * inverse_[k];
      for (const int* i = j; i != below_.end(k); ++i) entries_[*j * n + *i] -= l * column[*i];
      column[*j] = l;  // entries below are scaled later; this entry is not read again
    }
  }
}

long SparseLdl::factor_operations() const {
  long count = 0;
  for (int k = 0; k < size(); ++k) {
    const long below = below_.end(k) - below_.begin(k);
    count += 1 + below + below * (below + 1);
  }
  return count;
}

long SparseLdl::solve_operations() const { return 4 * static_cast<long>(below_.index.size()) + size(); }

void SparseLdl::solve(double* x) {
  const int n = size();
  for (int k = 0; k < n; ++k) work_[k] = x[order_[k]];
  for (int k = 0; k < n; ++k)
    for (const int* i = below_.begin(k); i != below_.end(k); ++i) work_[*i] -= entries_[k * n + *i] * work_[k];
  for (int k = n - 1; k >= 0; --k) {
    double sum = work_[k] * inverse_[k];
    for (const int* i = below_.begin(k); i != below_.end(k); ++i) sum -= entries_[k * n + *i] * work_[*i];
    work_[k] = sum;
    x[order_[k]] = sum;
  }
}

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
