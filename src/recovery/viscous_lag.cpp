// Integrates m + b dm/dt = c exactly from call to call, with c piecewise linear in time and discontinuous when a load
// passes the station.
#include "recovery/viscous_lag.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::beam {
namespace {

constexpr double same_load =
    0.1;  // tolerance of a load's expected position at the previous call, relative to its displacement

ElementLoad between(const ElementLoad& from, const ElementLoad& to, double part) {
  const auto at = [&](double a, double b) { return a + part * (b - a); };
  ElementLoad load = to;
  load.fx = at(from.fx, to.fx);
  load.fy = at(from.fy, to.fy);
  load.moment = at(from.moment, to.moment);
  return load;
}

}  // namespace

/// Identifies the loads of the previous call. Loads have the same order from call to call, except for those that enter
/// or leave the beam: the search continues behind the load that was found last.
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
    if (found_[i] == 0 && recovery_.is_outside(to)) moved_.push_back({loads_[i], loads_[i], x, to, true, false});
  }
}

/// The contributions of loads that move through the station's element, at the ends of parts of the interval, as if each
/// load remained on the side of the station from which it came, and the jumps when they pass the station. Returns
/// whether there are such loads. A load is on the side that evaluate() assigns to it, because rounding determines the
/// side at the station.
bool ViscousLag::add_passing_loads(std::size_t station, History& by_loads) {
  const auto [left, right] = recovery_.element_of(station);
  const double x = recovery_.stations()[station];
  jumps_.clear();
  bool any = false;
  for (const Moved& moved : moved_) {
    const double way = moved.x_to - moved.x_from;
    const bool was_left = moved.was_there ? recovery_.is_left_of(station, moved.from) : way > 0.0;
    const bool is_left = moved.is_there ? recovery_.is_left_of(station, moved.to) : way < 0.0;
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
    Jump jump{recovery_.jump(station, moved.to), interval_ * (1.0 - std::clamp((x - moved.x_from) / way, 0.0, 1.0))};
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
  const double h = moving ? interval_ / parts : interval_, decay = std::exp(-h / b_);
  for (double& part : inner.unrelaxed) part *= std::exp(-interval_ / b_);
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

void ViscousLag::apply(double t, const std::vector<ElementLoad>& loads, std::vector<Response>& responses) {
  interval_ = t - time_;
  const bool continues = !first_ && interval_ > 0.0;
  if (continues) record_moved(loads);
  for (std::size_t i = 0; i < responses.size(); ++i) {
    Response& r = responses[i];
    Inner& inner = inner_[i];
    const Forces nodal = {r.nodal_moment, r.nodal_shear, r.nodal_axial_force};
    const Forces c = {r.moment - nodal[0], r.shear - nodal[1], r.axial_force - nodal[2]};
    if (first_) inner.m = c;
    if (continues) advance_lag(i, c);
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
