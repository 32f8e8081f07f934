// Normal force and friction with their derivatives (equations 45, 48 and 49), the penetration of a contact in series
// with a spring by Newton's method, and hysteresis damping for a given restitution by bisection.
#include "traverse/contact/law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::contact {
namespace {

constexpr int most_iterations = 50;
constexpr double settled = 1e-16;
constexpr double slowest_approach = 1e-3;  // m/s: gentler touches are damped as this one

/// k*alpha^n and its derivative at alpha > 0.
struct Elastic {
  double force = 0.0;  // N
  double slope = 0.0;  // N/m
};

Elastic elastic_alone(const Law& law, double alpha) {
  if (law.kind == LawKind::linear) return {law.stiffness * alpha, law.stiffness};
  const double root = std::sqrt(alpha);
  return {law.stiffness * alpha * root, 1.5 * law.stiffness * root};
}

/// The same at a penetration that the seat takes part in.
Elastic elastic(const Law& law, double penetration) {
  if (law.seat == 0.0) return elastic_alone(law, penetration);
  const auto [force, slope] = elastic_alone(law, own_penetration(law, penetration));
  return {force, slope / (1.0 + law.seat * slope)};
}

/// Eq. 45, or hysteresis damping: the force and its derivatives before it is held at zero.
Force tendency(const Law& law, const Kinematics& k, double approach_speed) {
  const auto [force, slope] = elastic(law, k.penetration);
  Force f;
  f.normal = force;
  f.normal_by_penetration = slope;
  if (!law.hysteresis) {
    const double share = std::clamp(k.penetration / damper_ramp, 0.0, 1.0);
    f.normal += share * law.damping * k.penetration_rate;
    f.normal_by_rate = share * law.damping;
    if (share < 1.0) f.normal_by_penetration += law.damping * k.penetration_rate / damper_ramp;
  } else if (approach_speed > 0.0) {
    const double hysteresis = *law.hysteresis / std::max(approach_speed, slowest_approach);
    const double factor = 1.0 + hysteresis * k.penetration_rate;
    f.normal = force * factor;
    f.normal_by_penetration = slope * factor;
    f.normal_by_rate = force * hysteresis;
  }
  return f;
}

}  // namespace

Force force(const Law& law, const Kinematics& kinematics, double approach_speed) {
  if (!(kinematics.penetration > 0.0)) return {};
  Force f = tendency(law, kinematics, approach_speed);
  if (!(f.normal > 0.0)) return {};  // no sticking
  if (law.friction == 0.0) return f;
  const double t = std::tanh(kinematics.sliding_speed / law.transition_speed);  // eq. 49
  const double mu = law.friction * t;
  f.tangential = mu * f.normal;
  f.tangential_by_penetration = mu * f.normal_by_penetration;
  f.tangential_by_rate = mu * f.normal_by_rate;
  f.tangential_by_sliding = law.friction * (1.0 - t * t) / law.transition_speed * f.normal;
  return f;
}

double normal_tendency(const Law& law, const Kinematics& kinematics, double approach_speed) {
  return tendency(law, kinematics, approach_speed).normal;
}

double impact_duration(const Law& law, double mass, double speed) {
  if (law.kind == LawKind::linear) return std::numbers::pi * std::sqrt(mass / law.stiffness);
  return 2.9432750 * std::pow(1.25 * mass * speed * speed / law.stiffness, 0.4) / speed;
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

// Newton for r with r^2 + seat*k*r^3 = penetration, a convex line: from the right it comes down without passing it.
double own_penetration(const Law& law, double penetration) {
  if (law.seat == 0.0 || !(penetration > 0.0)) return penetration;
  const double yielding = law.seat * law.stiffness;
  if (law.kind == LawKind::linear) return penetration / (1.0 + yielding);
  double root = std::sqrt(penetration);
  for (int i = 0; i < most_iterations; ++i) {
    const double excess = root * root * (1.0 + yielding * root) - penetration;
    const double step = excess / (root * (2.0 + 3.0 * yielding * root));
    root -= step;
    if (step <= settled * root) break;
  }
  return root * root;
}

double potential(const Law& law, double penetration) {
  if (!(penetration > 0.0)) return 0.0;
  const double alpha = own_penetration(law, penetration);
  const double force = elastic_alone(law, alpha).force;
  return (law.kind == LawKind::linear ? 0.5 : 0.4) * force * alpha + 0.5 * law.seat * force * force;
}

double penetration_at_rest(const Law& law, double normal) {
  if (!(normal > 0.0)) return 0.0;
  const double ratio = normal / law.stiffness;
  if (law.kind == LawKind::linear) return ratio;
  const double root = std::cbrt(ratio);
  return root * root;
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
  // ln((1 + d)/(1 - e d)) - (1 + e) d is below 0 at first and rises without bound towards d = 1/e
  double low = 0.0, high = 1.0 / e;
  for (int i = 0; i < 200; ++i) {
    const double d = 0.5 * (low + high);
    (std::log1p(d) - std::log1p(-e * d) < (1.0 + e) * d ? low : high) = d;
  }
  return low;
}

}  // namespace traverse::contact
