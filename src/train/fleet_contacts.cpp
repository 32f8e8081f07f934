// The contacts of a fleet on their patches: kinematics, forces and energies.
#include <algorithm>
#include <cmath>
#include <limits>

#include "beam/shape.hpp"
#include "train/fleet.hpp"

namespace traverse::train {
namespace {

constexpr double at_end = 1e-10;  // m: distance from the end of a patch

}  // namespace

contact::Force force_of(const Contact& c) {
  contact::Force f = contact::force(c.law, c.kinematics, c.approach_speed);
  for (double* part : {&f.normal, &f.tangential, &f.normal_by_penetration, &f.normal_by_rate,
                       &f.tangential_by_penetration, &f.tangential_by_rate, &f.tangential_by_sliding})
    *part *= c.factor;
  return f;
}

// Selects the candidate with the largest penetration.
bool Fleet::touch_patches(WheelContact& c, int per_node, const double* v, const double* w, Find find) {
  const std::ptrdiff_t m = 2 * static_cast<std::ptrdiff_t>(per_node);
  const Eigen::Vector3d q = coordinates(c);
  const Eigen::Vector3d qd = velocities(c);
  Touch candidate;
  candidate.ahead = c.touch.ahead;
  if (c.candidates == 0) return true;
  double deepest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < c.candidates; ++i) {
    const std::ptrdiff_t at = c.slots[i] < 0 ? 0 : m * c.slots[i];
    if (!train::touch(c.patches[i], profile(c), wheel(c).radius, q, qd, per_node, v + at, w + at, candidate, find))
      return false;
    if (candidate.kinematics.penetration <= deepest) continue;
    deepest = candidate.kinematics.penetration;
    c.active = i;
    c.touch = candidate;
  }
  c.law.local_compliance = c.touch.local_compliance;
  add_shape(c);
  return true;
}

// The points on both sides of a jump in height and its two ends, whose shares of the common overlap follow from their
// heights. A point at its end and this end are one contact.
bool Fleet::touch_jump(WheelContact& left, WheelContact& right, WheelContact& left_end, WheelContact& right_end,
                       int per_node, const double* v, const double* w) {
  for (WheelContact* end : {&left_end, &right_end})
    if (!touch_patches(*end, per_node, v, w, Find::closest)) return false;
  left_end.jump = right_end.touch.kinematics.penetration - left_end.touch.kinematics.penetration;
  if (!left_end.share_held && std::abs(left_end.jump) > level) left_end.share = left_end.jump > 0.0 ? 1.0 : 0.0;
  left_end.factor = -left_end.share;
  right_end.factor = left_end.share - 1.0;
  const auto unite = [this](WheelContact& point, WheelContact& end) {
    point.factor += end.factor;
    end.factor = 0.0;
  };
  if (left.touch.station > left_end.minimum_station - at_end) unite(left, left_end);
  if (right.touch.station < left_end.minimum_station + at_end) unite(right, right_end);
  for (WheelContact* c : {&left, &right, &left_end, &right_end})
    if (c->factor == 0.0) clear_touch(*c);
  return true;
}

// Points first, then the overlaps that neighbours share. If the less deep one of two points has reached the minimum
// between them, both this point and the overlap are removed.
bool Fleet::touch_points(WheelContact& c, int per_node, const double* v, const double* w) {
  WheelContact* left = nullptr;
  for (int i = 0; i < track::most_points; ++i) {
    WheelContact& p = point(c, i);
    p.factor = 1.0;
    if (p.candidates == 0) continue;
    if (!touch_patches(p, per_node, v, w, Find::closest_within)) return false;
    WheelContact* shared = i > 0 && shared_entry(c, i - 1).candidates > 0 ? &shared_entry(c, i - 1) : nullptr;
    if (shared != nullptr && shared->at_height_jump) {
      if (!touch_jump(*left, p, *shared, right_end(c, i - 1), per_node, v, w)) return false;
    } else if (shared != nullptr) {
      shared->factor = -1.0;
      if (left->touch.station > shared->minimum_station - at_end ||
          p.touch.station < shared->minimum_station + at_end) {
        const bool keep_left = left->touch.kinematics.penetration >= p.touch.kinematics.penetration;
        clear_touch(*shared);
        clear_touch(keep_left ? p : *left);
      } else {
        shared->patches[0].low = left->touch.station;
        shared->patches[0].high = p.touch.station;
        shared->candidates = 1;
        if (!touch_patches(*shared, per_node, v, w, Find::farthest_within)) return false;
      }
    }
    if (left == nullptr || p.touch.kinematics.penetration > -wheel(p).radius) left = &p;  // otherwise it is removed
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
    if (c.is_further || !owns(c) || vehicles[c.vehicle].converged) continue;
    c.factor = 1.0;
    if (!(has_points(c) ? touch_points(c, per_node, v, w) : touch_patches(c, per_node, v, w, Find::closest)))
      return false;
  }
  return std::all_of(pairs.begin(), pairs.end(),
                     [this](PairContact& pair) { return vehicles[pair.vehicle].converged || touch(pair); });
}

