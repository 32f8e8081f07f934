// Where the contacts of a fleet are: the pieces of running surface under its wheels.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "train/fleet.hpp"

namespace traverse::train {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
// Within this part of its radius from a kink a wheel may touch on either side of it.
constexpr double nearby = 0.1;

}  // namespace

void Fleet::add_patch(WheelContact& c, int element, double start, double low, double high) {
  Patch& patch = c.patches[c.candidates++];
  patch.element = element;
  patch.low = low;
  patch.high = high;
  patch.start = start;
  if (element < 0) return;
  patch.height = surface_height_;
  const beam::Element& e = mesh_->element(element);
  patch.x = e.x;
  patch.length = e.length;
  patch.shear = e.shear;
  if (yields_inside_) patch.yield = e.length * e.length * e.length / (3.0 * e.EI);
}

// The patches within [low, high] under a contact at x: the one there, and its neighbour across a kink between `from`
// and `to`.
void Fleet::find_patches(WheelContact& c, double x, double from, double to, double low, double high) {
  c.candidates = c.active = 0;
  if (mesh_ == nullptr) {
    add_patch(c, -1, x, low, high);
    return;
  }
  const double start = mesh_->start(), end = mesh_->end();
  auto add_ground = [&](bool before) {
    add_patch(c, -1, x, before ? low : std::max(low, end), before ? std::min(high, start) : high);
  };
  auto add_beam = [&](double at, bool from_left) {
    const int element = mesh_->locate(at, from_left).element;
    const auto reach_of_element = mesh_->smooth_reach(element);
    add_patch(c, element, x, std::max(low, reach_of_element.first), std::min(high, reach_of_element.second));
    return reach_of_element;
  };
  if (x < start) {
    add_ground(true);
    if (to > start) add_beam(start, false);
  } else if (x > end) {
    add_ground(false);
    if (from < end) add_beam(end, true);
  } else {
    const auto [left, right] = add_beam(x, false);
    if (from < left) {
      if (left > start)
        add_beam(left, true);
      else
        add_ground(true);
    } else if (to > right) {
      if (right < end)
        add_beam(right, false);
      else
        add_ground(false);
    }
  }
}

// Apart, and far from touching.
void Fleet::take_away(WheelContact& c) {
  c.candidates = c.active = 0;
  c.slots = {-1, -1};
  lose(c);
  c.kinematics = c.touch.kinematics;
}

void Fleet::lose(WheelContact& c) const {
  c.touch = Touch{};
  c.touch.kinematics.penetration = -wheel(c).radius;
}

// The entries of a wheel that may touch at several points. A point that there was before keeps its kinematics, from
// which the solution starts.
void Fleet::find_points(WheelContact& c) {
  const track::TouchingPoints found = track::touching_points(profile(c), wheel(c).radius, coordinates(c).x());
  std::array<contact::Kinematics, track::most_points> kinematics;
  kinematics.fill({-wheel(c).radius, 0.0, 0.0});
  double deepest = -unbounded;
  for (int i = 0; i < track::most_points; ++i) {
    const WheelContact& old = point(c, i);
    if (old.candidates == 0) continue;
    deepest = std::max(deepest, old.kinematics.penetration);
    int nearest = 0;
    for (int j = 1; j < found.count; ++j)
      if (std::abs(found.points[j].station - old.touch.station) <
          std::abs(found.points[nearest].station - old.touch.station))
        nearest = j;
    if (old.kinematics.penetration > kinematics[nearest].penetration) kinematics[nearest] = old.kinematics;
  }
  for (int i = 0; i < track::most_points; ++i) {
    WheelContact& p = point(c, i);
    take_away(p);
    if (i >= found.count) continue;
    const track::TouchingPoint& at = found.points[i];
    find_patches(p, at.station, at.low, at.high, at.low, at.high);
    p.kinematics = kinematics[i];
  }
  for (int i = 0; i + 1 < track::most_points; ++i) {
    WheelContact& b = between(c, i);
    const contact::Kinematics old = b.kinematics;
    take_away(b);
    if (i + 1 >= found.count || found.points[i + 1].number != found.points[i].number + 1) continue;
    const track::TouchingPoint &left = found.points[i], &right = found.points[i + 1];
    find_patches(b, left.high, left.high, left.high, left.station, right.station);
    b.divide = left.high;
    b.kinematics = old;
  }
  if (crowded_.contact < 0 && found.left_out + deepest > 0.0)
    crowded_ = {static_cast<int>(index(c)), coordinates(c).x()};
}

void Fleet::place_wheels() {
  elements_.clear();
  for (WheelContact& c : wheels) {
    const double x = coordinates(c).x(), near = nearby * wheel(c).radius;
    if (c.further > 0)
      find_points(c);
    else if (!c.is_further)
      find_patches(c, x, x - near, x + near, -unbounded, unbounded);
  }
  for (const WheelContact& c : wheels)
    for (int i = 0; i < c.candidates; ++i)
      if (c.patches[i].element >= 0) elements_.push_back(c.patches[i].element);
  std::sort(elements_.begin(), elements_.end());
  elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
  for (WheelContact& c : wheels)
    for (int i = 0; i < c.candidates; ++i)
      c.slots[i] = c.patches[i].element < 0
                       ? -1
                       : static_cast<int>(std::lower_bound(elements_.begin(), elements_.end(), c.patches[i].element) -
                                          elements_.begin());
}

bool Fleet::wheels_in_place() const {
  if (mesh_ == nullptr) return true;
  return std::all_of(wheels.begin(), wheels.end(), [&](const WheelContact& c) {
    if (c.further > 0 || c.is_further || !owns(c)) return true;
    const double x = coordinates(c).x();
    const Patch& p = c.patches[0];
    const double slack = 1e-3 * (p.element < 0 ? wheel(c).radius : p.length);
    const double low = p.element < 0 ? p.low : p.x;
    const double high = p.element < 0 ? p.high : p.x + p.length;
    return x >= low - slack && x <= high + slack;
  });
}

}  // namespace traverse::train
