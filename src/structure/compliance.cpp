// Solves for unit loads on one element's unknowns within a window that is doubled until the response at its ends is
// negligible; statics are solved on the whole beam or a separate part of it.
#include "structure/compliance.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace traverse::structure {

namespace {
constexpr std::size_t most_stored_values = std::size_t{8} << 20;  // numbers in columns that are not in use
constexpr double negligible = 1e-18;         // smaller responses, relative to a column's peak, are set to zero
constexpr std::ptrdiff_t least_margin = 32;  // nodes
constexpr int short_part = 100;              // columns: up to this length the static error 0.02 eps n^4 is small

/// Adds the response of the elements to `loads` to v, for elements with m unknowns.
template <int m>
void respond_by(const ElementCompliance& compliance, const std::vector<double>& loads, std::vector<double>& v) {
  using Vector = Eigen::Matrix<double, m, 1>;
  const int elements = static_cast<int>(loads.size()) / m;
  for (int b = 0; b < elements; ++b) {
    const Eigen::Map<const Vector> f(&loads[static_cast<std::size_t>(b) * m]);
    if (f.isZero(0.0)) continue;
    const ElementCompliance::Response& reach = compliance.response(b);
    for (int a = reach.first; a < reach.last; ++a)
      Eigen::Map<Vector>(&v[static_cast<std::size_t>(a) * m]) +=
          Eigen::Map<const Eigen::Matrix<double, m, m>>(compliance.block(a, b)) * f;
  }
}

}  // namespace

void ElementCompliance::respond(const std::vector<double>& loads, std::vector<double>& v) const {
  m_ == 4 ? respond_by<4>(*this, loads, v) : respond_by<6>(*this, loads, v);
}

Compliance::Compliance(const beam::Beam& beam, BeamOperator& op)
    : ElementCompliance(beam.running().per_node),
      beam_(beam),
      operator_(op),
      line_(beam.running()),
      margin_(least_margin) {
  std::size_t slots = static_cast<std::size_t>(line_.mesh.elements());
  if (const solve::Parts* parts = op.parts(); parts != nullptr) {
    slots = 0;
    for (int kind = 0; kind < static_cast<int>(parts->of_kind.size()); ++kind) {
      kind_slot_.push_back(slots);
      slots += static_cast<std::size_t>(parts->nodes(kind)) * static_cast<std::size_t>(line_.tracks());
    }
    const std::vector<int>& begins = beam.parts();
    short_parts_ = true;
    for (std::size_t i = 1; i < begins.size(); ++i)
      short_parts_ = short_parts_ && begins[i] - begins[i - 1] <= short_part;
    ++slots;  // the last slot is for the elements of other ranks
  }
  if (operator_.parts() == nullptr) slots *= static_cast<std::size_t>(line_.tracks());
  of_slot_.assign(slots, columns_.end());
}

void Compliance::prepare(double shift, double shift2, const AddedSprings* added, const std::vector<int>& elements) {
  const BeamFactor& factor = operator_.factored(shift, shift2, added);
  if (!individual_ && operator_.factor_stamp() == stamp_ && elements == elements_) return;
  const bool same_factor = find_columns() && !individual_;
  individual_ = false;
  std::swap(before_.elements, elements_);
  elements_ = elements;
  active_.clear();
  for (int e : elements) {
    const Column& c = column(factor, shift, added, e);
    const auto [first, last] = reach(e, c);
    active_.push_back({&c, place_of(e).unknown, first, last});
  }
  std::swap(before_.responses, responses_);
  std::swap(before_.blocks, blocks_);
  find_responses();
  fill_blocks(same_factor);
  delete_columns();
}

void Compliance::prepare_individual(double shift, double shift2, const AddedSprings* added,
                                    const std::vector<int>& elements) {
  const BeamFactor& factor = operator_.factored(shift, shift2, added);
  if (individual_ && operator_.factor_stamp() == stamp_ && elements == elements_) return;
  const bool same_factor = find_columns() && individual_;
  individual_ = true;
  std::swap(before_.elements, elements_);
  std::swap(before_.blocks, blocks_);
  elements_ = elements;
  active_.resize(elements.size());
  responses_.clear();
  const std::size_t size = static_cast<std::size_t>(m_) * m_;
  blocks_.assign(elements.size() * size, 0.0);
  std::size_t old = 0;
  for (int b = 0; b < static_cast<int>(elements.size()); ++b) {
    const int element = elements[static_cast<std::size_t>(b)];
    responses_.push_back({b, b + 1, static_cast<std::size_t>(b) * size});
    double* const to = &blocks_[responses_.back().begin];
    while (old < before_.elements.size() && before_.elements[old] < element) ++old;
    if (same_factor && old < before_.elements.size() && before_.elements[old] == element) {
      std::copy_n(&before_.blocks[old * size], size, to);
      continue;
    }
    active_[static_cast<std::size_t>(b)] = {&column(factor, shift, added, element), place_of(element).unknown, 0, 0};
    fill_block(b, b, to);
  }
  delete_columns();
}

