// Where the contacts of a fleet are, their kinematics, forces and energies.
#include <algorithm>
#include <cmath>
#include <limits>

#include "beam/shape.hpp"
#include "train/fleet.hpp"

namespace traverse::train {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
// Within this part of its radius from a kink a wheel may touch on either side of it.
constexpr double nearby = 0.1;
constexpr double at_end = 1e-10;  // m: of a patch

}  // namespace

void Fleet::add_patch(WheelContact& c, int element, double start, double low, double high) {
  Patch& patch = c.patches[c.candidates++];
  patch.element = element;
  patch.low = low;
  patch.high = high;
  patch.start = start;
  if (element < 0) return;
  patch.height = surface_height_;
  patch.x = mesh_->element(element).x;
  patch.length = mesh_->element(element).length;
  if (inner_EI_ == nullptr) return;
  const double EI = inner_EI_->at(patch.x + 0.5 * patch.length, patch.x);
  patch.yield = patch.length * patch.length * patch.length / (3.0 * EI);
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
  const track::TouchingPoints found = track::touching_points(*profile_, wheel(c).radius, coordinates(c).x());
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

// The deepest of a contact's candidates.
bool Fleet::touch_patches(WheelContact& c, int per_node, const double* v, const double* w, Find find) {
  const std::ptrdiff_t m = 2 * static_cast<std::ptrdiff_t>(per_node);
  const Eigen::Vector3d q = coordinates(c);
  const Eigen::Vector3d qd = velocities(c);
  Touch candidate;
  candidate.ahead = c.touch.ahead;
  double deepest = -unbounded;
  for (int i = 0; i < c.candidates; ++i) {
    const std::ptrdiff_t at = c.slots[i] < 0 ? 0 : m * c.slots[i];
    if (!train::touch(c.patches[i], *profile_, wheel(c).radius, q, qd, per_node, v + at, w + at, candidate, find))
      return false;
    if (candidate.kinematics.penetration <= deepest) continue;
    deepest = candidate.kinematics.penetration;
    c.active = i;
    c.touch = candidate;
  }
  c.law.seat = c.touch.seat;
  add_shape(c);
  return true;
}

// Points first, then what neighbours share. A point at the near end of its patch is none: it has met the minimum
// between it and its neighbour, and both are lost.
bool Fleet::touch_points(WheelContact& c, int per_node, const double* v, const double* w) {
  WheelContact* left = nullptr;
  for (int i = 0; i < track::most_points; ++i) {
    WheelContact& p = point(c, i);
    if (p.candidates == 0) continue;
    if (!touch_patches(p, per_node, v, w, Find::closest_within)) return false;
    WheelContact* shared = i > 0 && between(c, i - 1).candidates > 0 ? &between(c, i - 1) : nullptr;
    if (shared != nullptr) {
      if (left->touch.station > shared->divide - at_end || p.touch.station < shared->divide + at_end) {
        const bool keep_left = left->touch.kinematics.penetration >= p.touch.kinematics.penetration;
        lose(*shared);
        lose(keep_left ? p : *left);
        if (keep_left) continue;
      } else {
        shared->patches[0].low = left->touch.station;
        shared->patches[0].high = p.touch.station;
        shared->candidates = 1;
        if (!touch_patches(*shared, per_node, v, w, Find::farthest_within)) return false;
      }
    }
    left = &p;
  }
  return true;
}

bool Fleet::touch(PairContact& c) const {
  const std::vector<multibody::Frame>& frames = vehicles[c.vehicle].state.frames;
  contact::PairTouch pair;
  if (!contact::touch(c.geometry, frames[c.body + 1], frames[c.other_body + 1], pair)) return false;
  c.touch.kinematics = pair.kinematics;
  c.touch.normal_on_body = pair.normal[0];
  c.touch.normal_on_other = pair.normal[1];
  c.touch.tangent_on_body = pair.tangent[0];
  c.touch.tangent_on_other = pair.tangent[1];
  return true;
}

bool Fleet::touch(int per_node, const double* v, const double* w) {
  for (WheelContact& c : wheels) {
    if (c.is_further || !owns(c) || vehicles[c.vehicle].rests) continue;
    if (!(c.further > 0 ? touch_points(c, per_node, v, w) : touch_patches(c, per_node, v, w, Find::closest)))
      return false;
  }
  return std::all_of(pairs.begin(), pairs.end(),
                     [this](PairContact& pair) { return vehicles[pair.vehicle].rests || touch(pair); });
}

WheelLoad Fleet::load(const WheelContact& c) const {
  WheelLoad sum{c.force.normal, c.force.tangential, contact::own_penetration(c.law, c.kinematics.penetration)};
  for (int i = 0; c.further > 0 && i < 2 * (track::most_points - 1); ++i) {
    const WheelContact& more = wheels[static_cast<std::size_t>(c.further + i)];
    sum.normal += more.force.normal;
    sum.tangential += more.force.tangential;
    sum.penetration = std::max(sum.penetration, contact::own_penetration(more.law, more.kinematics.penetration));
  }
  return sum;
}

void Fleet::note_sides() {
  for (PairContact& c : pairs) {
    const std::vector<multibody::Frame>& frames = vehicles[c.vehicle].state.frames;
    contact::note_side(c.geometry, frames[c.body + 1], frames[c.other_body + 1]);
  }
}

void Fleet::add_load(const Contact& c, double normal, double tangential, Eigen::VectorXd& Q) {
  Q.segment<3>(3 * c.body) -= normal * c.touch.normal_on_body + tangential * c.touch.tangent_on_body;
  Q[3 * c.body] += 0.5 * c.sign * c.touch.seat_by_x * normal * normal;
  if (c.other_body == multibody::ground) return;
  Q.segment<3>(3 * c.other_body) -= normal * c.touch.normal_on_other + tangential * c.touch.tangent_on_other;
}

void Fleet::contact_forces() {
  for (int i = 0; i < contacts(); ++i) {
    Contact& c = contact(i);
    c.force = contact::force(c.law, c.kinematics, c.approach_speed);
    if (c.sign < 0.0) c.force = -c.force;
  }
}

void Fleet::contact_loads() {
  for (MovingVehicle& vehicle : own()) {
    vehicle.Q.setZero();
    for (const int i : vehicle.touching)
      add_load(contact(i), contact(i).force.normal, contact(i).force.tangential, vehicle.Q);
  }
}

void Fleet::element_loads(int per_node, std::vector<double>& loads) const {
  const int m = 2 * per_node;
  loads.assign(elements_.size() * m, 0.0);
  for (const WheelContact& c : wheels) {
    if (c.slot() < 0) continue;
    double* f = &loads[static_cast<std::size_t>(c.slot()) * m];
    for (int i = 0; i < m; ++i)
      f[i] -= c.force.normal * c.touch.normal_on_beam[i] + c.force.tangential * c.touch.tangent_on_beam[i];
  }
}

void Fleet::expected_loads(int per_node, std::vector<double>& loads) const {
  const std::size_t m = 2 * static_cast<std::size_t>(per_node);
  loads.assign(elements_.size() * m, 0.0);
  for (const WheelContact& c : wheels) {
    if (c.force.normal == 0.0 || c.candidates == 0 || c.slots[0] < 0) continue;
    const Patch& patch = c.patches[0];
    const double xi = std::clamp((coordinates(c).x() - patch.x) / patch.length, 0.0, 1.0);
    const beam::Hermite psi = beam::hermite(xi, patch.length);
    double* f = &loads[static_cast<std::size_t>(c.slots[0]) * m] + per_node - 2;
    for (int i = 0; i < 2; ++i) {
      f[i] -= c.force.normal * psi.value[i];
      f[per_node + i] -= c.force.normal * psi.value[2 + i];
    }
  }
}

bool Fleet::touches(int i) const {
  const std::size_t k = static_cast<std::size_t>(i);
  if (k >= wheels.size()) return contact(i).force.normal > 0.0;
  return wheels[k].is_further || load(wheels[k]).normal > 0.0;
}

bool Fleet::has_points(int i) const {
  const std::size_t k = static_cast<std::size_t>(i);
  return k < wheels.size() && (wheels[k].is_further || wheels[k].further > 0);
}

const contact::Kinematics& Fleet::kinematics(int i) const {
  const contact::Kinematics* deepest = &contact(i).kinematics;
  const std::size_t k = static_cast<std::size_t>(i);
  if (k >= wheels.size() || wheels[k].further == 0) return *deepest;
  for (int j = 0; j < track::most_points - 1; ++j) {
    const contact::Kinematics& other = wheels[static_cast<std::size_t>(wheels[k].further + j)].kinematics;
    if (other.penetration > deepest->penetration) deepest = &other;
  }
  return *deepest;
}

double Fleet::impact_duration(int i) {
  const Contact& c = contact(i);
  MovingVehicle& vehicle = vehicles[c.vehicle];
  vehicle.Q.setZero();
  add_load(c, -1.0, 0.0, vehicle.Q);
  const double mass = vehicle.mechanism.effective_mass(vehicle.state, vehicle.Q);
  return contact::impact_duration(c.law, mass, c.kinematics.penetration_rate);
}

double Fleet::contact_dissipation() const {
  double power = 0.0;
  for (int i = 0; i < contacts(); ++i) {
    const Contact& c = contact(i);
    if (!owns(c)) continue;
    const bool elastic_alone = c.law.damping == 0.0 && !c.law.hysteresis && c.law.friction == 0.0;
    if (elastic_alone || (c.released && c.force.normal == 0.0)) continue;
    contact::Law elastic = c.law;
    elastic.damping = 0.0;
    elastic.hysteresis.reset();
    elastic.friction = 0.0;
    const double stored = c.sign * contact::force(elastic, c.kinematics, 0.0).normal;
    power +=
        (c.force.normal - stored) * c.kinematics.penetration_rate + c.force.tangential * c.kinematics.sliding_speed;
  }
  return power;
}

double Fleet::contact_potential() const {
  double sum = 0.0;
  for (int i = 0; i < contacts(); ++i)
    if (!contact(i).released || contact(i).force.normal != 0.0)
      sum += contact(i).sign * contact::potential(contact(i).law, contact(i).kinematics.penetration);
  return sum;
}

}  // namespace traverse::train
