// What acts on the beam: its own weight, the moving forces, the contacts.
#include <algorithm>

#include "traverse/beam/shape.hpp"
#include "traverse/coupling/system.hpp"

namespace traverse::coupling {

void System::moving_loads(double t) {
  loads_.clear();
  if (beam_ == nullptr) return;
  for (std::size_t i = 0; i < input_.load.forces.size(); ++i) {
    if (on_beam_[i] == 0) continue;
    const beam::Station s = line_->mesh.locate(input_.load.positions[i] + input_.load.speed * t);
    loads_.push_back({s.element, s.xi, 0.0, -input_.load.forces[i], 0.0, input_.load.speed});
  }
}

// The moving forces as forces on this rank's unknowns.
void System::list_nodal_loads() {
  nodal_loads_.clear();
  for (const beam::ElementLoad& load : loads_) {
    const beam::Hermite psi = beam::hermite(load.xi, line_->mesh.element(load.element).length);
    const auto unknowns = line_->transverse(load.element);
    for (int i = 0; i < 4; ++i) {
      const int local = beam_->local(unknowns[i]);
      if (local >= 0) nodal_loads_.push_back({local, load.fy * psi.value[i]});
    }
  }
  std::sort(nodal_loads_.begin(), nodal_loads_.end(),
            [](const NodalLoad& a, const NodalLoad& b) { return a.unknown < b.unknown; });
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

void System::add_point_load(const beam::Line& line, const beam::ElementLoad& load, double* nodal) const {
  const beam::Hermite psi = beam::hermite(load.xi, line.mesh.element(load.element).length);
  const auto unknowns = line.transverse(load.element);
  for (int i = 0; i < 4; ++i) {
    const int local = beam_->local(unknowns[i]);
    if (local >= 0) nodal[local] += load.fy * psi.value[i];
  }
}

// Everything but the contacts: self-weight and moving forces.
void System::external_load(double t, double* nodal) {
  std::copy(dead_load_.begin(), dead_load_.end(), nodal);
  moving_loads(t);
  for (const beam::ElementLoad& load : loads_) add_point_load(*line_, load, nodal);
}

void System::add_contact_load(double* nodal) {
  if (beam_ == nullptr) return;
  std::vector<double>& loads = element_work_;
  fleet_.element_loads(per_node_, loads);
  const int m = 2 * per_node_;
  for (std::size_t a = 0; a < fleet_.elements().size(); ++a) {
    const auto unknowns = line_->unknowns(fleet_.elements()[a]);
    for (int i = 0; i < m; ++i) {
      const int local = beam_->local(unknowns[i]);
      if (local >= 0) nodal[local] += loads[a * m + i];
    }
  }
}

// Loads on unknowns that a support holds go into the reactions, not into the equations of motion.
void System::release_held(double* nodal) const {
  if (beam_ == nullptr) return;
  const std::vector<char>& fixed = beam_->fixed();
  for (int i = 0; i < n_; ++i)
    if (fixed[i] != 0) nodal[i] = 0.0;
}

}  // namespace traverse::coupling
