// The exact reference (exact_beam.hpp) of a beam model whose data are constant piece by piece.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "support/exact_beam.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::test::exact {

/// A concentrated load: fx, fy in N, moment counter-clockwise in N m.
struct Load {
  double x, fy, moment = 0.0, fx = 0.0;
};

struct ModelChain {
  Chain chain;
  std::vector<double> x;  // stations of its joints
  std::size_t joint(double station) const {
    const auto at = std::lower_bound(x.begin(), x.end(), station - 1e-9);
    if (at == x.end() || *at > station + 1e-9) throw std::logic_error("no joint at this station");
    return static_cast<std::size_t>(at - x.begin());
  }
};

/// The chain of a model, with joints at span ends, springs, loads, jumps of the data, and `stations`. Not for separate
/// spans.
inline ModelChain chain_of(const beam::BeamModel& model, Motion motion = Motion::bending,
                           const std::vector<Load>& loads = {}, double gravity = 0.0,
                           const std::vector<double>& stations = {}) {
  const bool bending = motion == Motion::bending;
  const beam::Foundation& f = model.foundation;
  const beam::Distribution& stiffness = bending ? model.EI : model.EA;
  const auto& bed = bending ? f.vertical_bed : f.longitudinal_bed;
  const double length = model.length();
  ModelChain result;
  std::vector<double>& x = result.x;
  x = stations;
  x.push_back(0.0);
  for (double span : model.spans) x.push_back((x.size() == stations.size() + 1 ? 0.0 : x.back()) + span);
  const std::vector<double> ends(x.begin() + static_cast<std::ptrdiff_t>(stations.size()), x.end());
  for (const auto* points : {&f.vertical, &f.rotational, &f.longitudinal}) {
    for (const beam::PointFoundation& p : *points) x.push_back(p.x);
  }
  for (const Load& load : loads) x.push_back(load.x);
  const auto add_breaks = [&](const beam::Distribution& d) {
    const auto breaks = d.breaks(0.0, length);
    x.insert(x.end(), breaks.begin(), breaks.end());
  };
  add_breaks(stiffness);
  add_breaks(model.mass);
  if (bed) add_breaks(bed->k);
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end(), [](double a, double b) { return b - a < 1e-9; }), x.end());

  result.chain.motion = motion;
  result.chain.joints.resize(x.size());
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double left = x[i], right = x[i + 1];
    const double EI = stiffness.at(left, right), mass = model.mass.at(left, right);
    if (std::abs(stiffness.at(right, left) - EI) > 1e-12 * EI ||
        std::abs(model.mass.at(right, left) - mass) > 1e-12 * mass)
      throw std::logic_error("exact::chain_of: data vary within a piece");
    Piece piece{right - left, EI, mass};
    if (bed) piece.bed_k = bed->k.at(left, right), piece.bed_c = bed->c.at(left, right);
    if (bending) piece.load = -gravity * mass;
    result.chain.pieces.push_back(piece);
  }
  const auto at = [&](double station) -> Joint& { return result.chain.joints[result.joint(station)]; };
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const beam::Support s = model.supports[i];
    at(ends[i]).held[0] = bending ? fixes_vertical(s) : fixes_axial(s);
    at(ends[i]).held[1] = bending && fixes_rotation(s);
  }
  const auto add_points = [&](const std::vector<beam::PointFoundation>& points, int unknown) {
    for (const beam::PointFoundation& p : points) {
      at(p.x).k[unknown] += p.k;
      at(p.x).c[unknown] += p.c;
    }
  };
  add_points(bending ? f.vertical : f.longitudinal, 0);
  if (bending) add_points(f.rotational, 1);
  for (const Load& load : loads) {
    at(load.x).load[0] += bending ? load.fy : load.fx;
    if (bending) at(load.x).load[1] += load.moment;
  }
  return result;
}

}  // namespace traverse::test::exact
