// The foundation of the paper's section 3: springs and dampers that hold the beam besides its supports, at stations and
// along beds. A kind of foundation is a member of Foundation and a row of foundation_kinds below it; everything else,
// from the option table to the results, walks that table.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "traverse/beam/distribution.hpp"
#include "traverse/beam/foundation_law.hpp"

namespace traverse::beam {

/// What of the beam a foundation holds: its deflection v, its displacement along x u, or its slope.
enum class Direction { vertical, longitudinal, rotational };
inline constexpr std::size_t direction_count = 3;

/// A spring and a damper at one station (vertical or longitudinal: N/m, N s/m; rotational: N m/rad, N m s/rad).
struct PointFoundation {
  double x = 0.0;
  double k = 0.0;
  double c = 0.0;
  bool from_left = false;  // on the end of two separate spans, or beside a hinge: it holds the left one
  FoundationLaw law = {};
  double depth = 0.0;  // m below the beam's axis at which it holds along x; only at span ends
};

/// A bed along the whole beam: a point's k and c per length, neither negative.
struct Bed {
  Distribution k;
  Distribution c;
  FoundationLaw law = {};
};

/// Each kind is assembled into a matrix of its own. It pushes back: the force on the beam is -k v - c dv/dt. What has a
/// law that is not linear is in none of the matrices (nonlinear_points.hpp).
/// The longitudinal kinds have no effect on a beam without axial unknowns.
struct Foundation {
  std::vector<PointFoundation> vertical;      // 3.2
  std::optional<Bed> vertical_bed;            // 3.3
  std::vector<PointFoundation> longitudinal;  // 3.4
  std::optional<Bed> longitudinal_bed;        // 3.5
  std::vector<PointFoundation> rotational;    // 3.6
  std::optional<Bed> rotational_bed;          // holds the slope along the beam; not in the paper

  /// Whether any of it has a law that is not linear.
  bool nonlinear() const;
};

/// One row of the table: points at stations, or a bed, that hold the beam in a direction.
struct FoundationKind {
  std::string_view name;  // of its options and results
  Direction direction = Direction::vertical;
  std::vector<PointFoundation> Foundation::*points = nullptr;  // one of these two
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

/// Where a kind stands in the table. Throws InputError when there is none of this name.
std::size_t foundation_kind(std::string_view name);

/// What acts on the beam where a direction is held: its name and unit.
struct FoundationForceName {
  std::string_view quantity, unit;
};
inline constexpr std::array<FoundationForceName, direction_count> foundation_forces = {
    {{"force", "N"}, {"force", "N"}, {"moment", "N m"}}};
constexpr const FoundationForceName& force_name(const FoundationKind& kind) {
  return foundation_forces[static_cast<std::size_t>(kind.direction)];
}

/// The units of what describes a kind.
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

/// The rate at which bending beside a load fades along a bed of k on a beam of EI, 1/m: lambda = (k/(4 EI))^(1/4) on a
/// vertical bed, (k/EI)^(1/2) on a rotational one, 0 on a longitudinal one.
double fading_of_bending(Direction direction, double k, double EI);

/// Calls use(kind, points) for the kinds that stand at stations.
template <class F, class Use>
void for_points(F& foundation, Use use) {
  for (const FoundationKind& kind : foundation_kinds)
    if (kind.points != nullptr) use(kind, foundation.*kind.points);
}
/// Calls use(kind, bed) for the beds that there are.
template <class F, class Use>
void for_beds(F& foundation, Use use) {
  for (const FoundationKind& kind : foundation_kinds)
    if (kind.bed != nullptr && foundation.*kind.bed) use(kind, *(foundation.*kind.bed));
}

/// Whether there is any of a kind.
bool present(const Foundation& foundation, const FoundationKind& kind);
/// The same of a direction.
bool present(const Foundation& foundation, Direction direction);

}  // namespace traverse::beam
