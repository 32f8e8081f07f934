// Sparse LU factorisation of the Jacobian's dependent columns with Markowitz pivoting, the matrix B of dependent on
// independent coordinates, and the reduced mass matrix B^T N B.
#include "multibody/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::multibody {

namespace {

constexpr double acceptable_pivot =
    0.1;  // least pivot relative to the largest entry in its row, for the choice of the order
constexpr double degraded_pivot = 0.1;  // least pivot relative to its value when the order was chosen
constexpr double zero_pivot = 1e-13;    // scaled: with a smaller pivot, the solution is zero in its direction
constexpr long many = 2;                // non-zeros of the sensitivity, relative to those of the factors
constexpr int small = 24;               // independent coordinates up to which the sensitivity is always computed

/// The pivot with the least fill (Markowitz) among the pivots that are large enough in their row. If the fill is equal,
/// the larger pivot is chosen.
void find_pivot(const ActiveRows& A, int& row, int& column) {
  long best_fill = std::numeric_limits<long>::max();
  double best_size = 0.0;
  for (int i = 0; i < A.rows(); ++i) {
    if (!A.active(i)) continue;
    double largest = 0.0;
    for (const ActiveRows::Entry& e : A.row(i)) largest = std::max(largest, std::abs(e.value));
    const long in_row = static_cast<long>(A.row(i).size());
    for (const ActiveRows::Entry& e : A.row(i)) {
      const double size = std::abs(e.value);
      if (!(size > 0.0) || size < acceptable_pivot * largest) continue;
      const long fill = (in_row - 1) * (A.count(e.column) - 1);
      if (fill > best_fill || (fill == best_fill && size <= best_size)) continue;
      best_fill = fill;
      best_size = size;
      row = i;
      column = e.column;
    }
  }
}

}  // namespace

void Sensitivity::add(const Eigen::VectorXd& change, const std::vector<int>& places, Eigen::VectorXd& q) const {
  for (std::size_t k = 0; k < places.size(); ++k) q[places[k]] += change[static_cast<Eigen::Index>(k)];
  for (std::size_t i = 0; i < coordinate.size(); ++i)
    for (int j = independent.start[i]; j < independent.start[i + 1]; ++j)
      q[coordinate[i]] += value[j] * change[independent.index[j]];
}

void DependentBlock::plan(const Eigen::MatrixXd& Phi_q, const std::vector<char>& pattern, const Partition& partition,
                          const Scaling& scaling) {
  choose_order(Phi_q, partition, scaling);
  find_fill(pattern, static_cast<int>(Phi_q.rows()));
  find_sensitive(pattern, static_cast<int>(Phi_q.rows()));
  const int m = size();
  const auto factors = static_cast<long>(lower_.index.size() + upper_.index.size() + sensitivity_sources_.size()) + m;
  many_sensitivities_ = freedom() > small && static_cast<long>(sensitive_.index.size()) > many * factors;
  by_independent_.assign(sensitivity_sources_.size(), 0.0);
  block_.assign(static_cast<std::size_t>(m) * m, 0.0);
  sensitivity_.assign(static_cast<std::size_t>(m) * freedom(), 0.0);
  inverse_pivot_.assign(m, 0.0);
  planned_pivot_.assign(m, 0.0);
  work_.assign(m, 0.0);
  factor(Phi_q);
  for (int k = 0; k < m; ++k) planned_pivot_[k] = std::abs(block(k, k));
}

