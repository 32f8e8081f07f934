// The foundation of section 3 of the paper: springs and dampers that hold the beam in addition to its supports, at
// stations and as beds. Each kind of foundation is a member of Foundation and a row of foundation_kinds. Options,
// matrices and results iterate over these rows.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/beam/distribution.hpp"
#include "traverse/beam/foundation_law.hpp"

namespace traverse::beam {

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
