// Finds the probes in ranges of columns by binary search.
#include "run/moving_probes.hpp"

#include <algorithm>

namespace traverse::run {

MovingProbes::MovingProbes(const recovery::Recovery& recovery, const beam::Line& line)
    : all_(recovery.all()), now_(all_), before_(all_) {
  for (const std::size_t probe : all_) in_columns_.emplace_back(line.first_column + recovery.node_of(probe), probe);
  std::sort(in_columns_.begin(), in_columns_.end());
}

void MovingProbes::update(const std::optional<std::vector<structure::Range>>& moving) {
  now_ = moving ? before_ : all_;
  if (!moving) return;
  before_.clear();
  for (const structure::Range& range : *moving) {  // a probe's element ends in the column behind its own
    auto probe = std::lower_bound(in_columns_.begin(), in_columns_.end(), std::pair(range.first - 1, std::size_t{0}));
    for (; probe != in_columns_.end() && probe->first < range.past; ++probe) before_.push_back(probe->second);
  }
  now_.insert(now_.end(), before_.begin(), before_.end());
  std::sort(now_.begin(), now_.end());
  now_.erase(std::unique(now_.begin(), now_.end()), now_.end());
}

}  // namespace traverse::run
