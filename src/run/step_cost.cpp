// Counts unknowns and bodies and multiplies them by what one of each was found to take.
#include "run/step_cost.hpp"

#include <algorithm>

#include "base/one_step_methods.hpp"
#include "beam/layered_track.hpp"

namespace traverse::app {
namespace {

// s, of an unknown in a stage with its part of the step's end: of a continuous bridge, of spans apart, under a layered
// track.
constexpr double continuous = 7.2e-9, apart = 3.8e-9, layered = 16.6e-9;
constexpr double layered_unknowns = 5.0;   // of a column of a layered track
constexpr double elements_of_span = 20.0;  // where they are not chosen yet
// s, in a stage: what every one takes, a body of a mechanism, a body of linear vehicles, a probe.
constexpr double a_stage = 2e-6, a_body = 9.6e-7, a_linear_body = 1.6e-7, a_probe = 2e-8;
constexpr double rough_over_level = 3.0;  // stages on a rough track: no vehicle rests, contacts take more iterations
// s, of a run's stage in a batch: a vehicle, an element.
constexpr double a_lane_vehicle = 1e-7, a_lane_element = 5e-9;
// s, of an instant by modes: a mode, a mode's part of a probe; times that where dampers couple them.
constexpr double a_mode = 2e-9, a_mode_of_probe = 4e-10, coupled_over_uncoupled = 8.0;

double bodies_of(const Scene& scene) {
  double bodies = 0.0;
  for (const int type : scene.train.vehicles)
    bodies += static_cast<double>(scene.vehicles[static_cast<std::size_t>(type)].mechanism.bodies.size());
  return bodies;
}

double roughness_of(const Scene& scene) { return scene.profile.level() ? 1.0 : rough_over_level; }

}  // namespace

double unknowns_of(const Scene& scene, int elements) {
  if (!scene.beam) return 0.0;
  const beam::BeamModel& beam = *scene.beam;
  const auto spans = static_cast<double>(beam.spans.size());
  if (beam.track) {
    const int now = beam.track->elements_per_bay;
    return layered_unknowns * beam::rail_mesh(beam).elements * (elements > 0 ? elements : now) / now;
  }
  const double a_node = beam.axial ? 3.0 : 2.0;
  if (elements > 0) {
    const double longest = *std::max_element(beam.spans.begin(), beam.spans.end());
    return a_node * (beam.length() / longest * elements + spans);
  }
  if (scene.mesh_open) return a_node * elements_of_span * spans;
  double all = 0.0;
  for (const int count : beam.elements) all += count;
  return a_node * (all + spans);
}

double unknown_seconds(const Scene& scene) {
  if (!scene.beam) return 0.0;
  if (scene.beam->track) return layered;
  return scene.beam->all_separate() && scene.beam->spans.size() > 1 ? apart : continuous;
}

double step_seconds(const Scene& scene, const std::string& method, int elements, double moving) {
  const structure::MethodRow* row = structure::find_method(method);
  const double stages = (row == nullptr ? structure::methods().front() : *row).solves();
  const bool linear = scene.model.vehicles == VehicleModel::linear ||
                      (scene.model.vehicles == VehicleModel::automatic && scene.beam && scene.train.steady());
  const double body = linear ? a_linear_body : a_body;
  const double probes = a_probe * static_cast<double>(scene.output.probes.size());
  return stages * (roughness_of(scene) * (a_stage + body * bodies_of(scene)) + probes +
                   moving * unknown_seconds(scene) * unknowns_of(scene, elements));
}

double batch_stage_seconds(const Scene& scene, double elements) {
  return roughness_of(scene) *
         (a_lane_vehicle * static_cast<double>(scene.train.vehicles.size()) + a_lane_element * elements);
}

double modal_instant_seconds(const Scene& scene, double modes, bool coupled) {
  const auto probes = static_cast<double>(scene.output.probes.size());
  return (coupled ? coupled_over_uncoupled : 1.0) * modes * (a_mode + a_mode_of_probe * probes);
}

}  // namespace traverse::app
