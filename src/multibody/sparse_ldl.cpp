// Minimum-degree ordering and symbolic factorisation, then numerical factorisation and solution on the planned
// non-zeros.
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

}  // namespace traverse::multibody
