#include "traverse/multibody/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace traverse::multibody {

namespace {

constexpr double acceptable_pivot = 0.1;  // of the largest in its row, when the order is chosen
constexpr double worn_pivot = 0.1;        // of what it was when the order was chosen

/// The best pivot of the active matrix from (k, k) on: the one that fills least (Markowitz) among those large enough;
/// the larger one of two that fill alike.
void find_pivot(const Eigen::MatrixXd& A, int k, int& row, int& column) {
  const int left = static_cast<int>(A.rows()) - k;
  const auto active = A.bottomRightCorner(left, left).array();
  const Eigen::Array<Eigen::Index, 1, Eigen::Dynamic> in_column = (active != 0.0).colwise().count();
  Eigen::Index best_fill = std::numeric_limits<Eigen::Index>::max();
  double best_size = 0.0;
  row = column = k;
  for (int i = 0; i < left; ++i) {
    const double acceptable = acceptable_pivot * active.row(i).abs().maxCoeff();
    const Eigen::Index in_row = (active.row(i) != 0.0).count();
    for (int j = 0; j < left; ++j) {
      const double size = std::abs(active(i, j));
      if (!(size > 0.0) || size < acceptable) continue;
      const Eigen::Index fill = (in_row - 1) * (in_column[j] - 1);
      if (fill > best_fill || (fill == best_fill && size <= best_size)) continue;
      best_fill = fill;
      best_size = size;
      row = k + i;
      column = k + j;
    }
  }
}

}  // namespace

void DependentBlock::plan(const Eigen::MatrixXd& Phi_q, const std::vector<char>& pattern, const Partition& partition,
                          const Scaling& scaling) {
  choose_order(Phi_q, partition, scaling);
  find_fill(pattern, static_cast<int>(Phi_q.rows()));
  find_sensitive(pattern, static_cast<int>(Phi_q.rows()));
  const int m = size();
  block_.assign(static_cast<std::size_t>(m) * m, 0.0);
  sensitivity_.assign(static_cast<std::size_t>(m) * freedom(), 0.0);
  inverse_pivot_.assign(m, 0.0);
  planned_pivot_.assign(m, 0.0);
  work_.assign(m, 0.0);
  factor(Phi_q);
  for (int k = 0; k < m; ++k) planned_pivot_[k] = std::abs(block(k, k));
}

void DependentBlock::choose_order(const Eigen::MatrixXd& Phi_q, const Partition& partition, const Scaling& scaling) {
  row_of_ = partition.rows;
  column_of_ = partition.dependent;
  independent_ = partition.independent;
  const int m = size();
  active_.resize(m, m);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i)
      active_(i, j) = Phi_q(row_of_[i], column_of_[j]) * scaling.row[row_of_[i]] * scaling.column[column_of_[j]];
  for (int k = 0; k < m; ++k) {
    int row, column;
    find_pivot(active_, k, row, column);
    active_.row(k).swap(active_.row(row));
    active_.col(k).swap(active_.col(column));
    std::swap(row_of_[k], row_of_[row]);
    std::swap(column_of_[k], column_of_[column]);
    for (int i = k + 1; i < m; ++i) {
      if (active_(i, k) == 0.0) continue;
      const double factor = active_(i, k) / active_(k, k);
      active_(i, k) = 0.0;
      for (int j = k + 1; j < m; ++j) active_(i, j) -= factor * active_(k, j);
    }
  }
}

void DependentBlock::find_fill(const std::vector<char>& pattern, int rows) {
  const int m = size();
  filled_.assign(static_cast<std::size_t>(m) * m, 0);
  block_sources_.clear();
  lower_.clear();
  upper_.clear();
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) {
      const int from = column_of_[j] * rows + row_of_[i];
      if (!pattern[from]) continue;
      filled_[i * m + j] = 1;
      block_sources_.push_back({from, i * m + j});
    }
    filled_[i * m + i] = 1;
    for (int k = 0; k < i; ++k) {
      if (!filled_[i * m + k]) continue;
      lower_.index.push_back(k);
      for (const int* j = upper_.begin(k); j != upper_.end(k); ++j) filled_[i * m + *j] = 1;
    }
    for (int j = i + 1; j < m; ++j)
      if (filled_[i * m + j]) upper_.index.push_back(j);
    lower_.close();
    upper_.close();
  }
}

void DependentBlock::find_sensitive(const std::vector<char>& pattern, int rows) {
  const int m = size();
  const int f = freedom();
  filled_.assign(static_cast<std::size_t>(m) * f, 0);
  sensitivity_sources_.clear();
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < f; ++j) {
      const int from = independent_[j] * rows + row_of_[i];
      if (!pattern[from]) continue;
      filled_[i * f + j] = 1;
      sensitivity_sources_.push_back({from, i * f + j});
    }
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k)
      for (int j = 0; j < f; ++j) filled_[i * f + j] |= filled_[*k * f + j];
  }
  for (int i = m - 1; i >= 0; --i)
    for (const int* k = upper_.begin(i); k != upper_.end(i); ++k)
      for (int j = 0; j < f; ++j) filled_[i * f + j] |= filled_[*k * f + j];
  sensitive_.clear();
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < f; ++j)
      if (filled_[i * f + j]) sensitive_.index.push_back(j);
    sensitive_.close();
  }
}

