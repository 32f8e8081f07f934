// Assembles the bridge with a coarse mesh and finds the static equilibrium of the first run.
#include "scene_at_rest.hpp"

#include <Eigen/Core>
#include <numbers>
#include <vector>

#include "error_control/accuracy.hpp"
#include "error_control/sweep_model.hpp"
#include "modes/modes.hpp"
#include "results/stage.hpp"
#include "run/passage.hpp"
#include "study/study_scenes.hpp"

namespace traverse::check {
namespace {

/// The scene with the first mesh of trial runs. A layered track and given modes keep what they have.
scene::Scene with_coarse_mesh(scene::Scene scene) {
  if (!scene.beam || scene.beam->track || scene.by_given_modes()) return scene;
  scene.mesh_open = true;
  scene.model.modes = 0;
  error_control::set_first_mesh(scene);
  return scene;
}

}  // namespace

scene::Scene first_scene(const scene::Scene& given) { return given.study ? study::StudyScenes(given).base(0) : given; }

scene::Scene first_run(const scene::Scene& whole) {
  if (!whole.sweep) return whole;
  const std::vector<double>& speeds = whole.sweep->speeds;
  return error_control::at_speed(whole, speeds.empty() ? scene::moving_speed(whole) : speeds.front());
}

SceneAtRest::SceneAtRest(const scene::Scene& given)
    : whole(first_scene(given)), scene(with_coarse_mesh(first_run(whole))) {
  std::vector<std::string> ignored;
  shared = std::make_unique<run::SharedBeam>(PETSC_COMM_SELF, scene, ignored);
  if (scene.analysis == options::Analysis::modes) return;
  if (shared->beam) shared->beam->set_rayleigh({});  // has no effect at rest
  shared->prepare(scene, ignored);
  put_to_rest();
}

void SceneAtRest::put_to_rest() {
  const results::Stage stage("search for the static equilibrium");
  const bool stays = scene.analysis != options::Analysis::transient;
  const coupling::SystemInput input = run::system_input(scene, stays);
  system = std::make_unique<coupling::System>(PETSC_COMM_SELF, run::carrier(scene, *shared, input), input);
  std::vector<Eigen::VectorXd> placed;
  for (const train::MovingVehicle& vehicle : system->fleet().vehicles) placed.push_back(vehicle.state.q);
  std::vector<double> state(static_cast<std::size_t>(system->local_size()));
  const bool settles = stays || scene.start == scene::Start::equilibrium;
  system->start(settles, state.data(), stays);
  for (std::size_t k = 0; settles && k < placed.size(); ++k) {
    const train::MovingVehicle& vehicle = system->fleet().vehicles[k];
    const multibody::MechanismModel& model = vehicle.mechanism.model();
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const auto at = 3 * static_cast<Eigen::Index>(b);
      Eigen::Vector2d by = (vehicle.state.q - placed[k]).segment<2>(at);
      by.y() -= scene.profile.at(vehicle.state.q[at]).value;
      if (by.norm() > displaced.distance) displaced = {by.norm(), by.y(), model.name, model.bodies[b].name};
    }
  }
}

double SceneAtRest::first_frequency() const {
  if (!shared->beam) return 0.0;
  const beam::Beam& beam = *shared->beam;
  if (beam.model().given) return beam.model().given->omega.front() / (2.0 * std::numbers::pi);
  const bool linear = beam.rail() == nullptr && beam.model().dampers.empty() && !beam.model().nonlinear();
  const std::vector<double> omega =
      linear ? modes::distinct_frequencies(beam, 1)
             : modes::distinct_frequencies(beam::Beam(PETSC_COMM_SELF, linearised(bridge_alone(beam.model()))), 1);
  return omega.empty() ? 0.0 : omega.front() / (2.0 * std::numbers::pi);
}

}  // namespace traverse::check
