// Extends the moving ranges of nodes by the reach of waves within a step, and removes nodes whose displacement and
// velocity are below a tolerance relative to their largest values.
#include "structure/active_window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace traverse::structure {
namespace {
constexpr int steps_between_checks = 16;  // number of time steps between updates of the largest displacement and
                                          // velocity, and between divisions of ranges
constexpr int split_factor = 4;           // least length of a range at rest between two loads, over the reach of a load
}  // namespace

ActiveWindow::ActiveWindow(const beam::Beam& beam, const BeamOperator& op, const WindowTolerance& tolerance,
                           std::vector<int> probes, const double* rest)
    : beam_(beam),
      parts_(op.parts() != nullptr),
      shared_(op.shared()),
      tolerance_(tolerance),
      probe_columns_(std::move(probes)),
      at_rest_(rest),
      moving_{{0, beam.columns()}} {
  std::sort(probe_columns_.begin(), probe_columns_.end());
}

int ActiveWindow::local(int column) const {
  return std::clamp(column - beam_.first_column(), 0, beam_.local_columns());
}

// Updates the largest motion with the nodes [first, past).
void ActiveWindow::record_largest(const double* v, const double* w, int first, int past) {
  const int block = beam_.block();
  for (int i = block * first; i < block * past; ++i) {
    Largest& largest = largest_[static_cast<std::size_t>(i % block)];
    largest.displacement = std::max(largest.displacement, std::abs(v[i] - (at_rest_ != nullptr ? at_rest_[i] : 0.0)));
    largest.rate = std::max(largest.rate, std::abs(w[i]));
  }
}

bool ActiveWindow::is_quiet(int first, int past, const double* v, const double* w) const {
  const int from = first + beam_.first_column(), to = past + beam_.first_column();
  const auto probes = std::lower_bound(probe_columns_.begin(), probe_columns_.end(), from);
  const double limit = probes != probe_columns_.end() && *probes < to ? tolerance_.at_probes : tolerance_.elsewhere;
  const int block = beam_.block();
  for (int i = block * first; i < block * past; ++i) {
    const Largest& largest = largest_[static_cast<std::size_t>(i % block)];
    if (std::abs(v[i] - (at_rest_ != nullptr ? at_rest_[i] : 0.0)) > limit * largest.displacement ||
        std::abs(w[i]) > limit * largest.rate)
      return false;
  }
  return true;
}

void ActiveWindow::begin(BeamMotion& motion, double* v, double* w, const std::vector<Range>& loaded) {
  moving_ = {{0, beam_.columns()}};
  loaded_ = loaded;
  steps_ = 0;
  close(motion, v, w);
}

void ActiveWindow::open(const std::vector<Range>& loaded, int reach) {
  loaded_ = loaded;
  reach_ = reach;
  moving_.insert(moving_.end(), loaded.begin(), loaded.end());
  for (Range& r : moving_) r = {std::max(0, r.first - reach), std::min(beam_.columns(), r.past + reach)};
  merge(moving_);
}

// Sets the quiet parts without loads to rest. Ranks may share a part.
void ActiveWindow::close_parts(BeamMotion& motion, double* v, double* w) {
  const std::vector<int>& begins = beam_.parts();
  const auto for_parts = [&](const auto& use) {
    for (const Range& range : moving_)
      for (auto begin = std::lower_bound(begins.begin(), begins.end(), range.first); *begin < range.past; ++begin)
        use(Range{begin[0], begin[1]});
  };
  quiet_.clear();
  auto load = loaded_.begin();
  for_parts([&](const Range& part) {
    while (load != loaded_.end() && load->past <= part.first) ++load;
    const bool loaded = load != loaded_.end() && load->first < part.past;
    quiet_.push_back(!loaded && is_quiet(local(part.first), local(part.past), v, w) ? 1 : 0);
  });
  if (shared_)
    MPI_Allreduce(MPI_IN_PLACE, quiet_.data(), static_cast<int>(quiet_.size()), MPI_CHAR, MPI_MIN, beam_.comm());
  split_.clear();
  auto is_at_rest = quiet_.begin();
  for_parts([&](const Range& part) {
    if (*is_at_rest++ == 0)
      split_.push_back(part);
    else
      energy_left_ += motion.set_to_rest(local(part.first), local(part.past), at_rest_, v, w);
  });
  merge(split_);
  std::swap(moving_, split_);
}