// Finds the columns of the present factorisation. False if it is another one than before.
bool Compliance::find_columns() {
  const long stamp = operator_.factor_stamp();
  if (stamp == stamp_) return true;
  stamp_ = stamp;
  of_slot_.assign(of_slot_.size(), columns_.end());
  for (auto c = columns_.begin(); c != columns_.end();) {
    if (c->stamp == stamp) of_slot_[c->slot] = c;
    if (operator_.is_stored(c->stamp)) {
      ++c;
    } else {
      stored_values_ -= c->values.size();
      c = columns_.erase(c);
    }
  }
  return false;
}

// Deletes the oldest columns if more than most_stored_values numbers are stored.
void Compliance::delete_columns() {
  while (stored_values_ > most_stored_values && columns_.size() > elements_.size()) {
    const Column& oldest = columns_.back();
    stored_values_ -= oldest.values.size();
    if (oldest.stamp == stamp_) of_slot_[oldest.slot] = columns_.end();
    columns_.pop_back();
  }
}

int Compliance::reach(double shift, double shift2) {
  if (operator_.parts() != nullptr) return 0;
  const BeamFactor& factor = operator_.factored(shift, shift2);
  if (operator_.factor_stamp() != reach_stamp_)
    for (const int quarter : {1, 2, 3}) (void)solve_window(factor, quarter * line_.mesh.elements() / 4);
  reach_stamp_ = operator_.factor_stamp();
  return static_cast<int>(std::min<std::ptrdiff_t>(margin_, beam_.columns())) + 2;
}

void Compliance::keep(base::Bytes& bytes) {
  std::vector<Column> columns;
  if (!bytes.reads()) columns.assign(columns_.begin(), columns_.end());
  bytes(columns, margin_, reach_stamp_);
  if (!bytes.reads()) return;
  columns_.assign(columns.begin(), columns.end());
  stored_values_ = 0;
  for (const Column& column : columns_) stored_values_ += column.values.size();
  active_.clear();
  elements_.clear();
  before_.elements.clear();
  individual_ = false;
  stamp_ = -1;  // the next prepare finds the columns
}

Compliance::Place Compliance::place_of(int element) const {
  const solve::Parts* parts = operator_.parts();
  if (parts == nullptr) return {static_cast<std::size_t>(element), 0};
  const int node = line_.first_column + line_.mesh.element(element).left - beam_.first_column();
  if (node < 0 || node >= beam_.local_columns()) return {of_slot_.size() - 1, 0};
  const solve::Parts::Part& part = parts->at(node);
  const std::ptrdiff_t before = (part.past - part.first) * (element / line_.mesh.elements());  // of other tracks
  return {kind_slot_[static_cast<std::size_t>(part.kind)] + static_cast<std::size_t>(before + node - part.first),
          static_cast<int>(part.first) * beam_.block()};
}

// Returns the same columns on all ranks. If the beam has connected parts, it returns the whole part.
std::pair<int, int> Compliance::reach(int element, const Column& c) const {
  if (operator_.parts() == nullptr) return {c.first, c.last};
  const auto end = std::upper_bound(beam_.parts().begin(), beam_.parts().end(),
                                    line_.first_column + line_.mesh.element(element).left);
  return {end[-1], *end};
}

const Compliance::Column& Compliance::column(const BeamFactor& factor, double shift, const AddedSprings* added,
                                             int element) {
  const Place place = place_of(element);
  if (const auto found = of_slot_[place.slot]; found != columns_.end()) {
    columns_.splice(columns_.begin(), columns_, found);
    return columns_.front();
  }
  const bool parts = operator_.parts() != nullptr;
  const bool by_parts = parts && (shift > 0.0 || short_parts_);
  const std::ptrdiff_t first = by_parts      ? solve_part(factor, element)
                               : shift > 0.0 ? solve_window(factor, element)
                                             : solve_statics(element, added);
  columns_.emplace_front();
  Column& c = columns_.front();
  c.slot = place.slot;
  c.stamp = stamp_;
  store(c, first, place.unknown);
  // Static columns that all ranks compute together are not shared with equal elements.
  if (by_parts || !parts) of_slot_[place.slot] = columns_.begin();
  stored_values_ += c.values.size();
  return c;
}