void DependentBlock::choose_order(const Eigen::MatrixXd& Phi_q, const Partition& partition, const Scaling& scaling) {
  independent_ = partition.independent;
  const int m = static_cast<int>(partition.rows.size());
  Eigen::MatrixXd scaled(m, m);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) {
      const int row = partition.rows[i], column = partition.dependent[j];
      scaled(i, j) = Phi_q(row, column) * scaling.row[row] * scaling.column[column];
    }
  ActiveRows active;
  active.assign(scaled);
  std::vector<char> row_used(m, 0), column_used(m, 0);
  row_of_.clear();
  column_of_.clear();
  const auto append = [&](int row, int column) {
    row_of_.push_back(partition.rows[row]);
    column_of_.push_back(partition.dependent[column]);
    row_used[row] = column_used[column] = 1;
  };
  for (int k = 0; k < m; ++k) {
    int row = -1, column = -1;
    find_pivot(active, row, column);
    if (row < 0) break;  // singular to the last bit
    active.eliminate(row, column);
    append(row, column);
  }
  for (int row = 0, column = 0; row < m; ++row) {  // the other rows have no pivot
    if (row_used[row]) continue;
    while (column_used[column]) ++column;
    append(row, column);
  }
  pivot_scale_.resize(m);
  for (int k = 0; k < m; ++k) pivot_scale_[k] = scaling.row[row_of_[k]] * scaling.column[column_of_[k]];
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
  }
  const double* numbers = Phi_q.data();
  for (const Source& s : block_sources_) block_[s.to] = numbers[s.from];
  for (std::size_t k = 0; k < by_independent_.size(); ++k) by_independent_[k] = numbers[sensitivity_sources_[k].from];
  has_sensitivity_ = false;
  bool accurate = true;
  least_pivot_ = 1.0;
  for (int i = 0; i < m; ++i) {
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k) {
      const double l = block(i, *k) * inverse_pivot_[*k];
      block(i, *k) = l;
      for (const int* j = upper_.begin(*k); j != upper_.end(*k); ++j) block(i, *j) -= l * block(*k, *j);
    }
    const double size = std::abs(block(i, i));
    least_pivot_ = std::min(least_pivot_, size * pivot_scale_[i]);
    if (size < degraded_pivot * planned_pivot_[i]) accurate = false;
    inverse_pivot_[i] = size * pivot_scale_[i] > zero_pivot ? 1.0 / block(i, i) : 0.0;
  }
  return accurate && !nearly_singular();
}

void DependentBlock::compute_sensitivity() {
  const int m = size();
  const int f = freedom();
  for (int i = 0; i < m; ++i)
    for (const int* j = sensitive_.begin(i); j != sensitive_.end(i); ++j) sensitivity_[i * f + *j] = 0.0;
  for (std::size_t k = 0; k < by_independent_.size(); ++k)
    sensitivity_[sensitivity_sources_[k].to] = -by_independent_[k];
  has_sensitivity_ = true;
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

/// Solves with the factors: work_ has an entry for each pivot's row before, and for each pivot's column after.
void DependentBlock::solve_work() {
  const int m = size();
  for (int i = 0; i < m; ++i) {
    double sum = work_[i];
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k) sum -= block(i, *k) * work_[*k];
    work_[i] = sum;
  }
  for (int i = m - 1; i >= 0; --i) {
    double sum = work_[i];
    for (const int* k = upper_.begin(i); k != upper_.end(i); ++k) sum -= block(i, *k) * work_[*k];
    work_[i] = sum * inverse_pivot_[i];
  }
}

void DependentBlock::solve_work_transposed() {
  const int m = size();
  for (int i = 0; i < m; ++i) {
    work_[i] *= inverse_pivot_[i];
    for (const int* j = upper_.begin(i); j != upper_.end(i); ++j) work_[*j] -= block(i, *j) * work_[i];
  }
  for (int i = m - 1; i >= 0; --i)
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k) work_[*k] -= block(i, *k) * work_[i];
}

void DependentBlock::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
  for (int i = 0; i < size(); ++i) work_[i] = rhs[row_of_[i]];
  solve_work();
  for (int i = 0; i < size(); ++i) x[column_of_[i]] = work_[i];
}

void DependentBlock::solve_transposed(const Eigen::VectorXd& r, Eigen::VectorXd& y) {
  for (int i = 0; i < size(); ++i) work_[i] = r[column_of_[i]];
  solve_work_transposed();
  for (int i = 0; i < size(); ++i) y[row_of_[i]] = work_[i];
}

void DependentBlock::expand(const double* p, Eigen::VectorXd& x) {
  const int f = freedom();
  for (int k = 0; k < f; ++k) x[independent_[k]] = p[k];
  if (by_factors()) {
    std::fill(work_.begin(), work_.end(), 0.0);
    for (std::size_t k = 0; k < by_independent_.size(); ++k) {
      const int to = sensitivity_sources_[k].to;
      work_[to / f] -= by_independent_[k] * p[to % f];
    }
    solve_work();
    for (int i = 0; i < size(); ++i) x[column_of_[i]] += work_[i];
    return;
  }
  for (int i = 0; i < size(); ++i) {
    double sum = x[column_of_[i]];
    for (const int* j = sensitive_.begin(i); j != sensitive_.end(i); ++j) sum += sensitivity_[i * f + *j] * p[*j];
    x[column_of_[i]] = sum;
  }
}

