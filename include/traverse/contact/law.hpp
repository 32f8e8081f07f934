// Contact forces between a wheel and its running surface, or between two bodies: Hertz or linear law, damping, tanh
// friction (the paper's eqs. 45, 48, 49 as corrected in doc/theory.md).
#pragma once

#include <optional>

namespace traverse::contact {

enum class LawKind { hertz, linear };

/// Penetration over which a damper comes on, m. If it came on at once, a stage of an implicit method that ends just
/// there would have no solution.
constexpr double damper_ramp = 1e-9;

/// Normal force k*alpha^n + c*alpha_rate, n = 1.5 (hertz) or 1 (linear), never below zero, zero when apart.
/// With a hysteresis d instead of c: k*alpha^n*(1 + d*rate/approach_speed).
/// Friction: mu0*tanh(sliding/transition_speed)*normal, against the sliding.
/// On a seat that yields by `seat` times the elastic force the elastic law and the seat share the penetration:
/// penetration = alpha + seat*k*alpha^n. Damper and hysteresis act on the whole of it.
struct Law {
  LawKind kind = LawKind::hertz;
  double stiffness = 0.0;            // N/m^1.5 or N/m
  double damping = 0.0;              // N s/m
  std::optional<double> hysteresis;  // d
  double friction = 0.0;             // mu0
  double transition_speed = 0.01;    // m/s
  double seat = 0.0;                 // m/N
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

/// The hysteresis d for which an impact of two bodies left to themselves has the restitution e, 0 < e <= 1: the motion
/// m alpha'' = -k alpha^n (1 + d alpha'/v) from v to -e v integrates to (1 + e) d = ln((1 + d)/(1 - e d)), whatever m,
/// k, n and v are.
double exact_hysteresis(double restitution);
/// Lankarani and Nikravesh 1990: 3(1 - e^2)/4, the same to first order in 1 - e; rebounds come out higher than e.
double lankarani_nikravesh_hysteresis(double restitution);

/// The force and all its derivatives with the other sign.
Force operator-(const Force& f);

/// approach_speed: of the impact now going on, m/s, used with a hysteresis only (0: no impact, no damping).
Force force(const Law& law, const Kinematics& kinematics, double approach_speed);

/// The normal force before it is held at zero: below zero where the surfaces part.
double normal_tendency(const Law& law, const Kinematics& kinematics, double approach_speed);

/// How long an impact of an effective mass (kg) lasts that meets the elastic law at a speed (m/s), s; its first half is
/// the compression (Hertz: 2.9432 times the greatest penetration over the speed).
double impact_duration(const Law& law, double mass, double speed);

/// The part of a penetration that is the surfaces' own, alpha: all but what the seat yields, m.
double own_penetration(const Law& law, double penetration);

/// Elastic energy stored at a penetration, the seat's included: integral of k*alpha^n over the penetration, J.
double potential(const Law& law, double penetration);

/// Penetration at which the law gives `normal` at rest.
double penetration_at_rest(const Law& law, double normal);

/// Hertz stiffness of two curved bodies, eq. 48, N/m^1.5: R = R_i R_j/(R_i + R_j), the radius itself on a straight
/// line.
double hertz_stiffness(double radius, double young_i, double poisson_i, double young_j, double poisson_j);

}  // namespace traverse::contact
