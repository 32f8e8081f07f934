// Estimates computing times from the numbers of unknowns and bodies, with measured times for one of each.
#include "run/step_cost.hpp"

#include <algorithm>
#include <cmath>

#include "base/one_step_methods.hpp"
#include "beam/layered_track.hpp"

namespace traverse::run {
namespace {

// Time for an unknown in a stage with its share of the step's end, s: continuous bridge, separate spans, bridge with a
// layered track.
constexpr double continuous = 7.2e-9, separate = 3.8e-9, layered = 16.6e-9;
constexpr double layered_unknowns = 5.0;   // number of unknowns in a column of a layered track
constexpr double elements_of_span = 20.0;  // if they are not chosen yet
// Time in a stage, s: constant part, for a body of a mechanism, for a body of a linear vehicle, for a probe.
constexpr double per_stage = 2e-6, per_body = 9.6e-7, per_linear_body = 1.6e-7, per_probe = 2e-8;
constexpr double per_contact_pair = 4e-8;   // of a mechanism: each of its contacts moves all others
constexpr double rough_track_factor = 3.0;  // factor for a rough track, where contacts need more iterations
// Time for a run's stage in a batch, s: for a vehicle, for an element.
constexpr double per_lane_vehicle = 1e-7, per_lane_element = 5e-9;
// Time for an instant by modes, s: for a mode, for a mode at a probe; factor for dampers that couple the modes. In a
// single run: constant part, for a mode with its energies, for a mode at an unknown.
constexpr double per_mode = 2e-9, per_mode_and_probe = 4e-10, coupled_factor = 8.0;
constexpr double per_sample = 3e-6, per_mode_with_energy = 5e-8, per_mode_and_unknown = 1e-9;

double bodies_of(const scene::Scene& scene) {
  double bodies = 0.0;
  for (const int type : scene.train.vehicles)
    bodies += static_cast<double>(scene.vehicles[static_cast<std::size_t>(type)].mechanism.bodies.size());
  return bodies;
}

/// The pairs of contacts of one mechanism, which are many in a chain on rollers.
double contact_pairs_of(const scene::Scene& scene) {
  double pairs = 0.0;
  for (const int type : scene.train.vehicles)
    pairs += std::pow(static_cast<double>(scene.vehicles[static_cast<std::size_t>(type)].wheels.size()), 2);
  return pairs;
}

double roughness_of(const scene::Scene& scene) { return scene.profile.level() ? 1.0 : rough_track_factor; }

}  // namespace

double unknowns_of(const scene::Scene& scene, int elements) {
  if (!scene.beam) return 0.0;
  const beam::BeamModel& beam = *scene.beam;
  const auto spans = static_cast<double>(beam.spans.size());
  if (beam.track) {
    const int present = beam.track->elements_per_bay;
    return layered_unknowns * beam::rail_mesh(beam).elements * (elements > 0 ? elements : present) / present;
  }
  const double per_node = beam.axial ? 3.0 : 2.0;
  if (elements > 0) {
    const double longest = *std::max_element(beam.spans.begin(), beam.spans.end());
    return per_node * (beam.length() / longest * elements + spans);
  }
  if (scene.mesh_open) return per_node * elements_of_span * spans;
  double all = 0.0;
  for (const int count : beam.elements) all += count;
  return per_node * (all + spans);
}

double unknown_seconds(const scene::Scene& scene) {
  if (!scene.beam) return 0.0;
  if (scene.beam->track) return layered;
  return scene.beam->all_separate() && scene.beam->spans.size() > 1 ? separate : continuous;
}

double step_seconds(const scene::Scene& scene, const std::string& method, int elements, double moving) {
  const base::MethodRow* row = base::find_method(method);
  const double stages = (row == nullptr ? base::methods().front() : *row).solves();
  const bool linear = scene.model.vehicles == scene::VehicleModel::linear ||
                      (scene.model.vehicles == scene::VehicleModel::automatic && scene.beam && scene.train.steady());
  const double body = linear ? per_linear_body : per_body;
  const double contacts = linear ? 0.0 : per_contact_pair * contact_pairs_of(scene);
  const double probes = per_probe * static_cast<double>(scene.output.probes.size());
  return stages * (roughness_of(scene) * (per_stage + body * bodies_of(scene) + contacts) + probes +
                   moving * unknown_seconds(scene) * unknowns_of(scene, elements));
}

double batch_stage_seconds(const scene::Scene& scene, double elements) {
  return roughness_of(scene) *
         (per_lane_vehicle * static_cast<double>(scene.train.vehicles.size()) + per_lane_element * elements);
}

double modal_instant_seconds(const scene::Scene& scene, double modes, bool coupled) {
  const auto probes = static_cast<double>(scene.output.probes.size());
  return (coupled ? coupled_factor : 1.0) * modes * (per_mode + per_mode_and_probe * probes);
}

double modal_sample_seconds(double modes, double unknowns, bool coupled) {
  return per_sample +
         modes * ((coupled ? coupled_factor : 1.0) * per_mode_with_energy + per_mode_and_unknown * unknowns);
}

}  // namespace traverse::run