// Sets unit loads on the element's unknowns, in columns of the nodes [first, past).
void Compliance::load_element(int element, std::ptrdiff_t first, std::ptrdiff_t past) {
  const std::ptrdiff_t size = (past - first) * beam_.block();
  work_.assign(static_cast<std::size_t>(size * m_), 0.0);
  line_.for_unknowns(element, [&](int j, int global, double factor) {
    const int unknown = beam_.local(global);
    const std::ptrdiff_t place = unknown - first * beam_.block();
    if (unknown >= 0 && place >= 0 && place < size && beam_.fixed()[unknown] == 0)
      work_[static_cast<std::size_t>(j * size + place)] += factor;
  });
}

// Stores the solutions in work_; returns their first local node.
std::ptrdiff_t Compliance::solve_part(const BeamFactor& factor, int element) {
  const int node = line_.first_column + line_.mesh.element(element).left - beam_.first_column();
  if (node < 0 || node >= beam_.local_columns()) {
    work_.clear();
    return 0;
  }
  const solve::Parts::Part& part = operator_.parts()->at(node);
  load_element(element, part.first, part.past);
  factor.solve_local(work_.data(), m_, part.first, part.past);
  operator_.solves += m_;
  return part.first;
}

// Uses a window around the element, at whose ends the response is negligible.
std::ptrdiff_t Compliance::solve_window(const BeamFactor& factor, int element) {
  const std::ptrdiff_t nodes = beam_.local_columns();
  const std::ptrdiff_t left = line_.first_column + line_.mesh.element(element).left - beam_.first_column();
  for (;; margin_ *= 2) {
    const std::ptrdiff_t first = std::clamp<std::ptrdiff_t>(left - margin_, 0, nodes);
    const std::ptrdiff_t past = std::clamp<std::ptrdiff_t>(left + 2 + margin_, 0, nodes);
    const std::ptrdiff_t size = (past - first) * beam_.block();
    load_element(element, first, past);
    factor.solve_local(work_.data(), m_, first, past);
    operator_.solves += m_;
    // For each unit load: its largest response in the window, and at those window ends that are inside the bridge;
    // maximum over all ranks.
    std::array<double, 2 * 2 * beam::kinds> sizes{};
    for (int j = 0; j < m_; ++j) {
      const double* x = work_.data() + j * size;
      double& peak = sizes[2 * j];
      double& end = sizes[2 * j + 1];
      for (std::ptrdiff_t i = 0; i < size; ++i) peak = std::max(peak, std::abs(x[i]));
      for (std::ptrdiff_t i = 0; i < std::min<std::ptrdiff_t>(size, beam_.block()); ++i) {
        if (left - margin_ + beam_.first_column() > 0 && first == left - margin_) end = std::max(end, std::abs(x[i]));
        if (left + 2 + margin_ + beam_.first_column() < beam_.columns() && past == left + 2 + margin_)
          end = std::max(end, std::abs(x[size - 1 - i]));
      }
    }
    if (operator_.shared()) MPI_Allreduce(MPI_IN_PLACE, sizes.data(), 2 * m_, MPI_DOUBLE, MPI_MAX, beam_.comm());
    bool decayed = true;
    for (int j = 0; j < m_; ++j) decayed = decayed && sizes[2 * j + 1] <= negligible * sizes[2 * j];
    if (decayed || margin_ > beam_.columns()) return first;
  }
}

std::ptrdiff_t Compliance::solve_statics(int element, const AddedSprings* added) {
  const std::ptrdiff_t n = operator_.unknowns();
  load_element(element, 0, beam_.local_columns());
  for (int j = 0; j < m_; ++j) operator_.solve_static(work_.data() + j * n, added);
  return 0;
}

// Stores the solution in work_, which begins at local node `first`, where it exceeds rounding.
void Compliance::store(Column& c, std::ptrdiff_t first, int base_unknown) const {
  const int n = static_cast<int>(work_.size()) / m_, block = beam_.block();
  int lowest = n, highest = 0;
  for (int j = 0; j < m_; ++j) {
    const double* x = work_.data() + static_cast<std::ptrdiff_t>(j) * n;
    double peak = 0.0;
    for (int i = 0; i < n; ++i) peak = std::max(peak, std::abs(x[i]));
    int low = 0, high = n;
    while (low < high && std::abs(x[low]) <= negligible * peak) ++low;
    while (high > low && std::abs(x[high - 1]) <= negligible * peak) --high;
    if (low < high) {
      lowest = std::min(lowest, low);
      highest = std::max(highest, high);
    }
  }
  const int size = std::max(0, highest - lowest);
  c.values.resize(static_cast<std::size_t>(size) * m_);
  for (int j = 0; j < m_; ++j)
    if (size > 0)
      std::copy_n(work_.data() + static_cast<std::ptrdiff_t>(j) * n + lowest, size,
                  c.values.data() + static_cast<std::ptrdiff_t>(j) * size);
  const int offset = static_cast<int>(first) * block - base_unknown;
  c.low = offset + lowest;
  c.high = c.low + size;
  const int begin = beam_.first_column() + static_cast<int>(first);
  if (operator_.parts() != nullptr) return;
  const int none = std::numeric_limits<int>::max();
  std::array<int, 2> ends = {none, none};  // the least of first and of -last
  if (size > 0) ends = {begin + lowest / block, -(begin + (highest - 1) / block + 1)};
  if (operator_.shared()) MPI_Allreduce(MPI_IN_PLACE, ends.data(), 2, MPI_INT, MPI_MIN, beam_.comm());
  c.first = ends[0];
  c.last = -ends[1];
}

