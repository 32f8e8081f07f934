#include "traverse/coupling/compliance.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::coupling {

namespace {
constexpr std::size_t kept_values = std::size_t{8} << 20;  // doubles in columns that are not in use
constexpr double negligible = 1e-18;                       // of a column's peak
}  // namespace

Compliance::Compliance(const beam::Beam& beam, BeamOperator& op)
    : beam_(beam),
      operator_(op),
      line_(beam.running()),
      m_(2 * line_.per_node),
      work_(static_cast<std::size_t>(op.unknowns()) * m_) {}

void Compliance::prepare(double shift, double shift2, const AddedSprings* added, const std::vector<int>& elements) {
  const BeamFactor& factor = operator_.factored(shift, shift2, added);
  const long stamp = operator_.factor_stamp();
  if (stamp == stamp_ && elements == elements_) return;
  stamp_ = stamp;
  elements_ = elements;
  count_ = elements.size();
  active_.clear();
  for (int e : elements) active_.push_back(&column(factor, shift, added, stamp, e));
  fill_matrix();

  // Forget the oldest columns beyond what is worth keeping.
  std::size_t values = 0;
  std::size_t kept = 0;
  for (auto c = columns_.begin(); c != columns_.end(); ++c, ++kept) {
    values += c->values.size();
    if (values > kept_values && kept >= count_) {
      columns_.erase(c, columns_.end());
      break;
    }
  }
}

Compliance::Column& Compliance::column(const BeamFactor& factor, double shift,
                                       const AddedSprings* added, long stamp, int element) {
  auto found = std::find_if(columns_.begin(), columns_.end(),
                            [&](const Column& c) { return c.stamp == stamp && c.element == element; });
  if (found != columns_.end()) {
    columns_.splice(columns_.begin(), columns_, found);
    return columns_.front();
  }
  const int n = operator_.unknowns();
  std::fill(work_.begin(), work_.end(), 0.0);
  const auto unknowns = line_.unknowns(element);
  for (int j = 0; j < m_; ++j) {
    const int unknown = beam_.local(unknowns[j]);
    if (unknown >= 0 && beam_.fixed()[unknown] == 0) work_[static_cast<std::size_t>(j) * n + unknown] = 1.0;
  }
  if (shift == 0.0) {
    for (int j = 0; j < m_; ++j) operator_.solve_static(work_.data() + static_cast<std::ptrdiff_t>(j) * n, added);
  } else {
    factor.solve(work_.data(), m_);
    operator_.solves += m_;
  }

  columns_.emplace_front();
  Column& c = columns_.front();
  c.element = element;
  c.stamp = stamp;
  c.low = n;
  c.high = 0;
  for (int j = 0; j < m_; ++j) {
    const double* x = work_.data() + static_cast<std::ptrdiff_t>(j) * n;
    double peak = 0.0;
    for (int i = 0; i < n; ++i) peak = std::max(peak, std::abs(x[i]));
    int low = 0, high = n;
    while (low < high && std::abs(x[low]) <= negligible * peak) ++low;
    while (high > low && std::abs(x[high - 1]) <= negligible * peak) --high;
    if (low < high) {
      c.low = std::min(c.low, low);
      c.high = std::max(c.high, high);
    }
  }
  const int size = std::max(0, c.high - c.low);
  c.values.resize(static_cast<std::size_t>(size) * m_);
  for (int j = 0; j < m_; ++j)
    if (size > 0)
      std::copy_n(work_.data() + static_cast<std::ptrdiff_t>(j) * n + c.low, size,
                  c.values.data() + static_cast<std::ptrdiff_t>(j) * size);
  return c;
}

void Compliance::fill_matrix() {
  matrix_.assign(count_ * count_ * m_ * m_, 0.0);
  for (std::size_t a = 0; a < count_; ++a) {
    const auto unknowns = line_.unknowns(elements_[a]);
    for (std::size_t e = 0; e < count_; ++e) {
      const Column& c = *active_[e];
      double* to = &matrix_[(a * count_ + e) * m_ * m_];
      for (int i = 0; i < m_; ++i) {
        const int unknown = beam_.local(unknowns[i]);
        if (unknown < c.low || unknown >= c.high) continue;
        for (int j = 0; j < m_; ++j)
          to[i + j * m_] = c.values[static_cast<std::size_t>(j) * (c.high - c.low) + (unknown - c.low)];
      }
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, matrix_.data(), static_cast<int>(matrix_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
}

void Compliance::add_response(const std::vector<double>& loads, double* v) const {
  for (std::size_t e = 0; e < count_; ++e) {
    const Column& c = *active_[e];
    const int size = c.high - c.low;
    for (int j = 0; j < m_; ++j) {
      const double f = loads[e * m_ + j];
      if (f == 0.0 || size <= 0) continue;
      const double* x = c.values.data() + static_cast<std::ptrdiff_t>(j) * size;
      for (int i = 0; i < size; ++i) v[c.low + i] += f * x[i];
    }
  }
}

}  // namespace traverse::coupling
