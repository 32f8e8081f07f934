// The beam under the contact forces of a stage, at the elements under the wheels.
#include "coupling/contact_newton.hpp"

namespace traverse::coupling {
void ContactNewton::beam_field(const StageData& s, const train::Fleet& fleet, Loads loads) {
  if (loads == Loads::none || s.compliance == nullptr || fleet.elements().empty()) {
    v_ = *s.v0;
    w_ = *s.w0;
    return;
  }
  if (loads == Loads::expected)
    fleet.expected_loads(s.per_node, loads_);
  else
    fleet.element_loads(s.per_node, loads_);
  v_.assign(s.v0->size(), 0.0);
  w_.resize(v_.size());
  s.compliance->respond(loads_, v_);
  for (std::size_t i = 0; i < v_.size(); ++i) {
    w_[i] = (*s.w0)[i] + s.shift * v_[i];
    v_[i] += (*s.v0)[i];
  }
}

// The evaluated geometry gives the points of action of the forces. They differ slightly from those that the beam was
// computed with: the beam's response to the difference of the loads is added to the kinematics.
void ContactNewton::correct_kinematics(const StageData& s, train::Fleet& fleet) {
  const std::size_t m = 2 * static_cast<std::size_t>(s.per_node);
  before_.swap(loads_);
  fleet.element_loads(s.per_node, loads_);
  for (std::size_t i = 0; i < loads_.size(); ++i) before_[i] = loads_[i] - before_[i];
  v_.assign(v_.size(), 0.0);
  s.compliance->respond(before_, v_);
  for (train::WheelContact& c : fleet.wheels) {
    if (c.slot() < 0 || fleet.vehicles[c.vehicle].converged) continue;
    const double* z = &v_[m * static_cast<std::size_t>(c.slot())];
    double normal = 0.0, tangential = 0.0;
    for (std::size_t i = 0; i < m; ++i) {
      normal += c.touch.normal_on_beam[i] * z[i];
      tangential += c.touch.tangent_on_beam[i] * z[i];
    }
    c.touch.kinematics.penetration += normal;
    c.touch.kinematics.penetration_rate += s.shift * normal;
    c.touch.kinematics.sliding_speed += s.shift * tangential;
  }
}

}  // namespace traverse::coupling