// Trims a range of this rank's nodes, each end on the rank that has it.
Range ActiveWindow::trimmed(const Range& range, const double* v, const double* w) const {
  Range r{local(range.first), local(range.past)};
  int low = r.past, high = r.first;
  for (const Range& load : loaded_) {
    if (!is_loaded_in(range, load)) continue;
    low = std::min(low, local(load.first));
    high = std::max(high, local(load.past));
  }
  const bool own_left = range.first >= beam_.first_column(),
             own_right = range.past <= beam_.first_column() + beam_.local_columns();
  while (own_left && r.first < std::min(low, r.past) && is_quiet(r.first, r.first + 1, v, w)) ++r.first;
  while (own_right && r.past > std::max(high, r.first) && is_quiet(r.past - 1, r.past, v, w)) --r.past;
  return r;
}

// Converts the ranges of this rank's nodes to the ranges of columns on all ranks.
void ActiveWindow::share_ends() {
  const int begin = beam_.first_column();
  ends_.clear();
  for (const Range& r : moving_) {
    ends_.push_back(r.first < r.past ? begin + r.first : beam_.columns());
    ends_.push_back(r.first < r.past ? -(begin + r.past) : 0);
  }
  if (shared_)
    MPI_Allreduce(MPI_IN_PLACE, ends_.data(), static_cast<int>(ends_.size()), MPI_INT, MPI_MIN, beam_.comm());
  for (std::size_t i = 0; i < moving_.size(); ++i) moving_[i] = {ends_[2 * i], -ends_[2 * i + 1]};
  merge(moving_);
}

void ActiveWindow::close(BeamMotion& motion, double* v, double* w) {
  const bool check_due = steps_ % steps_between_checks == 0;
  if (steps_ < steps_between_checks || check_due) {
    for (const Range& r : moving_) record_largest(v, w, local(r.first), local(r.past));
    share_largest();
  }
  ++steps_;
  if (parts_) {
    if (check_due) close_parts(motion, v, w);
    return;
  }
  for (Range& range : moving_) {
    const Range r = trimmed(range, v, w);
    const int first = local(range.first), past = local(range.past);
    if (r.first > first) energy_left_ += motion.set_to_rest(first, r.first, at_rest_, v, w);
    if (r.past < past) energy_left_ += motion.set_to_rest(r.past, past, at_rest_, v, w);
    range = r;
  }
  share_ends();
  if (check_due && !shared_) split(motion, v, w);
}

// Divides ranges that are at rest between two loads.
void ActiveWindow::split(BeamMotion& motion, double* v, double* w) {
  split_.clear();
  for (Range range : moving_) {
    const Range* before = nullptr;
    for (const Range& load : loaded_) {
      if (!is_loaded_in(range, load)) continue;
      const Range quiet_range = before == nullptr ? Range{} : longest_quiet_range({before->past, load.first}, v, w);
      before = &load;
      if (quiet_range.past - quiet_range.first <= split_factor * std::max(reach_, 1)) continue;
      energy_left_ += motion.set_to_rest(quiet_range.first, quiet_range.past, at_rest_, v, w);
      split_.push_back({range.first, quiet_range.first});
      range.first = quiet_range.past;
    }
    split_.push_back(range);
  }
  merge(split_);
  std::swap(moving_, split_);
}

Range ActiveWindow::longest_quiet_range(Range gap, const double* v, const double* w) const {
  Range longest, current{gap.first, gap.first};
  for (int node = gap.first; node < gap.past; ++node) {
    current = is_quiet(node, node + 1, v, w) ? Range{current.first, node + 1} : Range{node + 1, node + 1};
    if (current.past - current.first > longest.past - longest.first) longest = current;
  }
  return longest;
}

void ActiveWindow::share_largest() {
  const MPI_Comm comm = shared_ ? beam_.comm() : beside_;
  if (comm == MPI_COMM_NULL) return;
  MPI_Allreduce(MPI_IN_PLACE, largest_.data(), 2 * static_cast<int>(largest_.size()), MPI_DOUBLE, MPI_MAX, comm);
}

void ActiveWindow::add(const std::vector<Range>& columns) {
  moving_.insert(moving_.end(), columns.begin(), columns.end());
  merge(moving_);
}

void ActiveWindow::remove(const std::vector<Range>& columns) {
  subtract(moving_, columns, split_);
  std::swap(moving_, split_);
}

std::vector<Range> ActiveWindow::probed() const {
  const std::vector<int>& begins = beam_.parts();
  std::vector<Range> parts;
  for (const Range& range : moving_)
    for (auto probe = std::lower_bound(probe_columns_.begin(), probe_columns_.end(), range.first);
         probe != probe_columns_.end() && *probe < range.past; ++probe) {
      const auto next = std::upper_bound(begins.begin(), begins.end(), *probe);
      parts.push_back({next[-1], next[0]});
    }
  merge(parts);
  return parts;
}

}  // namespace traverse::structure
