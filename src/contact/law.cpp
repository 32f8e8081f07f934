// Normal force and friction with their derivatives (equations 45, 48 and 49), the penetration of a contact in series
// with a spring by Newton's method, and the hysteresis damping for a given restitution by bisection.
#include "traverse/contact/law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#pragma GCC diagnostic error "-Wswitch"  // each switch over contact::LawKind has a case for every kind

namespace traverse::contact {
namespace {

constexpr int max_iterations = 50;
constexpr double tolerance = 1e-16;
constexpr int most_doublings = 60, most_halvings = 100;
constexpr double min_approach_speed = 1e-3;  // m/s: lower limit of the approach speed in the damping

/// k*alpha^n and its derivative at alpha > 0.
struct Elastic {
  double force = 0.0;  // N
  double slope = 0.0;  // N/m
};

Elastic surface_force(const Law& law, double alpha) {
  switch (law.kind) {
    case LawKind::hertz:
      return {law.stiffness * alpha * std::sqrt(alpha), 1.5 * law.stiffness * std::sqrt(alpha)};
    case LawKind::linear:
    case LawKind::two_sided:
      return {law.stiffness * alpha, law.stiffness};
    case LawKind::other:
      break;
  }
  return {law.elastic->force(alpha), law.elastic->stiffness(alpha)};
}

/// The penetration at which an increasing function of it has a value, by bisection, m.
template <class Increasing>
double penetration_of(double value, const Increasing& function) {
  double high = 1e-9;
  for (int i = 0; i < most_doublings && function(high) < value; ++i) high *= 2.0;
  double low = 0.0;
  for (int i = 0; i < most_halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) < value ? low : high) = middle;
  }
  return high;
}

/// The duration of an impact by the integral of 1/alpha' over the compression, with alpha = alpha_max sin(theta), s.
double duration_of_impact(const ElasticLaw& law, double mass, double speed) {
  const double energy = 0.5 * mass * speed * speed;
  const double largest = penetration_of(energy, [&](double alpha) { return law.energy(alpha); });
  constexpr int parts = 200;
  double sum = 0.0;
  for (int i = 0; i < parts; ++i) {
    const double theta = 0.5 * std::numbers::pi * (i + 0.5) / parts;
    const double left = std::max(1.0 - law.energy(largest * std::sin(theta)) / energy, 1e-12);
    sum += largest * std::cos(theta) / (speed * std::sqrt(left));
  }
  return std::numbers::pi * sum / parts;
}

/// The elastic force at a total penetration, which includes the deflection of the local compliance.
Elastic elastic(const Law& law, double penetration) {
  if (law.local_compliance == 0.0) return surface_force(law, penetration);
  const auto [force, slope] = surface_force(law, surface_penetration(law, penetration));
  return {force, slope / (1.0 + law.local_compliance * slope)};
}

/// Eq. 45, or hysteresis damping: the force and its derivatives without the lower limit of zero.
Force unlimited_force(const Law& law, const Kinematics& k, double approach_speed) {
  const auto [force, slope] = elastic(law, k.penetration);
  Force f;
  f.normal = force;
  f.normal_by_penetration = slope;
  if (!law.hysteresis) {
    const double share = pulls(law.kind) ? 1.0 : std::clamp(k.penetration / damper_ramp, 0.0, 1.0);
    f.normal += share * law.damping * k.penetration_rate;
    f.normal_by_rate = share * law.damping;
    if (share < 1.0) f.normal_by_penetration += law.damping * k.penetration_rate / damper_ramp;
  } else if (approach_speed > 0.0) {
    const double hysteresis = *law.hysteresis / std::max(approach_speed, min_approach_speed);
    const double factor = 1.0 + hysteresis * k.penetration_rate;
    f.normal = force * factor;
    f.normal_by_penetration = slope * factor;
    f.normal_by_rate = force * hysteresis;
  }
  return f;
}

}  // namespace

Force force(const Law& law, const Kinematics& kinematics, double approach_speed) {
  if (pulls(law.kind)) return unlimited_force(law, kinematics, 0.0);
  if (!(kinematics.penetration > 0.0)) return {};
  Force f = unlimited_force(law, kinematics, approach_speed);
  if (!(f.normal > 0.0)) return {};  // no adhesion
  if (law.friction == 0.0) return f;
  const double t = std::tanh(kinematics.sliding_speed / law.transition_speed);  // eq. 49
  const double mu = law.friction * t;
  f.tangential = mu * f.normal;
  f.tangential_by_penetration = mu * f.normal_by_penetration;
  f.tangential_by_rate = mu * f.normal_by_rate;
  f.tangential_by_sliding = law.friction * (1.0 - t * t) / law.transition_speed * f.normal;
  return f;
}