bool DependentBlock::factor(const Eigen::MatrixXd& Phi_q) {
  const int m = size();
  for (int i = 0; i < m; ++i) {
    for (const int* j = lower_.begin(i); j != lower_.end(i); ++j) block(i, *j) = 0.0;
    for (const int* j = upper_.begin(i); j != upper_.end(i); ++j) block(i, *j) = 0.0;
    block(i, i) = 0.0;
    for (const int* j = sensitive_.begin(i); j != sensitive_.end(i); ++j) sensitivity_[i * freedom() + *j] = 0.0;
  }
  const double* numbers = Phi_q.data();
  for (const Source& s : block_sources_) block_[s.to] = numbers[s.from];
  for (const Source& s : sensitivity_sources_) sensitivity_[s.to] = -numbers[s.from];
  bool sound = true;
  for (int i = 0; i < m; ++i) {
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k) {
      const double l = block(i, *k) * inverse_pivot_[*k];
      block(i, *k) = l;
      for (const int* j = upper_.begin(*k); j != upper_.end(*k); ++j) block(i, *j) -= l * block(*k, *j);
    }
    inverse_pivot_[i] = 1.0 / block(i, i);
    if (std::abs(block(i, i)) < worn_pivot * planned_pivot_[i]) sound = false;
  }
  return sound;
}

void DependentBlock::compute_sensitivity() {
  const int m = size();
  const int f = freedom();
  for (int i = 0; i < m; ++i) {
    double* target = sensitivity_.data() + i * f;
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k) {
      const double l = block(i, *k);
      const double* source = sensitivity_.data() + *k * f;
      for (const int* j = sensitive_.begin(*k); j != sensitive_.end(*k); ++j) target[*j] -= l * source[*j];
    }
  }
  for (int i = m - 1; i >= 0; --i) {
    double* target = sensitivity_.data() + i * f;
    for (const int* k = upper_.begin(i); k != upper_.end(i); ++k) {
      const double u = block(i, *k);
      const double* source = sensitivity_.data() + *k * f;
      for (const int* j = sensitive_.begin(*k); j != sensitive_.end(*k); ++j) target[*j] -= u * source[*j];
    }
    for (const int* j = sensitive_.begin(i); j != sensitive_.end(i); ++j) target[*j] *= inverse_pivot_[i];
  }
}

void DependentBlock::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
  const int m = size();
  for (int i = 0; i < m; ++i) {
    double sum = rhs[row_of_[i]];
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k) sum -= block(i, *k) * work_[*k];
    work_[i] = sum;
  }
  for (int i = m - 1; i >= 0; --i) {
    double sum = work_[i];
    for (const int* k = upper_.begin(i); k != upper_.end(i); ++k) sum -= block(i, *k) * work_[*k];
    work_[i] = sum * inverse_pivot_[i];
    x[column_of_[i]] = work_[i];
  }
}

void DependentBlock::solve_transposed(const Eigen::VectorXd& r, Eigen::VectorXd& y) {
  const int m = size();
  for (int i = 0; i < m; ++i) work_[i] = r[column_of_[i]];
  for (int i = 0; i < m; ++i) {
    work_[i] *= inverse_pivot_[i];
    for (const int* j = upper_.begin(i); j != upper_.end(i); ++j) work_[*j] -= block(i, *j) * work_[i];
  }
  for (int i = m - 1; i >= 0; --i) {
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k) work_[*k] -= block(i, *k) * work_[i];
    y[row_of_[i]] = work_[i];
  }
}

void DependentBlock::expand(const double* p, Eigen::VectorXd& x) const {
  const int f = freedom();
  for (int k = 0; k < f; ++k) x[independent_[k]] = p[k];
  for (int i = 0; i < size(); ++i) {
    double sum = x[column_of_[i]];
    for (const int* j = sensitive_.begin(i); j != sensitive_.end(i); ++j) sum += sensitivity_[i * f + *j] * p[*j];
    x[column_of_[i]] = sum;
  }
}

void DependentBlock::project(const Eigen::VectorXd& r, Eigen::VectorXd& reduced) const {
  const int f = freedom();
  for (int k = 0; k < f; ++k) reduced[k] = r[independent_[k]];
  for (int i = 0; i < size(); ++i) {
    const double value = r[column_of_[i]];
    for (const int* j = sensitive_.begin(i); j != sensitive_.end(i); ++j)
      reduced[*j] += sensitivity_[i * f + *j] * value;
  }
}

