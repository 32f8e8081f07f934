// Extends the moving ranges of nodes by the reach of waves within a step, and removes nodes whose displacement and
// velocity are below a tolerance relative to their largest values.
#include "structure/active_window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace traverse::structure {
namespace {
constexpr int steps_between_looks = 16;  // at all that moves, for the largest deflection and velocity, and for rest
constexpr int worth_parting = 4;         // times how far a load is felt, of a stretch that rests between two loads
}  // namespace

ActiveWindow::ActiveWindow(const beam::Beam& beam, const BeamOperator& op, double tolerance, std::vector<int> watched,
                           const double* rest)
    : beam_(beam),
      parts_(op.parts() != nullptr),
      shared_(op.shared()),
      tolerance_(tolerance),
      watched_(std::move(watched)),
      rest_(rest),
      moving_{{0, beam.columns()}} {
  std::sort(watched_.begin(), watched_.end());
}

int ActiveWindow::local(int column) const {
  return std::clamp(column - beam_.first_column(), 0, beam_.local_columns());
}

// Of the nodes [first, past).
void ActiveWindow::record_largest(const double* v, const double* w, int first, int past) {
  const int block = beam_.block();
  for (int i = block * first; i < block * past; ++i) {
    Largest& largest = largest_[static_cast<std::size_t>(i % block)];
    largest.displacement = std::max(largest.displacement, std::abs(v[i] - (rest_ != nullptr ? rest_[i] : 0.0)));
    largest.rate = std::max(largest.rate, std::abs(w[i]));
  }
}

bool ActiveWindow::rests(int first, int past, const double* v, const double* w) const {
  const int from = first + beam_.first_column(), to = past + beam_.first_column();
  const auto watched = std::lower_bound(watched_.begin(), watched_.end(), from);
  const double limit = watched != watched_.end() && *watched < to ? std::min(quiet, tolerance_) : tolerance_;
  const int block = beam_.block();
  for (int i = block * first; i < block * past; ++i) {
    const Largest& largest = largest_[static_cast<std::size_t>(i % block)];
    if (std::abs(v[i] - (rest_ != nullptr ? rest_[i] : 0.0)) > limit * largest.displacement ||
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

// The node behind, or where the part of this one ends.
int ActiveWindow::next(int node) const {
  if (!parts_) return node + 1;
  const auto& begins = beam_.parts();
  return *std::upper_bound(begins.begin(), begins.end(), node + beam_.first_column()) - beam_.first_column();
}

int ActiveWindow::previous(int node) const {
  if (!parts_) return node - 1;
  const auto& begins = beam_.parts();
  return std::lower_bound(begins.begin(), begins.end(), node + beam_.first_column())[-1] - beam_.first_column();
}

// Nodes of this rank, each end by the rank that has it, a part or a node at a time.
Range ActiveWindow::trimmed(const Range& range, const double* v, const double* w) const {
  Range r{local(range.first), local(range.past)};
  int low = r.past, high = r.first;
  for (const Range& load : loaded_) {
    if (!is_loaded_in(range, load)) continue;
    low = std::min(low, local(load.first));
    high = std::max(high, local(load.past));
  }
  const bool mine_left = range.first >= beam_.first_column(),
             mine_right = range.past <= beam_.first_column() + beam_.local_columns();
  while (mine_left && r.first < std::min(low, r.past) && rests(r.first, std::min(next(r.first), r.past), v, w))
    r.first = next(r.first);
  while (mine_right && r.past > std::max(high, r.first) && rests(std::max(previous(r.past), r.first), r.past, v, w))
    r.past = previous(r.past);
  return r;
}

// Of ranges of this rank's nodes: the columns that those of all ranks reach over.
void ActiveWindow::agree_on_ends() {
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
  const bool sampling_interval = steps_ % steps_between_looks == 0;
  if (steps_ < steps_between_looks || sampling_interval) {
    for (const Range& r : moving_) record_largest(v, w, local(r.first), local(r.past));
    if (shared_) agree();
  }
  ++steps_;
  for (Range& range : moving_) {
    const Range r = trimmed(range, v, w);
    const int first = local(range.first), past = local(range.past);
    if (r.first > first) energy_left_ += motion.put_to_rest(first, r.first, rest_, v, w);
    if (r.past < past) energy_left_ += motion.put_to_rest(r.past, past, rest_, v, w);
    range = r;
  }
  agree_on_ends();
  if (sampling_interval && !shared_) part(motion, v, w);
}

// Where it rests between two loads.
void ActiveWindow::part(BeamMotion& motion, double* v, double* w) {
  parted_.clear();
  for (Range range : moving_) {
    const Range* before = nullptr;
    for (const Range& load : loaded_) {
      if (!is_loaded_in(range, load)) continue;
      const Range rest = before == nullptr ? Range{} : longest_rest({before->past, load.first}, v, w);
      before = &load;
      if (rest.past - rest.first <= (parts_ ? 0 : worth_parting * std::max(reach_, 1))) continue;
      energy_left_ += motion.put_to_rest(rest.first, rest.past, rest_, v, w);
      parted_.push_back({range.first, rest.first});
      range.first = rest.past;
    }
    parted_.push_back(range);
  }
  merge(parted_);
  std::swap(moving_, parted_);
}

Range ActiveWindow::longest_rest(Range gap, const double* v, const double* w) const {
  Range longest, now{gap.first, gap.first};
  for (int node = gap.first; node < gap.past;) {
    const int behind = std::min(next(node), gap.past);
    now = rests(node, behind, v, w) ? Range{now.first, behind} : Range{behind, behind};
    if (now.past - now.first > longest.past - longest.first) longest = now;
    node = behind;
  }
  return longest;
}

void ActiveWindow::agree() {
  MPI_Allreduce(MPI_IN_PLACE, largest_.data(), 2 * static_cast<int>(largest_.size()), MPI_DOUBLE, MPI_MAX,
                beam_.comm());
}

}  // namespace traverse::structure
