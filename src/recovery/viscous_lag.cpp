#include "recovery/viscous_lag.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::beam {

/// What loads that move through the station's element add, part by part of the interval; whether there are any.
bool ViscousLag::passing(std::size_t station, const std::vector<ElementLoad>& loads, History& by_loads) const {
  const auto [left, right] = recovery_.element_of(station);
  bool any = false;
  for (const ElementLoad& load : loads) {
    const double x = recovery_.x_of(load), way = load.speed * interval_;
    if (way == 0.0 || std::max(x, x - way) <= left || std::min(x, x - way) >= right) continue;
    if (!any) by_loads.fill({});
    any = true;
    for (std::size_t k = 0; k <= parts; ++k) {
      const double back = 1.0 - static_cast<double>(k) / parts;
      const Forces added = recovery_.inside(station, x - back * way, load);
      for (std::size_t f = 0; f < added.size(); ++f) by_loads[k][f] += added[f];
    }
  }
  return any;
}

// m + b dm/dt = c, exactly for c that is linear from part to part.
void ViscousLag::follow(std::size_t station, const std::vector<ElementLoad>& loads, const Forces& c) {
  Inner& inner = inner_[station];
  History by_loads;
  const bool moving = passing(station, loads, by_loads);
  const double h = moving ? interval_ / parts : interval_, decay = std::exp(-h / b_);
  for (std::size_t f = 0; f < c.size(); ++f) {
    const auto advance = [&, m = &inner.m[f]](double from, double to) {
      const double late = b_ * (to - from) / h;
      *m = to - late + (*m - from + late) * decay;
    };
    if (moving) {
      const double rest = inner.c[f] - by_loads[0][f], change = (c[f] - by_loads[parts][f] - rest) / parts;
      for (std::size_t k = 0; k < parts; ++k)
        advance(rest + change * static_cast<double>(k) + by_loads[k][f],
                rest + change * static_cast<double>(k + 1) + by_loads[k + 1][f]);
    } else {
      advance(inner.c[f], c[f]);
    }
  }
}

void ViscousLag::apply(double t, const std::vector<ElementLoad>& loads, std::vector<Response>& responses) {
  interval_ = t - time_;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    Response& r = responses[i];
    Inner& inner = inner_[i];
    const Forces nodal = {r.nodal_moment, r.nodal_shear, r.nodal_axial_force};
    const Forces c = {r.moment - nodal[0], r.shear - nodal[1], r.axial_force - nodal[2]};
    if (first_) inner.m = c;
    if (!first_ && interval_ > 0.0) follow(i, loads, c);
    inner.c = c;
    r.moment = nodal[0] + inner.m[0];
    r.shear = nodal[1] + inner.m[1];
    r.axial_force = nodal[2] + inner.m[2];
    r.moment_rate = r.nodal_moment_rate + (c[0] - inner.m[0]) / b_;
  }
  time_ = t;
  first_ = false;
}

}  // namespace traverse::beam
