// The positions of a fleet's contacts: the pieces of running surface under its wheels.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "train/fleet.hpp"

namespace traverse::train {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
// Within this part of its radius from a kink a wheel may touch either side of it.
constexpr double nearby = 0.1;

}  // namespace

void Fleet::add_patch(WheelContact& c, int element, double start, double low, double high) {
  Patch& patch = c.patches[c.candidates++];
  patch.element = element;
  patch.rise = patch.rise_rate = 0.0;
  patch.low = low;
  patch.high = high;
  patch.start = start;
  if (element < 0) return;
  patch.height = surface_height_;
  const beam::Element& e = mesh_->element(element);
  patch.x = e.x;
  patch.length = e.length;
  patch.shear = e.shear;
  if (uses_local_compliance_) patch.compliance = e.length * e.length * e.length / (3.0 * e.EI);
}

void Fleet::add_ground(WheelContact& c, bool before, double x, double low, double high) {
  if (before ? !mesh_->ground_before() : !mesh_->ground_behind()) return;
  add_patch(c, -1, x, before ? low : std::max(low, mesh_->end()), before ? std::min(high, mesh_->start()) : high);
  const auto [rise, rate] = ground_[before ? 0 : 1];
  c.patches[c.candidates - 1].rise = rise;
  c.patches[c.candidates - 1].rise_rate = rate;
}

// Finds the patches within [low, high] under a contact at x: the patch at x, and its neighbour beyond a kink between
// `from` and `to`. If the surface jumps in height at low or high and x is there, the patch is between low and high.
void Fleet::find_patches(WheelContact& c, double x, double from, double to, double low, double high) {
  c.candidates = c.active = 0;
  if (mesh_ == nullptr) {
    add_patch(c, -1, x, low, high);
    return;
  }
  const double start = mesh_->start(), end = mesh_->end();
  const auto add_beam = [&](double at, bool from_left) {
    const int element = mesh_->on_track(mesh_->locate(at, from_left), c.track).element;
    const auto reach_of_element = mesh_->smooth_reach(element);
    add_patch(c, element, x, std::max(low, reach_of_element.first), std::min(high, reach_of_element.second));
    return reach_of_element;
  };
  if (x < start || high <= start) {
    add_ground(c, true, x, low, high);
    if (to > start || (c.candidates == 0 && x > start - wheel(c).radius)) add_beam(start, false);
  } else if (x > end || low >= end) {
    add_ground(c, false, x, low, high);
    if (from < end || (c.candidates == 0 && x < end + wheel(c).radius)) add_beam(end, true);
  } else {
    const auto [left, right] = add_beam(x, x == high);
    if (from < left) {
      if (left > start)
        add_beam(left, true);
      else
        add_ground(c, true, x, low, high);
    } else if (to > right) {
      if (right < end)
        add_beam(right, false);
      else
        add_ground(c, false, x, low, high);
    }
  }
}

// Sets the contact to the end of the surface on one side of a jump in height.
void Fleet::set_end(WheelContact& c, double step, bool left) {
  if (step == (left ? mesh_->start() : mesh_->end()))
    add_ground(c, left, step, step, step);
  else
    add_patch(c, mesh_->on_track(mesh_->locate(step, left), c.track).element, step, step, step);
}

std::span<const double> Fleet::height_jumps_near(const WheelContact& c) const {
  if (mesh_ == nullptr) return {};
  const double x = coordinates(c).x(), reach = track::reach_of_steps(wheel(c).radius);
  const std::vector<double>& steps = mesh_->steps();
  const auto from = std::upper_bound(steps.begin(), steps.end(), x - reach);
  return {from, std::lower_bound(from, steps.end(), x + reach)};
}

double Fleet::reach(const WheelContact& c) const { return c.further > 0 ? wheel(c).radius : nearby * wheel(c).radius; }

std::vector<double> Fleet::borders_of_patches(const WheelContact& c) const {
  std::vector<double> borders;
  if (mesh_ == nullptr) return borders;
  const double radius = wheel(c).radius, beside = track::reach_of_steps(radius);
  for (int e = 0; e < mesh_->elements(); ++e) borders.push_back(mesh_->element(e).x);
  borders.push_back(mesh_->end());
  for (const double kink : mesh_->kinks())
    for (const double x : {kink - nearby * radius, kink + nearby * radius}) borders.push_back(x);
  for (const double step : mesh_->steps())
    for (const double x : {step - beside, step + beside}) borders.push_back(x);
  std::sort(borders.begin(), borders.end());
  return borders;
}

// Sets the contact to one without a surface under it.
void Fleet::reset_contact(WheelContact& c) {
  c.candidates = c.active = 0;
  c.slots = {-1, -1};
  clear_touch(c);
  c.kinematics = c.touch.kinematics;
}

void Fleet::clear_touch(WheelContact& c) const {
  c.touch = Touch{};
  c.touch.kinematics.penetration = -wheel(c).radius;
}

