// What acts on the structure: moving forces and contacts.
#include "coupling/system.hpp"

namespace traverse::coupling {

// The moving forces as they stand at t.
void System::load_structure(double t) {
  loads_.clear();
  for (std::size_t i = 0; i < input_.load.forces.size(); ++i) {
    if (on_beam_[i] == 0) continue;
    const beam::Station s = line_->mesh.locate(input_.load.positions[i] + input_.load.speed * t);
    loads_.push_back({s.element, s.xi, 0.0, -input_.load.forces[i], 0.0, input_.load.speed});
  }
  structure_->load(loads_);
}

structure::ElementLoads System::contact_loads() {
  fleet_.element_loads(per_node(), element_loads_);
  return {fleet_.elements(), element_loads_};
}

bool System::begin_step(double from, double to) {
  if (line_ == nullptr) return false;
  bool changed = false;
  for (std::size_t i = 0; i < on_beam_.size(); ++i) {
    const double x = input_.load.positions[i] + input_.load.speed * 0.5 * (from + to);
    const char on = x >= line_->mesh.start() && x <= line_->mesh.end() ? 1 : 0;
    changed = changed || on != on_beam_[i];
    on_beam_[i] = on;
  }
  return changed;
}

}  // namespace traverse::coupling
