#include "traverse/coupling/compliance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

void Compliance::prepare(double shift, const AddedSprings* added, const std::vector<int>& elements) {
  const solve::SubstructuredCholesky& factor = operator_.factored(shift, added);
  const long stamp = operator_.factor_stamp();
  if (stamp == stamp_ && elements == elements_) return;
  if (stamp != stamp_) find_places(stamp);
  stamp_ = stamp;
  elements_ = elements;
  active_.clear();
  for (int e : elements) active_.push_back(&column(factor, shift, added, stamp, e));
  find_responses();
  fill_blocks();

  // Forget the oldest columns beyond what is worth keeping.
  while (kept_ > kept_values && columns_.size() > elements_.size()) {
    const Column& oldest = columns_.back();
    kept_ -= oldest.values.size();
    if (oldest.stamp == stamp) place_[oldest.element] = columns_.end();
    columns_.pop_back();
  }
}

void Compliance::find_places(long stamp) {
  place_.assign(static_cast<std::size_t>(line_.mesh.elements()), columns_.end());
  for (auto c = columns_.begin(); c != columns_.end(); ++c)
    if (c->stamp == stamp) place_[c->element] = c;
}

Compliance::Column& Compliance::column(const solve::SubstructuredCholesky& factor, double shift,
                                       const AddedSprings* added, long stamp, int element) {
  if (const auto found = place_[element]; found != columns_.end()) {
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
  place_[element] = columns_.begin();
  Column& c = columns_.front();
  c.element = element;
  c.stamp = stamp;
  keep(c);
  kept_ += c.values.size();
  return c;
}

// Takes the solution in work_, where it is above rounding.
void Compliance::keep(Column& c) const {
  const int n = operator_.unknowns();
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
  const int first = beam_.first_column(), block = beam_.block(), none = std::numeric_limits<int>::max();
  std::array<int, 2> ends = {none, none};  // the least of first and of -last
  if (size > 0) ends = {first + c.low / block, -(first + (c.high - 1) / block + 1)};
  MPI_Allreduce(MPI_IN_PLACE, ends.data(), 2, MPI_INT, MPI_MIN, beam_.comm());
  c.first = ends[0];
  c.last = -ends[1];
}

void Compliance::find_responses() {
  const auto left = [this](int element) { return line_.first_column + line_.mesh.element(element).left; };
  responses_.resize(elements_.size());
  std::size_t begin = 0;
  for (std::size_t b = 0; b < elements_.size(); ++b) {
    const Column& c = *active_[b];
    const auto first = std::partition_point(elements_.begin(), elements_.end(),
                                            [&](int element) { return left(element) + 1 < c.first; });
    const auto last = std::partition_point(first, elements_.end(), [&](int element) { return left(element) < c.last; });
    responses_[b] = {static_cast<int>(first - elements_.begin()), static_cast<int>(last - elements_.begin()), begin};
    begin += static_cast<std::size_t>(last - first) * m_ * m_;
  }
  blocks_.assign(begin, 0.0);
}

void Compliance::fill_blocks() {
  for (std::size_t b = 0; b < elements_.size(); ++b) {
    const Column& c = *active_[b];
    double* to = &blocks_[responses_[b].begin];
    for (int a = responses_[b].first; a < responses_[b].last; ++a, to += m_ * m_) {
      const auto unknowns = line_.unknowns(elements_[a]);
      for (int i = 0; i < m_; ++i) {
        const int unknown = beam_.local(unknowns[i]);
        if (unknown < c.low || unknown >= c.high) continue;
        for (int j = 0; j < m_; ++j)
          to[i + j * m_] = c.values[static_cast<std::size_t>(j) * (c.high - c.low) + (unknown - c.low)];
      }
    }
  }
  int ranks = 1;
  MPI_Comm_size(beam_.comm(), &ranks);
  if (ranks > 1)
    MPI_Allreduce(MPI_IN_PLACE, blocks_.data(), static_cast<int>(blocks_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
}

void Compliance::add_response(const std::vector<double>& loads, double* v) const {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
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
