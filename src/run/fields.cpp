#include "fields.hpp"

#include <algorithm>
#include <numeric>

#include "traverse/run/watch.hpp"

namespace traverse::app {
namespace {

constexpr std::size_t most_points = 2000;  // of a kind whose forces are stored one by one

using beam::GroundForces;
using beam::PointFoundation;

/// Calls use(number of the kind, count) for the kinds of foundation that the beam has and that are stored: a force for
/// every point, or for every span on a bed.
template <class Use>
void for_foundations(const beam::Beam& beam, Use use) {
  const beam::BeamModel& model = beam.model();
  for (std::size_t i = 0; i < beam::foundation_kind_count; ++i) {
    const beam::FoundationKind& kind = beam::foundation_kinds[i];
    if (!present(model.foundation, kind) || !acts(kind, model)) continue;
    const std::size_t count = kind.bed != nullptr ? model.spans.size() : (model.foundation.*kind.points).size();
    if (count <= most_points) use(i, count);
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
  for_foundations(beam, [&](std::size_t i, std::size_t count) {
    const beam::FoundationKind& kind = beam::foundation_kinds[i];
    const std::string group = "/foundation/" + std::string(kind.name) + "/";
    if (kind.points != nullptr) {
      std::vector<double> x;
      for (const PointFoundation& p : beam.model().foundation.*kind.points) x.push_back(p.x);
      layout.constants.push_back({group + "x", x, "m"});
    }
    const beam::FoundationForceName& force = beam::force_name(kind);
    layout.fields.push_back({group + std::string(force.quantity), count, std::string(force.unit)});
  });
}

void fill_foundation(const beam::Beam& beam, const GroundForces& linear, const structure::NonlinearForces& other,
                     Fields& fields) {
  for_foundations(beam, [&](std::size_t i, std::size_t count) {
    const double* first = linear.of_kind(i);
    std::vector<double>& field = fields.next();
    field.assign(first, first + count);
    const std::vector<double>& more = other.of_kind[i];
    for (std::size_t j = 0; j < more.size(); ++j) field[j] += more[j];
  });
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
  for (std::size_t i = 0; i < beam::foundation_kind_count; ++i) {
    const beam::Direction direction = beam::foundation_kinds[i].direction;
    if (direction == beam::Direction::rotational) continue;
    double& sum = foundation[direction == beam::Direction::longitudinal ? 0 : 1];
    const std::vector<double>& more = observation.beam.foundation.of_kind[i];
    sum = std::accumulate(more.begin(), more.end(), sum);
  }
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
