// The loads on the structure: moving forces, contact forces, and the braking forces of trains with prescribed speed.
#include <algorithm>
#include <numeric>
#include <utility>

#include "coupling/system.hpp"
#include "train/wheel_paths.hpp"

namespace traverse::coupling {

// The moving forces at their positions at t.
void System::load_structure(double t) {
  loads_.clear();
  move_supports(t);
  for (std::size_t i = 0; i < input_.load.forces.size(); ++i) {
    if (train::length_of(input_.load, i) > 0.0) load_line(i, t);
    if (on_beam_[i] == 0) continue;
    const beam::Station s = station_in_step(train::place_of(input_.load, i, t), middle_[i]);
    const double speed = train::speed_of(input_.load, i, t), force = -train::force_at(input_.load, i, t);
    const int track = track_of(input_.load, i);
    loads_.push_back({line_->mesh.on_track(s, track).element, s.xi, 0.0, force, train::moment_of(input_.load, i), speed,
                      0.0, static_cast<int>(i)});
    turn_beam({s.element, s.xi, 0.0, force, 0.0, speed, 0.0, static_cast<int>(turning_source() + i)}, track, speed);
  }
  for (std::size_t i = 0; i < shifted_.size(); ++i) {
    const auto& [weight, on] = shifted_[i];
    if (on == 0) continue;
    const beam::Station s = line_->mesh.locate(weight.x + weight.law.distance(t));
    const double speed = weight.law.speed(t);
    const std::size_t source = turning_source() + input_.load.forces.size() + i;
    turn_beam({s.element, s.xi, 0.0, -weight.force, 0.0, speed, 0.0, static_cast<int>(source)}, weight.track, speed);
  }
  for (std::size_t i = 0; i < braking_force_.size(); ++i) {
    if (braking_force_[i] == 0.0) continue;
    const double x = braking_[i].x + braking_[i].law.distance(t), along = braking_force_[i];
    const beam::Station s = line_->mesh.on_track(line_->mesh.locate(x), braking_[i].track);
    loads_.push_back({s.element, s.xi, along, 0.0, -surface_height() * along, braking_[i].law.speed(t), 0.0,
                      static_cast<int>(input_.load.forces.size() + i)});
  }
  for (const auto& [x, force] : applied_) {
    const beam::Station s = line_->mesh.locate(x);
    loads_.push_back({s.element, s.xi, 0.0, force, 0.0, 0.0});
  }
  structure_->load(loads_);
}

// The torque of a weight beside its track, in a curve or on cant, as a force on the line of action of unit lever. load:
// the weight, on an element of the beam.
void System::turn_beam(recovery::ElementLoad load, int track, double speed) {
  const beam::Mesh& mesh = line_->mesh;
  const beam::ActionLine& on = line_->action_line(mesh.on_track({load.element, 0.0}, track).element);
  if (!on.shifts()) return;
  load.element = mesh.on_track({load.element, 0.0}, unit_lever_).element;
  load.fy *= on.shift + on.shift_by_speed * speed * speed;
  loads_.push_back(load);
}

// The station x in the element on the side of `middle`, where a load is in the middle of the step: at a joint, the
// loads of a step act on the side that it comes from, or that it goes to.
beam::Station System::station_in_step(double x, double middle) const {
  constexpr double same_side = 1e-9;  // far above the rounding errors of places, relative to the step
  beam::Station s = line_->mesh.locate(x + same_side * (middle - x));
  const beam::Element& element = line_->mesh.element(s.element);
  s.xi = (std::clamp(x, line_->mesh.start(), line_->mesh.end()) - element.x) / element.length;
  return s;
}

// The supports of the beam, and the ground beside it, which moves with the first and the last support.
void System::move_supports(double t) {
  if (!structure_ || structure_->support_motion() == nullptr) return;
  structure_->set_time(t);
  const std::vector<structure::Movement>& now = structure_->support_motion()->upward();
  fleet_.move_ground({now.front().displacement, now.front().velocity}, {now.back().displacement, now.back().velocity});
}

// The part of line load i that is on the line at t, element by element.
void System::load_line(std::size_t i, double t) {
  const beam::Mesh& mesh = line_->mesh;
  const double length = train::length_of(input_.load, i), x = train::place_of(input_.load, i, t);
  const double from = std::max(x - 0.5 * length, mesh.start()), to = std::min(x + 0.5 * length, mesh.end());
  if (!(to > from)) return;
  const double per_length = -train::force_at(input_.load, i, t) / length;  // N/m, upward
  const int track = track_of(input_.load, i);
  const int last = mesh.locate(to).element;
  for (int e = mesh.locate(from).element; e <= last; ++e) {
    const beam::Element& element = mesh.element(e);
    const double left = std::max(from, element.x), right = std::min(to, element.x + element.length);
    if (!(right > left)) continue;
    recovery::ElementLoad load{e, (0.5 * (left + right) - element.x) / element.length, 0.0,
                               per_length * (right - left)};
    load.extent = (right - left) / element.length;
    turn_beam(load, track, train::speed_of(input_.load, i, t));
    load.element = mesh.on_track({e, 0.0}, track).element;
    loads_.push_back(load);
  }
}

void System::apply_to_body(int member, int body, const Eigen::Vector3d& action) {
  fleet_.apply(member, body, action);
  applied_changed_ = true;
}

void System::apply_to_beam(double x, double force) {
  if (line_ == nullptr) throw InputError("a force at a station needs a beam");
  if (!(x >= line_->mesh.start() && x <= line_->mesh.end()))
    throw InputError("the station " + std::to_string(x) + " m is not on the beam, which goes from " +
                     std::to_string(line_->mesh.start()) + " to " + std::to_string(line_->mesh.end()) + " m");
  applied_[x] = force;
  applied_changed_ = true;
}

structure::ElementLoads System::contact_loads() {
  fleet_.element_loads(per_node(), element_loads_);
  return {fleet_.elements(), element_loads_};
}

double System::gradient() const { return structure_ ? beam()->model().gradient : 0.0; }

// Whether the force that accelerates the vehicle, or holds it on an incline, acts on the track. Wheels with friction
// transmit it by themselves.
bool System::brakes_track(int wheel) const {
  if (line_ == nullptr || line_->per_node != 3 || !is_driven(wheel)) return false;
  if (law_of_wheel(wheel).constant() && gradient() == 0.0) return false;
  const auto member = static_cast<std::size_t>(fleet_.member(wheel));
  const train::Vehicle& type = input_.types[static_cast<std::size_t>(input_.train.vehicles[member])];
  return std::all_of(type.wheels.begin(), type.wheels.end(),
                     [](const train::Wheel& w) { return w.law.friction == 0.0; }) &&
         std::none_of(type.mechanism.drivers.begin(), type.mechanism.drivers.end(),
                      [](const multibody::Driver& d) { return d.coordinate == 0; });
}

// Distributes the mass of each vehicle over its wheels in proportion to the static wheel loads.
void System::record_braking() {
  braking_.clear();
  std::vector<double> carried(input_.train.vehicles.size(), 0.0);
  const auto wheels = static_cast<int>(fleet_.wheels.size());
  const auto member = [&](int wheel) { return static_cast<std::size_t>(fleet_.member(wheel)); };
  const auto& weights = weights_.all();
  for (int i = 0; i < wheels; ++i) carried[member(i)] += weights[static_cast<std::size_t>(i)].force;
  for (int i = 0; i < wheels; ++i) {
    const StaticLoad& weight = weights[static_cast<std::size_t>(i)];
    if (!brakes_track(i) || weight.force == 0.0) continue;
    const auto& bodies = input_.types[static_cast<std::size_t>(input_.train.vehicles[member(i)])].mechanism.bodies;
    const double mass = std::accumulate(bodies.begin(), bodies.end(), 0.0,
                                        [](double sum, const multibody::Body& b) { return sum + b.mass; });
    braking_.push_back({weight.x, mass * weight.force / carried[member(i)], weight.law, weight.track});
  }
  braking_force_.assign(braking_.size(), 0.0);
}

// The weights of wheels in curves or on cant, if their speed is prescribed.
void System::record_shifted() {
  shifted_.clear();
  if (line_ == nullptr || !line_->model.torsion) return;
  const std::vector<beam::ActionLine>& lines = line_->model.torsion->tracks;
  unit_lever_ = static_cast<int>(std::ranges::find(lines, beam::ActionLine{1.0, true}) - lines.begin());
  for (std::size_t i = 0; i < fleet_.wheels.size(); ++i)
    if (const StaticLoad& weight = weights_.all()[i]; lines[static_cast<std::size_t>(weight.track)].shifts())
      shifted_.push_back({weight, 0});
}

// The braking forces of a step whose middle is t. True if they have changed.
bool System::update_braking(double t) {
  bool changed = false;
  for (std::size_t i = 0; i < braking_.size(); ++i) {
    const BrakingWheel& wheel = braking_[i];
    const double x = wheel.x + wheel.law.distance(t);
    const bool on = train::is_on_line(line_->mesh.start(), line_->mesh.end(), x, wheel.law.speed(t));
    const double force = on ? -wheel.mass * (wheel.law.acceleration(t) + gradient() * input_.gravity) : 0.0;
    changed = changed || force != braking_force_[i];
    braking_force_[i] = force;
  }
  return changed;
}

// The prescribed motions of the step that jump. True if one has jumped.
bool System::select_sides() {
  const bool jumped = fleet_.begin_step(step_middle_);
  structure::SupportMotion* supports = line_ != nullptr ? structure_->support_motion() : nullptr;
  return (supports != nullptr && supports->select_sides(step_middle_)) || jumped;
}

bool System::begin_step(double from, double to) {
  const double middle = step_middle_ = 0.5 * (from + to);
  bool changed = std::exchange(applied_changed_, false);
  changed = select_sides() || changed;
  if (line_ == nullptr) return changed;
  changed = update_braking(middle) || changed;
  for (auto& [weight, on] : shifted_) {
    const double x = weight.x + weight.law.distance(middle), speed = weight.law.speed(middle);
    const char now = train::is_on_line(line_->mesh.start(), line_->mesh.end(), x, speed) ? 1 : 0;
    changed = changed || on != now;
    on = now;
  }
  for (std::size_t i = 0; i < on_beam_.size(); ++i) {
    const double x = train::place_of(input_.load, i, middle), speed = train::speed_of(input_.load, i, middle);
    const bool point = train::length_of(input_.load, i) == 0.0;
    const char on = point && train::is_on_line(line_->mesh.start(), line_->mesh.end(), x, speed) ? 1 : 0;
    middle_[i] = x;
    changed = changed || on != on_beam_[i];
    on_beam_[i] = on;
  }
  return changed;
}

}  // namespace traverse::coupling
