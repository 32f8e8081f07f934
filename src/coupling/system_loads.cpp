// What acts on the structure: moving forces and contacts.
#include <utility>

#include "coupling/system.hpp"

namespace traverse::coupling {

// The moving forces as they stand at t.
void System::load_structure(double t) {
  loads_.clear();
  for (std::size_t i = 0; i < input_.load.forces.size(); ++i) {
    if (on_beam_[i] == 0) continue;
    const beam::Station s = line_->mesh.locate(train::place_of(input_.load, i, t));
    loads_.push_back({s.element, s.xi, 0.0, -input_.load.forces[i], 0.0, train::speed_of(input_.load, i, t)});
  }
  for (const auto& [x, force] : applied_) {
    const beam::Station s = line_->mesh.locate(x);
    loads_.push_back({s.element, s.xi, 0.0, force, 0.0, 0.0});
  }
  structure_->load(loads_);
}

void System::apply_to_body(int member, int body, const Eigen::Vector3d& action) {
  check_applied();
  fleet_.apply(member, body, action);
  applied_anew_ = true;
}

void System::apply_to_beam(double x, double force) {
  check_applied();
  if (line_ == nullptr) throw InputError("a force at a station needs a beam");
  if (!(x >= line_->mesh.start() && x <= line_->mesh.end()))
    throw InputError("the station " + std::to_string(x) + " m is not on the beam, which goes from " +
                     std::to_string(line_->mesh.start()) + " to " + std::to_string(line_->mesh.end()) + " m");
  applied_[x] = force;
  applied_anew_ = true;
}

void System::check_applied() const {
  if (apart_) throw InputError("forces cannot be set where steps are taken apart: model_vehicles full");
}

structure::ElementLoads System::contact_loads() {
  fleet_.element_loads(per_node(), element_loads_);
  return {fleet_.elements(), element_loads_};
}

bool System::begin_step(double from, double to) {
  bool changed = std::exchange(applied_anew_, false);
  changed = fleet_.begin_step(0.5 * (from + to)) || changed;
  if (line_ == nullptr) return changed;
  for (std::size_t i = 0; i < on_beam_.size(); ++i) {
    const double x = train::place_of(input_.load, i, 0.5 * (from + to));
    const char on = x >= line_->mesh.start() && x <= line_->mesh.end() ? 1 : 0;
    changed = changed || on != on_beam_[i];
    on_beam_[i] = on;
  }
  return changed;
}

}  // namespace traverse::coupling
