#include "structure/rest_window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace traverse::structure {
namespace {
constexpr int steps_between_looks = 16;  // at the whole window, for the largest deflection and velocity
}

RestWindow::RestWindow(const beam::Beam& beam, const BeamOperator& op, double tolerance, std::vector<int> watched,
                       const double* rest)
    : beam_(beam),
      parts_(op.parts() != nullptr),
      shared_(op.shared()),
      tolerance_(tolerance),
      watched_(std::move(watched)),
      rest_(rest),
      past_(beam.columns()) {
  std::sort(watched_.begin(), watched_.end());
}

int RestWindow::local(int column) const { return std::clamp(column - beam_.first_column(), 0, beam_.local_columns()); }

// Of the nodes [first, past).
void RestWindow::note_largest(const double* v, const double* w, int first, int past) {
  const int block = beam_.block();
  for (int i = block * first; i < block * past; ++i) {
    Largest& largest = largest_[static_cast<std::size_t>(i % block)];
    largest.displacement = std::max(largest.displacement, std::abs(v[i] - (rest_ != nullptr ? rest_[i] : 0.0)));
    largest.rate = std::max(largest.rate, std::abs(w[i]));
  }
}

bool RestWindow::rests(int first, int past, const double* v, const double* w) const {
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

void RestWindow::begin(BeamMotion& motion, double* v, double* w, int low, int high) {
  first_ = 0;
  past_ = beam_.columns();
  low_ = low;
  high_ = high;
  steps_ = 0;
  close(motion, v, w);
}

void RestWindow::open(int low, int high, int reach) {
  low_ = low;
  high_ = high;
  if (low_ < high_) {
    first_ = first_ < past_ ? std::min(first_, low_) : low_;
    past_ = std::max(past_, high_);
  }
  first_ = std::max(0, first_ - reach);
  past_ = std::min(beam_.columns(), past_ + reach);
}

void RestWindow::close(BeamMotion& motion, double* v, double* w) {
  if (steps_ < steps_between_looks || steps_ % steps_between_looks == 0) {
    note_largest(v, w, local(first_), local(past_));
    if (shared_) agree();
  }
  ++steps_;
  // Each end by the rank that has it, a part or a node at a time.
  int first = local(first_), past = local(past_);
  const int low = low_ < high_ ? local(low_) : past, high = low_ < high_ ? local(high_) : first;
  const auto next = [&](int node) {
    if (!parts_) return node + 1;
    const auto& begins = beam_.parts();
    return *std::upper_bound(begins.begin(), begins.end(), node + beam_.first_column()) - beam_.first_column();
  };
  const auto previous = [&](int node) {
    if (!parts_) return node - 1;
    const auto& begins = beam_.parts();
    return std::lower_bound(begins.begin(), begins.end(), node + beam_.first_column())[-1] - beam_.first_column();
  };
  const bool mine_left = first_ >= beam_.first_column(),
             mine_right = past_ <= beam_.first_column() + beam_.local_columns();
  int from = first, to = past;
  while (mine_left && from < std::min(low, to) && rests(from, std::min(next(from), to), v, w)) from = next(from);
  while (mine_right && to > std::max(high, from) && rests(std::max(previous(to), from), to, v, w)) to = previous(to);
  if (from > first) energy_left_ += motion.put_to_rest(first, from, rest_, v, w);
  if (to < past) energy_left_ += motion.put_to_rest(to, past, rest_, v, w);
  const int begin = beam_.first_column();
  std::array<int, 2> ends = {from < to ? begin + from : beam_.columns(), from < to ? -(begin + to) : 0};
  if (shared_) MPI_Allreduce(MPI_IN_PLACE, ends.data(), 2, MPI_INT, MPI_MIN, beam_.comm());
  first_ = std::min(ends[0], -ends[1]);
  past_ = -ends[1];
}

void RestWindow::agree() {
  MPI_Allreduce(MPI_IN_PLACE, largest_.data(), 2 * static_cast<int>(largest_.size()), MPI_DOUBLE, MPI_MAX,
                beam_.comm());
}

}  // namespace traverse::structure
