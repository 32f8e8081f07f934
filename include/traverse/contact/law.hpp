// Contact forces between a wheel and its running surface, or between two bodies: Hertz or linear law, damping, tanh
// friction (eqs. 45, 48, 49 of the paper as corrected in doc/theory.md).
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>

namespace traverse::contact {

/// A new kind needs a row below and a case in each switch over the kinds; the compiler names them.
enum class LawKind { hertz, linear, two_sided, other };

/// What the program knows of a kind of contact law beside its formulas.
struct LawRow {
  LawKind kind;
  std::string_view name;   // that the user writes; empty: only a program can define it
  std::string_view words;  // for -help: the force over the penetration a
  bool pulls;              // it acts at all penetrations, so that the contact never opens
};

/// In the order of LawKind.
inline constexpr LawRow law_rows[] = {
    {LawKind::hertz, "hertz", "k a^1.5", false},
    {LawKind::linear, "linear", "k a", false},
    {LawKind::two_sided, "two_sided", "k a that also pulls", true},
    {LawKind::other, "", "", false},
};

/// The row of a kind.
constexpr const LawRow& row_of(LawKind kind) { return law_rows[static_cast<std::size_t>(kind)]; }

static_assert(std::size(law_rows) == static_cast<std::size_t>(LawKind::other) + 1, "each kind has a row");
static_assert(std::ranges::all_of(law_rows, [](const LawRow& row) { return &row_of(row.kind) == &row; }),
              "the rows are in the order of the kinds");

/// Whether contacts of a kind act at all penetrations.
constexpr bool pulls(LawKind kind) { return row_of(kind).pulls; }

/// The kind that the user names so; none for any other name.
constexpr std::optional<LawKind> law_kind(std::string_view name) {
  for (const LawRow& row : law_rows)
    if (!name.empty() && row.name == name) return row.kind;
  return {};
}

/// An elastic contact law that a program defines itself: a force over the penetration, which starts at zero and
/// increases. examples/simulate/own_laws.cpp has one.
class ElasticLaw {
 public:
  virtual ~ElasticLaw() = default;
  /// The force at a penetration above 0, N over m.
  virtual double force(double penetration) const = 0;
  /// The derivative of the force, N/m, above 0.
  virtual double stiffness(double penetration) const = 0;
  /// The integral of the force from 0, J.
  virtual double energy(double penetration) const = 0;
};

/// Penetration over which the damper force increases from zero, m. With a sudden damper force, a stage of an implicit
/// method that ends at the first contact would have no solution.
constexpr double damper_ramp = 1e-9;

/// Normal force k*alpha^n + c*alpha_rate, n = 1.5 (hertz) or 1 (linear), never negative, zero without contact. The
/// kind `other` has elastic->force(alpha) in place of k*alpha^n. The kind `two_sided` has k*alpha + c*alpha_rate at all
/// penetrations, negative ones too: it pulls, and the contact never opens (a magnet, a roller between two rails).
/// With a hysteresis d instead of c: k*alpha^n*(1 + d*rate/approach_speed).
/// Friction: mu0*tanh(sliding/transition_speed)*normal, against the sliding.
/// A local compliance s in series with the elastic law deflects by s times the elastic force, and both share the
/// penetration: penetration = alpha + s*k*alpha^n. Damper and hysteresis act on the whole penetration.
struct Law {
  LawKind kind = LawKind::hertz;
  std::shared_ptr<const ElasticLaw> elastic;  // law of the kind `other`
  double stiffness = 0.0;                     // N/m^1.5 or N/m
  double damping = 0.0;                       // N s/m
  std::optional<double> hysteresis;           // d
  double friction = 0.0;                      // mu0
  double transition_speed = 0.01;             // m/s
  double local_compliance = 0.0;              // m/N
};

/// Contact kinematics: penetration (positive in contact), its rate, and the sliding speed.
struct Kinematics {
  double penetration = 0.0;       // alpha, m
  double penetration_rate = 0.0;  // m/s
  double sliding_speed = 0.0;     // beta', m/s
};

/// Forces and their derivatives with respect to the kinematics.
struct Force {
  double normal = 0.0;      // N, >= 0 except for two_sided
  double tangential = 0.0;  // N, with the sign of the sliding speed, against which it acts
  double normal_by_penetration = 0.0, normal_by_rate = 0.0;
  double tangential_by_penetration = 0.0, tangential_by_rate = 0.0, tangential_by_sliding = 0.0;
};

/// The hysteresis d for which an impact of two free bodies has the restitution e, 0 < e <= 1. The motion m alpha'' = -k
/// alpha^n (1 + d alpha'/v) from v to -e v integrates to (1 + e) d = ln((1 + d)/(1 - e d)), independent of m, k, n and
/// v.
double exact_hysteresis(double restitution);
/// Lankarani and Nikravesh 1990: 3(1 - e^2)/4, equal to the exact value to first order in 1 - e. The resulting
/// restitution is larger than e.
double lankarani_nikravesh_hysteresis(double restitution);

/// approach_speed: approach speed of the present impact, m/s; only a hysteresis uses it (0: no impact, no damping).
Force force(const Law& law, const Kinematics& kinematics, double approach_speed);

/// The normal force without its lower limit of zero; it is negative if the surfaces separate.
double unlimited_normal_force(const Law& law, const Kinematics& kinematics, double approach_speed);

/// Duration of an impact of an effective mass (kg) on the elastic law at a speed (m/s), s (Hertz: 2.9432 times the
/// largest penetration over the speed). Its first half is the compression.
double impact_duration(const Law& law, double mass, double speed);

/// The penetration alpha of the surfaces alone, without the deflection of the local compliance, m.
double surface_penetration(const Law& law, double penetration);

/// Elastic energy at a penetration, including the local compliance: the integral of k*alpha^n over the penetration, J.
double potential(const Law& law, double penetration);

/// The penetration at which the static normal force is `normal`.
double static_penetration(const Law& law, double normal);

/// Hertz stiffness of two curved bodies, eq. 48, N/m^1.5, with the radius R_i R_j/(R_i + R_j), or the arc's radius on a
/// straight line.
double hertz_stiffness(double radius, double young_i, double poisson_i, double young_j, double poisson_j);

}  // namespace traverse::contact
