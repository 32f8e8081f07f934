// Outputs of the foundation: the forces of its points one by one, and those of its beds on each span.
#include "output_groups.hpp"

namespace traverse::app {
namespace {

constexpr std::size_t most_points = 2000;  // of a kind whose forces are stored one by one

using beam::GroundForces;
using beam::PointFoundation;

struct PointKind {
  const char* name;
  const char* quantity;
  const char* unit;
  std::vector<PointFoundation> beam::Foundation::*points;
  const double* (GroundForces::*force)() const;
  std::vector<double> structure::NonlinearForces::*other;
  bool axial;
};
constexpr PointKind point_kinds[] = {
    {"vertical", "force", "N", &beam::Foundation::vertical, &GroundForces::vertical,
     &structure::NonlinearForces::vertical, false},
    {"longitudinal", "force", "N", &beam::Foundation::longitudinal, &GroundForces::longitudinal,
     &structure::NonlinearForces::longitudinal, true},
    {"rotational", "moment", "N m", &beam::Foundation::rotational, &GroundForces::rotational,
     &structure::NonlinearForces::rotational, false},
};

struct BedKind {
  const char* name;
  std::optional<beam::Bed> beam::Foundation::*bed;
  const double* (GroundForces::*force)() const;
  std::vector<double> structure::NonlinearForces::*other;
  bool axial;
};
constexpr BedKind bed_kinds[] = {
    {"vertical_bed", &beam::Foundation::vertical_bed, &GroundForces::vertical_bed,
     &structure::NonlinearForces::vertical_bed, false},
    {"longitudinal_bed", &beam::Foundation::longitudinal_bed, &GroundForces::longitudinal_bed,
     &structure::NonlinearForces::longitudinal_bed, true},
};

/// Calls use(kind, count) for what the beam has and what is stored.
template <class Use>
void for_points(const beam::Beam& beam, Use use) {
  for (const PointKind& kind : point_kinds) {
    const std::size_t count = (beam.model().foundation.*kind.points).size();
    if (count > 0 && count <= most_points && (!kind.axial || beam.model().axial)) use(kind, count);
  }
}

template <class Use>
void for_beds(const beam::Beam& beam, Use use) {
  const std::size_t spans = beam.model().spans.size();
  for (const BedKind& kind : bed_kinds) {
    if (beam.model().foundation.*kind.bed && spans <= most_points && (!kind.axial || beam.model().axial))
      use(kind, spans);
  }
}

/// The force that is linear, of the kind's i-th point or span, and what the others add.
template <class Kind>
double force_of(const Observed& now, const Kind& kind, std::size_t i) {
  const double linear = (*now.ground.*kind.force)()[i];
  const std::vector<double>& other = now.motion.beam.foundation.*kind.other;
  return i < other.size() ? linear + other[i] : linear;
}

}  // namespace

void add_foundation(const Source& source, Outputs& outputs) {
  const auto force = [](const auto& kind) {
    return [&kind](const Observed& now, std::size_t i) { return force_of(now, kind, i); };
  };
  for_points(*source.beam, [&](const PointKind& kind, std::size_t count) {
    const std::string group = std::string("/foundation/") + kind.name + "/";
    std::vector<double> x;
    for (const PointFoundation& p : source.beam->model().foundation.*kind.points) x.push_back(p.x);
    outputs.add_constant(group + "x", x, "m");
    outputs.add_numbers(group + kind.quantity, kind.unit, count, force(kind));
  });
  for_beds(*source.beam, [&](const BedKind& kind, std::size_t spans) {
    outputs.add_numbers(std::string("/foundation/") + kind.name + "/force", "N", spans, force(kind));
  });
}

}  // namespace traverse::app
