// Outputs of the structure: responses of the bridge and of a rail at the probes, the reactions of supports, and the
// balance of all forces.
#include <numeric>
#include <utility>

#include "output_groups.hpp"

namespace traverse::run {
namespace {

using recovery::Response;
using Pair = std::array<double, 2>;
using Triple = std::array<double, 3>;

constexpr Row<Response> motion_rows[] = {
    {"deflection", "m", of<&Response::deflection>},
    {"velocity", "m/s", of<&Response::velocity>},
    {"acceleration", "m/s2", of<&Response::acceleration>},
};

// With supports that have settled or move.
constexpr Row<Response> relative_rows[] = {{"relative_deflection", "m", of<&Response::relative_deflection>}};

// Quantities of beams by elements.
constexpr Row<Response> force_rows[] = {
    {"moment", "N m", of<&Response::moment>},
    {"axial_displacement", "m", of<&Response::axial_displacement>},
    {"axial_force", "N", of<&Response::axial_force>},
};

// Quantities of beams that twist.
constexpr Row<Response> twist_rows[] = {
    {"twist", "rad", of<&Response::twist>},
    {"torsional_moment", "N m", of<&Response::torsional_moment>},
    {"track_twist", "m", [](const Response& r) { return track_twist(r); }},
};

// Quantities of the bridge only.
constexpr Row<Response> shear_rows[] = {{"shear", "N", of<&Response::shear>}};

constexpr Row<beam::Reaction> support_rows[] = {{"reaction", "N, N, N m", [](const beam::Reaction& r) {
                                                   return Triple{r[0], r[1], r[2]};
                                                 }}};
constexpr Row<std::array<double, 2>> bearing_rows[] = {
    {"left_bearing", "N", [](const std::array<double, 2>& up) { return up[0]; }},
    {"right_bearing", "N", [](const std::array<double, 2>& up) { return up[1]; }}};
constexpr Row<beam::Reaction> torque_rows[] = {{"torque", "N m", [](const beam::Reaction& r) { return r[3]; }}};

constexpr Row<structure::Movement> movement_rows[] = {
    {"displacement", "m", of<&structure::Movement::displacement>},
    {"velocity", "m/s", of<&structure::Movement::velocity>},
    {"acceleration", "m/s2", of<&structure::Movement::acceleration>},
};
constexpr Row<structure::Movement> movement_along_rows[] = {
    {"displacement_along", "m", of<&structure::Movement::displacement>},
    {"velocity_along", "m/s", of<&structure::Movement::velocity>},
    {"acceleration_along", "m/s2", of<&structure::Movement::acceleration>},
};

/// Resultants {x, y} of all forces on the structure, and their sum. The resultants along x are zero if the structure
/// has no axial unknowns.
struct Balance {
  Pair load{}, support{}, foundation{}, inertia{}, drag{}, residual{};
};

constexpr Row<Balance> balance_rows[] = {
    {"load", "N, N", of<&Balance::load>},
    {"support", "N, N", of<&Balance::support>},
    {"foundation", "N, N", of<&Balance::foundation>},
    {"inertia", "N, N", of<&Balance::inertia>},
    {"drag", "N, N", of<&Balance::drag>},
    {"residual", "N, N", of<&Balance::residual>},
};

/// gravity: gravity for the structure's own weight, m/s2; 0 without it. gradient: gradient of the beam.
Balance balance_of(const Observed& now, double gravity, bool axial, double gradient) {
  const recovery::GroundForces& ground = *now.ground;
  Balance b;
  b.load = {0.0, -(gravity * ground.mass())};
  if (axial) b.load[0] = gradient * b.load[1];
  for (const recovery::ElementLoad& l : now.motion.loads) {
    if (axial) b.load[0] += l.fx;
    b.load[1] += l.fy;
  }
  for (const beam::Reaction& r : now.supports) {
    b.support[0] += r[0];
    b.support[1] += r[1];
  }
  b.foundation = ground.foundation();
  b.foundation[0] += now.motion.beam.foundation.along_ground;
  b.foundation[1] += now.motion.beam.foundation.of_ground;
  for (std::size_t k = 0; k < beam::foundation_kind_count; ++k) {
    const beam::Direction direction = beam::foundation_kinds[k].direction;
    if (direction == beam::Direction::rotational) continue;
    double& sum = b.foundation[direction == beam::Direction::longitudinal ? 0 : 1];
    const std::vector<double>& more = now.motion.beam.foundation.of_kind[k];
    sum = std::accumulate(more.begin(), more.end(), sum);
  }
  b.inertia = ground.inertia();
  b.drag = ground.drag();
  for (std::size_t i = 0; i < 2; ++i)
    b.residual[i] = b.load[i] + b.support[i] + b.foundation[i] + b.inertia[i] + b.drag[i];
  return b;
}

const Response& probe(const Observed& now, std::size_t i) { return now.probes[i]; }
const Response& rail(const Observed& now, std::size_t i) { return now.rail[i]; }
const beam::Reaction& support(const Observed& now, std::size_t i) { return now.supports[i]; }
const structure::Movement& moved_upward(const Observed& now, std::size_t i) { return now.support_motion[0][i]; }
const structure::Movement& moved_along(const Observed& now, std::size_t i) { return now.support_motion[1][i]; }

/// The torques of the supports, and the forces of their two bearings.
void add_bearings(const beam::Torsion& torsion, std::size_t supports, Outputs& outputs) {
  outputs.add_each("/supports/", torque_rows, supports, support);
  if (torsion.bearing_spacing.empty()) return;
  outputs.add_each("/supports/", bearing_rows, supports, [&torsion](const Observed& now, std::size_t i) {
    return beam::bearing_forces(torsion, i, now.supports[i]);
  });
}

}  // namespace

void add_probes(const Source& source, Outputs& outputs) {
  const std::vector<double>& x = source.scene.output.probes;
  if (x.empty()) return;
  outputs.add_constant("/probes/x", x, "m");
  if (std::vector<double> e = source.scene.output.eccentricities; !e.empty()) {
    for (double& one : e) one += source.beam->model().torsion->shear_centre;
    outputs.add_constant("/probes/eccentricity", e, "m");
  }
  outputs.add_each("/probes/", motion_rows, x.size(), probe);
  if (source.scene.supports_displaced()) outputs.add_each("/probes/", relative_rows, x.size(), probe);
  if (source.beam->model().given) return;
  outputs.add_each("/probes/", force_rows, x.size(), probe);
  outputs.add_each("/probes/", shear_rows, x.size(), probe);
  if (source.beam->model().torsion) outputs.add_each("/probes/", twist_rows, x.size(), probe);
}

void add_supports(const Source& source, Outputs& outputs) {
  if (source.beam->model().given) return;
  const std::vector<double> x = source.beam->mesh().span_ends();
  outputs.add_constant("/supports/x", x, "m");
  outputs.add_each("/supports/", support_rows, x.size(), support);
  if (source.beam->model().torsion) add_bearings(*source.beam->model().torsion, x.size(), outputs);
  if (!source.scene.support_motion.empty()) outputs.add_each("/supports/", movement_rows, x.size(), moved_upward);
  if (!source.scene.support_motion_along.empty())
    outputs.add_each("/supports/", movement_along_rows, x.size(), moved_along);
}

void add_balance(const Source& source, Outputs& outputs) {
  if (source.beam->model().given) return;
  const double gravity = source.scene.self_weight ? source.scene.gravity : 0.0;
  outputs.add("/balance/", balance_rows,
              [gravity, axial = source.beam->model().axial, gradient = source.beam->model().gradient](
                  const Observed& now) { return balance_of(now, gravity, axial, gradient); });
}

void add_dampers(const Source& source, Outputs& outputs) {
  const std::vector<beam::MassDamper>& dampers = source.beam->model().dampers;
  if (dampers.empty()) return;
  std::vector<double> x;
  for (const beam::MassDamper& damper : dampers) x.push_back(damper.x);
  outputs.add_constant("/dampers/x", std::move(x), "m");
  outputs.add_numbers("/dampers/travel", "m", dampers.size(),
                      [](const Observed& now, std::size_t i) { return now.dampers->travel(i); });
  outputs.add_numbers("/dampers/force", "N", dampers.size(),
                      [](const Observed& now, std::size_t i) { return now.dampers->force(i); });
}

void add_rail(const Source& source, Outputs& outputs) {
  if (source.beam->rail() == nullptr) return;
  const std::size_t probes = source.scene.output.probes.size();
  outputs.add_each("/rail/", motion_rows, probes, rail);
  outputs.add_each("/rail/", force_rows, probes, rail);
  if (const std::vector<double>& x = source.scene.output.rail; !x.empty()) {
    const auto at_station = [probes](const Observed& now, std::size_t i) { return now.rail[probes + i]; };
    outputs.add_constant("/rail/stations/x", x, "m");
    outputs.add_each("/rail/stations/", motion_rows, x.size(), at_station);
    outputs.add_each("/rail/stations/", force_rows, x.size(), at_station);
  }
  const std::vector<double> devices = recovery::RailDevices(*source.beam).x();
  if (devices.empty()) return;
  outputs.add_constant("/rail/devices/x", devices, "m");
  outputs.add_numbers("/rail/devices/opening", "m", devices.size(),
                      [](const Observed& now, std::size_t i) { return now.devices->openings()[i]; });
}

void add_outputs_of_modes(const Source& source, Outputs& outputs) {
  if (!source.beam->model().given) return;
  for (const beam::GivenModes::Output& output : source.beam->model().given->outputs)
    outputs.add_number("/outputs/" + output.name, output.unit, [&output](const Observed& now) {
      const std::vector<double>& q = now.motion.beam.coordinates;
      return std::inner_product(q.begin(), q.end(), output.of_mode.begin(), 0.0);
    });
}

}  // namespace traverse::run
