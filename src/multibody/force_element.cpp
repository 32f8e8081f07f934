// Tension of a spring from its elongation and elongation rate, its generalized forces on both bodies, and their
// analytical derivatives with respect to coordinates and velocities.
#include "multibody/force_element.hpp"

#include <cmath>

namespace traverse::multibody {

using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace {

constexpr double shortest = 1e-12;  // m; a shorter spring has no direction

/// The geometry and tension of a spring.
struct Line {
  Vector2d a1, a2;          // arms, global components
  Vector2d d, rate;         // from the first to the second point, and its time derivative
  double length;            // m
  Vector2d u;               // unit vector along d, zero for a spring of zero length
  double elastic;           // N, without the damper; not meaningful with a law
  double force_per_length;  // N/m: tension/length, or its limit for a zero-length spring
  double stiffness;         // N/m: tangents of the tension
  double damping;           // N s/m
  double dissipation;       // W, in the damper
  Line(const SpringGeometry& s, const Frame& first, const Frame& second)
      : a1(first.to_global(s.first_arm)),
        a2(second.to_global(s.second_arm)),
        d((second.origin - first.origin) + (a2 - a1)),
        rate(second.velocity_at(a2) - first.velocity_at(a1)),
        length(d.norm()),
        u(length > shortest ? Vector2d(d / length) : Vector2d::Zero()),
        elastic(s.preload + s.stiffness * (length - s.reference_length)),
        stiffness(s.stiffness),
        damping(s.damping) {
    if (s.law != nullptr) [[unlikely]] {
      apply_law(s);
      return;
    }
    const bool zero_length_spring = s.preload == 0.0 && s.reference_length <= shortest;
    const double elongation_rate = u.dot(rate) - s.reference_rate;
    dissipation = s.damping * elongation_rate * elongation_rate;
    if (length > shortest) {
      force_per_length = (elastic + s.damping * elongation_rate) / length;
    } else {
      force_per_length = zero_length_spring ? s.stiffness : 0.0;
    }
  }
  /// Sets tension and tangents by the law of the spring.
  void apply_law(const SpringGeometry& s) {
    const base::Tension t = base::tension(*s.law, length - s.reference_length, u.dot(rate) - s.reference_rate);
    stiffness = t.by_elongation;
    damping = t.by_rate;
    dissipation = t.dissipation;
    if (length > shortest) {
      force_per_length = t.tension / length;
    } else {
      force_per_length = s.reference_length <= shortest && t.tension == 0.0 ? stiffness : 0.0;
    }
  }
  Vector2d force() const { return force_per_length * d; }
};

double twist_of(const TorsionGeometry& s, const Frame& first, const Frame& second) {
  return second.angle - first.angle - s.free_angle;
}

base::Tension torsion_law(const TorsionGeometry& s, const Frame& first, const Frame& second) {
  return base::tension(*s.law, twist_of(s, first, second), second.omega - first.omega);
}

std::shared_ptr<const base::ForceLaw> shared(const std::optional<base::ForceLaw>& law) {
  return law ? std::make_shared<const base::ForceLaw>(*law) : nullptr;
}

}  // namespace

SpringGeometry spring_geometry(const Spring& spring, const Frame& first, const Frame& second) {
  SpringGeometry s;
  s.first = spring.bodies[0];
  s.second = spring.bodies[1];
  s.first_arm = first.to_body(spring.from - first.origin);
  s.second_arm = second.to_body(spring.to - second.origin);
  s.stiffness = spring.stiffness;
  s.damping = spring.damping;
  s.reference_length = spring.free_length.value_or((spring.to - spring.from).norm());
  if (spring.law) {
    s.law = shared(spring.law);
    if (spring.preload) s.reference_length -= s.law->elongation_at(*spring.preload).value();
  } else {
    s.preload = spring.preload.value_or(0.0);
  }
  if (spring.winding) s.winding = std::make_shared<base::TimeFunction>(*spring.winding);
  return s;
}

TorsionGeometry torsion_geometry(const TorsionSpring& spring, const Frame& first, const Frame& second) {
  return {spring.bodies[0],
          spring.bodies[1],
          spring.stiffness,
          spring.damping,
          spring.free_angle.value_or(second.angle - first.angle),
          shared(spring.law)};
}

PairForce spring_force(const SpringGeometry& spring, const Frame& first, const Frame& second) {
  double dissipation = 0.0;
  return spring_force(spring, first, second, dissipation);
}

PairForce spring_force(const SpringGeometry& spring, const Frame& first, const Frame& second, double& dissipation) {
  const Line line(spring, first, second);
  dissipation += line.dissipation;
  const Vector2d f = line.force();  // force on the first body; the opposite force acts on the second body
  PairForce g;
  g << f, quarter_turn(line.a1).dot(f), -f, -quarter_turn(line.a2).dot(f);
  return g;
}

double spring_length(const SpringGeometry& spring, const Frame& first, const Frame& second) {
  return Line(spring, first, second).length;
}

double spring_tension(const SpringGeometry& spring, const Frame& first, const Frame& second) {
  const Line line(spring, first, second);
  return line.force_per_length * line.length;
}

void spring_derivatives(const SpringGeometry& spring, const Frame& first, const Frame& second, PairMatrix& g_q,
                        PairMatrix& g_qd) {
  const Line line(spring, first, second);
  using PairRows = Eigen::Matrix<double, 2, 6>;
  PairRows d_q;  // also d(rate)/dq'
  d_q << -Matrix2d::Identity(), -quarter_turn(line.a1), Matrix2d::Identity(), quarter_turn(line.a2);
  PairRows rate_q = PairRows::Zero();
  rate_q.col(2) = first.omega * line.a1;
  rate_q.col(5) = -second.omega * line.a2;

  const Matrix2d along = line.u * line.u.transpose();
  Matrix2d f_d = line.force_per_length * (Matrix2d::Identity() - along);
  if (line.length > shortest) {
    const Vector2d u_rate = (line.rate - line.u * line.u.dot(line.rate)) / line.length;
    f_d += line.u * (line.stiffness * line.u + line.damping * u_rate).transpose();
  }
  const PairRows f_qd = line.damping * along * d_q;
  const PairRows f_q = f_d * d_q + line.damping * along * rate_q;
  g_q.noalias() = -d_q.transpose() * f_q;
  g_qd.noalias() = -d_q.transpose() * f_qd;
  const Vector2d f = line.force();
  g_q(2, 2) -= f.dot(line.a1);
  g_q(5, 5) += f.dot(line.a2);
}

double spring_strain_energy(const SpringGeometry& spring, const Frame& first, const Frame& second) {
  const Line line(spring, first, second);
  if (spring.law != nullptr) return base::stored_energy(*spring.law, line.length - spring.reference_length);
  if (spring.stiffness == 0.0) return spring.preload * (line.length - spring.reference_length);
  return 0.5 * line.elastic * line.elastic / spring.stiffness;
}

double spring_dissipation(const SpringGeometry& spring, const Frame& first, const Frame& second) {
  return Line(spring, first, second).dissipation;
}

double torsion_moment(const TorsionGeometry& s, const Frame& first, const Frame& second) {
  if (s.law != nullptr) [[unlikely]]
    return -torsion_law(s, first, second).tension;
  return -s.stiffness * twist_of(s, first, second) - s.damping * (second.omega - first.omega);
}

TorsionTangent torsion_tangent(const TorsionGeometry& s, const Frame& first, const Frame& second) {
  if (s.law == nullptr) return {s.stiffness, s.damping};
  const base::Tension t = torsion_law(s, first, second);
  return {t.by_elongation, t.by_rate};
}

double torsion_strain_energy(const TorsionGeometry& s, const Frame& first, const Frame& second) {
  const double twist = twist_of(s, first, second);
  if (s.law != nullptr) return base::stored_energy(*s.law, twist);
  return 0.5 * s.stiffness * twist * twist;
}

double torsion_dissipation(const TorsionGeometry& s, const Frame& first, const Frame& second) {
  if (s.law != nullptr) return torsion_law(s, first, second).dissipation;
  const double rate = second.omega - first.omega;
  return s.damping * rate * rate;
}

}  // namespace traverse::multibody