WheelLoad Fleet::load(const WheelContact& c) const {
  WheelLoad sum{c.force.normal, c.force.tangential, contact::surface_penetration(c.law, c.kinematics.penetration)};
  for (int i = 0; c.further > 0 && i < further_entries; ++i) {
    const WheelContact& more = wheels[static_cast<std::size_t>(c.further + i)];
    sum.normal += more.force.normal;
    sum.tangential += more.force.tangential;
    sum.penetration = std::max(sum.penetration, contact::surface_penetration(more.law, more.kinematics.penetration));
  }
  return sum;
}

void Fleet::record_sides() {
  for (PairContact& c : pairs) {
    const std::vector<multibody::Frame>& frames = vehicles[c.vehicle].state.frames;
    contact::record_side(c.geometry, frames[c.body + 1], frames[c.other_body + 1]);
  }
}

void Fleet::add_load(const Contact& c, double normal, double tangential, Eigen::VectorXd& Q) {
  Q.segment<3>(3 * c.body) -= normal * c.touch.normal_on_body + tangential * c.touch.tangent_on_body;
  if (c.factor != 0.0) Q[3 * c.body] += 0.5 / c.factor * c.touch.local_compliance_by_x * normal * normal;
  if (c.other_body == multibody::ground) return;
  Q.segment<3>(3 * c.other_body) -= normal * c.touch.normal_on_other + tangential * c.touch.tangent_on_other;
}

void Fleet::contact_forces() {
  for (int i = 0; i < contacts(); ++i) {
    Contact& c = contact(i);
    c.force = may_touch(i) ? force_of(c) : contact::Force{};
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
    const beam::Hermite psi = beam::hermite(xi, patch.length, patch.shear);
    double* f = &loads[static_cast<std::size_t>(c.slots[0]) * m] + per_node - 2;
    for (int i = 0; i < 2; ++i) {
      f[i] -= c.force.normal * psi.value[i];
      f[per_node + i] -= c.force.normal * psi.value[2 + i];
    }
  }
}

bool Fleet::touches(int i) const {
  const std::size_t k = static_cast<std::size_t>(i);
  if (contact::pulls(contact(i).law.kind)) return may_touch(i);
  if (k >= wheels.size()) return contact(i).force.normal > 0.0;
  return wheels[k].is_further || load(wheels[k]).normal > 0.0;
}

bool Fleet::has_points(const WheelContact& c) const {
  if (c.is_further || c.may_touch_several_points) return true;
  const auto is_candidate = [](const WheelContact& more) { return more.candidates > 0; };
  return c.further > 0 &&
         std::any_of(wheels.begin() + c.further, wheels.begin() + c.further + track::most_points - 1, is_candidate);
}

bool Fleet::has_points(int i) const {
  const std::size_t k = static_cast<std::size_t>(i);
  return k < wheels.size() && has_points(wheels[k]);
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

contact::Kinematics Fleet::event_kinematics(int i) const {
  const auto k = static_cast<std::size_t>(i);
  if (k >= wheels.size() || !contact::pulls(contact(i).law.kind)) return kinematics(i);
  const double x = coordinates(wheels[k]).x(), speed = velocities(wheels[k]).x();
  if (mesh_ != nullptr && !mesh_->ground_behind() && speed >= 0.0) return {mesh_->end() - x, -speed, 0.0};
  if (mesh_ != nullptr && !mesh_->ground_before() && speed <= 0.0) return {x - mesh_->start(), speed, 0.0};
  return {1.0, 0.0, 0.0};
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
    const double stored = c.factor * contact::force(elastic, c.kinematics, 0.0).normal;
    power +=
        (c.force.normal - stored) * c.kinematics.penetration_rate + c.force.tangential * c.kinematics.sliding_speed;
  }
  return power;
}

double Fleet::power_of_ground() const {
  double power = 0.0;
  for (const WheelContact& c : wheels)
    if (c.candidates > 0 && c.slot() < 0)
      power -= c.patches[c.active].rise_rate *
               (c.force.normal * c.touch.normal_on_body.y() + c.force.tangential * c.touch.tangent_on_body.y());
  return power;
}

double Fleet::contact_potential() const {
  double sum = 0.0;
  for (int i = 0; i < contacts(); ++i)
    if (!contact(i).released || contact(i).force.normal != 0.0)
      sum += contact(i).factor * contact::potential(contact(i).law, contact(i).kinematics.penetration);
  return sum;
}

}  // namespace traverse::train
