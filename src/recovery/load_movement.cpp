// Finds the loads of the previous instant by their numbers, and the stations between both positions of each load.
#include "recovery/load_movement.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace traverse::recovery {

LoadMovement::LoadMovement(const Recovery& recovery) : recovery_(recovery), along_(recovery.stations().size()) {
  std::iota(along_.begin(), along_.end(), std::size_t{0});
  std::sort(along_.begin(), along_.end(),
            [&](std::size_t one, std::size_t other) { return recovery.stations()[one] < recovery.stations()[other]; });
}

void LoadMovement::advance(double t, const std::vector<ElementLoad>& loads) {
  interval_ = first_ ? 0.0 : t - time_;
  moved_.clear();
  passages_.clear();
  if (interval_ > 0.0) {
    record_moved(loads);
    record_passages();
  }
  loads_ = loads;
  time_ = t;
  first_ = false;
}

/// Loads have the same order from instant to instant: the search continues behind the load that was found last. A load
/// that appears or disappears elsewhere than at an end, as a wheel that lands or takes off, has not moved.
void LoadMovement::record_moved(const std::vector<ElementLoad>& loads) {
  found_.assign(loads_.size(), 0);
  std::size_t next = 0;
  for (const ElementLoad& load : loads) {
    if (load.source < 0) continue;
    std::size_t searched = 0;
    while (searched < loads_.size() && loads_[(next + searched) % loads_.size()].source != load.source) ++searched;
    const double x = recovery_.x_of(load), entered_from = x - load.speed * interval_;
    if (searched < loads_.size()) {
      next = (next + searched) % loads_.size();
      const ElementLoad& from = loads_[next];
      moved_.push_back({from, load, recovery_.x_of(from), x});
      found_[next++] = 1;
    } else if (recovery_.is_outside(entered_from)) {
      moved_.push_back({load, load, entered_from, x});
    }
  }
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    const double x = recovery_.x_of(loads_[i]), to = x + loads_[i].speed * interval_;
    if (found_[i] == 0 && loads_[i].source >= 0 && recovery_.is_outside(to))
      moved_.push_back({loads_[i], loads_[i], x, to});
  }
}

void LoadMovement::record_passages() {
  const std::vector<double>& x = recovery_.stations();
  const double margin = recovery_.greatest_tolerance();
  for (const Moved& m : moved_) {
    const auto [rear, front] = std::minmax(m.x_from, m.x_to);
    auto at = std::lower_bound(along_.begin(), along_.end(), rear - margin,
                               [&](std::size_t station, double limit) { return x[station] < limit; });
    for (; at != along_.end() && x[*at] <= front + margin; ++at) {
      if (recovery_.is_left_of(*at, m.x_from) == recovery_.is_left_of(*at, m.x_to)) continue;
      const double part = std::clamp((x[*at] - m.x_from) / (m.x_to - m.x_from), 0.0, 1.0);
      passages_.push_back({*at, time_ + interval_ * part});
    }
  }
  std::sort(passages_.begin(), passages_.end(), [](const StationPassage& a, const StationPassage& b) {
    return std::tie(a.station, a.time) < std::tie(b.station, b.time);
  });
}

}  // namespace traverse::recovery
