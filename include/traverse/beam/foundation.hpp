// The foundation of section 3 of the paper: springs and dampers that hold the beam in addition to its supports, at
// stations and as beds, and quantities that vary along the beam. Each kind of foundation is a member of Foundation and
// a row of foundation_kinds. Options, matrices and results iterate over these rows.
//
// The law of a foundation that is one-sided or has a gap or a cubic term; a bed obeys the law per length. With the
// displacement d of the beam at the station (upward, to the right, counter-clockwise) and the gap g:
//   |d| <= g:  no force;     |d| > g:  s = |d| - g,  force k s + cubic s^3 + c ds/dt, towards d = 0.
// A one-sided foundation acts only if the beam is pressed down, d < -g. A foundation that is one-sided or has a gap
// never pulls: if k s + cubic s^3 + c ds/dt is negative, the beam moves away faster than the foundation follows, and
// the force is zero. The damper force increases linearly over the first nanometre of s; otherwise a stage of an
// implicit method that ends in this range could have no solution. The work of the force minus the work
// of the spring is dissipated.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::beam {

/// A quantity over x: a constant, or a piecewise linear table. The quantity jumps at an x that occurs twice. Outside
/// the table the end value applies.
class Distribution {
 public:
  Distribution(double value = 0.0) : values_{value} {}  // NOLINT: a number is a distribution
  /// x must not decrease, and at most two successive values may be equal; otherwise an InputError that names `name` is
  /// thrown.
  Distribution(std::vector<double> x, std::vector<double> values, const std::string& name);

  /// The value at x; at a jump the value on the side of `inside`.
  double at(double x, double inside) const;
  bool uniform() const { return x_.empty(); }
  double minimum() const;
  double maximum() const;
  /// This distribution increased by `value` everywhere.
  Distribution plus(double value) const;
  /// This distribution multiplied by `factor` between `from` and `to`, with a jump at both ends.
  Distribution with_factor(double from, double to, double factor) const;
  /// Stations of the table strictly inside (a, b), each once, at which an integration must be divided.
  std::vector<double> breaks(double a, double b) const;
  /// Stations strictly inside (a, b) at which the value jumps.
  std::vector<double> steps(double a, double b) const;

 private:
  std::vector<double> x_;
  std::vector<double> values_;
};

/// The properties that make a foundation nonlinear; with the default values it is linear.
struct FoundationLaw {
  bool one_sided = false;
  double gap = 0.0;    // in both directions, m or rad, >= 0
  double cubic = 0.0;  // N/m3, N m/rad3; for a bed N/m4; >= 0
  /// The force at which a longitudinal point slides, as a bearing does by friction, N; 0: it never slides. A sliding
  /// point has none of the other properties.
  double slides_at = 0.0;

  /// Whether the force is not proportional to displacement and rate.
  bool nonlinear() const { return one_sided || gap > 0.0 || cubic > 0.0 || slides_at > 0.0; }
};

/// The force with its derivatives, energy and dissipation at a displacement d and its rate w.
struct FoundationForce {
  double force = 0.0;            // on the beam, N or N m
  double by_displacement = 0.0;  // -d force/dd, N/m
  double by_rate = 0.0;          // -d force/dw, N s/m, >= 0
  double energy = 0.0;           // strain energy of the spring, J
  double dissipation = 0.0;      // W, >= 0
};
FoundationForce foundation_force(const FoundationLaw& law, double k, double c, double d, double w);

/// A spring that slides if its force reaches a limit: the longitudinal resistance of a sleeper (UIC 774-3) or the
/// friction of a bearing. A sleeper under a train has a larger stiffness and limit.
struct Sliding {
  double k = 0.0, limit = 0.0;                // N/m, N; limit 0: it never slides
  double loaded_k = 0.0, loaded_limit = 0.0;  // stiffness and limit under a train, N/m, N

  /// Stiffness (N/m) and limit (N), under a train or outside it.
  double k_of(bool loaded) const { return loaded ? loaded_k : k; }
  double limit_of(bool loaded) const { return loaded ? loaded_limit : limit; }
};
/// The force after a displacement d (m) from the position with the force `previous` (N), which is first limited to
/// `limit`.
FoundationForce sliding_force(double k, double limit, double previous, double d);

/// The displacement that a foundation resists: the deflection v, the displacement u along x, or the slope.
enum class Direction { vertical, longitudinal, rotational };
inline constexpr std::size_t direction_count = 3;

/// A spring and a damper at one station (vertical or longitudinal: N/m, N s/m; rotational: N m/rad, N m s/rad).
struct PointFoundation {
  double x = 0.0;
  double k = 0.0;
  double c = 0.0;
  bool from_left = false;  // between two separate spans or at a hinge: it holds the left side
  FoundationLaw law = {};
  double depth = 0.0;            // depth of a longitudinal point below the beam's axis, m; only at span ends
  double eccentricity = 0.0;     // of a vertical point to the left of the shear centre, m; only if the beam twists
  std::string_view option = {};  // that defines k; empty: foundation_KIND_k
};

