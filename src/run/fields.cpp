#include "fields.hpp"

#include <algorithm>
#include <numeric>

#include "traverse/run/watch.hpp"

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

struct RailQuantity {
  const char* name;
  const char* unit;
  double beam::Response::*member;
};
constexpr RailQuantity rail_quantities[] = {
    {"deflection", "m", &beam::Response::deflection},
    {"velocity", "m/s", &beam::Response::velocity},
    {"acceleration", "m/s2", &beam::Response::acceleration},
    {"moment", "N m", &beam::Response::moment},
    {"axial_displacement", "m", &beam::Response::axial_displacement},
    {"axial_force", "N", &beam::Response::axial_force},
};

}  // namespace

void describe_foundation(const beam::Beam& beam, results::Layout& layout) {
  for_points(beam, [&](const PointKind& kind, std::size_t count) {
    const std::string group = std::string("/foundation/") + kind.name + "/";
    std::vector<double> x;
    for (const PointFoundation& p : beam.model().foundation.*kind.points) x.push_back(p.x);
    layout.constants.push_back({group + "x", x, "m"});
    layout.fields.push_back({group + kind.quantity, count, kind.unit});
  });
  for_beds(beam, [&](const BedKind& kind, std::size_t spans) {
    layout.fields.push_back({std::string("/foundation/") + kind.name + "/force", spans, "N"});
  });
}

void fill_foundation(const beam::Beam& beam, const GroundForces& linear, const structure::NonlinearForces& other,
                     Fields& fields) {
  const auto fill = [&](const auto& kind, std::size_t count) {
    const double* first = (linear.*kind.force)();
    std::vector<double>& field = fields.next();
    field.assign(first, first + count);
    const std::vector<double>& more = other.*kind.other;
    for (std::size_t i = 0; i < more.size(); ++i) field[i] += more[i];
  };
  for_points(beam, fill);
  for_beds(beam, fill);
}

void describe_balance(results::Layout& layout) {
  for (const char* name : {"load", "support", "foundation", "inertia", "drag", "residual"})
    layout.fields.push_back({std::string("/balance/") + name, 2, "N, N"});
}

void fill_balance(const GroundForces& forces, const coupling::Observation& observation,
                  const std::vector<std::array<double, 3>>& supports, double weight, bool axial, Fields& fields) {
  std::array<double, 2> load{0.0, -weight}, support{}, residual{};
  for (const beam::ElementLoad& l : observation.loads) {
    if (axial) load[0] += l.fx;
    load[1] += l.fy;
  }
  for (const auto& r : supports) {
    support[0] += r[0];
    support[1] += r[1];
  }
  auto foundation = forces.foundation();
  const auto add = [](const std::vector<double>& more, double& sum) {
    sum = std::accumulate(more.begin(), more.end(), sum);
  };
  const structure::NonlinearForces& other = observation.beam.foundation;
  for (const auto* along : {&other.longitudinal, &other.longitudinal_bed}) add(*along, foundation[0]);
  for (const auto* up : {&other.vertical, &other.vertical_bed}) add(*up, foundation[1]);
  const auto inertia = forces.inertia(), drag = forces.drag();
  for (std::size_t i = 0; i < 2; ++i) residual[i] = load[i] + support[i] + foundation[i] + inertia[i] + drag[i];
  for (const auto& term : {load, support, foundation, inertia, drag, residual})
    fields.next().assign(term.begin(), term.end());
}

void describe_rail(const std::vector<double>& stations, results::Layout& layout) {
  for (const RailQuantity& q : rail_quantities)
    layout.fields.push_back({std::string("/rail/") + q.name, stations.size(), q.unit});
}

void fill_rail(const std::vector<beam::Response>& rail, Fields& fields) {
  for (const RailQuantity& q : rail_quantities) {
    std::vector<double>& field = fields.next();
    for (const beam::Response& r : rail) field.push_back(r.*q.member);
  }
}

void describe_couplers(const train::Train& train, results::Layout& layout) {
  for (const train::Coupler& c : train.couplers) {
    const std::string group = "/couplers/" + c.name + "/";
    layout.constants.push_back({group + "gap", {c.gaps.begin(), c.gaps.end()}, "1"});
    if (!c.joint) layout.fields.push_back({group + "force", c.gaps.size(), "N"});
    if (!c.joint) continue;
    layout.fields.push_back({group + "fx", c.gaps.size(), "N"});
    layout.fields.push_back({group + "fy", c.gaps.size(), "N"});
    layout.fields.push_back({group + "moment", c.gaps.size(), "N m"});
  }
}

void fill_couplers(const train::Fleet& fleet, const train::Train& train, Fields& fields) {
  auto part = fleet.couplers.begin();
  for (const train::Coupler& c : train.couplers) {
    const auto first = part;
    part += static_cast<std::ptrdiff_t>(c.gaps.size());
    for (int component = 0; component < (c.joint ? 3 : 1); ++component) {
      std::vector<double>& field = fields.next();
      for (auto gap = first; gap != part; ++gap) {
        const train::MovingVehicle& unit = fleet.vehicles[gap->unit];
        field.push_back(c.joint ? unit.mechanism.joint_reaction(unit.state, gap->part)[component]
                                : unit.mechanism.spring_force(unit.state, gap->part));
      }
    }
  }
}

results::Layout layout_of(const Scene& scene, const coupling::System& system, const beam::Beam* beam) {
  results::Layout layout;
  describe_couplers(scene.train, layout);
  if (beam != nullptr) {
    layout.probes = scene.output.probes;
    layout.supports = beam->mesh().span_ends();
    describe_foundation(*beam, layout);
    describe_balance(layout);
    if (beam->rail() != nullptr) describe_rail(scene.output.probes, layout);
  }
  for (const train::Member& member : system.fleet().members) {
    results::Layout::VehicleNames names;
    const train::Vehicle& type = *member.type;
    for (const multibody::Body& b : type.mechanism.bodies) names.bodies.push_back(b.name);
    for (const train::Wheel& w : type.wheels) names.wheels.push_back(w.name);
    for (const contact::BodyContact& c : type.contacts) names.wheels.push_back(c.name);
    for (const multibody::Joint& j : type.mechanism.joints) names.joints.push_back(j.name);
    for (const multibody::Spring& s : type.mechanism.springs) names.springs.push_back(s.name);
    for (const multibody::TorsionSpring& s : type.mechanism.torsion_springs) names.torsion_springs.push_back(s.name);
    layout.vehicles.push_back(std::move(names));
  }
  return layout;
}

}  // namespace traverse::app
