#include "traverse/contact/law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::contact {
namespace {

/// k*alpha^n and its derivative at alpha > 0.
struct Elastic {
  double force = 0.0;  // N
  double slope = 0.0;  // N/m
};

Elastic elastic(const Law& law, double alpha) {
  if (law.kind == LawKind::linear) return {law.stiffness * alpha, law.stiffness};
  const double root = std::sqrt(alpha);
  return {law.stiffness * alpha * root, 1.5 * law.stiffness * root};
}

/// Eq. 45, or Lankarani and Nikravesh's hysteresis damping, held at zero from below: no sticking.
void normal_force(const Law& law, const Kinematics& k, double approach_speed, Force& f) {
  if (!(k.penetration > 0.0)) return;
  const auto [force, slope] = elastic(law, k.penetration);
  double normal = force, by_penetration = slope, by_rate = 0.0;
  if (!law.restitution) {
    normal += law.damping * k.penetration_rate;
    by_rate = law.damping;
  } else if (approach_speed > 0.0) {
    const double e = *law.restitution;
    const double hysteresis = 0.75 * (1.0 - e * e) / approach_speed;
    const double factor = 1.0 + hysteresis * k.penetration_rate;
    normal = force * factor;
    by_penetration = slope * factor;
    by_rate = force * hysteresis;
  }
  if (!(normal > 0.0)) return;
  f.normal = normal;
  f.normal_by_penetration = by_penetration;
  f.normal_by_rate = by_rate;
}

}  // namespace

Force force(const Law& law, const Kinematics& kinematics, double approach_speed) {
  Force f;
  normal_force(law, kinematics, approach_speed, f);
  if (f.normal == 0.0 || law.friction == 0.0) return f;
  const double t = std::tanh(kinematics.sliding_speed / law.transition_speed);  // eq. 49
  const double mu = law.friction * t;
  f.tangential = mu * f.normal;
  f.tangential_by_penetration = mu * f.normal_by_penetration;
  f.tangential_by_rate = mu * f.normal_by_rate;
  f.tangential_by_sliding = law.friction * (1.0 - t * t) / law.transition_speed * f.normal;
  return f;
}

Force operator-(const Force& f) {
  return {-f.normal,
          -f.tangential,
          -f.normal_by_penetration,
          -f.normal_by_rate,
          -f.tangential_by_penetration,
          -f.tangential_by_rate,
          -f.tangential_by_sliding};
}

double potential(const Law& law, double penetration) {
  if (!(penetration > 0.0)) return 0.0;
  if (law.kind == LawKind::linear) return 0.5 * law.stiffness * penetration * penetration;
  return 0.4 * law.stiffness * penetration * penetration * std::sqrt(penetration);
}

double penetration_at_rest(const Law& law, double normal) {
  if (!(normal > 0.0)) return 0.0;
  const double ratio = normal / law.stiffness;
  if (law.kind == LawKind::linear) return ratio;
  const double root = std::cbrt(ratio);
  return root * root;
}

double hertz_stiffness(double radius, double young_wheel, double poisson_wheel, double young_rail,
                       double poisson_rail) {
  using std::numbers::pi;
  const double h_wheel = (1.0 - poisson_wheel * poisson_wheel) / (pi * young_wheel);
  const double h_rail = (1.0 - poisson_rail * poisson_rail) / (pi * young_rail);
  return 4.0 / (3.0 * pi * (h_wheel + h_rail)) * std::sqrt(radius);
}

}  // namespace traverse::contact
