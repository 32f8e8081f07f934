// Finds the two supports next to a station, and the shares of a straight line through them.
#include "beam/support_line.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace traverse::beam {
namespace {

constexpr double same_place = 1e-9;  // relative to the length of the bridge

struct Bearing {
  double x = 0.0;
  std::size_t end = 0;  // span end
};

bool has_spring(const BeamModel& model, double x) {
  return std::ranges::any_of(model.foundation.vertical, [&](const PointFoundation& point) {
    return std::abs(point.x - x) <= same_place * model.length();
  });
}

/// The supports in ascending order.
std::vector<Bearing> bearings_of(const BeamModel& model) {
  std::vector<Bearing> bearings;
  double x = model.start;
  for (std::size_t end = 0; end < model.supports.size(); ++end) {
    if (fixes_vertical(model.supports[end]) || has_spring(model, x)) bearings.push_back({x, end});
    if (end < model.spans.size()) x += model.spans[end];
  }
  return bearings;
}

}  // namespace

SupportLine support_line(const BeamModel& model, double x) {
  const std::vector<Bearing> bearings = bearings_of(model);
  if (bearings.empty()) return {};
  const bool before = x<bearings.front().x, behind = x> bearings.back().x;
  const Bearing& outermost = before ? bearings.front() : bearings.back();
  if (bearings.size() == 1 || ((before || behind) && fixes_rotation(model.supports[outermost.end])))
    return {{outermost.end, outermost.end}, {1.0, 0.0}};
  const auto after = std::ranges::upper_bound(bearings, x, {}, &Bearing::x);
  const auto right = std::clamp(after, bearings.begin() + 1, bearings.end() - 1), left = right - 1;
  const double part = (x - left->x) / (right->x - left->x);
  return {{left->end, right->end}, {1.0 - part, part}};
}

}  // namespace traverse::beam