void Compliance::find_responses() {
  const auto left = [this](int element) { return line_.first_column + line_.mesh.element(element).left; };
  responses_.resize(elements_.size());
  std::size_t begin = 0;
  for (std::size_t b = 0; b < elements_.size(); ++b) {
    if (line_.tracks() > 1) {  // the elements of a column are not neighbours in the list
      responses_[b] = {0, static_cast<int>(elements_.size()), begin};
      begin += elements_.size() * m_ * m_;
      continue;
    }
    const Active& c = active_[b];
    const auto first = std::partition_point(elements_.begin(), elements_.end(),
                                            [&](int element) { return left(element) + 1 < c.first; });
    const auto last = std::partition_point(first, elements_.end(), [&](int element) { return left(element) < c.last; });
    responses_[b] = {static_cast<int>(first - elements_.begin()), static_cast<int>(last - elements_.begin()), begin};
    begin += static_cast<std::size_t>(last - first) * m_ * m_;
  }
  blocks_.resize(begin);
}

// Copies the blocks of the previous list: a wheel that enters an element changes few blocks.
void Compliance::fill_blocks(bool same_factor) {
  const std::size_t size = static_cast<std::size_t>(m_) * m_;
  previous_index_.assign(elements_.size(), -1);
  for (std::size_t e = 0, old = 0; same_factor && e < elements_.size(); ++e) {
    while (old < before_.elements.size() && before_.elements[old] < elements_[e]) ++old;
    if (old < before_.elements.size() && before_.elements[old] == elements_[e])
      previous_index_[e] = static_cast<int>(old);
  }
  new_blocks_.clear();
  new_begin_.clear();
  for (int b = 0; b < static_cast<int>(elements_.size()); ++b) {
    std::size_t to = responses_[b].begin;
    for (int a = responses_[b].first; a < responses_[b].last; ++a, to += size) {
      if (previous_index_[a] >= 0 && previous_index_[b] >= 0) {
        const Response& old = before_.responses[previous_index_[b]];
        const double* from =
            &before_.blocks[old.begin + static_cast<std::size_t>(previous_index_[a] - old.first) * size];
        std::copy_n(from, size, &blocks_[to]);
        continue;
      }
      new_begin_.push_back(to);
      new_blocks_.resize(new_blocks_.size() + size, 0.0);
      fill_block(a, b, &new_blocks_[new_blocks_.size() - size]);
    }
  }
  if (operator_.shared() && !new_blocks_.empty())
    MPI_Allreduce(MPI_IN_PLACE, new_blocks_.data(), static_cast<int>(new_blocks_.size()), MPI_DOUBLE, MPI_SUM,
                  beam_.comm());
  for (std::size_t i = 0; i < new_begin_.size(); ++i)
    std::copy_n(&new_blocks_[i * size], size, &blocks_[new_begin_[i]]);
}

// Fills this rank's rows of the block; the other entries are unchanged.
void Compliance::fill_block(int a, int b, double* to) const {
  const Column& c = *active_[b].column;
  line_.for_unknowns(elements_[a], [&](int i, int global, double factor) {
    const int local = beam_.local(global), unknown = local - active_[b].unknown;
    if (local < 0 || unknown < c.low || unknown >= c.high) return;
    for (int j = 0; j < m_; ++j)
      to[i + j * m_] += factor * c.values[static_cast<std::size_t>(j) * (c.high - c.low) + (unknown - c.low)];
  });
}

void Compliance::add_response(const std::vector<double>& loads, double* v) const {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Column& c = *active_[e].column;
    const int size = c.high - c.low;
    double* to = v + active_[e].unknown + c.low;
    for (int j = 0; j < m_; ++j) {
      const double f = loads[e * m_ + j];
      if (f == 0.0 || size <= 0) continue;
      const double* x = c.values.data() + static_cast<std::ptrdiff_t>(j) * size;
      for (int i = 0; i < size; ++i) to[i] += f * x[i];
    }
  }
}

}  // namespace traverse::structure