void DependentBlock::project(const Eigen::Ref<const Eigen::VectorXd>& r, Eigen::Ref<Eigen::VectorXd> reduced) {
  const int f = freedom();
  for (int k = 0; k < f; ++k) reduced[k] = r[independent_[k]];
  if (by_factors()) {
    for (int i = 0; i < size(); ++i) work_[i] = r[column_of_[i]];
    solve_work_transposed();
    for (std::size_t k = 0; k < by_independent_.size(); ++k) {
      const int to = sensitivity_sources_[k].to;
      reduced[to % f] -= by_independent_[k] * work_[to / f];
    }
    return;
  }
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
      if (!(scaled <= largest)) largest = scaled;  // also for NaN
    }
  return largest;
}

void DependentBlock::set_sensitivity(const Eigen::Ref<const Eigen::MatrixXd>& B) {
  has_sensitivity_ = true;
  for (int i = 0; i < size(); ++i)
    for (const int* j = sensitive_.begin(i); j != sensitive_.end(i); ++j)
      sensitivity_[i * freedom() + *j] = B(column_of_[i], *j);
}

void DependentBlock::copy_sensitivity(Sensitivity& copy) const {
  copy.coordinate = column_of_;
  copy.independent = sensitive_;
  copy.value.clear();
  for (int i = 0; i < size(); ++i)
    for (const int* j = sensitive_.begin(i); j != sensitive_.end(i); ++j) copy.value.push_back(sensitivity(i, *j));
}

BlockOperations DependentBlock::operations() const {
  const auto length = [](const IndexLists& lists, int i) { return static_cast<long>(lists.end(i) - lists.begin(i)); };
  BlockOperations count;
  for (int i = 0; i < size(); ++i) {
    count.factor += 3;  // a pivot is compared twice and inverted
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k) {
      count.factor += 1 + 2 * length(upper_, *k);
      count.sensitivity += 2 * length(sensitive_, *k);
    }
    for (const int* k = upper_.begin(i); k != upper_.end(i); ++k) count.sensitivity += 2 * length(sensitive_, *k);
    count.sensitivity += length(sensitive_, i);
    count.solve += 2 * (length(lower_, i) + length(upper_, i)) + 1;
    count.expand += 2 * length(sensitive_, i);
  }
  return count;
}

void ReducedMass::plan(const DependentBlock& block) {
  const int f = block.freedom();
  filled_.assign(static_cast<std::size_t>(f) * f, 0);
  for (int i = 0; i < block.size(); ++i)
    for (const int* a = block.sensitivity_begin(i); a != block.sensitivity_end(i); ++a)
      for (const int* b = block.sensitivity_begin(i); b != block.sensitivity_end(i); ++b) filled_[*a * f + *b] = 1;
  ldl_.plan(f, filled_);
  diagonal_.clear();
  target_.clear();
  for (int k = 0; k < f; ++k) diagonal_.push_back(ldl_.entry_index(k, k));
  for (int i = 0; i < block.size(); ++i)
    for (const int* a = block.sensitivity_begin(i); a != block.sensitivity_end(i); ++a)
      for (const int* b = a; b != block.sensitivity_end(i); ++b) target_.push_back(ldl_.entry_index(*a, *b));
}

void ReducedMass::factor(const DependentBlock& block, const Eigen::VectorXd& mass) {
  ldl_.set_zero();
  double* entries = ldl_.entries();
  for (int k = 0; k < ldl_.size(); ++k) entries[diagonal_[k]] = mass[block.independent(k)];
  const int* target = target_.data();
  for (int i = 0; i < block.size(); ++i) {
    const double inertia = mass[block.coordinate(i)];
    const double* sensitivity = block.sensitivities(i);
    const int* end = block.sensitivity_end(i);
    for (const int* a = block.sensitivity_begin(i); a != end; ++a) {
      const double weighted = inertia * sensitivity[*a];
      for (const int* b = a; b != end; ++b) entries[*target++] += weighted * sensitivity[*b];
    }
  }
  ldl_.factor();
}

void ReducedMass::solve(Eigen::VectorXd& x) { ldl_.solve(x.data()); }

MassOperations ReducedMass::operations(const DependentBlock& block) const {
  long product = 0;
  for (int i = 0; i < block.size(); ++i) {
    const long width = block.sensitivity_end(i) - block.sensitivity_begin(i);
    product += width + width * (width + 1);
  }
  return {product + ldl_.factor_operations(), ldl_.solve_operations()};
}

}  // namespace traverse::multibody
