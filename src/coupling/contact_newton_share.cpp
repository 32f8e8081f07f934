// The data that ranks with shared vehicles exchange in every iteration.
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

}  // namespace traverse::coupling