// Sets the entries of a wheel that may touch at several points. A point that existed before keeps its kinematics as the
// initial guess of the solution.
void Fleet::find_points(WheelContact& c) {
  const double x = coordinates(c).x(), radius = wheel(c).radius;
  const std::span<const double> steps = height_jumps_near(c);
  const bool single = !c.may_touch_several_points && steps.empty();
  track::TouchingPoints found;
  if (single) {
    found.count = 1;
    found.points[0].station = x;
    found.deepest_omitted = -unbounded;
  } else {
    found = track::touching_points(profile(c), radius, x, steps);
  }
  std::array<contact::Kinematics, track::most_points> kinematics;
  kinematics.fill({-wheel(c).radius, 0.0, 0.0});
  double deepest = -unbounded;
  for (int i = 0; i < track::most_points; ++i) {
    const WheelContact& old = point(c, i);
    if (old.candidates == 0) continue;
    deepest = std::max(deepest, old.kinematics.penetration);
    int nearest = std::min(i, found.count - 1);  // also where two points are at the same place
    for (int j = 0; j < found.count; ++j)
      if (std::abs(found.points[j].station - old.patches[0].start) <
          std::abs(found.points[nearest].station - old.patches[0].start))
        nearest = j;
    if (old.kinematics.penetration > kinematics[nearest].penetration) kinematics[nearest] = old.kinematics;
  }
  for (int i = 0; i < track::most_points; ++i) {
    WheelContact& p = point(c, i);
    reset_contact(p);
    if (i >= found.count) continue;
    const track::TouchingPoint& at = found.points[i];
    if (single)
      find_patches(p, x, x - nearby * radius, x + nearby * radius, -unbounded, unbounded);
    else
      find_patches(p, at.station, at.low, at.high, at.low, at.high);
    if (p.candidates > 0) p.kinematics = kinematics[i];
  }
  for (int i = 0; i + 1 < track::most_points; ++i) {
    WheelContact &b = shared_entry(c, i), &e = right_end(c, i);
    const contact::Kinematics old = b.kinematics, old_end = e.kinematics;
    reset_contact(b);
    reset_contact(e);
    if (i + 1 >= found.count || found.points[i + 1].number != found.points[i].number + 1) continue;
    const track::TouchingPoint &left = found.points[i], &right = found.points[i + 1];
    b.at_height_jump = std::find(steps.begin(), steps.end(), left.high) != steps.end();
    if (b.at_height_jump) {
      set_end(b, left.high, true);
      set_end(e, left.high, false);
      e.kinematics = old_end;
    } else {
      find_patches(b, left.high, left.high, left.high, left.station, right.station);
    }
    if (b.minimum_station != left.high) b.share = 1.0;
    b.minimum_station = left.high;
    b.kinematics = old;
  }
  if (unmodelled_contact_.contact < 0 && found.deepest_omitted + deepest > 0.0)
    unmodelled_contact_ = {static_cast<int>(index(c)), coordinates(c).x()};
}

// Whether a guided wheel is beyond an end of the beam without a surface there.
bool Fleet::has_left_guide(const WheelContact& c) const {
  const double x = coordinates(c).x();
  return contact::pulls(c.law.kind) &&
         ((x > mesh_->end() && !mesh_->ground_behind()) || (x < mesh_->start() && !mesh_->ground_before()));
}

void Fleet::place_wheels() {
  elements_.clear();
  const bool ends = mesh_ != nullptr && !(mesh_->ground_before() && mesh_->ground_behind());
  for (WheelContact& c : wheels) {
    const double x = coordinates(c).x(), radius = wheel(c).radius, near = nearby * radius;
    if (ends && has_left_guide(c)) {  // its last kinematics determine the elastic energy that is lost
      c.candidates = c.active = 0;
      c.slots = {-1, -1};
      continue;
    }
    if (ends && coordinates(c).y() < profile(c).at(x).value -
                                         radius)  // the wheel has fallen off the end: it is beside or below the beam
      c.candidates = 0;
    else if (c.further > 0)
      find_points(c);
    else if (!c.is_further)
      find_patches(c, x, x - near, x + near, -unbounded, unbounded);
    if (c.candidates > 0) continue;
    reset_contact(c);
    c.force = {};
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
    if (c.is_further || !owns(c) || c.candidates == 0 || has_points(c)) return true;
    const double x = coordinates(c).x();
    const Patch& p = c.patches[0];
    const double slack = 1e-3 * (p.element < 0 ? wheel(c).radius : p.length);
    double low = p.element < 0 ? p.low : p.x, high = p.element < 0 ? p.high : p.x + p.length;
    if (low == mesh_->start() && !mesh_->ground_before()) low = -unbounded;
    if (high > mesh_->end() - slack && !mesh_->ground_behind()) high = unbounded;
    return x >= low - slack && x <= high + slack;
  });
}

}  // namespace traverse::train
