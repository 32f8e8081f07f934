// Integrates m + b dm/dt = c exactly from call to call, with c piecewise linear in time and discontinuous where a load
// passes the station.
#include "recovery/viscous_lag.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::beam {
namespace {

constexpr double same_load = 0.1;  // of its way: so near where it should have come from a load was at the call before

ElementLoad between(const ElementLoad& from, const ElementLoad& to, double part) {
  const auto at = [&](double a, double b) { return a + part * (b - a); };
  ElementLoad load = to;
  load.fx = at(from.fx, to.fx);
  load.fy = at(from.fy, to.fy);
  load.moment = at(from.moment, to.moment);
  return load;
}

}  // namespace

/// Loads come in the same order from call to call, but for those that come onto the beam or leave it: the search goes
/// on behind the load that was found last.
void ViscousLag::record_moved(const std::vector<ElementLoad>& loads) {
  moved_.clear();
  found_.assign(loads_.size(), 0);
  std::size_t next = 0;
  for (const ElementLoad& load : loads) {
    const double x = recovery_.x_of(load), way = load.speed * interval_;
    if (way == 0.0) continue;
    Moved moved{load, load, x - way, x, false, true};
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      const std::size_t at = (next + i) % loads_.size();
      const double x_at = recovery_.x_of(loads_[at]);
      if (loads_[at].speed * load.speed <= 0.0 || std::abs(x_at - (x - way)) > same_load * std::abs(way)) continue;
      moved.from = loads_[at];
      moved.x_from = x_at;
      moved.was_there = true;
      found_[at] = 1;
      next = at + 1;
      break;
    }
    moved_.push_back(moved);
  }
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    const double x = recovery_.x_of(loads_[i]), to = x + loads_[i].speed * interval_;
    if (found_[i] == 0 && recovery_.is_beyond(to)) moved_.push_back({loads_[i], loads_[i], x, to, true, false});
  }
}

/// What loads that move through the station's element add, part by part of the interval, as if each stayed on the side
/// of the station from which it came, and by how much it jumps where they pass it; whether there are any. Which side a
/// load counts to is what evaluate() has taken: rounding decides where it stands on the station.
bool ViscousLag::passing(std::size_t station, History& by_loads) {
  const auto [left, right] = recovery_.element_of(station);
  const double x = recovery_.stations()[station];
  jumps_.clear();
  bool any = false;
  for (const Moved& moved : moved_) {
    const double way = moved.x_to - moved.x_from;
    const bool was_left = moved.was_there ? recovery_.is_left_of(station, moved.from) : way > 0.0;
    const bool is_left = moved.is_there ? recovery_.is_left_of(station, moved.to) : way < 0.0;
    const bool apart = std::max(moved.x_from, moved.x_to) <= left || std::min(moved.x_from, moved.x_to) >= right;
    if (apart && was_left == is_left) continue;
    if (!any) by_loads.fill({});
    any = true;
    for (std::size_t k = 0; k <= parts; ++k) {
      const double part = static_cast<double>(k) / parts, at = moved.x_from + part * way;
      const ElementLoad load = between(moved.from, moved.to, part);
      const Forces added = recovery_.inside(station, at, load, was_left);
      for (std::size_t f = 0; f < added.size(); ++f) by_loads[k][f] += added[f];
    }
    if (was_left == is_left) continue;
    Jump jump{recovery_.jump(station, moved.to), interval_ * (1.0 - std::clamp((x - moved.x_from) / way, 0.0, 1.0))};
    for (double& by : jump.by) by *= is_left ? 1.0 : -1.0;
    jumps_.push_back(jump);
  }
  return any;
}

// m + b dm/dt = c, exactly for c that is linear from part to part and jumps where loads pass the station.
void ViscousLag::follow(std::size_t station, const Forces& c) {
  Inner& inner = inner_[station];
  History by_loads;
  const bool moving = passing(station, by_loads);
  const double h = moving ? interval_ / parts : interval_, decay = std::exp(-h / b_);
  for (double& part : inner.unrelaxed) part *= std::exp(-interval_ / b_);
  for (std::size_t f = 0; f < c.size(); ++f) {
    const auto advance = [&, m = &inner.m[f]](double from, double to) {
      const double late = b_ * (to - from) / h;
      *m = to - late + (*m - from + late) * decay;
    };
    if (!moving) {
      advance(inner.c[f], c[f]);
      continue;
    }
    double end = c[f] - by_loads[parts][f];
    for (const Jump& jump : jumps_) end -= jump.by[f];
    const double rest = inner.c[f] - by_loads[0][f], change = (end - rest) / parts;
    for (std::size_t k = 0; k < parts; ++k)
      advance(rest + change * static_cast<double>(k) + by_loads[k][f],
              rest + change * static_cast<double>(k + 1) + by_loads[k + 1][f]);
    for (const Jump& jump : jumps_) {
      const double late = jump.by[f] * std::exp(-jump.ago / b_);
      inner.m[f] += jump.by[f] - late;
      inner.unrelaxed[f] -= late;
    }
  }
}

void ViscousLag::apply(double t, const std::vector<ElementLoad>& loads, std::vector<Response>& responses) {
  interval_ = t - time_;
  const bool goes_on = !first_ && interval_ > 0.0;
  if (goes_on) record_moved(loads);
  for (std::size_t i = 0; i < responses.size(); ++i) {
    Response& r = responses[i];
    Inner& inner = inner_[i];
    const Forces nodal = {r.nodal_moment, r.nodal_shear, r.nodal_axial_force};
    const Forces c = {r.moment - nodal[0], r.shear - nodal[1], r.axial_force - nodal[2]};
    if (first_) inner.m = c;
    if (goes_on) follow(i, c);
    inner.c = c;
    r.moment = nodal[0] + inner.m[0];
    r.shear = nodal[1] + inner.m[1];
    r.axial_force = nodal[2] + inner.m[2];
    r.moment_rate = r.nodal_moment_rate + (c[0] - inner.m[0]) / b_;
    r.unrelaxed_shear = inner.unrelaxed[1];
    r.unrelaxed_axial_force = inner.unrelaxed[2];
  }
  loads_ = loads;
  time_ = t;
  first_ = false;
}

}  // namespace traverse::beam