void DependentBlock::scatter(Eigen::MatrixXd& B) const {
  for (int i = 0; i < size(); ++i)
    for (const int* j = sensitive_.begin(i); j != sensitive_.end(i); ++j)
      B(column_of_[i], *j) = sensitivity_[i * freedom() + *j];
}

double DependentBlock::largest_sensitivity(const Scaling& scaling) const {
  double largest = 0.0;
  for (int i = 0; i < size(); ++i)
    for (const int* j = sensitive_.begin(i); j != sensitive_.end(i); ++j) {
      const double scaled =
          std::abs(sensitivity_[i * freedom() + *j]) * scaling.column[independent_[*j]] / scaling.column[column_of_[i]];
      if (!(scaled <= largest)) largest = scaled;  // also when it is not a number
    }
  return largest;
}

void ReducedMass::plan(const DependentBlock& block) {
  const int f = block.freedom();
  filled_.assign(static_cast<std::size_t>(f) * f, 0);
  for (int i = 0; i < block.size(); ++i)
    for (const int* a = block.sensitivity_begin(i); a != block.sensitivity_end(i); ++a)
      for (const int* b = block.sensitivity_begin(i); b != block.sensitivity_end(i); ++b) filled_[*a * f + *b] = 1;
  entries_.assign(static_cast<std::size_t>(f) * f, 0.0);
  inverse_.assign(f, 0.0);
  work_.assign(f, 0.0);
  place_.assign(f, -1);
  order_.clear();
  below_.clear();
  for (int k = 0; k < f; ++k) {
    const int next = least_coupled();
    place_[next] = k;
    order_.push_back(next);
    for (int i = 0; i < f; ++i) {
      if (place_[i] >= 0 || !filled_[next * f + i]) continue;
      below_.index.push_back(i);  // renumbered when all places are known
      for (int j = 0; j < f; ++j)
        if (filled_[next * f + j]) filled_[i * f + j] = 1;
    }
    below_.close();
  }
  for (int& i : below_.index) i = place_[i];
  for (int k = 0; k < f; ++k)
    std::sort(below_.index.data() + below_.start[k], below_.index.data() + below_.start[k + 1]);
}

/// The coordinate not yet placed that is coupled with the fewest others that are not.
int ReducedMass::least_coupled() const {
  const int f = static_cast<int>(place_.size());
  int best = -1;
  int fewest = f + 1;
  for (int i = 0; i < f; ++i) {
    if (place_[i] >= 0) continue;
    int count = 0;
    for (int j = 0; j < f; ++j)
      if (place_[j] < 0 && filled_[i * f + j]) ++count;
    if (count >= fewest) continue;
    fewest = count;
    best = i;
  }
  return best;
}

void ReducedMass::factor(const DependentBlock& block, const Eigen::VectorXd& mass) {
  const int f = static_cast<int>(order_.size());
  for (int k = 0; k < f; ++k) {
    for (const int* i = below_.begin(k); i != below_.end(k); ++i) entries_[k * f + *i] = 0.0;
    entries_[k * f + k] = mass[block.independent(order_[k])];
  }
  for (int i = 0; i < block.size(); ++i) {
    const double inertia = mass[block.coordinate(i)];
    for (const int* a = block.sensitivity_begin(i); a != block.sensitivity_end(i); ++a) {
      const double weighted = inertia * block.sensitivity(i, *a);
      const int column = place_[*a];
      for (const int* b = block.sensitivity_begin(i); b != block.sensitivity_end(i); ++b)
        if (place_[*b] >= column) entries_[column * f + place_[*b]] += weighted * block.sensitivity(i, *b);
    }
  }
  for (int k = 0; k < f; ++k) {
    double* column = entries_.data() + k * f;
    inverse_[k] = 1.0 / column[k];
    for (const int* j = below_.begin(k); j != below_.end(k); ++j) {
      const double l = column[*j] * inverse_[k];
      for (const int* i = j; i != below_.end(k); ++i) entries_[*j * f + *i] -= l * column[*i];
      column[*j] = l;  // the rows further down are still to be scaled, this one is not needed again
    }
  }
}

void ReducedMass::solve(Eigen::VectorXd& x) {
  const int f = static_cast<int>(order_.size());
  for (int k = 0; k < f; ++k) work_[k] = x[order_[k]];
  for (int k = 0; k < f; ++k)
    for (const int* i = below_.begin(k); i != below_.end(k); ++i) work_[*i] -= entries_[k * f + *i] * work_[k];
  for (int k = f - 1; k >= 0; --k) {
    double sum = work_[k] * inverse_[k];
    for (const int* i = below_.begin(k); i != below_.end(k); ++i) sum -= entries_[k * f + *i] * work_[*i];
    work_[k] = sum;
    x[order_[k]] = sum;
  }
}

}  // namespace traverse::multibody