/// A bed along the whole beam: k and c of a point per length, both >= 0.
struct Bed {
  Distribution k;
  Distribution c;
  FoundationLaw law = {};
  std::string_view option = {};  // that defines k; empty: foundation_KIND_k
};

/// Each kind is assembled into its own matrix. The force on the beam is -k v - c dv/dt. Foundations with a nonlinear
/// law are in none of the matrices (nonlinear_points.hpp). The longitudinal kinds have no effect on a beam without
/// axial unknowns.
struct Foundation {
  std::vector<PointFoundation> vertical;      // 3.2
  std::optional<Bed> vertical_bed;            // 3.3
  std::vector<PointFoundation> longitudinal;  // 3.4
  std::optional<Bed> longitudinal_bed;        // 3.5
  std::vector<PointFoundation> rotational;    // 3.6
  std::optional<Bed> rotational_bed;          // resists the slope along the beam; not in the paper

  /// Whether a part of the foundation has a nonlinear law.
  bool nonlinear() const;
};

/// A row of the table: points at stations, or a bed, that resist one displacement.
struct FoundationKind {
  std::string_view name;  // in the names of its options and results
  Direction direction = Direction::vertical;
  std::vector<PointFoundation> Foundation::*points = nullptr;  // either points or bed is set
  std::optional<Bed> Foundation::*bed = nullptr;
};
inline constexpr std::array foundation_kinds = {
    FoundationKind{.name = "vertical", .direction = Direction::vertical, .points = &Foundation::vertical},
    FoundationKind{.name = "vertical_bed", .direction = Direction::vertical, .bed = &Foundation::vertical_bed},
    FoundationKind{.name = "longitudinal", .direction = Direction::longitudinal, .points = &Foundation::longitudinal},
    FoundationKind{
        .name = "longitudinal_bed", .direction = Direction::longitudinal, .bed = &Foundation::longitudinal_bed},
    FoundationKind{.name = "rotational", .direction = Direction::rotational, .points = &Foundation::rotational},
    FoundationKind{.name = "rotational_bed", .direction = Direction::rotational, .bed = &Foundation::rotational_bed},
};
inline constexpr std::size_t foundation_kind_count = foundation_kinds.size();

/// The option that defines the stiffness of a point or bed of this kind.
template <class Part>
std::string stiffness_option(const FoundationKind& kind, const Part& part) {
  return part.option.empty() ? "foundation_" + std::string(kind.name) + "_k" : std::string(part.option);
}

/// The index of a kind in the table. Throws InputError if there is no kind of this name.
std::size_t foundation_kind(std::string_view name);

/// The quantity and unit of the force of a foundation on the beam.
struct FoundationForceName {
  std::string_view quantity, unit;
};
inline constexpr std::array<FoundationForceName, direction_count> foundation_forces = {
    {{"force", "N"}, {"force", "N"}, {"moment", "N m"}}};
constexpr const FoundationForceName& force_name(const FoundationKind& kind) {
  return foundation_forces[static_cast<std::size_t>(kind.direction)];
}

/// The units of a kind's properties.
struct FoundationUnits {
  std::string_view k, c, gap, cubic;
};
constexpr FoundationUnits units_of(const FoundationKind& kind) {
  if (kind.direction == Direction::rotational)
    return kind.bed != nullptr ? FoundationUnits{"N m/rad/m", "N m s/rad/m", "rad", "N m/rad3/m"}
                               : FoundationUnits{"N m/rad", "N m s/rad", "rad", "N m/rad3"};
  return kind.bed != nullptr ? FoundationUnits{"N/m2", "N s/m2", "m", "N/m4"}
                             : FoundationUnits{"N/m", "N s/m", "m", "N/m3"};
}

/// The decay rate of bending beside a load on a beam of EI on a bed of k, 1/m: lambda = (k/(4 EI))^(1/4) on a vertical
/// bed, (k/EI)^(1/2) on a rotational one, 0 on a longitudinal one.
double bending_decay_rate(Direction direction, double k, double EI);

/// Calls use(kind, points) for each kind at stations.
template <class F, class Use>
void for_points(F& foundation, Use use) {
  for (const FoundationKind& kind : foundation_kinds)
    if (kind.points != nullptr) use(kind, foundation.*kind.points);
}
/// Calls use(kind, bed) for each bed of the foundation.
template <class F, class Use>
void for_beds(F& foundation, Use use) {
  for (const FoundationKind& kind : foundation_kinds)
    if (kind.bed != nullptr && foundation.*kind.bed) use(kind, *(foundation.*kind.bed));
}

/// Whether the foundation contains a kind.
bool present(const Foundation& foundation, const FoundationKind& kind);
/// Whether the foundation contains a kind in this direction.
bool present(const Foundation& foundation, Direction direction);

}  // namespace traverse::beam
