// Finds the loads of the previous instant by their numbers, and the stations between both positions of each load.
// Integrates m + b dm/dt = c exactly from call to call, with c piecewise linear in time and discontinuous when a load
// passes the station.
#include "recovery/load_movement.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace traverse::recovery {
namespace {

ElementLoad between(const ElementLoad& from, const ElementLoad& to, double part) {
  const auto at = [&](double a, double b) { return a + part * (b - a); };
  ElementLoad load = to;
  load.fx = at(from.fx, to.fx);
  load.fy = at(from.fy, to.fy);
  load.moment = at(from.moment, to.moment);
  return load;
}

}  // namespace

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
    std::stable_sort(moved_.begin(), moved_.end(), [](const Moved& one, const Moved& other) {
      return std::min(one.x_from, one.x_to) < std::min(other.x_from, other.x_to);
    });
    longest_way_ = 0.0;
    for (const Moved& m : moved_) longest_way_ = std::max(longest_way_, std::abs(m.x_to - m.x_from));
    record_passages();
  }
  loads_ = loads;
  time_ = t;
  first_ = false;
}

std::span<const LoadMovement::Moved> LoadMovement::moved(double from, double to) const {
  const auto begins_before = [](const Moved& m, double x) { return std::min(m.x_from, m.x_to) < x; };
  const double margin = recovery_.greatest_tolerance();
  const auto first = std::lower_bound(moved_.begin(), moved_.end(), from - margin - longest_way_, begins_before);
  return {first, std::lower_bound(first, moved_.end(), to + margin, begins_before)};
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

/// The contributions of loads that move through the station's element, at the ends of parts of the interval, as if each
/// load remained on the side of the station from which it came, and the jumps when they pass the station. Returns
/// whether there are such loads.
bool ViscousLag::add_passing_loads(std::size_t station, History& by_loads) {
  const auto [left, right] = recovery_.element_of(station);
  const double x = recovery_.stations()[station];
  jumps_.clear();
  bool any = false;
  for (const LoadMovement::Moved& moved : movement_.moved(left, right)) {
    const double way = moved.x_to - moved.x_from;
    const bool was_left = recovery_.is_left_of(station, moved.x_from);
    const bool is_left = recovery_.is_left_of(station, moved.x_to);
    const bool outside = std::max(moved.x_from, moved.x_to) <= left || std::min(moved.x_from, moved.x_to) >= right;
    if (outside && was_left == is_left) continue;
    if (!any) by_loads.fill({});
    any = true;
    for (std::size_t k = 0; k <= parts; ++k) {
      const double part = static_cast<double>(k) / parts, at = moved.x_from + part * way;
      const ElementLoad load = between(moved.from, moved.to, part);
      const Forces added = recovery_.inside(station, at, load, was_left);
      for (std::size_t f = 0; f < added.size(); ++f) by_loads[k][f] += added[f];
    }
    if (was_left == is_left) continue;
    Jump jump{recovery_.jump(station, moved.to),
              movement_.interval() * (1.0 - std::clamp((x - moved.x_from) / way, 0.0, 1.0))};
    for (double& by : jump.by) by *= is_left ? 1.0 : -1.0;
    jumps_.push_back(jump);
  }
  return any;
}

// Solves m + b dm/dt = c, exactly for c that is linear in each part and jumps when loads pass the station.
void ViscousLag::advance_lag(std::size_t station, const Forces& c) {
  Inner& inner = inner_[station];
  History by_loads;
  const bool moving = add_passing_loads(station, by_loads);
  const double interval = movement_.interval(), h = moving ? interval / parts : interval, decay = std::exp(-h / b_);
  for (double& part : inner.unrelaxed) part *= std::exp(-interval / b_);
  for (std::size_t f = 0; f < c.size(); ++f) {
    const auto advance = [&, m = &inner.m[f]](double from, double to) {
      const double lag = b_ * (to - from) / h;
      *m = to - lag + (*m - from + lag) * decay;
    };
    if (!moving) {
      advance(inner.c[f], c[f]);
      continue;
    }
    double end = c[f] - by_loads[parts][f];
    for (const Jump& jump : jumps_) end -= jump.by[f];
    const double remainder = inner.c[f] - by_loads[0][f], change = (end - remainder) / parts;
    for (std::size_t k = 0; k < parts; ++k)
      advance(remainder + change * static_cast<double>(k) + by_loads[k][f],
              remainder + change * static_cast<double>(k + 1) + by_loads[k + 1][f]);
    for (const Jump& jump : jumps_) {
      const double lag = jump.by[f] * std::exp(-jump.ago / b_);
      inner.m[f] += jump.by[f] - lag;
      inner.unrelaxed[f] -= lag;
    }
  }
}

void ViscousLag::apply(std::vector<Response>& responses, const std::vector<std::size_t>& which) {
  for (const std::size_t i : which) {
    Response& r = responses[i];
    Inner& inner = inner_[i];
    const Forces nodal = {r.nodal_moment, r.nodal_shear, r.nodal_axial_force};
    const Forces c = {r.moment - nodal[0], r.shear - nodal[1], r.axial_force - nodal[2]};
    if (first_) inner.m = c;
    if (movement_.interval() > 0.0) advance_lag(i, c);
    inner.c = c;
    r.moment = nodal[0] + inner.m[0];
    r.shear = nodal[1] + inner.m[1];
    r.axial_force = nodal[2] + inner.m[2];
    r.moment_rate = r.nodal_moment_rate + (c[0] - inner.m[0]) / b_;
    r.unrelaxed_shear = inner.unrelaxed[1];
    r.unrelaxed_axial_force = inner.unrelaxed[2];
  }
  first_ = false;
}

}  // namespace traverse::recovery
