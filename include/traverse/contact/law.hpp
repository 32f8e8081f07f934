// Contact forces between a wheel and its running surface: Hertz or linear law, damping, tanh friction
// (the paper's eqs. 45, 48, 49 as corrected).
#pragma once

#include <optional>

namespace traverse::contact {

enum class LawKind { hertz, linear };

/// Normal force k*alpha^n + c*alpha_rate, n = 1.5 (hertz) or 1 (linear), never below zero, zero when apart.
/// With a restitution e instead of c: k*alpha^n*(1 + 3(1 - e^2)/4 * rate/approach_speed), Lankarani-Nikravesh.
/// Friction: mu0*tanh(sliding/transition_speed)*normal, against the sliding.
struct Law {
  LawKind kind = LawKind::hertz;
  double stiffness = 0.0;             // N/m^1.5 or N/m
  double damping = 0.0;               // N s/m
  std::optional<double> restitution;  // 0..1
  double friction = 0.0;              // mu0
  double transition_speed = 0.01;     // m/s
};

/// Contact kinematics: penetration (positive when touching), its rate, and the sliding speed.
struct Kinematics {
  double penetration = 0.0;       // alpha, m
  double penetration_rate = 0.0;  // m/s
  double sliding_speed = 0.0;     // beta', m/s
};

/// Forces and their derivatives with respect to the kinematics.
struct Force {
  double normal = 0.0;      // N, >= 0
  double tangential = 0.0;  // N, magnitude with the sign of the sliding speed (it acts against it)
  double normal_by_penetration = 0.0, normal_by_rate = 0.0;
  double tangential_by_penetration = 0.0, tangential_by_rate = 0.0, tangential_by_sliding = 0.0;
};

/// The force and all its derivatives with the other sign.
Force operator-(const Force& f);

/// approach_speed: of the impact now going on, m/s, used with a restitution only (0: no impact, no damping).
Force force(const Law& law, const Kinematics& kinematics, double approach_speed);

/// Elastic energy stored at a penetration: integral of k*alpha^n, J.
double potential(const Law& law, double penetration);

/// Penetration at which the law gives `normal` at rest.
double penetration_at_rest(const Law& law, double normal);

/// Hertz stiffness of a cylinder of radius R on a straight line, eq. 48 with R_i infinite, N/m^1.5.
double hertz_stiffness(double radius, double young_wheel, double poisson_wheel, double young_rail, double poisson_rail);

}  // namespace traverse::contact