double unlimited_normal_force(const Law& law, const Kinematics& kinematics, double approach_speed) {
  return unlimited_force(law, kinematics, approach_speed).normal;
}

double impact_duration(const Law& law, double mass, double speed) {
  switch (law.kind) {
    case LawKind::hertz:
      return 2.9432750 * std::pow(1.25 * mass * speed * speed / law.stiffness, 0.4) / speed;
    case LawKind::linear:
    case LawKind::two_sided:
      return std::numbers::pi * std::sqrt(mass / law.stiffness);
    case LawKind::other:
      break;
  }
  return duration_of_impact(*law.elastic, mass, speed);
}

namespace {

// Newton's method for r in r^2 + s*k*r^3 = penetration, s the local compliance. The function is convex, so that the
// iteration from the right converges monotonically.
double surface_penetration_of_hertz(double compliance_factor, double penetration) {
  double root = std::sqrt(penetration);
  for (int i = 0; i < max_iterations; ++i) {
    const double excess = root * root * (1.0 + compliance_factor * root) - penetration;
    const double step = excess / (root * (2.0 + 3.0 * compliance_factor * root));
    root -= step;
    if (step <= tolerance * root) break;
  }
  return root * root;
}

}  // namespace

double surface_penetration(const Law& law, double penetration) {
  if (law.local_compliance == 0.0 || (!pulls(law.kind) && !(penetration > 0.0))) return penetration;
  const double compliance_factor = law.local_compliance * law.stiffness;
  switch (law.kind) {
    case LawKind::hertz:
      return surface_penetration_of_hertz(compliance_factor, penetration);
    case LawKind::linear:
    case LawKind::two_sided:
      return penetration / (1.0 + compliance_factor);
    case LawKind::other:
      break;
  }
  return std::min(penetration, penetration_of(penetration, [&](double alpha) {
                    return alpha + law.local_compliance * law.elastic->force(alpha);
                  }));
}

double potential(const Law& law, double penetration) {
  if (!pulls(law.kind) && !(penetration > 0.0)) return 0.0;
  const double alpha = surface_penetration(law, penetration), force = surface_force(law, alpha).force,
               of_compliance = 0.5 * law.local_compliance * force * force;
  switch (law.kind) {
    case LawKind::hertz:
      return 0.4 * force * alpha + of_compliance;
    case LawKind::linear:
    case LawKind::two_sided:
      return 0.5 * force * alpha + of_compliance;
    case LawKind::other:
      break;
  }
  return law.elastic->energy(alpha) + of_compliance;
}

double static_penetration(const Law& law, double normal) {
  if (!(normal > 0.0)) return 0.0;
  const double ratio = normal / law.stiffness;
  switch (law.kind) {
    case LawKind::hertz:
      return std::cbrt(ratio) * std::cbrt(ratio);
    case LawKind::linear:
    case LawKind::two_sided:
      return ratio;
    case LawKind::other:
      break;
  }
  return penetration_of(normal, [&](double alpha) { return law.elastic->force(alpha); });
}

double hertz_stiffness(double radius, double young_i, double poisson_i, double young_j, double poisson_j) {
  using std::numbers::pi;
  const double h_i = (1.0 - poisson_i * poisson_i) / (pi * young_i);
  const double h_j = (1.0 - poisson_j * poisson_j) / (pi * young_j);
  return 4.0 / (3.0 * pi * (h_i + h_j)) * std::sqrt(radius);
}

double lankarani_nikravesh_hysteresis(double e) { return 0.75 * (1.0 - e * e); }

double exact_hysteresis(double e) {
  if (e >= 1.0) return 0.0;
  // ln((1 + d)/(1 - e d)) - (1 + e) d is negative for small d and increases without limit towards d = 1/e.
  double low = 0.0, high = 1.0 / e;
  for (int i = 0; i < 200; ++i) {
    const double d = 0.5 * (low + high);
    (std::log1p(d) - std::log1p(-e * d) < (1.0 + e) * d ? low : high) = d;
  }
  return low;
}

}  // namespace traverse::contact
