// The data that ranks with shared vehicles exchange in every iteration, and the beam under the contact forces of a
// stage, at the elements under the wheels.
#include <algorithm>

#include "coupling/contact_newton.hpp"

namespace traverse::coupling {

// Residuals, contact geometry, and the vehicles' displacements under unchanged contact forces.
unsigned ContactNewton::share_contacts(const StageData& s, train::Fleet& fleet, unsigned flags) {
  if (s.share == nullptr) return flags;
  const int m = s.compliance != nullptr ? 2 * s.per_node : 0;
  const auto numbers = [m](const train::Contact& c) { return 7 + (c.law.friction > 0.0 ? 2 * m : m); };
  const auto each = [&](int k, auto number) {
    number(contacts_.compliance(k).residual);
    Eigen::VectorXd& own = contacts_.compliance(k).c;
    own.resize(contacts_.rows(k));
    for (int i = 0; i < own.size(); ++i) number(own[i]);
    for (const int i : fleet.vehicles[k].touching) {
      train::Contact& c = fleet.contact(i);
      auto& [penetration, rate, sliding] = c.touch.kinematics;
      for (double* value : {&penetration, &rate, &sliding}) number(*value);
      number(fleet.x(c));
      number(fleet.x_rate(c));
      number(c.active);
      number(c.law.local_compliance);
      for (int j = 0; j < m; ++j) number(c.touch.normal_on_beam[j]);
      for (int j = 0; c.law.friction > 0.0 && j < m; ++j) number(c.touch.tangent_on_beam[j]);
    }
  };
  const auto size = [&](int k) {
    int sum = 1 + contacts_.rows(k);
    for (const int i : fleet.vehicles[k].touching) sum += numbers(fleet.contact(i));
    return sum;
  };
  return s.share->exchange(
      flags, size, [&](int k, double* to) { each(k, [&to](auto& value) { *to++ = value; }); },
      [&](int k, const double* from) {
        each(k, [&from](auto& value) { value = static_cast<std::remove_reference_t<decltype(value)>>(*from++); });
      });
}

void ContactNewton::share_matrices(const StageData& s) {
  if (s.share == nullptr) return;
  const auto rows = [this](int k) { return contacts_.rows(k); };
  (void)s.share->exchange(
      0, [&](int k) { return rows(k) * rows(k); },
      [&](int k, double* to) { std::copy_n(contacts_.compliance(k).H.data(), rows(k) * rows(k), to); },
      [&](int k, const double* from) {
        contacts_.compliance(k).H = Eigen::Map<const Eigen::MatrixXd>(from, rows(k), rows(k));
        contacts_.compliance(k).P.resize(0, 0);
      });
}

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
